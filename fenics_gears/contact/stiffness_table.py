"""A table of the mesh stiffness: how far the mesh yields under some loads at each phase, and how its tooth pairs share
them.

It is taken from one quasi-static, frictionless mesh cycle of the full contact; between loads and phases it is linear.
This is the time-varying non-linear mesh spring of common practice: it depends neither on speed nor on friction, and on
rotations of the gears alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .laws import Tolerance
from .mesh_cycle import Cycle
from .mixed_form import StepEquations
from .operator import ContactOperator
from .spring_mesh import PairSprings
from .step_solver import cold_start, solve_step
from .tooth_pair import COAST, DRIVE

# In parts of the scene's load; above the last the curve goes on straight.
LOADS = (0.0, 0.25, 0.5, 0.7, 0.85, 1.0, 1.15, 1.3, 1.6, 2.5)
# A spring that adds less than this part to the stiffness is left out: it is round-off of a curve that is straight
# there.
NEGLIGIBLE = 1e-9


@dataclass(frozen=True)
class StiffnessTable:
    """`loads` (l,), N, from zero; `approach` by flank (phases + 1, l), mm; `share` by (flank, index) (phases + 1, l),
    N, of each pair.

    Phases are even over a mesh cycle, its end included.
    """

    loads: np.ndarray
    approach: dict[int, np.ndarray]
    share: dict[tuple[int, int], np.ndarray]

    def springs(self, phase: float) -> list[PairSprings]:
        """The springs of every pair at a phase (0 <= phase < 1)."""
        return [each for flank in self.approach for each in self._of_flank(flank, phase)]

    def _of_flank(self, flank: int, phase: float) -> list[PairSprings]:
        approach = _at(self.approach[flank], phase)
        indices = [index for side, index in self.share if side == flank]
        shares = np.array([_at(self.share[flank, index], phase) for index in indices])
        slopes = np.maximum.accumulate(np.diff(self.loads) / np.diff(approach))
        # Where a pair comes into contact the slopes of the others fall a little, since they share the gear body; the
        # sum includes that.
        gained = np.maximum(np.diff(np.diff(shares, axis=1) / np.diff(approach), axis=1, prepend=0.0), 0.0)
        stiffness = np.diff(slopes, prepend=0.0) * gained / np.maximum(gained.sum(axis=0), np.finfo(float).tiny)
        springs = []
        for index, row in zip(indices, stiffness):
            level = np.flatnonzero(row > NEGLIGIBLE * slopes[-1])
            if len(level):
                springs.append(PairSprings(index, flank, level, approach[level], row[level]))
        return springs


def _at(values: np.ndarray, phase: float) -> np.ndarray:
    """Rows over phases, linear between them."""
    place = phase * (len(values) - 1)
    low = min(int(place), len(values) - 2)
    part = place - low
    return values[low] if part == 0.0 else (1.0 - part) * values[low] + part * values[low + 1]


def stiffness_table(cycle: Cycle, rotation: int, load: float, loads: tuple[float, ...] = LOADS) -> StiffnessTable:
    """Tabulate a cycle without friction at its own steps.

    `rotation`: column of the wheel's rotation among the operators' coordinates. `load`: the force (N) that the `loads`
    are parts of.
    """
    levels = load * np.asarray(loads)
    flanks = (DRIVE, COAST) if cycle.coast_flanks else (DRIVE,)
    approach = {flank: np.zeros((cycle.steps + 1, len(levels))) for flank in flanks}
    share: dict[tuple[int, int], np.ndarray] = {}
    for step in range(cycle.steps + 1):
        operator, passed = cycle.position(step).operator, step // cycle.steps
        for flank in flanks:
            nodes = np.flatnonzero(operator.on_drive_flanks == (flank == DRIVE))
            approach[flank][step], forces = _curve(operator, nodes, rotation, levels)
            for place in np.unique(operator.node_pair[nodes]):
                # At the end of a cycle pairs are counted as in it.
                index = operator.pairs[place].place.index - passed
                rows = share.setdefault((flank, index), np.zeros((cycle.steps + 1, len(levels))))
                rows[step] = forces[:, operator.node_pair[nodes] == place].sum(axis=1)
    return StiffnessTable(levels, approach, {key: rows for key, rows in share.items() if rows.any()})


def _curve(
    operator: ContactOperator, nodes: np.ndarray, rotation: int, levels: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Approach (l,), mm, along the line of action, and forces (l, n), N, of the nodes under each load."""
    # Coast flanks are approached by turning the other way.
    along = np.abs(operator.jacobian[nodes, rotation])
    gap, compliance = operator.gap[nodes], np.ascontiguousarray(operator.compliance[np.ix_(nodes, nodes)])
    approach, forces = np.zeros(len(levels)), np.zeros((len(levels), len(nodes)))
    approach[0] = (gap / along).min()
    status = cold_start(gap, operator.node_pair[nodes])
    for row, load in enumerate(levels[1:], 1):
        problem = StepEquations(
            stiffness=np.zeros((1, 1)), load=np.array([load]), compliance=compliance, jacobian=along[:, None], gap=gap,
            slip_before=np.empty(0), friction=0.0, free_motion=np.ones(1), tolerance=Tolerance.of_load(load),
        )  # fmt: skip
        solution = solve_step(problem, status)
        approach[row], forces[row], status = solution.coordinates[0], solution.forces, solution.status.copy()
    return approach, forces
