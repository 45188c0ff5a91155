"""Tasks shared with a copy of the process: each is done once, and a failure is as without a copy."""

import os
import signal
from functools import partial

import pytest

from fenics_gears.system import copied_process
from fenics_gears.system.copied_process import do_all

HERE = os.getpid()


COPIES = []


@pytest.fixture(autouse=True)
def two_processors(monkeypatch):
    """A copy may be made, whatever this machine has and other tests have loaded; which ones are made is noted."""
    fork = os.fork

    def noted():
        COPIES.append(fork())
        return COPIES[-1]

    COPIES.clear()
    monkeypatch.setattr(os, "fork", noted)
    monkeypatch.setattr(copied_process, "_may_copy", lambda: True)


def note(directory, number):
    """Append the process that does a task to the file of that number."""
    with open(directory / str(number), "a") as file:
        file.write(f"{os.getpid()} ")


def done(directory):
    """The processes that did the tasks, by number."""
    return [(directory / name).read_text().split() for name in sorted(os.listdir(directory))]


def elsewhere(act):
    """Do something only in the copy."""
    if os.getpid() != HERE:
        act()


def no_process_is_left():
    assert COPIES
    for copy in COPIES:
        with pytest.raises(ChildProcessError):
            os.waitpid(copy, os.WNOHANG)


def test_each_task_is_done_once_by_two_processes_or_one(tmp_path):
    """Authority: counting; without `shared` there is no copy."""
    do_all([partial(note, tmp_path, number) for number in range(5)], shared=True)
    copies, own = done(tmp_path)[::2], done(tmp_path)[1::2]
    assert own == [[str(HERE)]] * 2 and len(copies[0]) == 1 and copies == [copies[0]] * 3 and copies[0] != own[0]
    do_all([partial(note, tmp_path, number) for number in range(5, 9)], shared=False)
    assert done(tmp_path)[5:] == [[str(HERE)]] * 4
    no_process_is_left()


@pytest.mark.parametrize(
    "end", [lambda: 1 / 0, lambda: os.kill(os.getpid(), signal.SIGKILL), lambda: os.kill(os.getpid(), signal.SIGINT)]
)
def test_what_the_copy_leaves_is_done_here(tmp_path, end):
    """Authority: hard_cases.md: no failure of a part that only saves time reaches the user; the copy fails, is killed,
    is interrupted."""
    do_all([lambda: (elsewhere(end), note(tmp_path, 0)), partial(note, tmp_path, 1)], shared=True)
    assert done(tmp_path) == [[str(HERE)]] * 2
    no_process_is_left()


def test_a_task_that_fails_in_both_processes_fails_here():
    """Authority: the same call without a copy raises this."""
    with pytest.raises(ZeroDivisionError):
        do_all([lambda: 1 / 0, lambda: None], shared=True)
    no_process_is_left()


def test_a_failure_or_ctrl_c_here_ends_the_copy():
    """Authority: files of a copy that goes on would appear after the call has failed; this one would go on for a
    minute."""

    def interrupted():
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        do_all([lambda: elsewhere(partial(signal.sigtimedwait, [signal.SIGUSR1], 60)), interrupted], shared=True)
    no_process_is_left()


def test_a_system_that_gives_no_further_process(tmp_path, monkeypatch):
    """Authority: `fork` raises BlockingIOError where a user's processes are limited."""
    monkeypatch.setattr(os, "fork", lambda: (_ for _ in ()).throw(BlockingIOError()))
    do_all([partial(note, tmp_path, number) for number in range(3)], shared=True)
    assert done(tmp_path) == [[str(HERE)]] * 3
