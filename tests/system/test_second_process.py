"""A second process beside this one."""

import os
import signal
import threading
import time

import numpy as np
import pytest
from threadpoolctl import threadpool_info

from fenics_gears.errors import ComputationError, SceneError
from fenics_gears.system import environment, second_process


def product(rows, _):
    print("a library prints")
    return os.getpid(), rows @ rows.T, max(pool["num_threads"] for pool in threadpool_info())


def failing(error, _):
    raise error


def killed(_):
    os.kill(os.getpid(), signal.SIGKILL)


def endless(folder, _):
    (folder / str(os.getpid())).touch()
    time.sleep(600.0)


def test_it_computes_what_this_process_computes(capfd):
    """With threads of its own; what libraries print does not come between."""
    rows = np.arange(12.0).reshape(3, 4)
    process, found, threads = second_process.SecondProcess(1).together(product, rows)[0]
    assert process != os.getpid() and threads == 1
    assert np.array_equal(found, rows @ rows.T)
    assert capfd.readouterr().err == "a library prints\n"


@pytest.mark.parametrize(
    ("error", "kind", "words"),
    [
        (SceneError("no such gear"), SceneError, "no such gear"),
        (MemoryError("full"), ComputationError, "MemoryError: full"),
    ],
)
def test_its_error_is_raised_here(error, kind, words):
    """Errors that a user meets keep their kind, and so their exit code."""
    with pytest.raises(kind, match=words):
        second_process.SecondProcess(1).together(failing, error)


def test_a_process_that_is_killed_is_said():
    """As the kernel does where memory is short."""
    with pytest.raises(ComputationError, match="code -9.*Memory may be short.*OMP_NUM_THREADS=1"):
        second_process.SecondProcess(1).together(killed)


def test_it_ends_with_what_it_was_started_for(tmp_path, monkeypatch):
    """An error here, or Ctrl-C, leaves no process behind."""
    monkeypatch.setattr(second_process, "threads", lambda: 2)
    raised = []

    def wait(process):
        try:
            process.together(endless, tmp_path)
        except ComputationError as error:
            raised.append(error)

    with pytest.raises(KeyboardInterrupt), second_process.second_process() as process:
        waiting = threading.Thread(target=wait, args=[process])
        waiting.start()
        while not list(tmp_path.iterdir()):
            time.sleep(0.01)
        raise KeyboardInterrupt
    waiting.join()
    assert raised
    with pytest.raises(ProcessLookupError):
        os.kill(int(next(tmp_path.iterdir()).name), 0)


def test_threads(monkeypatch):
    """At most as there are cores; a rank of a job has one."""
    cores = len(os.sched_getaffinity(0))
    for name in (*environment.THREADS, *environment.RANK_COUNTS):
        monkeypatch.delenv(name, raising=False)
    assert environment.threads() == cores
    monkeypatch.setenv("OMP_NUM_THREADS", "1")
    assert environment.threads() == 1
    monkeypatch.setenv("OMP_NUM_THREADS", "1000")
    assert environment.threads() == cores
    monkeypatch.setenv("OMPI_COMM_WORLD_SIZE", "1")
    assert environment.threads() == 1
