"""Lead modifications that make the line load along the face as even as two numbers can: helix slope and crowning of the
pinion for the least face load factor of the run's own mesh.

Static positions of a mesh cycle are solved by the run's contact operators with other gaps, without friction; everything
else that opens the flanks along the face counts as in the run. While the closed nodes stay closed, line load w (S,) is
linear in amounts a = (slope, crowning); the largest mean over a window of the face, W w (`results.face_ends`), is then
least by a linear program:

    minimise t  with  W (w + dw/da d) <= t,  crowning + d_2 >= 0

whose step d is halved until that largest mean falls, and which is repeated until it falls no more. Where a part of the
face does not touch, a helix slope first takes off what is left open there and what the rest approaches by.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.tooth_pair import per_node
from fenics_gears.dynamics.between_steps import BetweenSteps
from fenics_gears.dynamics.march import thread_pools
from fenics_gears.effects.lead_modifications import LeadModification, LeadModifications
from fenics_gears.model.model import Model
from fenics_gears.results.face_ends import windows
from fenics_gears.results.recorder import Recorder
from fenics_gears.scene.data import Scene

from .dynamic_factor import at_rest, quasi_static
from .elastic_route import gaps_apart, gaps_of

# Positions of the mesh cycle, about.
POSITIONS = 16
# Steps of the search, halvings of one, and the part of the face load factor below which a gain is none.
MOST_STEPS, MOST_HALVINGS, GAIN = 8, 5, 1e-3
# Difference for derivatives, over the mean approach of the flanks, estimated by a mesh stiffness, N/mm per mm of face.
DIFFERENCE, STIFFNESS = 0.05, 14e3
MICROMETRE = 1e-3


class Proposal(NamedTuple):
    """Lead modifications of the pinion, mm over its own face, in place of its own; the face load factor and the line
    load (S,), N/mm, of all tooth pairs together, mean over the mesh cycle, with them."""

    helix_slope: float
    crowning: float
    face_load_factor: float
    line_load: np.ndarray


def wanted(model: Model) -> bool:
    """Whether something tilts the flanks of a scene against each other, under a load on the drive flanks."""
    scene = model.scene
    if not scene.three_dimensional or not gaps_apart(model) or scene.load.wheel_torque <= 0.0:
        return False
    webs = [gear.web for gear in (model.pair.pinion, model.pair.wheel)]
    bearings, leaning = scene.bearings, scene.misalignment
    return (
        any(web is not None and web.offset for web in webs)
        or (bearings is not None and (bearings.places is not None or bearings.each is not None))
        or (leaning is not None and bool(leaning.in_plane))
    )


def add_proposal(dataset: xr.Dataset, recorder: Recorder) -> None:
    found = proposed(recorder)
    if found is None:
        return
    for name in ("helix_slope", "crowning"):
        dataset.attrs[f"proposed_{name}"] = getattr(found, name) / MICROMETRE
    dataset.attrs["proposed_face_load_factor"] = found.face_load_factor
    words = "line load of all tooth pairs, mean over the mesh cycle, with the proposed lead modifications"
    dataset["proposed_line_load"] = "face_position", found.line_load, {"units": "N/mm", "long_name": words}


def proposed(recorder: Recorder) -> Proposal | None:
    """The proposal for a run; None where a position has no solution without friction and inertia."""
    loads = _LineLoads(recorder.model, recorder.cycle)
    amounts, face = loads.own, xr.Dataset(coords=recorder.along_face[0].coordinates())
    over, widths, last = windows(face, recorder.model.pair), face["face_slice_width"].values, np.inf
    found = loads.of(amounts)
    if found is None:
        return None
    mean = float(found.load @ widths / widths.sum())
    for _ in range(MOST_STEPS):
        largest = (over @ found.load).max()
        if last - largest < GAIN * mean:
            break
        last, slopes = largest, loads.slopes(amounts, found, mean)
        steps = [] if slopes is None else [_towards_even(over @ found.load, over @ slopes, amounts[1])]
        if not found.load.all():
            steps.append(loads.closing(found))
        tried = [_better(loads.of, amounts, step, lambda each: (over @ each.load).max(), last) for step in steps]
        better = [each for each in tried if each is not None]
        if not better:
            break
        amounts, found = min(better, key=lambda each: (over @ each[1].load).max())
    return Proposal(float(amounts[0]), float(amounts[1]), float((over @ found.load).max()) / mean, found.load)


class _Along(NamedTuple):
    """Mean over the mesh cycle: line load (S,), N/mm, of all tooth pairs, and what is left open (S,), mm, where the
    flanks are nearest."""

    load: np.ndarray
    opening: np.ndarray


def _better(
    of: Callable[[np.ndarray], _Along | None],
    amounts: np.ndarray,
    step: np.ndarray,
    value: Callable[[_Along], float],
    last: float,
) -> tuple[np.ndarray, _Along] | None:
    """Amounts on the way of a step whose value is below the last one, and what they make along the face; None if there
    are none."""
    for _ in range(MOST_HALVINGS):
        found = of(amounts + step)
        if found is not None and value(found) < last:
            return amounts + step, found
        step = 0.5 * step
    return None


def _towards_even(values: np.ndarray, slopes: np.ndarray, crowning: float) -> np.ndarray:
    """The step (2,) of the amounts after which the largest of values (k,) that change by slopes (k, 2) is least."""
    # Imported here: few runs look for corrections.
    from scipy.optimize import linprog

    scale = np.abs(slopes).max() / np.abs(values).max()
    table = np.column_stack([slopes / np.abs(slopes).max(), -np.ones(len(values))])
    bounds = [(None, None), (-crowning * scale, None), (None, None)]
    found = linprog([0.0, 0.0, 1.0], A_ub=table, b_ub=-values / np.abs(values).max(), bounds=bounds)
    return found.x[:2] / scale


class _LineLoads:
    """Line loads of a model without friction and inertia, whatever lead modifications its pinion has; `own`: those of
    the scene."""

    def __init__(self, model: Model, cycle: Cycle):
        scene = model.scene
        self._model = at_rest(model, replace(quasi_static(scene), friction=None), cycle.steps)
        # Operators without friction are apart.
        indices = self._model.drivetrain.indices
        self._cycle = Cycle(cycle.mesh, cycle.steps, indices, False) if cycle.tangential else cycle
        self._leads = scene.lead_modifications or LeadModifications()
        self._pinion = self._leads.pinion or LeadModification()
        self.own = np.array([self._pinion.helix_slope, self._pinion.crowning])
        count = min(POSITIONS, cycle.steps)
        self._places = np.unique(np.round(np.arange(1, count + 1) * cycle.steps / count)).astype(float).tolist()

    def of(self, amounts: np.ndarray) -> _Along | None:
        """What a helix slope and a crowning, mm, make along the face; None where a position has no solution."""
        slope, crowning = amounts.tolist()
        pinion = replace(self._pinion, helix_slope=slope, crowning=crowning)
        scene: Scene = replace(self._model.scene, lead_modifications=replace(self._leads, pinion=pinion))
        model = replace(self._model, scene=scene)
        # What differs from one mesh cycle to the next leaves no trace in their mean.
        cycle = self._cycle.with_gaps(replace(gaps_of(model, self._cycle), deviations=()))
        with thread_pools().limit(limits=1):
            solved = BetweenSteps(cycle, model.equations_of_motion, lambda record: True).at(self._places)
        load, opening = np.zeros((2, cycle.face.slices))
        for record in solved.values():
            if record is None:
                return None
            operator, solution = record.position.operator, record.solution
            slices = per_node(operator.pairs, np.array([pair.place.slice for pair in operator.pairs], dtype=int))
            load += np.bincount(slices, solution.forces, minlength=len(load))
            left = np.full(len(load), np.inf)
            np.minimum.at(left, slices, operator.gap - solution.displacement)
            opening += left
        return _Along(load / cycle.face.widths / len(solved), opening / len(solved))

    def slopes(self, amounts: np.ndarray, found: _Along, mean: float) -> np.ndarray | None:
        """Change of the line load (S, 2), N/mm, per mm of each amount, about those whose line load is `found`."""
        step = DIFFERENCE * mean / STIFFNESS
        beside = [self.of(amounts + step * each) for each in np.eye(2)]
        if beside[0] is None or beside[1] is None:
            return None
        slopes = np.stack([each.load - found.load for each in beside], axis=1) / step
        return slopes if slopes.any() else None

    def closing(self, found: _Along) -> np.ndarray:
        """The helix slope, mm, beside no crowning, that closes what is left open."""
        places = self._cycle.face.positions / self._model.pair.face_widths[0]
        slope = np.polyfit(places, found.opening - found.load / STIFFNESS, 1)[0]
        return np.array([-slope, 0.0])
