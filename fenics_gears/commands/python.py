"""``gears python ...``: run a Python script that imports fenics_gears, or a module such as `-m jupyter lab`, in the
program's own Python."""

import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

from fenics_gears.system.environment import cache_folder

KERNEL = "python3"


def carry_out(options: Sequence[str]) -> NoReturn:
    """Become Python with these arguments, in the folder of the call; ./gears has set the path to the checkout."""
    if list(options[:1]) == ["-m"] and "jupyter" in "".join(options[1:2]):
        offer_kernel(cache_folder() / "fenics_gears" / "jupyter")
    sys.stdout.flush()
    os.execv(sys.executable, [sys.executable, *options])


def offer_kernel(folder: Path) -> None:
    """Let notebooks run in this Python. Jupyter's own kernel of that name may be the system's, as Debian's is, which
    lacks what pip installed. A folder that cannot be written leaves Jupyter as it is."""
    call = [sys.executable, "-Xfrozen_modules=off", "-m", "ipykernel_launcher", "-f", "{connection_file}"]
    kernel = {"argv": call, "display_name": "Python 3 (fenics_gears)", "language": "python"}
    place = folder / "kernels" / KERNEL / "kernel.json"
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(json.dumps(kernel), encoding="utf-8")
    except OSError:
        return
    # Jupyter looks there first.
    os.environ["JUPYTER_PATH"] = os.pathsep.join(filter(None, [str(folder), os.environ.get("JUPYTER_PATH")]))
