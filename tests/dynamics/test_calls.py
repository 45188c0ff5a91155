"""Steps that are solved in calls of compiled code, by one thread or by two."""

from threading import Lock

import pytest

from fenics_gears.dynamics.calls import FEWEST_IN_HALVES, Calls

END = 2 * FEWEST_IN_HALVES


class Solver:
    """Counts how often each place is solved; compiled code does not solve the `hard` ones."""

    def __init__(self, hard=(), broken=None):
        self.hard, self.broken, self.solved, self.lock = set(hard), broken, [], Lock()

    def solve(self, first, end):
        for place in range(first, end):
            if place == self.broken:
                raise MemoryError
            if place in self.hard:
                return place
            with self.lock:
                self.solved.append(place)
        return end

    def plain(self, place):
        assert place in self.hard
        self.solved.append(place)


@pytest.mark.parametrize("cores", [1, 2])
@pytest.mark.parametrize("at_rest", [False, True])
@pytest.mark.parametrize("hard", [(), (3, END // 2 - 1), (END // 2,), (END // 2 + 4, END - 1), range(1, END)])
def test_every_place_is_solved_once(monkeypatch, cores, at_rest, hard):
    """Identity: by compiled code, or plainly where that does not solve it, whichever thread comes to it."""
    monkeypatch.setattr("fenics_gears.dynamics.calls.threads", lambda: cores)
    solver = Solver(hard)
    reached = list(Calls().through(solver.solve, solver.plain, END, at_rest))
    assert sorted(solver.solved) == list(range(1, END))
    assert reached == sorted(reached) and reached[-1] == END


@pytest.mark.parametrize("broken", [2, END - 2])
def test_what_either_half_raises_is_raised(monkeypatch, broken):
    """The user's expectation: memory that ends in the other thread ends the march."""
    monkeypatch.setattr("fenics_gears.dynamics.calls.threads", lambda: 2)
    solver = Solver(broken=broken)
    with pytest.raises(MemoryError):
        list(Calls().through(solver.solve, solver.plain, END, True))
