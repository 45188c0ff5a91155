"""Scenes of `whole_scenes` by `gears check` and `gears run` for some time: `python -m tests.hard_cases.random_runs SEED
SECONDS FOLDER`.

An end is right if it is a result without a number that is not finite, or a typed error with its exit code and words;
`gears run` refuses nothing that `gears check` has accepted. Other ends are kept in FOLDER: the scene, and what came.
What takes too long is stopped. A line a scene on the standard output says how it ended."""

import contextlib
import io
import os
import re
import resource
import signal
import sys
import time
import traceback
from collections import Counter
from pathlib import Path

from hypothesis import HealthCheck, Phase, given, seed, settings

EXIT_CODES = {"check": (0, 2, 3), "run": (0, 2, 3, 4)}
INTERRUPTED = 130
# Bytes and seconds that a scene may be expected to take, else it is left out; and bytes and seconds of the processor
# that end it.
DEAREST, MOST = (1.0e9, 10.0), (6e9, 90.0)
AT_A_TIME = 40
STOPPED = f"stopped after {MOST[1]:g} s"


class TookTooLong(KeyboardInterrupt):
    """A scene took more than its time; the run ends as by Ctrl-C."""


def main(number: str, seconds: str, folder: str) -> int:
    from tests.hard_cases.whole_scenes import whole_scenes

    # What is mapped and never used counts too: libraries alone have 2 GB of that.
    resource.setrlimit(resource.RLIMIT_AS, (int(MOST[0]), int(MOST[0])))
    signal.signal(signal.SIGPROF, _ended)
    os.chdir(folder)
    os.environ["FENICS_GEARS_CACHE"] = str(Path("cache").absolute())
    end, ends, block = time.monotonic() + float(seconds), Counter(), 0

    def one(text: str) -> None:
        if time.monotonic() < end:
            how = ended(text, f"{number}-{sum(ends.values())}")
            ends[how] += 1
            print(how, flush=True)

    while time.monotonic() < end:
        block += 1
        patient = settings(
            max_examples=AT_A_TIME, phases=[Phase.generate], database=None, deadline=None,
            suppress_health_check=list(HealthCheck),
        )  # fmt: skip
        seed(f"{number} {block}")(patient(given(whole_scenes())(one)))()
    return 0


def ended(text: str, name: str) -> str:
    """How a scene ended: in a word where that is right, else `wrong: ` and why."""
    file = Path(f"{name}.toml")
    file.write_text(text, encoding="utf-8")
    signal.setitimer(signal.ITIMER_PROF, MOST[1])
    try:
        how, said = _ended_by_itself(file)
    except TookTooLong:
        how, said = STOPPED, ""
    except BaseException as error:
        last = traceback.extract_tb(error.__traceback__)[-1]
        how = f"wrong: {type(error).__name__} in {Path(last.filename).name}:{last.lineno}"
        said = traceback.format_exc()
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
    if how.startswith("wrong"):
        file.with_suffix(".txt").write_text(f"{how}\n{said}", encoding="utf-8")
        return f"{how} ({name})"
    file.unlink()
    return how


def _ended_by_itself(file: Path) -> tuple[str, str]:
    from fenics_gears import expected_cost, load_scene, model_of
    from fenics_gears.errors import GearsError

    accepted, said = called("check", str(file))
    if wrong := wrong_with("check", accepted, said):
        return wrong, said
    if accepted:
        return "refused", said
    cost = expected_cost(model_of(load_scene(file)))
    if cost.memory > DEAREST[0] or (cost.condensing or 0.0) + cost.marching > DEAREST[1]:
        return "too dear", said
    with contextlib.suppress(GearsError):
        Path("here/run.nc").unlink(missing_ok=True)
    code, said = called("run", str(file), "--output", "here", "--no-pictures")
    if code == INTERRUPTED:
        return STOPPED, said
    wrong = wrong_with("run", code, said) or (code == 2 and "wrong: refused after it was accepted")
    if wrong:
        return wrong, said
    why = f" ({_reason(said)})" if code == 3 else ""
    if not Path("here/run.nc").exists():
        return f"exit code {code}{why}", said
    not_finite = _not_finite(Path("here/run.nc"))
    return (f"wrong: not finite: {', '.join(not_finite)}" if not_finite else f"exit code {code}, result{why}"), said


def _reason(said: str) -> str:
    """The first line that tells no progress."""
    return next((line for line in said.splitlines() if not re.search(r": [\d.]+ s$| after [\d.]+ s", line)), "")


def called(*words: str) -> tuple[int, str]:
    """Exit code of a call and what it said."""
    from fenics_gears.commands.cli import main as gears

    out, error = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
        code = gears([*words])
    return code, out.getvalue() + error.getvalue()


def wrong_with(command: str, code: int, said: str) -> str:
    if code not in EXIT_CODES[command]:
        return f"wrong: exit code {code}"
    if not said.strip():
        return "wrong: nothing said"
    # Words such as "information" have the letters too.
    shown = re.search(r"(?<![\w.])[-+]?(nan|inf)(?![\w-])|None\b", said)
    return f"wrong: {command} says {shown[0]}" if shown else ""


def _not_finite(file: Path) -> list[str]:
    import numpy as np

    from fenics_gears import results

    run = results.load(file)
    found = [name for name, value in run.attrs.items() if isinstance(value, float) and not np.isfinite(value)]
    for name, values in run.data_vars.items():
        if values.dtype.kind == "f" and values.dims == ("time",):
            # There is no place of the largest pressure where nothing presses, and no stiffness of teeth that wedges
            # and friction press though they do not approach.
            there = run["largest_contact_pressure"] > 0.0 if name == "largest_contact_pressure_roll_angle" else True
            if name == "mesh_stiffness" and "coast_normal_force" in run:
                there = run["coast_normal_force"] <= 0.0
            if not (np.isfinite(values) | ~np.asarray(there)).all():
                found.append(str(name))
    return found


def _ended(number, frame) -> None:
    raise TookTooLong


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
