"""Row 28 and the exit codes of docs/promises.md: the case of a failing rank is recorded, the others finish, nothing
hangs."""

import signal
import subprocess
from pathlib import Path

import numpy as np
import pytest
from tests.hard_cases.kept_files import left_over
from tests.programs import command, environment, python
from tests.studies.conftest import folder, stamps, undrawn, write_study  # noqa: F401
from tests.studies.test_run_study import FIVE, THREE, load, stopped_in_the_middle

from fenics_gears.commands.cli import main
from fenics_gears.studies.study_file import load_study

pytestmark = [pytest.mark.ranks, pytest.mark.usefixtures("undrawn")]


def in_the_way(study, index, directory="here"):
    """A directory where a case's file belongs: its rank computes the case and then cannot write it."""
    case = load_study(study).cases[index]
    obstacle = Path(directory, "cases", f"{case.name}.nc", "of somebody else")
    obstacle.mkdir(parents=True)
    return case


@pytest.mark.nightly
@pytest.mark.parametrize("failing", [(1,), (0,), (0, 2)])
def test_the_case_of_a_failing_rank_is_recorded_and_the_others_finish(folder, measured, capsys, failing):
    """The dataset of a study alone, whichever rank has the case: rank 0 takes them from the last on, rank 1 from the
    first. `-n 2` starts mpirun itself, as root too."""
    study = write_study(folder, THREE)
    cases = [in_the_way(study, index) for index in failing]
    plain = {name: value for name, value in environment().items() if not name.startswith(("OMPI_", "PRTE_"))}
    call = command("study", study, "--output", "here", "--processes", 2)
    ended = subprocess.run(call, cwd=folder, env=plain, capture_output=True, text=True, timeout=120)
    assert "by 2 processes" in ended.stderr
    combined = load("here")
    done, failed = int(np.isfinite(combined["mean_transmission_error"]).sum()), int(combined["failed"].sum())
    outcome = f"exit code {ended.returncode}, {done} done, {failed} failed"
    expected = f"exit code 3, {3 - len(cases)} done, {len(cases)} failed"
    measured(
        f"cases {' and '.join(map(str, failing))} of 0 to 2 cannot be written, 2 ranks", outcome, f"{expected}, no hang"
    )
    assert ended.returncode == 3, ended.stderr
    assert list(combined["failed"].values) == [int(index in failing) for index in range(3)]
    assert all("directory" in str(combined["failure"].values[index]).lower() for index in failing)
    assert list(np.isnan(combined["mean_transmission_error"].values)) == [index in failing for index in range(3)]
    assert all(case.name in ended.stderr for case in cases) and f"{len(cases)} of 3 cases failed" in ended.stderr
    notes = list(Path("here/cases").glob("*.failed.txt"))
    assert {note.name for note in notes} == {f"{case.name}.failed.txt" for case in cases}
    assert all("Traceback" in note.read_text() for note in notes)
    # With the obstacles gone only the failed cases are computed.
    for case in cases:
        (Path("here/cases") / f"{case.name}.nc" / "of somebody else").rmdir()
        (Path("here/cases") / f"{case.name}.nc").rmdir()
    assert main(["study", str(study), "--output", "here"]) == 0
    assert f"{3 - len(cases)} kept, {len(cases)} to be computed" in capsys.readouterr().err
    assert main(["study", str(study), "--output", "alone", "--quiet"]) == 0
    alone, here = load("alone"), load("here")
    assert here.attrs["complete"] == 1 and here.drop_vars("wall_time").equals(alone.drop_vars("wall_time"))
    assert not list(Path("here/cases").glob("*.failed.txt"))


@pytest.mark.nightly
@pytest.mark.parametrize(("ranks", "who"), [(2, "a rank"), (0, "study")])
def test_a_killed_process_loses_nothing_that_was_done(folder, measured, capsys, ranks, who):
    """Also row 27: kill -9 of one rank ends the job, without a hang; run again it computes only what is missing."""
    study = write_study(folder, FIVE)
    ended = stopped_in_the_middle(folder, study, signal.SIGKILL, ranks=ranks)
    before = stamps("here")
    again = main(["study", str(study), "--output", "here"])
    after = stamps("here")
    repeated = sum(after[name] != before[name] for name in before)
    words, row = f"{repeated} of {len(before)} done", 28 if ranks else 27
    measured(f"{who} killed: cases computed again", words, "none, no hang", row=row)
    # The killed rank had done two, the other at most as many.
    assert ended.returncode != 0 and (2 <= len(before) <= 4 if ranks else len(before) == 3)
    assert again == 0 and f"{len(before)} kept" in capsys.readouterr().err
    assert len(after) == 5 and repeated == 0 and left_over("here")[1] == []
    assert load("here").attrs["complete"] == 1


@pytest.mark.nightly
def test_an_outcome_that_cannot_be_reported_is_the_failure_of_its_case(folder, measured):
    """One that cannot be sent, or made again, is a failure, not a rank waiting for ever."""
    program = (
        "import time\n"
        "from fenics_gears.system import environment; environment.prepare()\n"
        "from fenics_gears.runs.team import ranks\n"
        "class Odd(Exception):\n"
        "    def __init__(self, one, two): super().__init__('odd')\n"
        "def task(number, tick=None):\n"
        "    if number == 4: time.sleep(0.5)  # rank 0 begins with the last and leaves the first to the worker\n"
        "    if number == 1: return lambda: 0\n"
        "    if number == 2: raise Odd(1, 2)\n"
        "    return number\n"
        "with ranks() as team:\n"
        "    if team is not None:\n"
        "        found = {}\n"
        "        team.run(task, [0, 1, 2, 3, 4], found.__setitem__, lambda: None)\n"
        "        print(*(found[i] if isinstance(found[i], int) else 'failed' for i in range(5)))\n"
    )
    Path("program.py").write_text(program)
    told = python("program.py", folder=folder, ranks=2, ends=None, timeout=60)
    measured(
        "outcomes that cannot be sent back or made again",
        told.stdout.strip() or f"exit code {told.returncode}",
        "the other three outcomes come back",
    )
    outcomes = told.stdout.split()
    assert len(outcomes) == 5 and [outcomes[0], *outcomes[3:]] == ["0", "3", "4"], told.stderr
