"""What the arithmetic and the memory traffic of a step of the march would take at the processor's best, beside what
each part takes.

    python -m tests.benchmarks.roofline [SCENE]   # the paper's scene unless given; writes docs/performance.md's table

Parts are timed one by one, each over all steps of the run in one call of compiled code, with what the march itself
found; CPU time, best of the rounds. Operations are counted from the sizes that these steps have; traffic is the entries
of compliance that are read, eight bytes each.
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from numba import njit

from fenics_gears.contact.laws import OPEN, STICK
from fenics_gears.contact.mixed_form import Equations, Iterate, relative_displacement, solve_sets
from fenics_gears.contact.newton import measure
from fenics_gears.dynamics.compiled_march import Course, slip_at_start, solve_steps
from fenics_gears.dynamics.contact_work import contact_work
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.steps import Steps, forces_at, nodes_at, operator_at
from fenics_gears.model.model import model_of
from fenics_gears.results.energy_variables import energy_of_teeth
from fenics_gears.results.mesh_curves import stiffness_curves
from fenics_gears.results.recorder import Recorder
from fenics_gears.scene.read import load_scene
from fenics_gears.simulation.elastic_route import gear_compliances, mesh_cycle
from fenics_gears.system.progress import SilentProgress

PAPER = Path(__file__).parents[2] / "demos" / "lundvall2004.toml"
ROUNDS = 9


@njit(cache=True)
def _equations(steps, s, motion, loads, slips):
    """The equations of a step and its solution."""
    contact, nodes, forces = operator_at(steps, s), nodes_at(steps, s), forces_at(steps, s)
    slip = slips[nodes] if steps.kinds == 2 else slips[:0]
    equations = Equations(
        motion.stiffness, loads[s], contact.compliance, contact.jacobian, contact.gap, slip, motion.friction,
        motion.free_motion,
    )  # fmt: skip
    found = Iterate(steps.status[nodes], steps.forces[forces], steps.states[s, 0], steps.displacement[forces])
    return equations, found


@njit(cache=True)
def _systems(steps, motion, loads, slips):
    """The linear system of the final sets of every step, set up and solved."""
    for s in range(1, len(steps.rows)):
        equations, found = _equations(steps, s, motion, loads, slips)
        nothing = np.zeros(len(found.forces))
        solve_sets(equations, Iterate(found.status, nothing, np.zeros(len(found.coordinates)), nothing))


@njit(cache=True)
def _displacements(steps, motion, loads, slips):
    total = 0.0
    for s in range(1, len(steps.rows)):
        equations, found = _equations(steps, s, motion, loads, slips)
        moved = Iterate(found.status, found.forces, found.coordinates, np.empty(len(found.forces)))
        relative_displacement(equations, moved, 0, len(found.forces))
        total += moved.displacement[0]
    return total


@njit(cache=True)
def _slips(steps, slips):
    for s in range(1, len(steps.rows)):
        contact, before = operator_at(steps, s), steps.forces[forces_at(steps, s - 1)]
        slips[nodes_at(steps, s)] = slip_at_start(
            contact.rigid_slip, contact.previous_jacobian, contact.previous_columns, steps.states[s - 1, 0], before
        )


@njit(cache=True)
def _measures(steps, motion, loads, slips):
    residual = np.empty(5)
    for s in range(1, len(steps.rows)):
        equations, found = _equations(steps, s, motion, loads, slips)
        measure(residual, equations, found)


def seconds(call) -> float:
    """Shortest CPU time of a call, the first one apart."""
    call()
    found = []
    for _ in range(ROUNDS):
        begun = time.process_time()
        call()
        found.append(time.process_time() - begun)
    return min(found)


def peaks() -> tuple[float, float]:
    """Gflop/s of a product of matrices, and Gbyte/s of a sum over memory that no cache holds, on one thread."""
    a, big = np.random.default_rng(0).random((800, 800)), np.ones(2**25)
    return 2e-9 * 800**3 / seconds(lambda: a @ a), 8e-9 * len(big) / seconds(big.sum)


def main() -> None:
    """Measure and print."""
    model = model_of(load_scene(Path(sys.argv[1]) if len(sys.argv) > 1 else PAPER))
    cycle = mesh_cycle(model, gear_compliances(model, SilentProgress(), None))
    marcher = Marcher(cycle, model.equations_of_motion)
    blocks: list[Steps] = []
    marcher.run(model.steps, 1, observe=lambda solved, march: blocks.append(solved))
    steps = blocks[0]
    for block in blocks[1:]:
        steps = steps.followed_by(block)
    count, k, kinds = len(steps), len(marcher.drivetrain.coordinates), steps.kinds
    loads, slips = np.tile(marcher.drivetrain.load, (count, 1)), np.zeros(len(steps.status))
    effective = marcher._motion._replace(stiffness=np.ascontiguousarray(marcher.dynamic.stiffness))
    of_step = np.repeat(np.arange(count), np.diff(steps.starts))
    n = np.diff(steps.starts).astype(float)
    closed = np.bincount(of_step[steps.status != OPEN], minlength=count).astype(float)
    stick = np.bincount(of_step[steps.status == STICK], minlength=count) * float(kinds == 2)
    m, loaded, iterations = kinds * n, kinds * closed, np.maximum(steps.iterations, 1)
    size = closed + stick + k
    # Name, seconds, operations and entries of compliance of a step, arrays over the steps.
    rows = []
    if kinds == 2:
        rows.append(
            ("slip before the step", seconds(lambda: _slips(steps.in_memory, slips)), 2 * n * (loaded + k), n * loaded)
        )
    arguments = steps.in_memory, effective, loads, slips
    per_iteration = [
        (
            "Newton's matrix and its solution",
            seconds(lambda: _systems(*arguments)),
            2 * size**2 + 4 * size * closed * (kinds - 1) + 2 / 3 * size**3 + 2 * size**2,
            kinds * closed * size,
        ),
        ("displacements", seconds(lambda: _displacements(*arguments)), 2 * m * (k + loaded), m * loaded),
        ("residuals", seconds(lambda: _measures(*arguments)), 6 * k * k + 4 * k * loaded + 8 * n, 0 * n),
    ]
    rows += [
        (name, spent * float(iterations.mean()), operations * iterations, entries * iterations)
        for name, spent, operations, entries in per_iteration
    ]
    solved = steps.between(0, count)
    durations = np.full(count, model.time_step)
    march = seconds(lambda: solve_steps(solved, 1, count, marcher._motion, Course(durations, loads)))
    rows += [
        (
            "contact work",
            seconds(lambda: contact_work(steps)),
            3 * closed**2 * kinds**2 + 2 * m * k,
            2 * (kinds * closed) ** 2,
        ),
        (
            "mesh stiffness",
            seconds(lambda: stiffness_curves(steps)),
            2 / 3 * closed**3 + 4 * closed**2 + 2 * n * loaded,
            closed**2 + n * loaded,
        ),
        ("energy of the teeth", seconds(lambda: energy_of_teeth(steps)), 4 * loaded**2, loaded**2),
    ]

    def recorded():
        recorder = Recorder(model, cycle)
        for block in blocks:
            recorder.take(block)
        recorder.finish()

    gflops, bandwidth = peaks()
    print(
        f"{count} steps of {n.mean():.1f} contact nodes, {closed.mean():.1f} closed, {k} centre coordinates,"
        f" {iterations.mean():.2f} iterations; {gflops:.0f} Gflop/s, {bandwidth:.1f} GB/s\n"
    )
    print(
        "| part | operations | bytes of compliance | us a step | Gflop/s | at the processor's best, us"
        " |\n|---|---|---|---|---|---|"
    )
    for name, spent, operations, entries in rows:
        work, traffic, each = float(operations.mean()), 8 * float(entries.mean()), spent / count * 1e6
        print(
            f"| {name} | {work:,.0f} | {traffic:,.0f} | {each:.1f} | {work / each * 1e-3:.2f} |"
            f" {max(work / gflops, traffic / bandwidth) * 1e-3:.2f} |"
        )
    print(
        f"| **all of the march** | | | {march / count * 1e6:.1f} | | |\n| **recording, with the last three and"
        f" numpy's** | | | {seconds(recorded) / count * 1e6:.1f} | | |"
    )


if __name__ == "__main__":
    main()
