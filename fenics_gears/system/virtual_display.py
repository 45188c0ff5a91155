"""A display in memory, for versions of VTK that cannot draw without one."""

import atexit
import os
import shutil
import subprocess

from fenics_gears.errors import ComputationError

# From this version on VTK draws off screen by EGL.
FIRST_WITHOUT_DISPLAY = (9, 4)


def ensure_display(vtk_version: tuple[int, ...]) -> None:
    """Start Xvfb, which ends with this process, where VTK of this version needs a display and there is none.

    Raises ComputationError where Xvfb is missing or does not start: VTK would abort the process.
    """
    if tuple(vtk_version[:2]) >= FIRST_WITHOUT_DISPLAY or os.environ.get("DISPLAY"):
        return
    if shutil.which("Xvfb") is None:
        raise ComputationError(
            f"VTK {'.'.join(map(str, vtk_version))} draws on a display only, and there is none. Install Xvfb (Debian:"
            " xvfb), or VTK 9.4 or later"
        )
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", "1600x1200x24", "-nolisten", "tcp"],
        pass_fds=[write],
        stderr=subprocess.DEVNULL,
    )
    # VTK holds its connection until the process ends, and would end the process with it.
    atexit.register(server.terminate)
    os.close(write)
    with os.fdopen(read) as answer:
        number = answer.readline().strip()
    if not number:
        raise ComputationError("Xvfb, the display in memory that this version of VTK draws on, did not start")
    os.environ["DISPLAY"] = f":{number}"
