"""Build the wheel from this checkout and try it as a user would: `./gears python -m release.wheel [FOLDER]`.

The wheel is built from the source archive, as for whoever has the archive alone. It is installed beside the packages of
this Python, and runs in an empty folder. FOLDER keeps archive and wheel; without it they are removed.
Needs a network for `pip install build`, and python3-venv on Debian.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import venv
import zipfile
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parents[1]
PACKAGE = "fenics_gears"
EXTRAS = "live,optimize,report"
SCENE = CHECKOUT / "demos" / "lundvall2004.toml"
FINISHED = "run.nc"
NOT_OF_THE_SOURCES = (
    ".git",
    ".setup",
    ".venv",
    ".*_cache",
    "results",
    "__pycache__",
    "*.egg-info",
    "build",
    "dist",
    "_build",
)


class NotReady(Exception):
    """What stands against a release, as a sentence."""


def called(*command: str | Path, folder: Path) -> str:
    """What a program prints. Raises NotReady with the end of it where it fails."""
    # A user's Python knows nothing of this checkout.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run([*map(str, command)], cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode:
        raise NotReady(f"{' '.join(map(str, command))} failed:\n{(done.stdout + done.stderr)[-3000:]}")
    return done.stdout


def files_of_package() -> set[str]:
    files = (path for path in (CHECKOUT / PACKAGE).rglob("*") if path.is_file() and path.parent.name != "__pycache__")
    return {path.relative_to(CHECKOUT).as_posix() for path in files}


def python_of(folder: Path, *, system: bool = False) -> Path:
    """The Python of a new environment in `folder`; with `system` it sees the packages of this Python as well."""
    venv.create(folder, with_pip=True, system_site_packages=system)
    return folder / "bin" / "python"


def built(folder: Path) -> Path:
    """Source archive and wheel of this checkout, in `folder`; the wheel's path."""
    with tempfile.TemporaryDirectory() as temporary:
        source = Path(temporary) / "source"
        shutil.copytree(CHECKOUT, source, ignore=_not_of_the_sources, symlinks=True)
        builder = python_of(Path(temporary) / "builder")
        called(builder, "-m", "pip", "install", "--quiet", "build", folder=source)
        called(builder, "-m", "build", "--outdir", folder, folder=source)
    (wheel,) = folder.glob("*.whl")
    return wheel


def _not_of_the_sources(folder: str, names: list[str]) -> set[str]:
    """What was installed, computed, compiled or built; the package has a folder `results` of its own."""
    unwanted = shutil.ignore_patterns(*NOT_OF_THE_SOURCES)(folder, names)
    return unwanted - {"results"} if Path(folder) == CHECKOUT / PACKAGE else unwanted


def compare(wheel: Path, expected: set[str]) -> None:
    """Raises NotReady where the wheel lacks a file of the package, or has one more."""
    with zipfile.ZipFile(wheel) as archive:
        packed = {name for name in archive.namelist() if not name.split("/")[0].endswith(".dist-info")}
    lacking = sorted(expected - packed)
    foreign = sorted(packed - expected)
    if lacking or foreign:
        raise NotReady(f"{wheel.name} lacks {lacking or 'nothing'} and has {foreign or 'nothing'} besides the package")


def try_out(wheel: Path, version: str) -> list[str]:
    """Install the wheel and run the paper's pair with it; the lines that tell how it went."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        python = python_of(folder / "environment", system=True)
        called(python, "-m", "pip", "install", "--quiet", f"{wheel}[{EXTRAS}]", folder=folder)
        command = python.with_name("gears")
        told = called(command, "--version", folder=folder).strip()
        if told != f"gears {version}":
            raise NotReady(f"the wheel's command says {told!r}, not 'gears {version}'")
        called(command, "check", SCENE, folder=folder)
        printed = called(command, "run", SCENE, "-o", folder / "result", folder=folder)
        if not (folder / "result" / FINISHED).is_file():
            raise NotReady(f"gears run of the wheel has written no {FINISHED}:\n{printed[-3000:]}")
    return [
        told,
        *(line.strip() for line in printed.splitlines() if line.strip().startswith(("transmission", "compile"))),
    ]


def main(arguments: list[str]) -> int:
    from fenics_gears import __version__

    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(arguments[0] if arguments else temporary).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        try:
            wheel = built(folder)
            compare(wheel, files_of_package())
            print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB, all files of the package")
            print(*try_out(wheel, __version__), sep="\n")
        except NotReady as reason:
            print(reason, file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
