"""What tests/debians/run tries on each Debian."""

import argparse
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
from dataclasses import dataclass
from pathlib import Path

from tests.debians.root import Call, Root

SUITES = {"bookworm": "Debian 12", "trixie": "Debian 13", "sid": "unstable"}
DEMO = "demos/lundvall2004.toml"
# Every rank runs these whole, by itself: what is built on all ranks by mistake would differ from what is built on one,
# or hang. Jobs that share their work between ranks are started by tests of the suite.
OF_RANKS = (
    "tests/elasticity", "tests/simulation/reference", "tests/hard_cases/test_row_05_schur_complement.py",
    "tests/hard_cases/test_row_06_condensation.py", "tests/hard_cases/test_row_07_patch_test.py",
)  # fmt: skip
# mpirun as root, which containers are: as the Dockerfile has it.
AS_ROOT = {f"{prefix}_ALLOW_RUN_AS_ROOT{suffix}": "1" for prefix in ("OMPI", "PRTE") for suffix in ("", "_CONFIRM")}
VERSIONS = "import dolfinx, numpy, gmsh, platform; print(platform.python_version(), *(each.__name__ + ' ' + "
VERSIONS += "each.__version__ for each in (dolfinx, numpy, gmsh)))"
CHECKOUT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Dockerfile:
    """suite: that of its Debian; copied_to: where the checkout goes; commands: of the shell; the rest: of whoever
    runs the image."""

    suite: str
    copied_to: str
    commands: tuple[str, ...]
    environment: dict[str, str]
    folder: str
    entry_point: list[str]
    user: str


def read_dockerfile(path: Path = CHECKOUT / "Dockerfile") -> Dockerfile:
    """Raises ValueError for a step that only Docker could carry out."""
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    steps = [line.split(None, 1) for line in "\n".join(lines).replace("\\\n", " ").splitlines()]
    several = ("RUN", "ENV", "COPY")
    one, environment = {name: rest.strip() for name, rest in steps if name not in several}, {}
    suite = re.fullmatch(r"debian:(\w+)-slim", one.pop("FROM"))
    # All of the checkout is there before the first command, which then has more than Docker gives it.
    copies = dict(rest.split() for name, rest in steps if name == "COPY")
    target = copies.pop(".", "")
    folder, entry_point = one.pop("WORKDIR"), json.loads(one.pop("ENTRYPOINT"))
    user, _ = one.pop("USER"), one.pop("VOLUME")
    elsewhere = [each for source, each in copies.items() if each != f"{target}/{source}"]
    if one or not suite or not target or elsewhere:
        raise ValueError(f"{path}: only Docker can carry out {one or elsewhere or 'its FROM and COPY'}")
    for name, rest in steps:
        if name == "ENV":
            environment.update(pair.split("=", 1) for pair in shlex.split(rest))
    commands = tuple(rest for name, rest in steps if name == "RUN")
    return Dockerfile(suite[1], target, commands, environment, folder, entry_point, user)


class Trial:
    """A suite's system, and whether all that was tried on it ended well so far."""

    def __init__(self, suite: str, options):
        self.root, self.logs, self.green = Root(suite, options.roots / suite), options.logs / suite, True
        self.options, self.docker = options, read_dockerfile()
        self.logs.mkdir(parents=True, exist_ok=True)

    def note(self, name: str, call: Call) -> bool:
        """Tell how a call ended, with the last line of what it printed; whether it ended well."""
        self.green &= call.is_green
        last = (call.output.strip().splitlines() or [""])[-1]
        outcome = last if call.is_green else f"FAILED ({call.exit_code}), see {self.log(name)}: {last}"
        print(f"{SUITES[self.root.suite]}: {name}, {call.seconds:.0f} s: {outcome}", flush=True)
        return call.is_green

    def log(self, name: str) -> Path:
        return self.logs / f"{name.replace(' ', '_')}.log"

    def call(self, name: str, *command: str, folder: str = "", environment=None) -> bool:
        done = self.root.call(list(command), self.log(name), folder or self.docker.copied_to, environment)
        return self.note(name, done)

    def run(self, archive: bytes, own: list[str]) -> None:
        """Everything on a fresh system (with `--reuse` on the one that is there), or the command `own` after the
        set-up."""
        there = self.options.reuse and self.root.is_there()
        if not there and not self.note("system", self.root.make(self.log("system"), self.options.expired)):
            return
        self.root.copy_in(archive, self.docker.copied_to)
        if not self._set_up():
            return
        self.call("versions", "./gears", "python", "-c", VERSIONS)
        if own:
            self.call("command", *own, environment=AS_ROOT)
        elif self.call("set-up of the tests", "./gears", "--set-up-only", "--test"):
            self.call("tests", "./gears", "test", "-rfEs")
            if self.call("environments", "apt-get", "install", "-y", "-qq", "python3-venv"):
                self.call("wheel", "./gears", "python", "-m", "release.wheel")
            for ranks in (2, 3):
                # Caches of their own, cold as on a cluster's first job.
                environment = {**AS_ROOT, "XDG_CACHE_HOME": f"/tmp/cache_of_{ranks}"}
                mpirun = ["mpirun", "--oversubscribe", "-n", str(ranks), "./gears", "test", "-p", "no:cacheprovider"]
                self.call(f"{ranks} ranks", *mpirun, "-m", "not nightly and not ranks", *OF_RANKS,
                          environment=environment)  # fmt: skip

    def _set_up(self) -> bool:
        """By the Dockerfile where it starts from this suite, else by README's first command."""
        docker = self.docker
        if docker.suite == self.root.suite:
            if not self.call("Dockerfile", "sh", "-ec", "\n".join(docker.commands), folder="/"):
                return False
            demo = f"mkdir -p {docker.folder} && cd {docker.folder} && cp {docker.copied_to}/{DEMO} scene.toml"
            as_user = f'exec setpriv --reuid={docker.user} --regid={docker.user} --clear-groups "$@" run scene.toml'
            run = ["sh", "-ec", f"{demo} && {as_user}", "sh", *docker.entry_point]
            self.call("container", *run, folder="/", environment=docker.environment)
        return self.call("first command", "./gears", "run", DEMO)


def main(arguments: list[str], description: str) -> int:
    at = arguments.index("--") if "--" in arguments else len(arguments)
    parser = argparse.ArgumentParser(
        "tests/debians/run", description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("suites", nargs="*", metavar="SUITE", help=f"{', '.join(SUITES)}; without any all of them")
    parser.add_argument("--reuse", action="store_true", help="take the system that an earlier call left")
    parser.add_argument("--expired", action="store_true", help="accept a mirror whose lists are past their date")
    parser.add_argument("--keep", action="store_true", help="leave systems that are green too, 5 GB each, for --reuse")
    for name, usual in (("roots", Path("/var/tmp/fenics_gears_debians")), ("logs", CHECKOUT / "results" / "debians")):
        parser.add_argument(f"--{name}", type=Path, default=usual, metavar="DIR", help=f"where {name} are ({usual})")
    options = parser.parse_args(arguments[:at])
    missing = [tool for tool in ("mmdebstrap", "unshare", "chroot", "git", "tar") if not shutil.which(tool)]
    if os.geteuid() != 0 or missing or {*options.suites} - {*SUITES}:
        print(
            f"It needs root, mmdebstrap, git and util-linux, and suites among {', '.join(SUITES)}; missing: {missing}"
        )
        return 2
    # Shells start what runs in the background deaf to Ctrl-C, every process below would be too, and tests of Ctrl-C
    # would wait for ever.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    git = ["git", "-c", "safe.directory=*", "-C", str(CHECKOUT), "archive", "HEAD"]
    # Once for all suites: the checkout may go on meanwhile.
    archive = subprocess.run(git, check=True, capture_output=True).stdout
    trials = [Trial(suite, options) for suite in options.suites or SUITES]
    for trial in trials:
        trial.run(archive, arguments[at + 1 :])
        if trial.green and not options.keep and not options.reuse:
            trial.root.remove()
    return 0 if all(trial.green for trial in trials) else 1
