"""The settings given to MPI and BLAS: each library's documented variables; a user's own setting wins."""

import os

import pytest

from fenics_gears.system import environment


def prepared(**given):
    environment.prepare(given)
    return given


def test_one_thread_for_each_rank_under_mpirun():
    """Ranks with all cores each would compete; Open MPI announces the number of ranks."""
    assert prepared(OMPI_COMM_WORLD_SIZE="2", OMPI_COMM_WORLD_LOCAL_SIZE="2")["OMP_NUM_THREADS"] == "1"


def test_tcp_is_left_out_on_one_machine_and_kept_across_machines():
    """Ranks on two machines reach each other by TCP."""
    assert prepared()["OMPI_MCA_btl"] == "^tcp,ofi" and prepared()["OMPI_MCA_pml"] == "ob1"
    assert prepared(OMPI_COMM_WORLD_SIZE="4", OMPI_COMM_WORLD_LOCAL_SIZE="4")["OMPI_MCA_btl"] == "^tcp,ofi"
    assert not {"OMPI_MCA_btl", "OMPI_MCA_pml"} & {*prepared(OMPI_COMM_WORLD_SIZE="4", OMPI_COMM_WORLD_LOCAL_SIZE="2")}


@pytest.mark.parametrize(
    ("given", "together", "here"),
    [
        ({}, 1, 1),
        ({"OMPI_COMM_WORLD_SIZE": "8", "OMPI_COMM_WORLD_LOCAL_SIZE": "4"}, 8, 4),
        ({"PMI_SIZE": "8", "MPI_LOCALNRANKS": "4"}, 8, 4),
        ({"SLURM_STEP_NUM_TASKS": "11", "SLURM_STEP_TASKS_PER_NODE": "4(x2),3"}, 11, 4),
        # mpirun under Slurm: one daemon on each machine is a step's task.
        (
            {
                "SLURM_STEP_NUM_TASKS": "2",
                "SLURM_STEP_TASKS_PER_NODE": "1(x2)",
                "OMPI_COMM_WORLD_SIZE": "8",
                "OMPI_COMM_WORLD_LOCAL_SIZE": "4",
            },
            8,
            4,
        ),
        ({"OMPI_COMM_WORLD_LOCAL_SIZE": "0", "PMI_SIZE": "two"}, 1, 1),
    ],
)
def test_ranks_are_counted(given, together, here):
    """Variables of Open MPI, Hydra and srun; what is no number above 0 counts as one process."""
    assert (environment.started_ranks(given), environment.local_ranks(given)) == (together, here)


def test_mpirun_may_run_as_root_only_where_the_user_is_root(monkeypatch):
    """Open MPI refuses root unless both variables are set."""
    names = {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"}
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    assert names <= prepared().keys()
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    assert not names & prepared().keys()
