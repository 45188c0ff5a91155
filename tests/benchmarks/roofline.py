"""What the arithmetic and the memory traffic of a step of the march would take at the processor's best, beside what
each part takes.

    python -m tests.benchmarks.roofline [SCENE]   # the paper's unless given; for docs/evidence/performance.md

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

from fenics_gears.contact.addresses import (
    COMPLIANCE,
    GAP,
    JACOBIAN,
    PREVIOUS_COMPLIANCE,
    PREVIOUS_JACOBIAN,
    RIGID_SLIP,
    matrix_at,
    vector_at,
)
from fenics_gears.contact.laws import OPEN, STICK
from fenics_gears.contact.newton import measure, relative_displacement, solve_sets
from fenics_gears.dynamics.compiled_march import slip_at_start, solve_steps
from fenics_gears.dynamics.contact_work import contact_work
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.steps import Steps
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
def _systems(table, starts, kinds, stiffness, loads, friction, slips, status, forces):
    """The linear system of the final sets of every step, set up and solved."""
    for s in range(1, len(table)):
        n, m, k = starts[s + 1] - starts[s], kinds * (starts[s + 1] - starts[s]), len(stiffness)
        found, coordinates = np.zeros(m), np.zeros(k)
        solve_sets(
            stiffness, loads[s], matrix_at(table[s, COMPLIANCE], m, m), matrix_at(table[s, JACOBIAN], m, k),
            vector_at(table[s, GAP], n),
            slips[starts[s] : starts[s] + (n if kinds == 2 else 0)], friction, status[starts[s] : starts[s + 1]], found,
            coordinates,
        )  # fmt: skip


@njit(cache=True)
def _displacements(table, starts, kinds, forces, positions):
    total = 0.0
    for s in range(1, len(table)):
        m, k = kinds * (starts[s + 1] - starts[s]), positions.shape[1]
        found, now = np.empty(m), slice(kinds * starts[s], kinds * starts[s + 1])
        relative_displacement(
            found,
            0,
            m,
            matrix_at(table[s, COMPLIANCE], m, m),
            matrix_at(table[s, JACOBIAN], m, k),
            forces[now],
            positions[s],
        )
        total += found[0]
    return total


@njit(cache=True)
def _slips(table, starts, forces, positions, slips):
    for s in range(1, len(table)):
        n, k = starts[s + 1] - starts[s], positions.shape[1]
        before = forces[2 * starts[s - 1] : 2 * starts[s]]
        slips[starts[s] : starts[s + 1]] = slip_at_start(
            vector_at(table[s, RIGID_SLIP], n), matrix_at(table[s, PREVIOUS_JACOBIAN], n, k),
            matrix_at(table[s, PREVIOUS_COMPLIANCE], len(before), n),
            positions[s - 1], before,
        )  # fmt: skip


@njit(cache=True)
def _measures(table, starts, kinds, stiffness, loads, friction, slips, status, forces, displacement, positions):
    residual = np.empty(5)
    for s in range(1, len(table)):
        n, m, k = starts[s + 1] - starts[s], kinds * (starts[s + 1] - starts[s]), len(stiffness)
        now = slice(kinds * starts[s], kinds * starts[s + 1])
        measure(
            residual, stiffness, loads[s], matrix_at(table[s, COMPLIANCE], m, m), matrix_at(table[s, JACOBIAN], m, k),
            vector_at(table[s, GAP], n),
            slips[starts[s] : starts[s] + (n if kinds == 2 else 0)], friction, status[starts[s] : starts[s + 1]],
            forces[now], positions[s], displacement[now],
        )  # fmt: skip


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
    positions, loads = steps.states[:, 0].copy(), np.tile(marcher.drivetrain.load, (count, 1))
    slips, effective, friction = (
        np.zeros(len(steps.status)),
        np.ascontiguousarray(marcher.dynamic.stiffness),
        marcher.friction,
    )
    of_step = np.repeat(np.arange(count), np.diff(steps.starts))
    n = np.diff(steps.starts).astype(float)
    closed = np.bincount(of_step[steps.status != OPEN], minlength=count).astype(float)
    stick = np.bincount(of_step[steps.status == STICK], minlength=count) * float(kinds == 2)
    m, loaded, iterations = kinds * n, kinds * closed, np.maximum(steps.iterations, 1)
    size = closed + stick + k
    # Name, seconds, operations and entries of compliance of a step, arrays over the steps.
    table, starts = steps.table, steps.starts
    rows = []
    if kinds == 2:
        rows.append(
            (
                "slip before the step",
                seconds(lambda: _slips(table, starts, steps.forces, positions, slips)),
                2 * n * (loaded + k),
                n * loaded,
            )
        )
    arguments = table, starts, kinds, effective, loads, friction, slips, steps.status, steps.forces
    per_iteration = [
        (
            "Newton's matrix and its solution",
            seconds(lambda: _systems(*arguments)),
            2 * size**2 + 4 * size * closed * (kinds - 1) + 2 / 3 * size**3 + 2 * size**2,
            kinds * closed * size,
        ),
        (
            "displacements",
            seconds(lambda: _displacements(table, starts, kinds, steps.forces, positions)),
            2 * m * (k + loaded),
            m * loaded,
        ),
        (
            "residuals",
            seconds(lambda: _measures(*arguments, steps.displacement, positions)),
            6 * k * k + 4 * k * loaded + 8 * n,
            0 * n,
        ),
    ]
    rows += [
        (name, spent * float(iterations.mean()), operations * iterations, entries * iterations)
        for name, spent, operations, entries in per_iteration
    ]
    solved = steps.between(0, count)
    durations = np.full(count, model.time_step)
    march = seconds(lambda: solve_steps(solved, 1, count, marcher._motion, durations, loads))
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
