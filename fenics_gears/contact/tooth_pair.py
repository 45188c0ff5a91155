"""One tooth pair at one position: its contact nodes, their gaps, and their interpolation of both flanks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from numba import njit

from fenics_gears.elasticity.compliance import FlankBody
from fenics_gears.geometry.pair import GearPair

from .flank_at_height import points_of_pairs
from .interpolation import INTERPOLATIONS, Averages, FlankInterpolation, GearContacts, Points, hats_of
from .window import ContactGrid, coast_roll_angles, contact_roll_angles, ends_of, offsets_of

Removal = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Flanks:
    """The flanks of a pair: geometry of the gears, and of either gear its compliance and the material removed.

    `removal`: functions of the roll angle (rad) that give mm along the flank normal, or None for a true involute.
    """

    pair: GearPair
    compliance: tuple[FlankBody, FlankBody]
    removal: tuple[Removal | None, Removal | None] = (None, None)


DRIVE = 0
COAST = 1


@dataclass(frozen=True)
class Line:
    """A line of action: its distances `lever_arms` (mm) from both centres, and `length` (mm) between the feet of the
    centres on it."""

    lever_arms: tuple[float, float]
    length: float


@dataclass(frozen=True)
class Place:
    """The place of a pair of flanks: its `index`, `flank` DRIVE or COAST, `contact_rolls` (rad) of either gear.

    Coast flanks are described in the mirror, the line of centres being the mirror's line. `axes` (2, 2) are the
    directions in space of the line of action and across it, `turn` is the sign of rotations. `line`: another line than
    the theoretical line of action, of a tip edge (`contact.corner`); its direction is in `axes`, and `contact_rolls`
    are measured from it. `slice`, `height` (mm): of the face, and where its middle is along the axes; both 0 in the
    plane.
    """

    index: int
    flank: int
    contact_rolls: tuple[float, float]
    axes: tuple[tuple[float, float], tuple[float, float]] = ((1.0, 0.0), (0.0, 1.0))
    turn: float = 1.0
    line: Line | None = None
    slice: int = 0
    height: float = 0.0

    def line_in(self, pair: GearPair) -> Line:
        """The line of action of the flanks: the theoretical one but for tip edges."""
        return self.line or Line(pair.base_radii, pair.line_of_action_length)

    @property
    def teeth(self) -> tuple[int, int]:
        """Pitches by which the tooth of either gear is counter-clockwise of that of drive pair 0."""
        # A later pair has a tooth ahead on the pinion, and behind on the wheel.
        return self.index, self.flank - self.index


def drive_place(pair: GearPair, index: int, xi: float) -> Place:
    """The drive flanks of tooth pair `index`, with contact at `xi` (mm from T1)."""
    return Place(index, DRIVE, contact_roll_angles(pair, xi))


def coast_place(pair: GearPair, index: int, xi: float) -> Place:
    """The coast flank of the pinion's tooth in pair `index`, whose drive flank touches at `xi` (mm), and the one that
    faces it."""
    double = 2.0 * pair.operating_pressure_angle
    cosine = np.cos(double)
    sine = np.sin(double)
    return Place(index, COAST, coast_roll_angles(pair, xi), ((-cosine, -sine), (-sine, cosine)), -1.0)


@dataclass(frozen=True)
class PairNodes:
    """Contact nodes (n,) of the flanks at `place`.

    `offsets` (mm, from the line of action), `lengths` (mm of flank of a node), `gap` [9] (mm, positive when
    open). Of both gears: `rolls` (2, n), roll angles, rad, and `friction_arms` (2, n), mm, lever arms of friction:
    distances of the point of contact from T1 and T2 along the line of action.
    """

    place: Place
    offsets: np.ndarray
    lengths: np.ndarray
    gap: np.ndarray
    friction_arms: np.ndarray
    rolls: np.ndarray


# Contact nodes of the tooth pairs that can touch at each of some phases (0 <= phase < 1).
Nodes = Callable[[Sequence[float]], list[tuple[PairNodes, ...]]]


@dataclass(frozen=True)
class ToothPair(PairNodes):
    """Contact nodes with the `interpolation` of either flank there."""

    interpolation: tuple[FlankInterpolation, FlankInterpolation]


def flank_points(
    pair: GearPair, contact_rolls: np.ndarray, lever_arms: np.ndarray, offsets: np.ndarray, ends: np.ndarray
) -> np.ndarray:
    """Roll angles (rad) and x (mm, of `flank_at_height`) of points of both flanks, (2, 2 gears, n).

    They are at offsets (n,), mm, from the lines of action of many pairs, from the place in `ends` (P + 1,) on those
    of each. These lines have contact roll angles (2, P), rad, and lever arms (2, P), mm.
    """
    lines = zip(pair.sides, contact_rolls, lever_arms)
    both = [points_of_pairs(side.gear.base_radius, side.sense, *line, offsets, ends) for side, *line in lines]
    return np.array(both).swapaxes(0, 1)


def contact_rolls_of(places: Sequence[Place]) -> np.ndarray:
    """Contact roll angles (2, P), rad, of both gears at places."""
    return np.ascontiguousarray(np.array([place.contact_rolls for place in places]).reshape(-1, 2).T)


def apart(pair: GearPair, places: Sequence[Place]) -> np.ndarray:
    """How far (P,), mm along their lines, points that meet are apart: on coast flanks until the wheel has turned."""
    turned = pair.backlash / pair.base_radii[1]
    return np.array([turned * place.line_in(pair).lever_arms[1] * (place.flank == COAST) for place in places])


def facing_points(
    pair: GearPair, places: Sequence[Place], offsets: np.ndarray, ends: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points of involutes that face each other along the line of action at places; nodes as of `flank_points`.

    Their roll angles (2, n), rad, and distances from T1 and T2 (2, n), mm, and the gap (n,), mm, beyond `apart`.
    """
    radii = np.array(pair.base_radii)[:, None].repeat(len(places), axis=1)
    rolls, distances = flank_points(pair, contact_rolls_of(places), radii, offsets, ends)
    return rolls, distances, pair.line_of_action_length - distances[1] - distances[0]


def facing_points_at(
    pair: GearPair, removal: tuple[Removal | None, Removal | None], place: Place, offsets: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The same at one place, with the whole gap and with material removed from either flank."""
    rolls, distances, gap = facing_points(pair, [place], offsets, np.array([0, len(offsets)]))
    gap = gap + apart(pair, [place])
    for removed, roll in zip(removal, rolls):
        if removed is not None:
            gap = gap + removed(roll)
    return rolls, distances, gap


def tooth_pairs(flanks: Flanks, grid: ContactGrid, places: Sequence[Place]) -> list[ToothPair]:
    """The contact nodes of the flanks at those places whose window is not empty."""
    offsets, counts = offsets_of(ends_of(flanks.pair, contact_rolls_of(places)), grid)
    there = np.flatnonzero(counts)
    if not len(there):
        return []
    places = [places[at] for at in there]
    ends = _ends(counts[there])
    view = INTERPOLATIONS[grid.interpolation]
    points = view.points(ends)
    rolls, distances, gap = facing_points(flanks.pair, places, view.places(offsets, ends), points)
    if flanks.removal != (None, None):
        drive = np.repeat([place.flank == DRIVE for place in places], np.diff(points))
        for removed, roll in zip(flanks.removal, rolls):
            if removed is not None:
                gap[drive] += removed(roll[drive])
    return nodes_on_flanks(flanks, grid, places, (offsets, ends), distances[0] - distances[1], gap)


def _ends(counts: np.ndarray) -> np.ndarray:
    """Where groups of so many (P,) begin, one after the other, and the last one ends (P + 1,)."""
    return np.array([0, *accumulate(counts.tolist())])


@njit(cache=True)
def _not_below(nodal, ends, gap, points):
    """Raise the values of the nodes of each pair (n,) to the smallest gap there."""
    for pair in range(len(ends) - 1):
        least = min(0.0, gap[points[pair] : points[pair + 1]].min())
        for node in range(ends[pair], ends[pair + 1]):
            nodal[node] = max(nodal[node], least)


def nodal_gap(view: Averages | Points, offsets: np.ndarray, ends: np.ndarray, gap: np.ndarray) -> np.ndarray:
    """Gaps (n,), mm, of contact nodes at `offsets` (n,), mm, of many pairs from `ends` (P + 1,) on, from gaps at the
    places of their interpolation.

    Averages of flanks that are nowhere one inside the other may not say that they are: they would press without load.
    """
    nodal = view.at_nodes(offsets, ends, gap).copy()
    _not_below(nodal, ends, gap, view.points(ends))
    return nodal


def nodes_on_flanks(
    flanks: Flanks,
    grid: ContactGrid,
    places: Sequence[Place],
    nodes: tuple[np.ndarray, np.ndarray],
    difference: np.ndarray,
    gap: np.ndarray,
) -> list[ToothPair]:
    """Contact nodes with the grid's interpolation, at `nodes`: offsets (n,), mm, of one place after the other, and
    where each begins and the last one ends (P + 1,).

    `difference`, mm: of the distances of both surfaces from their feet on the place's line, and `gap`, mm, at the
    places of the interpolation.
    """
    offsets, ends = nodes
    view = INTERPOLATIONS[grid.interpolation]
    rolls = rolls_of(flanks.pair, places, nodes)
    lengths = np.repeat([place.line_in(flanks.pair).length for place in places], np.diff(ends))
    # Flanks that deform to touch meet midway between their places undeformed. Friction acts there on both, so that
    # action and reaction leave no torque. Averaged gaps are those of closed flanks.
    meeting = 0.5 * (view.at_nodes(offsets, ends, difference) + lengths)
    gap = nodal_gap(view, offsets, ends, gap) + np.repeat(apart(flanks.pair, places), np.diff(ends))
    arrays = offsets, hats_of(offsets, ends), gap, np.stack([meeting, lengths - meeting]), rolls
    each = interpolations(flanks, grid, places, nodes, rolls)
    parts = zip(places, ends[:-1].tolist(), ends[1:].tolist(), each)
    return [ToothPair(place, *[array[..., start:end] for array in arrays], own) for place, start, end, own in parts]


def _lever_arms(pair: GearPair, places: Sequence[Place]) -> np.ndarray:
    """Lever arms (2, P), mm, of the places' lines of action about the centres of both gears."""
    arms = np.array([pair.base_radii if place.line is None else place.line.lever_arms for place in places])
    return np.ascontiguousarray(arms.T)


def rolls_of(pair: GearPair, places: Sequence[Place], nodes: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Roll angles (2, n), rad, of contact nodes, as of `nodes_on_flanks`, on both gears."""
    return flank_points(pair, contact_rolls_of(places), _lever_arms(pair, places), *nodes)[0]


def interpolations(
    flanks: Flanks, grid: ContactGrid, places: Sequence[Place], nodes: tuple[np.ndarray, np.ndarray], rolls: np.ndarray
) -> list[tuple[FlankInterpolation, FlankInterpolation]]:
    """Interpolation of either flank at contact nodes, as of `nodes_on_flanks`, of each place; `rolls` (2, n), rad:
    their roll angles."""
    offsets, ends = nodes
    of_gears = []
    of_sides = flanks.pair.sides, rolls, contact_rolls_of(places), _lever_arms(flanks.pair, places), flanks.compliance
    for side, own, contact, arms, flank in zip(*of_sides):
        # Offsets from the line at the gear's own base radius.
        own_offsets = offsets - side.sense * np.repeat(arms - side.gear.base_radius, np.diff(ends))
        teeth = [flank.rolls_of(place.teeth[side.number]) for place in places]
        on_flank = GearContacts(
            own_offsets, ends, own, contact, teeth, side.gear.base_radius, side.sense, flank.element_order
        )
        of_gears.append(INTERPOLATIONS[grid.interpolation].of_flank(on_flank))
    return list(zip(*of_gears))


def node_slices(pairs: Sequence[PairNodes]) -> list[slice]:
    """Slice of each pair's contact nodes among those of all pairs, one pair after the other."""
    ends = list(accumulate((len(pair.offsets) for pair in pairs), initial=0))
    return [slice(start, end) for start, end in zip(ends[:-1], ends[1:])]


def node_ends(pairs: Sequence[PairNodes]) -> np.ndarray:
    """Where each pair's contact nodes begin among those of all pairs, and where the last one's end (P + 1,)."""
    return np.array(list(accumulate((len(pair.offsets) for pair in pairs), initial=0)))


def count_of(pairs: Sequence[PairNodes]) -> int:
    """Number of contact nodes."""
    return sum(len(pair.offsets) for pair in pairs)


def over_nodes(pairs: Sequence[PairNodes], name: str) -> np.ndarray:
    """An array (n,), or (2, n) over both gears, of every pair's contact nodes, one pair after the other."""
    return np.concatenate([getattr(pair, name) for pair in pairs], axis=-1) if pairs else np.empty(0)


def per_node(pairs: Sequence[PairNodes], values: np.ndarray) -> np.ndarray:
    """A value of each pair (pairs, ...) repeated for its contact nodes (n, ...)."""
    return np.repeat(values, [len(pair.offsets) for pair in pairs], axis=0)
