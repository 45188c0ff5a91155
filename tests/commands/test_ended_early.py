"""Runs that are interrupted or fail. The simulation is replaced."""

import builtins
import os
import signal
import sys

import pytest
from tests.commands.conftest import files, small_result
from tests.programs import DEMO

from fenics_gears import ComputationError, results
from fenics_gears.__main__ import _main
from fenics_gears.commands.cli import main


def test_ctrl_c_waits_for_the_end_of_a_step(simulation, tmp_path):
    """A real signal ends the march between two steps, and the handler is given back."""
    before = signal.getsignal(signal.SIGINT)
    steps = []

    def march(scene, *, progress, job, journal, keep):
        progress.stage("march")
        try:
            for step in range(10):
                progress.update(step, 10)
                if step == 4:
                    os.kill(os.getpid(), signal.SIGINT)
                steps.append(step)
        except KeyboardInterrupt:
            keep(small_result(complete=0))
            return small_result(complete=0)
        raise AssertionError("Ctrl-C was not heeded")

    simulation.simulate = march
    assert main(["run", str(DEMO), "--output", "here", "--quiet"]) == 130
    assert steps == [0, 1, 2, 3, 4]
    assert files(tmp_path) == ["here/run.nc"]
    assert signal.getsignal(signal.SIGINT) is before


def test_a_second_ctrl_c_does_not_wait(simulation, tmp_path):
    """A step that never ends can be left."""

    def hang(scene, *, progress, job, journal, keep):
        progress.stage("march")
        progress.update(1, 10)
        os.kill(os.getpid(), signal.SIGINT)
        os.kill(os.getpid(), signal.SIGINT)
        raise AssertionError("the second signal was not heeded")

    simulation.simulate = hang
    assert main(["run", str(DEMO), "--output", "here", "--quiet"]) == 130
    assert files(tmp_path) == []


@pytest.mark.parametrize("before", [signal.default_int_handler, signal.SIG_IGN], ids=["terminal", "background"])
def test_ctrl_c_that_mpirun_gets_too(tmp_path, monkeypatch, capsys, before):
    """docs/promises.md, exit code 130; mpirun itself ends with 1, and takes Ctrl-C in a shell's background too."""
    mpirun, found = tmp_path / "mpirun", signal.getsignal(signal.SIGINT)
    mpirun.write_text("#!/bin/sh\nkill -INT $PPID\nexit 1\n")
    mpirun.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    signal.signal(signal.SIGINT, before)
    try:
        assert main(["study", "study.toml", "--processes", "2"]) == 130
        assert signal.getsignal(signal.SIGINT) is before and "Interrupted" in capsys.readouterr().err
    finally:
        signal.signal(signal.SIGINT, found)


def test_ctrl_c_while_the_program_is_imported_ends_it_without_a_word(monkeypatch):
    """What the system does with a process that handles no signal; the handler of before is back for the command."""
    found = signal.getsignal(signal.SIGINT)
    handlers = []
    imported = builtins.__import__

    def seen(name, *given):
        handlers.append(signal.getsignal(signal.SIGINT))
        return imported(name, *given)

    monkeypatch.setattr(builtins, "__import__", seen)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        assert _main() is main
        assert handlers[0] is signal.SIG_DFL
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, found)


def test_a_users_file_is_no_module_of_processes_that_mpirun_starts(tmp_path, monkeypatch):
    """What `./gears` says of its own process; without one the study file is missed, exit code 2."""
    mpirun = tmp_path / "mpirun"
    mpirun.write_text('#!/bin/sh\nshift 2\nexec "$@"\n')
    mpirun.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "argparse.py").write_text("raise SystemExit(9)\n")
    assert main(["study", "study.toml", "--processes", "1"]) == 2


def test_the_summary_of_an_interrupted_run_says_so_first(simulation, capsys):
    """What a user expects before numbers of a part of the run: that they are, and of how much. The stand-in has two
    steps, one mesh cycle, of the demonstration's 3000."""
    simulation.outcome = small_result(complete=0)
    assert main(["run", str(DEMO), "--output", "here"]) == 130
    output = capsys.readouterr()
    first = output.out.splitlines()[1]
    assert first.split()[0] == "INTERRUPTED" and "stopped before its end: 2 of its 3000 steps are there" in first
    assert "(mesh cycle 1.00 of 30), and all numbers are of these" in first
    assert "marked incomplete: here/run.nc, 2 of the run's steps" in output.err
    simulation.outcome = small_result()
    assert main(["run", str(DEMO), "--output", "here"]) == 0
    assert "INTERRUPTED" not in capsys.readouterr().out


def test_ctrl_c_before_the_recorded_cycles_says_so(simulation, capsys, tmp_path):
    """docs/promises.md: kept, marked incomplete, not summed up."""
    simulation.outcome = small_result(complete=0).isel(time=slice(0, 0))
    assert main(["run", str(DEMO), "--output", "here"]) == 130
    output = capsys.readouterr()
    assert "Newton" not in output.out
    assert "marked incomplete: here/run.nc, none of the run's steps" in output.err


@pytest.mark.parametrize("partial", [True, False])
def test_a_failed_computation_keeps_what_was_done(simulation, capsys, tmp_path, partial):
    """docs/promises.md: exit code 3, kept, marked incomplete."""
    simulation.outcome = ComputationError("no convergence in step 17")
    simulation.outcome.partial = small_result(complete=0) if partial else None
    assert main(["run", str(DEMO), "--output", "here"]) == 3
    error = capsys.readouterr().err
    assert "no convergence in step 17" in error
    assert files(tmp_path) == (["here/run.nc"] if partial else [])
    assert ("marked incomplete: here/run.nc" in error) == partial


def test_what_comes_after_the_march_is_added_to_a_file_that_is_there(simulation, tmp_path):
    """A run is kept as soon as its march ends: its file is there when what follows begins, and has it at the end."""

    def afterwards(result):
        with results.load("here/run.nc") as kept:
            assert kept.attrs["complete"] == 1 and "dynamic_factor_by_force" not in kept.attrs
        return result.assign_attrs(dynamic_factor_by_force=1.25)

    simulation.afterwards = afterwards
    assert main(["run", str(DEMO), "--output", "here", "--quiet", "--no-pictures"]) == 0
    with results.load("here/run.nc") as kept:
        assert kept.attrs["dynamic_factor_by_force"] == 1.25


def test_ctrl_c_after_the_march_leaves_a_whole_result(simulation, capsys, tmp_path):
    """A real signal while factors or proposals are computed: exit code 130, the file as the march made it."""

    def afterwards(result):
        os.kill(os.getpid(), signal.SIGINT)
        raise AssertionError("the signal was not heeded")

    simulation.afterwards = afterwards
    assert main(["run", str(DEMO), "--output", "here"]) == 130
    assert "The result is whole, without the stages after the march: here/run.nc" in capsys.readouterr().err
    assert files(tmp_path) == ["here/run.nc"]


@pytest.mark.parametrize("what", ["dynamic factor", "pictures", "summary"])
def test_what_fails_after_the_march_costs_exit_code_5(simulation, capsys, monkeypatch, tmp_path, what):
    """The result stands, a warning says what is missing and why; no traceback."""

    def fails(*_):
        raise ZeroDivisionError("float\ndivision")

    if what == "dynamic factor":
        simulation.outcome.attrs |= {"failed_afterwards": what, "warnings": f"{what}: failed: float division"}
    elif what == "pictures":
        sys.modules["fenics_gears.show.plots"].draw_run = fails
    else:
        monkeypatch.setattr("fenics_gears.commands.work.kept_run.summary_rows", fails)
    assert main(["run", str(DEMO), "--output", "here"]) == 5
    said = capsys.readouterr()
    assert f"{what}: failed" in said.out + said.err and "float division" in said.out + said.err
    assert "here/run.nc" in files(tmp_path) and "here/run.nc" in said.out
