"""Rows 1 and 2 on single steps drawn at random."""

import numpy as np
from hypothesis import event, given, settings
from hypothesis import strategies as st
from tests.contact.laws_of_contact import law_residual
from tests.contact.problems import random_problem

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.mixed_form import StepEquations
from fenics_gears.contact.step_solver import StepSolution, solve_step

REASONS = ("no equilibrium", "self-locking", "more than one solution")


@st.composite
def steps(draw, frictions) -> tuple[StepEquations, np.ndarray]:
    """A problem with 1 to 12 nodes, loads over six decades, held or free, and any sets to start from."""
    seed, nodes, friction = draw(st.integers(0, 10**9)), draw(st.integers(1, 12)), draw(frictions)
    load = 10.0 ** draw(st.floats(-1.0, 5.0))
    problem = random_problem(seed, nodes, friction, draw(st.integers(1, 4)), load, free=draw(st.booleans()))
    highest = 3 if friction else 1
    return problem, np.array(draw(st.lists(st.integers(0, highest), min_size=nodes, max_size=nodes)), dtype=np.int8)


def solved(problem: StepEquations, start: np.ndarray) -> StepSolution | None:
    """The solution; None where there is a typed error with its reason, which only friction may have."""
    try:
        solution = solve_step(problem, start)
    except ContactNotConverged as failure:
        event(failure.reason.split(":")[0])
        assert problem.friction > 0.0 and failure.reason.startswith(REASONS), str(failure)
        return None
    event(solution.method)
    return solution


def judged_steps(measured, drawn, limits, examples: int) -> None:
    """Draw steps, hold each solution against `limits` (name: words, limit, unit), and tell the worst."""
    worst, count = dict.fromkeys(limits, 0.0), {"solved": 0, "typed": 0}

    @settings(max_examples=examples)
    @given(drawn)
    def every_step(step):
        solution = solved(*step)
        count["solved" if solution is not None else "typed"] += 1
        if solution is None:
            return
        found = violations(step[0], solution)
        for name, (_, limit, _) in limits.items():
            worst[name] = max(worst[name], found[name])
            assert found[name] <= limit, name

    try:
        every_step()
    finally:
        for name, (words, limit, unit) in limits.items():
            measured(f"{words}, single steps", worst[name], f"{limit:g} {unit}".rstrip(), unit)
        measured("random single steps", f"{count['solved']} solved, {count['typed']} errors with their cause", "all")


def violations(problem: StepEquations, solution: StepSolution) -> dict[str, float]:
    """How far a solution misses the laws: lengths in um, forces in parts of the largest, works of that times the
    largest length."""
    forces, n = solution.forces, len(problem.gap)
    deflection, moved = problem.compliance @ forces, problem.jacobian @ solution.coordinates
    displacement = moved - deflection
    slip_before = problem.slip_before if problem.friction else None
    laws = law_residual(forces, displacement, problem.gap, slip_before, problem.friction)
    force = max(float(np.abs(forces).max()), float(np.abs(problem.load).max()))
    length = max(float(np.abs(each).max()) for each in (problem.gap, moved, deflection))
    balance = problem.stiffness @ solution.coordinates + problem.jacobian.T @ forces - problem.load
    found = {
        "penetration": 1e3 * laws["penetration"],
        "tension": laws["tension"] / force,
        "complementarity": float(np.max(np.abs(forces[:n] * (problem.gap - displacement[:n])))) / (force * length),
        # The system holds loads beside lengths over compliances: those are the terms whose round-off is left of the
        # balance.
        "balance": float(np.abs(balance).max()) / max(force, length / float(np.diag(problem.compliance)[:n].min())),
    }
    if slip_before is not None:
        slip = displacement[n:] + slip_before
        path = max(length, float(np.abs(slip_before).max()))
        found["cone"] = laws["cone_excess"] / force
        found["stick"] = 1e3 * laws["stick_slip"]
        found["wrong_way"] = laws["wrong_way"] / (force * path)
        found["dissipation"] = max(-float(forces[n:] @ slip), 0.0) / (force * path)
    return found
