"""How progress is reported."""

import io
import signal

import pytest

from fenics_gears.system import progress


class Clock:
    now = 0.0

    def __call__(self):
        return self.now


@pytest.fixture
def bar():
    """`drawn`: what it draws on a terminal."""
    console = pytest.importorskip("rich.console").Console(file=io.StringIO(), force_terminal=True, width=100)
    found = progress.BarProgress(console)
    found.drawn = console.file
    return found


def test_lines_come_at_most_every_few_seconds_and_say_the_time_left():
    """A fifth done after 6 s leaves 24 s."""
    clock, stream = Clock(), io.StringIO()
    lines = progress.LineProgress(stream, interval=5.0, clock=clock)
    lines.stage("march")
    for tenth in range(101):
        clock.now = 0.1 * tenth * 3
        lines.update(tenth, 100)
    lines.close()
    told = stream.getvalue().splitlines()
    assert told[0] == "march: 17 of 100 (17 %) after 5.1 s, about 25 s left"
    assert len(told) == 6
    assert told[-1] == "march: 30 s"


def test_no_time_left_is_said_before_enough_is_known():
    """A real run of 75 s, whose first mesh cycle took half of the time; cases of 20 s each. At most a factor of two
    off."""
    steps = [done if done < 40 else 40.0 + 35.0 * (done - 40) / 7160 for done in range(7201)]
    for times, counts, whole in (
        (steps, range(7201), 75.0),
        (range(101), [second // 20 for second in range(101)], 100.0),
    ):
        clock, stream = Clock(), io.StringIO()
        lines = progress.LineProgress(stream, interval=5.0, clock=clock)
        lines.stage("march")
        for clock.now, done in zip(times, counts):
            lines.update(done, counts[-1])
        told = (line.partition(" after ")[2].partition(" s, about ") for line in stream.getvalue().splitlines())
        said = [(whole - float(after), float(left.partition(" s")[0])) for after, _, left in told if left]
        assert said and all(0.5 * there <= left <= 2.0 * there + 20.0 for there, left in said), said


def test_a_bar_stops_where_the_work_stopped(bar):
    """An interrupted run must not look finished."""
    bar.stage("condense pinion")
    bar.stage("march")
    bar.update(30, 100)
    bar.close()
    last = bar.drawn.getvalue().rpartition("march")[2]
    assert "30/100" in last and "100/100" not in last


def test_a_bar_is_full_where_the_work_ended_and_a_later_stage_is_drawn_alone(bar):
    """What is told to be done is done; a bar that was drawn for good is not drawn again."""
    bar.stage("sections")
    assert list(bar.counted(range(30))) == list(range(30))
    bar.close()
    assert "30/30" in bar.drawn.getvalue().rpartition("sections")[2]
    before = bar.drawn.tell()
    bar.stage("draw pictures")
    bar.close()
    assert "sections" not in bar.drawn.getvalue()[before:]


def test_ctrl_c_does_not_interrupt_what_is_done():
    """All steps are there: the run is complete, and what comes after it hears of Ctrl-C."""
    with progress.Interruption(progress.SilentProgress()) as interruption:
        interruption.stage("march")
        interruption.update(1, 2)
        signal.raise_signal(signal.SIGINT)
        interruption.update(2, 2)
        with pytest.raises(KeyboardInterrupt):
            interruption.heed()


@pytest.mark.parametrize(("done", "said"), [(5, False), (50, True)])
def test_a_bar_says_the_time_left_once_enough_is_known(bar, done, said):
    """The rule of the lines: a twentieth of the whole may be its beginning."""
    bar.stage("march")
    for count in range(done + 1):
        bar.update(count, 100)
    bar.close()
    assert ("-:--:--" not in bar.drawn.getvalue().rpartition("left")[2]) == said
