"""Studies under mpirun. Failing and killed ranks are hard case 28."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Event

import pytest
from tests.programs import gears, python
from tests.studies.conftest import write_study
from tests.studies.test_run_study import FOUR, load
from tests.system.test_failing_ranks import FACE

from fenics_gears.commands.cli import main
from fenics_gears.runs.team import Alone, Together

pytestmark = pytest.mark.ranks


@pytest.mark.nightly
def test_a_study_of_more_ranks_than_cases_gives_what_it_gives_alone(folder, undrawn):
    """Exact identity but for the sets that a run begins with."""
    study = write_study(folder, '[sweep]\nfriction = ["absent", "present"]\n')
    assert main(["study", str(study), "--output", "alone", "--quiet"]) == 0
    together = gears(folder, "study", study, "--output", "here", ranks=3)
    assert together.returncode == 0, together.stderr
    assert "by 3 processes" in together.stderr and together.stdout.count("kept from before") == 1
    effort = ["wall_time", "newton_iterations"]
    assert load("here").drop_vars(effort).equals(load("alone").drop_vars(effort))


def test_what_the_end_needs_is_made_while_others_compute():
    """Order of events: once for a job, and not where there are few tasks."""
    begun, made = Event(), []
    with ThreadPoolExecutor(1) as executor:
        team = Together(executor, 2, lambda: made.append(begun.wait(timeout=60)))
        for count, times in ((7, 0), (8, 1), (8, 1)):
            found = {}
            team.run(lambda task, tick=None: begun.set() or task, range(count), found.__setitem__, lambda: None)
            assert found == {task: task for task in range(count)}
            assert made == [True] * times
            begun.clear()


@pytest.mark.nightly
def test_both_of_two_ranks_compute_and_a_wrong_study_ends_both(folder):
    """A task ends when one of the other rank's has begun. docs/promises.md: exit code 2, nothing written, no rank
    left waiting."""
    program = (
        "import os, sys, time\n"
        "from pathlib import Path\n"
        "from fenics_gears.system import environment; environment.prepare()\n"
        "from fenics_gears.commands.cli import main\n"
        "from fenics_gears.runs.team import ranks\n"
        "def rank(task, tick=None):\n"
        "    own = os.environ['OMPI_COMM_WORLD_RANK']\n"
        "    Path(own).touch()\n"
        "    while not (Path('0').exists() and Path('1').exists()): time.sleep(0.01)\n"
        "    return own\n"
        "with ranks() as team:\n"
        "    if team is not None:\n"
        "        found = {}\n"
        "        team.run(rank, list(range(4)), found.__setitem__, lambda: None)\n"
        "        print(*(found[i] for i in range(4)))\n"
        "sys.exit(main(['study', 'wrong.toml']))\n"
    )
    Path("program.py").write_text(program)
    write_study(folder, '[sweep]\nmotion.mesh_frequency = ["1 mm"]\n', "wrong.toml")
    ended = python("program.py", folder=folder, ranks=2, ends=2, timeout=60)
    computed_by = ended.stdout.split()
    assert len(computed_by) == 4, ended.stderr
    # Rank 0 begins with the last, the worker with the first.
    assert (computed_by[0], computed_by[-1]) == ("1", "0")
    assert ended.stderr.count("is a length") == 1
    assert not Path("results").exists()


@pytest.mark.nightly
def test_ranks_of_a_study_condense_each_body_over_the_face_once(folder):
    """Count: two bodies for three cases on three ranks; each computation adds a line to a file."""
    program = (
        "import sys\n"
        "from fenics_gears.commands.cli import main\n"
        "from fenics_gears.elasticity.face import computed as of_face\n"
        "computed = of_face.computed_body\n"
        "def counted(*arguments):\n"
        "    with open('computed', 'a') as out: out.write('a body\\n')\n"
        "    return computed(*arguments)\n"
        "of_face.computed_body = counted\n"
        "sys.exit(main(['study', 'study.toml', '--output', 'here']))\n"
    )
    Path("program.py").write_text(program)
    Path("pair.toml").write_text(FACE)
    write_study(folder, '[sweep]\nmisalignment.in_plane = ["0 um", "10 um", "20 um"]\n')
    python("program.py", folder=folder, ranks=3, FENICS_GEARS_CACHE=str(folder / "cache"))
    assert Path("computed").read_text().splitlines() == ["a body"] * 2


def test_processes_that_mpi4py_cannot_join_are_refused(folder, monkeypatch, capsys):
    """Two copies of one study must not both believe to be alone."""
    study = write_study(folder, FOUR)
    monkeypatch.setenv("PMI_SIZE", "2")
    assert main(["study", str(study)]) == 3
    assert "different MPI installations" in capsys.readouterr().err
    assert not Path("results").exists()


def test_an_error_of_a_task_is_its_outcome():
    """The promise of `run`."""

    def inverse(task, tick):
        return 1 / task

    found = {}
    Alone().run(inverse, [1, 0, 2], found.__setitem__, lambda: None)
    assert found[0] == 1 and isinstance(found[1], ZeroDivisionError) and found[2] == 0.5
