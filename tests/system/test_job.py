"""Work that all ranks carry out together. The program's own stages are in test_failing_ranks.py."""

import pytest
from tests.programs import python

pytestmark = pytest.mark.ranks

PROGRAM = """
import sys
from fenics_gears import GearsError, SceneError
from fenics_gears.system import environment, job
environment.prepare()
job.PATIENCE = 0.2

def squared(number, comm, added=0):
    return comm.rank + number**2 + added

def failing(waits, comm):
    if comm.rank == 1:
        raise SceneError("no more chalk")
    if waits:
        comm.Barrier()

def lead(team):
    print(team.together(squared, 3, added=10), job.ranks_on_machine())
    try:
        team.together(failing, False)
    except GearsError as error:
        print(error, "exit code", error.exit_code)
    team.together(failing, True)

sys.exit(job.led(lead))
"""


def test_an_error_of_one_rank_is_an_error_of_all(tmp_path):
    """Definitions; a SceneError of rank 1 is rank 0's, and the work goes on. Where rank 0 waits inside MPI, Abort
    ends both with the error's words and exit code."""
    (tmp_path / "program.py").write_text(PROGRAM)
    done = python("program.py", folder=tmp_path, ranks=2, ends=2, timeout=60)
    assert done.stdout.splitlines() == ["[19, 10] 2", "rank 1: no more chalk exit code 2"], done.stderr
    assert "rank 1: no more chalk" in done.stderr
