"""A mesh cycle whose every step is solved with contact nodes and centre coordinates in another order."""

from dataclasses import replace

import numpy as np

from fenics_gears import simulate
from fenics_gears.simulation.routes import prepared
from fenics_gears.system.progress import SilentProgress


def solved_in_other_order(scene, seed: int):
    """The scene's result with all unknowns of every step shuffled before the solver sees them, and its answer put
    back."""

    def preparation(model, progress, cache):
        gears, cycle = prepared(model, SilentProgress(), cache)
        plain, random = cycle.solve, np.random.default_rng(seed)

        def solve(position, problem, status, last):
            nodes, coordinates = random.permutation(len(problem.gap)), random.permutation(len(problem.load))
            rows = np.concatenate([nodes, len(nodes) + nodes])[: len(problem.compliance)]
            shuffled = replace(
                problem,
                stiffness=np.ascontiguousarray(problem.stiffness[np.ix_(coordinates, coordinates)]),
                load=problem.load[coordinates],
                compliance=np.ascontiguousarray(problem.compliance[np.ix_(rows, rows)]),
                jacobian=np.ascontiguousarray(problem.jacobian[np.ix_(rows, coordinates)]),
                gap=problem.gap[nodes],
                slip_before=problem.slip_before[nodes] if len(problem.slip_before) else problem.slip_before,
                free_motion=problem.free_motion[coordinates] if len(problem.free_motion) else problem.free_motion,
            )
            solution = plain(position, shuffled, status[nodes], None)
            back = {}
            for name, order in (
                ("forces", rows), ("displacement", rows), ("coordinates", coordinates), ("status", nodes),
            ):  # fmt: skip
                back[name] = np.empty_like(getattr(solution, name))
                back[name][order] = getattr(solution, name)
            return replace(solution, **back)

        cycle.solve = solve
        return gears, cycle

    return simulate(scene, preparation=preparation)
