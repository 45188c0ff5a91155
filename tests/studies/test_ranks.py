"""Studies under mpirun: the same numbers as alone, for any number of ranks. Failing and killed ranks are hard case 28."""

import subprocess
import sys
from pathlib import Path

import pytest
from tests.studies.conftest import command, environment, gears, write_study
from tests.studies.test_run_study import FOUR, load

from fenics_gears.commands.cli import main
from fenics_gears.studies.ranks import Alone

pytestmark = pytest.mark.ranks


@pytest.mark.parametrize("ranks", [*(pytest.param(few, marks=pytest.mark.nightly) for few in (1, 2)), 3])
def test_a_study_under_mpirun_gives_what_it_gives_alone(folder, ranks):
    """Authority: exact identity; a case's run does not depend on where it runs. Two cases: with 3 ranks there are more ranks than cases."""
    study = write_study(folder, '[sweep]\nfriction = ["absent", "present"]\n')
    assert main(["study", str(study), "--output", "alone", "--quiet"]) == 0
    together = gears(folder, "study", study, "--output", "here", ranks=ranks)
    assert together.returncode == 0, together.stderr
    assert (f"by {ranks} processes" in together.stderr) == (ranks > 1)
    assert together.stdout.count("kept from before") == 1
    alone, here = load("alone"), load("here")
    assert here.drop_vars("wall_time").equals(alone.drop_vars("wall_time"))


def test_a_wrong_study_ends_every_rank(folder):
    """Authority: design.md; exit code 2, nothing written, and no rank is left waiting."""
    study = write_study(folder, '[sweep]\nmotion.mesh_frequency = ["1 mm"]\n')
    ended = gears(folder, "study", study, ranks=2)
    assert ended.returncode == 2 and ended.stderr.count("is a length") == 1
    assert not Path("results").exists()


def test_both_of_two_ranks_compute(folder):
    """Authority: issue 3; rank 0 does not merely hand out. A task ends when one of the other rank's has begun."""
    program = (
        "import os, time\n"
        "from pathlib import Path\n"
        "from fenics_gears.system import environment; environment.prepare()\n"
        "from fenics_gears.studies.ranks import ranks\n"
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
    )
    Path("program.py").write_text(program)
    call = command("x", ranks=2)
    call = [*call[: call.index(sys.executable)], sys.executable, "program.py"]
    told = subprocess.run(call, cwd=folder, env=environment(), capture_output=True, text=True, timeout=60)
    computed_by = told.stdout.split()
    assert len(computed_by) == 4, told.stderr
    # Rank 0 begins with the last, the worker with the first.
    assert (computed_by[0], computed_by[-1]) == ("1", "0")


def test_alone_mpi_is_never_touched(folder):
    """Authority: a study alone must run where MPI is absent or broken."""
    study = write_study(folder, FOUR)
    program = "import sys; sys.modules['mpi4py'] = None; from fenics_gears.commands.cli import main; sys.exit(main(sys.argv[1:]))"
    main(["study", str(study), "--output", "first", "--quiet"])  # gears in the cache: no DOLFINx, which brings mpi4py
    ended = subprocess.run(
        [sys.executable, "-c", program, "study", str(study), "--output", "here"],
        cwd=folder, env=environment(), capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert ended.returncode == 0, ended.stderr


def test_processes_that_mpi4py_cannot_join_are_refused(folder):
    """Authority: two copies of one study must not both believe to be alone."""
    study = write_study(folder, FOUR)
    ended = subprocess.run(
        command("study", study), cwd=folder, env={**environment(), "PMI_SIZE": "2"}, capture_output=True, text=True, timeout=60
    )
    assert ended.returncode == 3 and "different MPI installations" in ended.stderr
    assert not Path("results").exists()


def test_an_error_of_a_task_is_its_outcome():
    """Authority: the promise of `run`; one task's error is not another's."""

    def inverse(task, tick):
        return 1 / task

    found = {}
    Alone().run(inverse, [1, 0, 2], found.__setitem__, lambda: None)
    assert found[0] == 1 and isinstance(found[1], ZeroDivisionError) and found[2] == 0.5


def test_the_program_starts_mpirun_itself(folder):
    """`gears study -n 2` is `mpirun -n 2 gears study`, as root too, where mpirun alone would refuse: the settings are the program's."""
    study = write_study(folder, '[sweep]\nfriction = ["absent", "present"]\n')
    plain = {name: value for name, value in environment().items() if not name.startswith(("OMPI_", "PRTE_"))}
    call = [*command("study", study, "--output", "here"), "--processes", "2"]
    ended = subprocess.run(call, cwd=folder, env=plain, capture_output=True, text=True, timeout=120)
    assert ended.returncode == 0, ended.stderr
    assert "by 2 processes" in ended.stderr
    assert load("here").attrs["complete"] == 1
