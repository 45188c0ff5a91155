"""The command line of tests/debians/run."""

import argparse
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

from tests.debians.root import Root
from tests.debians.summary import table
from tests.debians.trial import SUITES, Trial, try_out

ROOTS = "FENICS_GEARS_DEBIANS"
CHECKOUT = Path(__file__).resolve().parents[2]


def main(arguments, description) -> int:
    """Try what the arguments ask for; the exit code."""
    arguments, separator, own = split(arguments)
    options = parser(description).parse_args(arguments)
    if separator and not own:
        say("a command is missing after --")
        return 2
    why_not = obstacle()
    if why_not:
        say(why_not)
        return 2
    # Shells start what runs in the background deaf to Ctrl-C, every process below would be too, and tests of Ctrl-C
    # would wait for ever.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    commit = git("log", "-1", "--format=%h %s").decode().strip()
    say(
        f"trying {commit}"
        + (" (what is uncommitted is left out)" if git("status", "--porcelain", "--untracked-files=no") else "")
    )
    # Once for all suites: the checkout may go on meanwhile.
    archive, trials = git("archive", "HEAD"), []
    for suite in options.suites or SUITES:
        root = Root(suite, options.roots / suite)
        trial = Trial(suite, options.logs / suite, options.quick)
        trials.append(trial)
        trial.logs.mkdir(parents=True, exist_ok=True)
        try_out(trial, root, archive, CHECKOUT, reuse=options.reuse, expired=options.expired, own=own)
        if not options.keep and not options.reuse and trial.is_green:
            root.remove()
    text = table(trials)
    (options.logs / "summary.md").write_text(f"{commit}\n\n{text}\n")
    print(f"\n{text}\n\nLogs: {options.logs}")
    return 0 if all(trial.is_green for trial in trials) else 1


def split(arguments):
    """Arguments before the first "--", whether there is one, and what follows it."""
    if "--" not in arguments:
        return arguments, False, []
    at = arguments.index("--")
    return arguments[:at], True, arguments[at + 1 :]


def parser(description):
    """The options."""
    options = argparse.ArgumentParser(
        "tests/debians/run", description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    options.add_argument(
        "suites", nargs="*", type=suite, metavar="SUITE", help=f"{', '.join(SUITES)}; without any all of them"
    )
    options.add_argument(
        "--quick", action="store_true", help="a few tests instead of the suite: minutes after the set-up"
    )
    options.add_argument(
        "--reuse", action="store_true", help="take the system that an earlier call left, with its packages"
    )
    options.add_argument(
        "--expired", action="store_true", help="accept a mirror that is a snapshot, its lists past their date"
    )
    options.add_argument("--keep", action="store_true", help="leave systems that are green too, 5 GB each, for --reuse")
    roots = Path(os.environ.get(ROOTS, "/var/tmp/fenics_gears_debians"))
    options.add_argument(
        "--roots", type=Path, default=roots, metavar="DIR", help=f"where the systems are ({ROOTS}, now {roots})"
    )
    options.add_argument(
        "--logs", type=Path, default=CHECKOUT / "results/debians", metavar="DIR", help="where logs go (results/debians)"
    )
    return options


def suite(name):
    """A suite that is known."""
    if name not in SUITES:
        raise argparse.ArgumentTypeError(f"{name!r} is none of {', '.join(SUITES)}")
    return name


def obstacle():
    """Why nothing can be tried here, None where it can."""
    if os.geteuid() != 0:
        return (
            "making a Debian system needs root: call it by sudo, or in a container that may mount (docker run"
            " --privileged)."
        )
    missing = [tool for tool in ("mmdebstrap", "unshare", "chroot", "git", "tar") if not shutil.which(tool)]
    if missing:
        return f"{', '.join(missing)} not found; on Debian: apt-get install mmdebstrap git util-linux"
    tried = subprocess.run(
        ["unshare", "--mount", "mount", "-t", "tmpfs", "none", "/mnt"], capture_output=True, text=True
    )
    return (
        f"nothing can be mounted here ({tried.stderr.strip()}); in a container it takes --privileged."
        if tried.returncode
        else None
    )


def git(*arguments) -> bytes:
    """What git says of this checkout."""
    return subprocess.run(
        ["git", "-c", "safe.directory=*", "-C", CHECKOUT, *arguments], check=True, capture_output=True
    ).stdout


def say(what):
    """Progress, to standard error."""
    print(f"tests/debians: {what}", file=sys.stderr, flush=True)
