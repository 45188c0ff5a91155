"""A mesh cycle whose unknowns are in another order at every step."""

from dataclasses import replace

import numpy as np

from fenics_gears import simulate
from fenics_gears.contact.addresses import form_rows
from fenics_gears.simulation.routes import prepared
from fenics_gears.system.progress import SilentProgress


def solved_in_other_order(scene, seed: int):
    def preparation(model, progress, cache):
        gears, cycle = prepared(model, SilentProgress(), cache)
        return gears, in_other_order(cycle, seed)

    return simulate(scene, preparation=preparation)


def in_other_order(cycle, seed: int):
    """All unknowns of every step shuffled before the solver sees them, and its answer put back."""
    plain, random = cycle.solve, np.random.default_rng(seed)

    def solve(position, problem, status, last):
        nodes, coordinates = random.permutation(len(problem.gap)), random.permutation(len(problem.load))
        rows = np.concatenate([nodes, len(nodes) + nodes])[: len(problem.compliance)]
        form_rows(problem.rows, np.arange(len(nodes)))
        shuffled = problem._replace(
            rows=0,
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

    return solved_by(cycle, solve)


def solved_by(cycle, solve):
    """Every step solved by `solve`, none within compiled code."""
    cycle.solve, cycle.traits = solve, replace(cycle.traits, own_solver=True)
    return cycle
