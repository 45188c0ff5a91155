"""Lead modifications that make the line load along the face as even as two numbers can. They are the helix slope and
crowning of the pinion that give the mesh its least face load factor.

Static positions of a mesh cycle are solved by the run's contact operators with other gaps, without friction; everything
else that opens the flanks along the face counts as in the run. While the closed nodes stay closed, line load w (S,) is
linear in amounts a = (slope, crowning). The face load factor is the largest of W w over m w, means over windows of the
inner face and over all of it (`results.face_ends`). It falls below its last value k where a linear program finds t < 0:

    minimise t  with  (W - k m) (w + dw/da d) <= t,  crowning + d_2 >= 0

whose step d is halved until the factor falls, and which is repeated until it falls no more. Where a part of the face
does not touch, a helix slope first takes off what is left open there and what the rest approaches by. No step may press
the load out of the inner face, nor take off more than the flanks approach unevenly without it.

A march of one mesh cycle with the amounts, and with the friction of the scene, then has the factor that is told.
Without one that is lower than the run's nothing is proposed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.tooth_pair import DRIVE, per_node
from fenics_gears.dynamics.batch import Batch
from fenics_gears.dynamics.march import Marcher, thread_pools
from fenics_gears.dynamics.marched import BetweenSteps
from fenics_gears.dynamics.steps import Record
from fenics_gears.errors import attempted
from fenics_gears.geometry.lead_modification import LeadModification, LeadModifications
from fenics_gears.model.model import Model
from fenics_gears.results.dataset import RunResult
from fenics_gears.results.face_ends import inner_widths, windows
from fenics_gears.results.load_factors import face_load_factor, mean_line_load
from fenics_gears.results.recorder import Recorder
from fenics_gears.scene.data import Scene
from fenics_gears.system.progress import Progress

from .dynamic_factor import at_rest, quasi_static
from .elastic_route import gaps_apart, gaps_of

# Positions of the mesh cycle, about.
POSITIONS = 16
# Steps of the search, halvings of one, and the change of the face load factor below which a gain is none.
MOST_STEPS = 8
MOST_HALVINGS = 5
GAIN = 1e-3
# The part of an even load's share that the inner face keeps, and the largest part of what the flanks approach unevenly,
# which is estimated by the stiffness below, that is taken off.
EVEN = 0.95
MOST_TAKEN = 1.5
# Difference for derivatives, over the mean approach of the flanks, estimated by a mesh stiffness, N/mm per mm of face.
DIFFERENCE = 0.05
STIFFNESS = 14e3
MICROMETRE = 1e-3
# Of amounts, mm.
DECIMALS = 4


class Proposal(NamedTuple):
    """Lead modifications of the pinion, mm over its own face, in place of its own; the face load factor and the line
    load (S,), N/mm, of all tooth pairs together, mean over a mesh cycle that was run with them."""

    helix_slope: float
    crowning: float
    face_load_factor: float
    line_load: np.ndarray


def wanted(model: Model) -> bool:
    """Whether something tilts the flanks of a scene against each other, under a load on the drive flanks."""
    scene = model.scene
    if not scene.three_dimensional or not gaps_apart(model) or scene.load.wheel_torque <= 0.0:
        return False
    webs = [gear.web for gear in model.pair.gears]
    bearings = scene.bearings
    leaning = scene.misalignment
    return (
        any(web is not None and web.offset for web in webs)
        or (bearings is not None and (bearings.places is not None or bearings.each is not None))
        or (leaning is not None and bool(leaning.in_plane))
    )


def add_proposal(dataset: xr.Dataset, recorder: Recorder, progress: Progress) -> None:
    """Add the proposal for a run to its dataset, where one is wanted and there is one."""
    if wanted(recorder.model):
        progress.stage("propose lead modifications")
        attempted(dataset.attrs, "proposal of lead modifications", lambda: _add(dataset, proposed(recorder)))


def _add(dataset: xr.Dataset, proposal: Proposal | None) -> None:
    if proposal is None:
        return
    for name in ("helix_slope", "crowning"):
        dataset.attrs[f"proposed_{name}"] = getattr(proposal, name) / MICROMETRE
    dataset.attrs["proposed_face_load_factor"] = proposal.face_load_factor
    words = "line load of all tooth pairs, mean over the mesh cycle, with the proposed lead modifications"
    dataset["proposed_line_load"] = "face_position", proposal.line_load, {"units": "N/mm", "long_name": words}


def proposed(recorder: Recorder) -> Proposal | None:
    """The proposal for a run; None where a position has no solution without friction and inertia, or where no amounts
    are confirmed."""
    loads = _LineLoads(recorder.model, recorder.cycle, recorder.along_face[0].coordinates())
    amounts = loads.own
    along = first = loads.of(amounts)
    if first is None or along is None:
        return None
    last = np.inf
    for _ in range(MOST_STEPS):
        if last - along.factor < GAIN:
            break
        last = along.factor
        steps = [step for step in (loads.towards_even(amounts, along), loads.closing(along)) if step is not None]
        tried = [_better(loads, amounts, step, last, first) for step in steps]
        better = [each for each in tried if each is not None]
        if not better:
            break
        amounts, along = min(better, key=lambda each: each[1].factor)
    # As they are printed; a tenth of a micrometre is less than any flank is ground to.
    amounts = np.round(amounts, DECIMALS) + 0.0
    if first.factor - along.factor < GAIN or np.abs(amounts - loads.own).max() < 10.0**-DECIMALS:
        return None
    return loads.confirmed(amounts, first.factor)


class _Along(NamedTuple):
    """Means over the mesh cycle: the line load (S,), N/mm, of all tooth pairs, and the gap (S,), mm, where the flanks
    are nearest. Then the face load factor, infinite where the ends of the face alone carry, and the share of the load
    between them."""

    load: np.ndarray
    opening: np.ndarray
    factor: float
    inner: float

    @property
    def uneven(self) -> float:
        """By how much the flanks approach more in one slice than in another, about, mm: all that can be taken off."""
        return float(np.ptp(self.load / STIFFNESS - self.opening))


def _better(
    loads: _LineLoads, amounts: np.ndarray, step: np.ndarray, last: float, first: _Along
) -> tuple[np.ndarray, _Along] | None:
    """Amounts on the way of a step whose factor is below the last one, and what they make along the face; None if there
    are none. They take off no more than the flanks approach unevenly at `first`, with the scene's own, and press no
    load out of the inner face."""
    inner = min(first.inner, EVEN * loads.inner_share)
    for _ in range(MOST_HALVINGS):
        if loads.taken_off(amounts + step) <= MOST_TAKEN * first.uneven:
            along = loads.of(amounts + step)
            if along is not None and along.factor < last and along.inner >= inner:
                return amounts + step, along
        step = 0.5 * step
    return None


def _towards_even(values: np.ndarray, slopes: np.ndarray, crowning: float) -> np.ndarray | None:
    """The step (2,) of the amounts after which the largest of values (k,) that change by slopes (k, 2) is least; None
    where they do not change, or where there is no least one."""
    # Imported here: few runs look for corrections.
    from scipy.optimize import linprog

    steepest = np.abs(slopes).max(initial=0.0)
    largest = np.abs(values).max(initial=0.0)
    if not (0.0 < steepest < np.inf and 0.0 < largest < np.inf):
        return None
    scale = steepest / largest
    table = np.column_stack([slopes / steepest, -np.ones(len(values))])
    bounds = [(None, None), (-crowning * scale, None), (None, None)]
    minimum = linprog([0.0, 0.0, 1.0], A_ub=table, b_ub=-values / largest, bounds=bounds)
    return minimum.x[:2] / scale if minimum.success else None


class _LineLoads:
    """Line loads of a model without friction and inertia, whatever lead modifications its pinion has; `own`: those of
    the scene."""

    def __init__(self, model: Model, cycle: Cycle, along: Mapping[str, Any]):
        scene = model.scene
        self._face = xr.Dataset(coords=along)
        self._run = (model, cycle)
        self._windows = windows(self._face, model.pair)
        widths = inner_widths(self._face, model.pair)
        self._inner = widths / widths.sum()
        # Of an even load.
        self.inner_share = float(widths.sum() / cycle.face.widths.sum())
        self._model = at_rest(model, replace(quasi_static(scene), friction=None), cycle.steps)
        # Operators without friction are apart.
        indices = self._model.drivetrain.indices
        self._cycle = cycle.frictionless(indices) if cycle.tangential else cycle
        self._leads = scene.lead_modifications or LeadModifications()
        self._pinion = self._leads.pinion or LeadModification()
        self.own = np.array([self._pinion.helix_slope, self._pinion.crowning])
        count = min(POSITIONS, cycle.steps)
        self._places = np.unique(np.round(np.arange(1, count + 1) * cycle.steps / count)).astype(float).tolist()

    def of(self, amounts: np.ndarray) -> _Along | None:
        """What a helix slope and a crowning, mm, make along the face; None where a position has no solution, or coast
        flanks press."""
        model = replace(self._model, scene=self._with(self._model.scene, amounts))
        # What differs from one mesh cycle to the next leaves no trace in their mean.
        cycle = self._cycle.with_gaps(replace(gaps_of(model, self._cycle), deviations=()))
        with thread_pools().limit(limits=1):
            between = BetweenSteps(Batch(cycle, [model.equations_of_motion]))
            solved = between.at([(0, place) for place in self._places])
        load, opening = np.zeros((2, cycle.face.slices))
        for record in solved.values():
            of_position = None if record is None else _of_position(record, len(load))
            if of_position is None:
                return None
            load += of_position[0]
            opening += of_position[1]
        load /= cycle.face.widths * len(solved)
        force = float(load @ cycle.face.widths)
        inner = float(load @ self._inner) * self.inner_share * cycle.face.widths.sum()
        factor = face_load_factor(load, self._face, self._model.pair)
        factor = np.inf if factor is None else factor
        return _Along(load, opening / len(solved), factor, inner / force if force > 0.0 else 0.0)

    def _with(self, scene: Scene, amounts: np.ndarray) -> Scene:
        slope, crowning = amounts.tolist()
        pinion = replace(self._pinion, helix_slope=slope, crowning=crowning)
        return replace(scene, lead_modifications=replace(self._leads, pinion=pinion))

    def confirmed(self, amounts: np.ndarray, least: float) -> Proposal | None:
        """The amounts with what a march of one mesh cycle makes of them, without inertia, with the friction of the
        scene; None where it has no solution or its face load factor is not below `least`."""
        model, cycle = self._run
        scene = self._with(quasi_static(model.scene), amounts)
        motion = replace(scene.motion, mesh_cycles=1, recorded_cycles=1)
        fields = replace(scene.output, contact_fields=True, root_stress=False)
        still = at_rest(model, replace(scene, motion=motion, output=fields), cycle.steps)
        own = cycle.with_gaps(replace(gaps_of(still, cycle), deviations=()))
        recorder = Recorder(still, own)
        try:
            march = Marcher(own, still.equations_of_motion).run(still.steps, 1, observe=recorder.take)
        except ContactNotConverged:
            return None
        if march.interrupted:
            return None
        recorder.finish()
        load = mean_line_load(RunResult(recorder, march).dataset, "")
        factor = None if load is None else face_load_factor(load, self._face, model.pair)
        if load is None or factor is None or factor >= least:
            return None
        return Proposal(float(amounts[0]), float(amounts[1]), factor, load)

    def taken_off(self, amounts: np.ndarray) -> float:
        """By how much more two amounts take off the pinion at one place of the common face than at another, mm, beyond
        the scene's own."""
        slope, crowning = amounts - self.own
        places = np.linspace(*self._model.pair.common_face, 21) / self._model.pair.face_widths[0]
        return float(np.ptp(slope * places + 4.0 * crowning * places**2))

    def towards_even(self, amounts: np.ndarray, along: _Along) -> np.ndarray | None:
        """The step of the amounts that makes the load even if it stays linear in them; None where there is none."""
        if not np.isfinite(along.factor):
            return None
        step = DIFFERENCE * float(along.load.mean()) / STIFFNESS
        varied = [self.of(amounts + step * each) for each in np.eye(2)]
        if varied[0] is None or varied[1] is None:
            return None
        slopes = np.stack([each.load - along.load for each in varied if each is not None], axis=1) / step
        over = self._windows - along.factor * self._inner
        return _towards_even(over @ along.load, over @ slopes, amounts[1])

    def closing(self, along: _Along) -> np.ndarray | None:
        """The helix slope, mm, beside no crowning, that closes what is left open; None where all the face touches."""
        if along.load.all():
            return None
        places = self._cycle.face.positions / self._model.pair.face_widths[0]
        slope = np.polyfit(places, along.opening - along.load / STIFFNESS, 1)[0]
        return np.array([-slope, 0.0])


def _of_position(record: Record, slices: int) -> tuple[np.ndarray, np.ndarray] | None:
    """Force (S,), N, and what is left open (S,), mm, at a position; None where coast flanks press."""
    operator = record.position.operator
    solution = record.solution
    places = np.array([(pair.place.slice, pair.place.flank) for pair in operator.pairs], dtype=int)
    number, flank = per_node(operator.pairs, places.reshape(-1, 2)).T
    drive = flank == DRIVE
    if (solution.forces[~drive] > NO_FORCE).any():
        return None
    left = np.full(slices, np.inf)
    np.minimum.at(left, number[drive], (operator.gap - solution.displacement)[drive])
    return np.bincount(number[drive], solution.forces[drive], minlength=slices), left
