"""The numbers of runs that are marched together, where a few numbers and no dataset are asked for. The functions are
the same as in `results.dataset`.

A run that would have a warning is run by itself: where contact is lost, gears pass through each other, or steps are
divided or have no solution.
"""

import time
from collections.abc import Collection, Sequence
from typing import Any

import numpy as np

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.step_solver import HALVED
from fenics_gears.dynamics.batch import OpenedNodes
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.marched import March
from fenics_gears.dynamics.steps import Steps
from fenics_gears.model.model import Model
from fenics_gears.model.row_model import RowModel

from .contact_variables import energy_variables, node_variables, normal_forces, pair_variables, work_variables
from .dataset import friction_loss, numbers_of_curves
from .extrema import Extrema, repeating_steps
from .face_variables import AlongTheFace
from .key_numbers import HARMONIC_NAMES
from .mesh_curves import EdgesAndKinks, pressure_curves
from .recorder import KnownTouching
from .settled import settled
from .side_by_side import KnownLayouts, SideBySide

ERROR = "peak_to_peak_transmission_error"
FORCE = "largest_pair_force"
PRESSURE = "peak_contact_pressure"
LOSS = "friction_loss"
# What can be asked for, and what of it takes no other key numbers.
OVER_FACE = "face_load_factor", "largest_line_load_factor", "edge_line_load_factor", "transverse_load_factor"
OF_THEMSELVES = frozenset((ERROR, LOSS, "max_normal_force", *OVER_FACE))
Curves = dict[str, np.ndarray]
OFFERED = OF_THEMSELVES | {FORCE, PRESSURE, *HARMONIC_NAMES}


class NumbersOfRun:
    """Numbers of a run by name (`attrs`), and the curves (steps, ...) that they were taken from; `seconds`: that they
    took."""

    def __init__(self, attrs: dict[str, Any], curves: dict[str, np.ndarray], seconds: float):
        self.attrs = attrs
        self._curves = curves
        self.seconds = seconds

    def __getitem__(self, name: str) -> np.ndarray:
        return self._curves[name]

    def __contains__(self, name: str) -> bool:
        return name in self._curves


def numbers_together(
    models: Sequence[Model], cycle: Cycle, opened: OpenedNodes, asked: Collection[str]
) -> list[NumbersOfRun | None]:
    """The numbers that are `asked` of OFFERED of runs on a `cycle` without gaps of its own; None of a run that has to
    be run by itself."""
    begun = time.perf_counter()
    model = models[0]
    marcher = Marcher(cycle, *equations_of(models), opened=opened)
    marches = marcher.together(model.steps, repeating_steps(model))
    if any(march.interrupted for march in marches):
        raise KeyboardInterrupt
    marched = time.perf_counter() - begun
    counts = (run not in marcher.failures and _is_as_expected(model, march) for run, march in enumerate(marches))
    runs = np.flatnonzero(list(counts)).tolist()
    count = len(models)
    of_runs: list[NumbersOfRun | None] = [None] * count
    if not runs:
        return of_runs
    first = settled(model, model.steps).first
    curves, factors = _curves(models, cycle, [(run, marches[run]) for run in runs], first, asked)
    counted = [{name: values[first:] for name, values in of_run.items()} for of_run in curves]
    loss = [friction_loss(*each) if LOSS in asked else {} for each in zip(curves, counted)]
    phase, error = (counted[0][name] for name in ("mesh_phase", "transmission_error"))
    extrema = Extrema(model, cycle, phase, error, marches, marcher.batch)
    found = numbers_of_curves(model, extrema, list(zip(runs, counted, loss)), not OF_THEMSELVES.issuperset(asked))
    seconds = (time.perf_counter() - begun) / count
    for place, run in enumerate(runs):
        numbers = found[place][0] | found[place][1] | factors[place]
        numbers |= {
            "newton_iterations_total": marches[run].newton_iterations,
            "steps_per_mesh_cycle": model.resolution.steps_per_mesh_cycle,
            "base_radius_wheel": abs(model.pair.wheel.base_radius),
            "settled_from": float(curves[place]["time"][first]),
            "time_march": marched / count,
            "wall_time": seconds,
        }
        of_runs[run] = NumbersOfRun(numbers, curves[place], seconds - marched / count)
    return of_runs


def equations_of(models: Sequence[Model | RowModel]) -> list:
    """What each run solves for, made once for runs with the same load: they are alike in all else."""
    equations = []
    known = {}
    for model in models:
        load = model.drivetrain.load.tobytes()
        if load not in known:
            known[load] = model.equations_of_motion
        equations.append(known[load])
    return equations


def _error(model: Model, march: March) -> np.ndarray:
    """The transmission error at all steps of a march, whose steps are in one block."""
    return model.transmission_error(march.latest.states[:, 0])


def runs_smoothly(march: March) -> bool:
    """Whether flanks touch at every step, and none was divided."""
    return not (march.separations or march.steps_by_method[HALVED])


def _is_as_expected(model: Model, march: March) -> bool:
    """Whether the result of a march would have no warning."""
    if not runs_smoothly(march):
        return False
    return bool(np.abs(_error(model, march)).max() <= abs(model.pair.wheel.angular_pitch))


def _curves(
    models: Sequence[Model], cycle: Cycle, marches: Sequence[tuple[int, March]], first: int, asked: Collection[str]
) -> tuple[list[Curves], list[dict[str, float]]]:
    """Curves of the runs that are counted, by their marches, and load factors over a face where they are asked for,
    from a first step on."""
    model = models[0]
    of_runs = []
    factors = []
    numbers = np.arange(model.steps + 1)
    common = {"time": model.clock.times(numbers), "mesh_phase": numbers / model.resolution.steps_per_mesh_cycle}
    nodes: SideBySide | None = None
    over_face = not set(OVER_FACE).isdisjoint(asked)
    for run, march in marches:
        steps = march.latest
        nodes = nodes_of(cycle, steps) if nodes is None else nodes.with_forces(steps)
        curves = common | {"transmission_error": _error(model, march)} | _of_nodes(models[run], cycle, nodes, asked)
        of_runs.append(curves)
        factors.append(_load_factors(models[run], nodes, curves, first) if over_face else {})
    return of_runs, factors


def _load_factors(model: Model, nodes: SideBySide, curves: Curves, first: int) -> dict[str, float]:
    of_pairs = {"pair_number": nodes.pair_number, **pair_variables(model.scene, nodes)}
    return AlongTheFace(nodes.cycle).numbers_of_curves(curves | of_pairs, nodes, first, model.contact_steps)


def nodes_of(cycle: Cycle, steps: Steps) -> SideBySide:
    """Contact nodes of the steps of a run on a cycle."""
    ways = cycle.shared(KnownTouching).of(cycle)
    return SideBySide(cycle.shared(KnownLayouts), cycle, steps, ways.slots, 1 + ways.latest)


def _of_nodes(model: Model, cycle: Cycle, nodes: SideBySide, asked: Collection[str]) -> Curves:
    scene = model.scene
    steps = nodes.steps
    values = normal_forces(scene, nodes) | (pair_variables(scene, nodes) if FORCE in asked else {})
    if PRESSURE in asked:
        values |= pressure_curves(nodes, node_variables(scene, nodes), EdgesAndKinks(model))
    if LOSS in asked and scene.friction is not None:
        energies = energy_variables(scene, model.drivetrain, steps)
        values |= work_variables(scene, cycle, model.drivetrain, model.clock, (), steps, energies["energy"])
    return values
