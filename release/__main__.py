"""Check and build a release: `./gears python -m release [--folder DIR] [--quick]`.

It says all that stands against a release of the last commit, and makes nothing public:

1. the checkout has no changes that are not committed; package, CITATION.cff, the conda recipe and the topmost heading
   of CHANGELOG.md name one version, which has no tag yet;
2. source archive and wheel are built; the wheel has all files of the package, installs, and runs the paper's pair;
3. unless `--quick` is given: the suite, by day and by night, then Debian 12 and 13, each newly made
   (tests/debians/run, which needs root and mmdebstrap), with the wheel tried in each.

The exit code is 1 where anything stands against it. What is left to do by hand is printed: the tag, and the upload.
"""

import argparse
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from release.wheel import CHECKOUT, NotReady, built, called, compare, files_of_package, try_out

DEBIANS = ("bookworm", "trixie")
VERSIONS = {
    "fenics_gears/__init__.py": r'^__version__ = "(.+)"$',
    "CITATION.cff": r"^version: (.+)$",
    "release/recipe.yaml": r'^  version: "(.+)"$',
    "CHANGELOG.md": r"^## (.+)$",
}


def versions(checkout: Path = CHECKOUT) -> dict[str, str]:
    """The version that each file names, the first where it names several; "none" where it names none."""
    named = {}
    for name, pattern in VERSIONS.items():
        found = re.search(pattern, (checkout / name).read_text(encoding="utf-8"), re.MULTILINE)
        named[name] = found[1].strip() if found else "none"
    return named


def one_version(named: dict[str, str]) -> str:
    """Raises NotReady where files name different versions, or one that is no number."""
    own = named["fenics_gears/__init__.py"]
    others = [f"{name} says {version}" for name, version in named.items() if version != own]
    if others:
        raise NotReady(f"the package is version {own}, but {', '.join(others)}")
    if not re.fullmatch(r"\d+\.\d+\.\d+", own):
        raise NotReady(f"version {own} is not of the form 1.2.3")
    return own


def check_state(version: str) -> None:
    changes = called("git", "status", "--porcelain", folder=CHECKOUT)
    if changes:
        raise NotReady(f"not committed:\n{changes}")
    if called("git", "tag", "--list", f"v{version}", folder=CHECKOUT):
        raise NotReady(f"there is a tag v{version} already: give the next version")


def build(folder: Path, version: str) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    before = sorted(each.name for each in folder.iterdir())
    if before:
        raise NotReady(f"{folder} is not empty ({before[0]}): name a new folder")
    wheel = built(folder)
    compare(wheel, files_of_package())
    print(*try_out(wheel, version), sep="\n")


def shown(*command: str) -> None:
    """A long command, whose output is shown as it comes."""
    done = subprocess.run(command, cwd=CHECKOUT)
    if done.returncode:
        raise NotReady(f"{' '.join(command)} failed")


def steps(options: argparse.Namespace) -> Iterator[tuple[str, Callable[[], object]]]:
    named = versions()
    version = named["fenics_gears/__init__.py"]
    yield "versions", lambda: one_version(named)
    yield "state of the checkout", lambda: check_state(version)
    yield "archive and wheel", lambda: build(options.folder, version)
    if not options.quick:
        yield "suite", lambda: shown("./gears", "test", "-q")
        yield "nightly suite", lambda: shown("./gears", "test", "-q", "-m", "nightly")
        yield "fresh Debians", lambda: shown("tests/debians/run", *DEBIANS)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        "python -m release", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--folder", type=Path, metavar="DIR", help="keep archive and wheel in this new folder")
    parser.add_argument("--quick", action="store_true", help="neither suites nor Debians")
    options = parser.parse_args(arguments)
    against = []
    with tempfile.TemporaryDirectory() as temporary:
        options.folder = (options.folder or Path(temporary) / "dist").resolve()
        for name, step in steps(options):
            try:
                step()
                print(f"{name}: well", flush=True)
            except NotReady as reason:
                against.append(name)
                print(f"{name}: {reason}", flush=True)
    if against:
        print(f"No release yet: {', '.join(against)}.")
        return 1
    print("Ready. By hand: git tag, push, and the upload of both files.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
