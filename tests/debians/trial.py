"""What is tried on one Debian: set-up, README's commands, the suite alone and its finite elements under mpirun."""

import json
import re
import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

from tests.debians.dockerfile import read_dockerfile
from tests.debians.root import Call, Root

SUITES = {"bookworm": "Debian 12", "trixie": "Debian 13", "sid": "unstable"}
RANKS = (2, 3)
DEMO = "demos/lundvall2004.toml"
# Every rank runs these whole, by itself: what is built on all ranks by mistake would differ from what is built on one,
# or hang. Jobs that share their work between ranks (studies, every step condensed) are started by tests of the suite,
# with 1, 2 and 3 ranks.
OF_RANKS = (
    "tests/elasticity", "tests/simulation/reference", "tests/hard_cases/test_row_05_schur_complement.py",
    "tests/hard_cases/test_row_06_condensation.py", "tests/hard_cases/test_row_07_patch_test.py",
)  # fmt: skip
QUICK = (
    "tests/setup", "tests/commands/test_cli.py", "tests/elasticity/test_web.py",
    "tests/studies/test_ranks.py",
    "tests/show/test_stress_picture.py",
)  # fmt: skip
QUICK_OF_RANKS = ("tests/elasticity/test_web.py", "tests/elasticity/test_ring.py")
RESULTS = "/results"
OF_EACH_RANK = 'exec ./gears test -rfEs -p no:cacheprovider --junitxml=$rank.xml "$@" >$rank.log 2>&1'
# mpirun as root, which containers are: as the Dockerfile has it.
AS_ROOT = {f"{prefix}_ALLOW_RUN_AS_ROOT{suffix}": "1" for prefix in ("OMPI", "PRTE") for suffix in ("", "_CONFIRM")}


@dataclass(frozen=True)
class Counts:
    """Outcomes of tests; `complete` when pytest ended by itself with a verdict on all of them."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0
    seconds: float = 0.0
    complete: bool = False
    reasons: tuple[str, ...] = ()
    """Why tests were skipped, each reason once."""

    @property
    def is_green(self) -> bool:
        """Whether there were tests and none failed."""
        return self.complete and self.passed > 0 and self.failed == 0


@dataclass
class Trial:
    """What came of a suite ("trixie"), as far as it came. own: a command given instead of the usual ones."""

    suite: str
    logs: Path
    quick: bool = False
    """Whether only a few tests are tried."""
    versions: dict[str, str] = field(default_factory=dict)
    set_up_seconds: dict[str, float] = field(default_factory=dict)
    calls: dict[str, Call] = field(default_factory=dict)
    tests: dict[int, Counts] = field(default_factory=dict)
    """By number of ranks."""
    is_whole: bool = False
    """Whether nothing was left out because of what came before."""

    @property
    def is_green(self) -> bool:
        """Whether everything was tried and came out well."""
        return self.is_whole and all(part.is_green for part in (*self.calls.values(), *self.tests.values()))

    def note(self, name: str, call: Call) -> bool:
        """Keep how a call ended and tell it; whether it ended well."""
        self.calls[name] = call
        outcome = "" if call.is_green else f": FAILED (exit code {call.exit_code}), see {self.log(name)}"
        print(f"tests/debians: {self.suite}: {name}, {call.seconds:.0f} s{outcome}", file=sys.stderr, flush=True)
        return call.is_green

    def log(self, name: str) -> Path:
        """File of a call's output."""
        return self.logs / f"{name.replace(' ', '_')}.log"


def try_out(trial: Trial, root: Root, archive: bytes, checkout: Path, reuse=False, expired=False, own=()) -> None:
    """Try everything on a fresh system (with `reuse` on the one that is there), or the command `own` after the set-up;
    fills the trial."""
    docker = read_dockerfile(checkout / "Dockerfile")
    if not (reuse and root.is_there()) and not trial.note("system", root.make(trial.log("system"), expired)):
        return
    root.copy_in(archive, docker.copied_to)

    def call(name, *command, folder=docker.copied_to, environment=None):
        return trial.note(name, root.call(list(command), trial.log(name), folder, environment))

    if not _set_up(trial, call, docker):
        return
    python = '{ read -r _ && read -r python; } <.setup/ready && exec "$python" tests/debians/versions.py'
    if call("versions", "sh", "-c", python):
        trial.versions = json.loads(trial.calls["versions"].output.splitlines()[-1])
    if own:
        call("command", *own, environment=AS_ROOT)
    elif call("set-up of the tests", "./gears", "--set-up-only", "--test"):
        trial.set_up_seconds["tests"] = _seconds_of_set_up(trial.calls["set-up of the tests"].output)
        _run_tests(trial, root, call)
    else:
        return
    trial.is_whole = True


def _set_up(trial, call, docker):
    """Set up by the Dockerfile where it starts from this suite, else by README's first command as on a user's
    machine."""
    if docker.suite == trial.suite:
        if not call("Dockerfile", "sh", "-ec", "\n".join(docker.commands), folder="/"):
            return False
        environment = {**docker.environment}
        demo = (
            f'mkdir -p {docker.folder} && cd {docker.folder} && cp {docker.copied_to}/{DEMO} scene.toml && exec "$@"'
            " run scene.toml"
        )
        call("container", "sh", "-ec", demo, "sh", *docker.entry_point, folder="/", environment=environment)
    call("first command", "./gears", "run", DEMO)
    ready = [trial.calls[name].output for name in ("Dockerfile", "first command") if name in trial.calls]
    trial.set_up_seconds["program"] = _seconds_of_set_up("\n".join(ready))
    return trial.calls["first command"].is_green


def _seconds_of_set_up(output):
    """Seconds by the launcher's own account."""
    told = re.search(r"^gears: ready \((\d+) s\)", output, re.MULTILINE)
    return float(told[1]) if told else 0.0


def _run_tests(trial, root, call):
    """The suite alone, then what ranks can run by themselves with caches of their own, cold as on a cluster's first
    job."""
    folder = root.empty_folder(RESULTS)
    call("tests", "./gears", "test", "-rfEs", f"--junitxml={RESULTS}/tests.xml", *(QUICK if trial.quick else ()))
    trial.tests[1] = counted([folder / "tests.xml"])
    for ranks in RANKS:
        each = f"rank={RESULTS}/{ranks}.$OMPI_COMM_WORLD_RANK\n" + OF_EACH_RANK
        which = ["-m", "not nightly and not ranks", *(QUICK_OF_RANKS if trial.quick else OF_RANKS)]
        mpirun = ["mpirun", "--oversubscribe", "-n", str(ranks)]
        call(
            f"{ranks} ranks",
            *mpirun,
            "sh",
            "-c",
            each,
            "sh",
            *which,
            environment={**AS_ROOT, "XDG_CACHE_HOME": f"/tmp/cache_of_{ranks}"},
        )
        for log in folder.glob(f"{ranks}.*.log"):
            (trial.logs / f"{ranks}_ranks.{log.name.split('.')[1]}.log").write_bytes(log.read_bytes())
        trial.tests[ranks] = counted([folder / f"{ranks}.{rank}.xml" for rank in range(ranks)])


def counted(files) -> Counts:
    """Outcomes in the JUnit files of all ranks: what every rank passed counts once, what any failed or skipped is added
    up."""
    reports = [ElementTree.parse(file).getroot().find("testsuite") for file in files if file.exists()]
    if not reports:
        return Counts()
    suites = [report.attrib for report in reports]
    reasons = {skip.get("message", "") for report in reports for skip in report.iter("skipped")}
    failed = [int(suite["failures"]) + int(suite["errors"]) for suite in suites]
    skipped = [int(suite["skipped"]) for suite in suites]
    passed = [
        int(suite["tests"]) - bad - left_out for suite, bad, left_out in zip(suites, failed, skipped, strict=True)
    ]
    seconds = max(float(suite["time"]) for suite in suites)
    return Counts(min(passed), sum(failed), sum(skipped), seconds, len(suites) == len(files), tuple(sorted(reasons)))
