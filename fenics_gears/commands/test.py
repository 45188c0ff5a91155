"""``gears test ...``: run the tests of the checkout; options are those of pytest."""

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from fenics_gears.errors import SceneError


def carry_out(options: Sequence[str]) -> int:
    """Run pytest with its own options; paths count from the checkout."""
    checkout = Path(__file__).resolve().parents[2]
    tests = checkout / "tests"
    if not tests.is_dir():
        raise SceneError(f"{tests}: there are no tests beside an installed program. Run `gears test` in a checkout.")
    chosen = any((checkout / option.partition("::")[0]).exists() for option in options if not option.startswith("-"))
    return subprocess.call([sys.executable, "-m", "pytest", *options, *([] if chosen else ["tests"])], cwd=checkout)
