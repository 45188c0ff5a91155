"""One tooth pair at one position: its contact nodes, their gaps, and their interpolation of both flanks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from numba import njit

from fenics_gears.elasticity.compliance import FlankCompliance
from fenics_gears.geometry.pair import GearPair

from .flank_at_height import points_of_pairs
from .interpolation import INTERPOLATIONS, Averages, FlankInterpolation, Points, Seeing, hats_of
from .window import ContactGrid, coast_roll_angles, contact_roll_angles, ends_of, offsets_of

Removal = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Flanks:
    """The two gears as contact sees them: geometry, compliance, and material removed from either flank.

    `removal`: functions of the roll angle (rad) giving mm along the flank normal, or None for a true involute.
    """

    pair: GearPair
    compliance: tuple[FlankCompliance, FlankCompliance]
    removal: tuple[Removal | None, Removal | None] = (None, None)


DRIVE, COAST = 0, 1
SENSES = (-1.0, 1.0)  # of offsets: towards the pinion's centre, away from the wheel's


@dataclass(frozen=True)
class Line:
    """A line of action: its distances `lever_arms` (mm) from both centres, and `length` (mm) between the feet of the
    centres on it."""

    lever_arms: tuple[float, float]
    length: float


@dataclass(frozen=True)
class Place:
    """Where a pair of flanks stands: `index` of the pinion's tooth, `flank` DRIVE or COAST, `contact_rolls` (rad) of
    either gear.

    Coast flanks are seen in the mirror, the line of centres being the mirror's line: `axes` (2, 2) are the line of
    action's direction and the one across it in space, `turn` the sign of rotations. `line`: another line than the
    theoretical line of action, of a tip edge (`contact.corner`); its direction is in `axes`, and `contact_rolls` are
    measured from it. `slice`, `height` (mm): of the face, and where its middle is along the axes; both 0 in the plane.
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
        return self.line or Line((pair.pinion.base_radius, pair.wheel.base_radius), pair.line_of_action_length)

    @property
    def teeth(self) -> tuple[int, int]:
        """Index of the pinion's and of the wheel's tooth, by the drive pairs they belong to."""
        return self.index, self.index - self.flank

    def ahead(self, gear: int) -> int:
        """Pitches by which the pinion's (0) or the wheel's (1) tooth stands counter-clockwise of that of drive pair
        0."""
        # A later pair index means a tooth ahead on the pinion, and behind on the wheel.
        return self.teeth[gear] if gear == 0 else -self.teeth[gear]


def drive_place(pair: GearPair, index: int, xi: float) -> Place:
    """The drive flanks of tooth pair `index`, with contact at `xi` (mm from T1)."""
    return Place(index, DRIVE, contact_roll_angles(pair, xi))


def coast_place(pair: GearPair, index: int, xi: float) -> Place:
    """The coast flank of the pinion's tooth in pair `index`, whose drive flank touches at `xi` (mm), and the one that
    faces it."""
    cosine, sine = np.cos(2.0 * pair.operating_pressure_angle), np.sin(2.0 * pair.operating_pressure_angle)
    return Place(index, COAST, coast_roll_angles(pair, xi), ((-cosine, -sine), (-sine, cosine)), -1.0)


@dataclass(frozen=True)
class PairNodes:
    """Contact nodes (n,) of the flanks at `place`.

    `offsets` (mm, from the line of action), `lengths` (mm of flank a node stands for), `gap` [9] (mm, positive when
    open), `pinion_lever_arm` and `wheel_lever_arm` (mm, of friction: distance of the point of contact from T1 and T2
    along the line of action), `pinion_roll` (rad).
    """

    place: Place
    offsets: np.ndarray
    lengths: np.ndarray
    gap: np.ndarray
    pinion_lever_arm: np.ndarray
    wheel_lever_arm: np.ndarray
    pinion_roll: np.ndarray


# Contact nodes of the tooth pairs that can touch at each of some phases (0 <= phase < 1).
Nodes = Callable[[Sequence[float]], list[tuple[PairNodes, ...]]]


@dataclass(frozen=True)
class ToothPair(PairNodes):
    """Contact nodes that see the flanks through the `interpolation` of either one."""

    interpolation: tuple[FlankInterpolation, FlankInterpolation]


# Of pinion and wheel.
Both = tuple[np.ndarray, np.ndarray]


def flank_points(
    pair: GearPair, contact_rolls: np.ndarray, lever_arms: np.ndarray, offsets: np.ndarray, ends: np.ndarray
) -> tuple[Both, Both]:
    """Roll angles (rad) and x (mm, of `flank_at_height`), of pinion and wheel, at offsets (n,), mm, from the lines of
    action of many pairs, of each from its place in `ends` (P + 1,) on; contact roll angles (2, P), rad, and lever arms
    (2, P), mm, of these lines."""
    radii = pair.pinion.base_radius, pair.wheel.base_radius
    (rolls_1, x_1), (rolls_2, x_2) = (
        points_of_pairs(radius, sense, rolls, arms, offsets, ends)
        for radius, sense, rolls, arms in zip(radii, SENSES, contact_rolls, lever_arms)
    )
    return (rolls_1, rolls_2), (x_1, x_2)


def apart(pair: GearPair, places: Sequence[Place]) -> np.ndarray:
    """How far (P,), mm along their lines, points that meet stand apart: on coast flanks until the wheel has turned."""
    turned = pair.backlash / pair.wheel.base_radius
    return np.array([turned * place.line_in(pair).lever_arms[1] * (place.flank == COAST) for place in places])


def facing_points(
    pair: GearPair, places: Sequence[Place], offsets: np.ndarray, ends: np.ndarray
) -> tuple[Both, Both, np.ndarray]:
    """Points of involutes that face each other along the line of action at places; nodes as of `flank_points`.

    Their roll angles (rad) and distances from T1, T2 (mm), each of pinion and wheel, and the gap (mm) beyond `apart`.
    """
    contact_rolls = np.ascontiguousarray(np.array([place.contact_rolls for place in places]).reshape(-1, 2).T)
    radii = np.array([[gear.base_radius] * (len(ends) - 1) for gear in (pair.pinion, pair.wheel)])
    rolls, distances = flank_points(pair, contact_rolls, radii, offsets, ends)
    return rolls, distances, pair.line_of_action_length - distances[1] - distances[0]


def facing_points_at(
    pair: GearPair, removal: tuple[Removal | None, Removal | None], place: Place, offsets: np.ndarray
) -> tuple[Both, Both, np.ndarray]:
    """The same at one place, with the whole gap and with material removed from either flank."""
    rolls, distances, gap = facing_points(pair, [place], offsets, np.array([0, len(offsets)]))
    gap = gap + apart(pair, [place])
    for removed, roll in zip(removal, rolls):
        if removed is not None:
            gap = gap + removed(roll)
    return rolls, distances, gap


def tooth_pairs(flanks: Flanks, grid: ContactGrid, places: Sequence[Place]) -> list[ToothPair]:
    """The contact nodes of the flanks at those places whose window is not empty."""
    every = np.array([place.contact_rolls for place in places]).reshape(len(places), 2).T
    offsets, counts = offsets_of(ends_of(flanks.pair, every), grid)
    there = np.flatnonzero(counts)
    if not len(there):
        return []
    places, ends, view = [places[at] for at in there], _ends(counts[there]), INTERPOLATIONS[grid.interpolation]
    at, points = view.places(offsets, ends), view.points(ends)
    rolls, distances, gap = facing_points(flanks.pair, places, at, points)
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
def _not_below(seen, ends, gap, points):
    """Raise what the nodes of each pair see (n,) to the smallest gap there."""
    for pair in range(len(ends) - 1):
        least = min(0.0, gap[points[pair] : points[pair + 1]].min())
        for node in range(ends[pair], ends[pair + 1]):
            seen[node] = max(seen[node], least)


def seen_gap(view: Averages | Points, offsets: np.ndarray, ends: np.ndarray, gap: np.ndarray) -> np.ndarray:
    """Gaps (n,), mm, of contact nodes at `offsets` (n,), mm, of many pairs from `ends` (P + 1,) on, from gaps at the
    points that they see.

    Averages of flanks that are nowhere one inside the other may not say that they are: they would press without load.
    """
    seen = view.seen(offsets, ends, gap).copy()
    _not_below(seen, ends, gap, view.points(ends))
    return seen


def nodes_on_flanks(
    flanks: Flanks,
    grid: ContactGrid,
    places: Sequence[Place],
    nodes: tuple[np.ndarray, np.ndarray],
    difference: np.ndarray,
    gap: np.ndarray,
) -> list[ToothPair]:
    """Contact nodes that see the flanks by the grid's interpolation, at `nodes`: offsets (n,), mm, of one place after
    the other, and where each begins and the last one ends (P + 1,).

    `difference`: of the distances of pinion's and wheel's surface from their foot on the place's line, mm, and `gap`,
    mm, where the interpolation wants them.
    """
    view, (offsets, ends) = INTERPOLATIONS[grid.interpolation], nodes
    rolls, length = rolls_of(flanks.pair, places, nodes), flanks.pair.line_of_action_length
    lengths = np.repeat([length if place.line is None else place.line.length for place in places], np.diff(ends))
    # Flanks that deform to touch meet midway between where they stand undeformed. Friction acts there on both, so that
    # action and reaction leave no torque. Averaged gaps are those of closed flanks.
    meeting = 0.5 * (view.seen(offsets, ends, difference) + lengths)
    gap = seen_gap(view, offsets, ends, gap) + np.repeat(apart(flanks.pair, places), np.diff(ends))
    arrays = offsets, hats_of(offsets, ends), gap, meeting, lengths - meeting, rolls[0]
    parts = [tuple(array[start:end] for array in arrays) for start, end in zip(ends[:-1].tolist(), ends[1:].tolist())]
    seen = interpolations(flanks, grid, places, nodes, rolls)
    return [ToothPair(place, *part, views) for place, part, views in zip(places, parts, seen)]


def _lever_arms(pair: GearPair, places: Sequence[Place]) -> np.ndarray:
    """Lever arms (2, P), mm, of the places' lines of action about the centres of pinion and wheel."""
    radii = pair.pinion.base_radius, pair.wheel.base_radius
    arms = np.array([radii if place.line is None else place.line.lever_arms for place in places])
    return np.ascontiguousarray(arms.T)


def rolls_of(pair: GearPair, places: Sequence[Place], nodes: tuple[np.ndarray, np.ndarray]) -> Both:
    """Roll angles (n,), rad, of contact nodes, as of `nodes_on_flanks`, on pinion and wheel."""
    contact_rolls = np.ascontiguousarray(np.array([place.contact_rolls for place in places]).T)
    return flank_points(pair, contact_rolls, _lever_arms(pair, places), *nodes)[0]


def interpolations(
    flanks: Flanks, grid: ContactGrid, places: Sequence[Place], nodes: tuple[np.ndarray, np.ndarray], rolls: Both
) -> list[tuple[FlankInterpolation, FlankInterpolation]]:
    """How contact nodes, as of `nodes_on_flanks`, see the nodes of either flank at each place; `rolls` (n,), rad: their
    roll angles on pinion and wheel."""
    (offsets, ends), gears, found = nodes, (flanks.pair.pinion, flanks.pair.wheel), []
    apart = np.zeros((2, 1))
    if any(place.line is not None for place in places):
        # Offsets from the line at the gear's own base radius.
        arms = _lever_arms(flanks.pair, places) - np.array([[gear.base_radius] for gear in gears])
        apart = np.repeat(arms, np.diff(ends), axis=1)
    for number, (gear, own, sense, flank) in enumerate(zip(gears, rolls, SENSES, flanks.compliance)):
        seeing = Seeing(
            offsets + sense * apart[number], ends, own,
            np.array([place.contact_rolls[number] for place in places]),
            [flank.rolls_of(place.ahead(number)) for place in places], gear.base_radius, sense, flank.element_order,
        )  # fmt: skip
        found.append(INTERPOLATIONS[grid.interpolation].of_flank(seeing))
    return list(zip(*found))


def node_slices(pairs: Sequence[PairNodes]) -> list[slice]:
    """Where each pair's contact nodes stand among those of all pairs, one pair after the other."""
    ends = list(accumulate((len(pair.offsets) for pair in pairs), initial=0))
    return [slice(start, end) for start, end in zip(ends[:-1], ends[1:])]


def node_ends(pairs: Sequence[PairNodes]) -> np.ndarray:
    """Where each pair's contact nodes begin among those of all pairs, and where the last one's end (P + 1,)."""
    return np.array(list(accumulate((len(pair.offsets) for pair in pairs), initial=0)))


def count_of(pairs: Sequence[PairNodes]) -> int:
    """Number of contact nodes."""
    return sum(len(pair.offsets) for pair in pairs)


def over_nodes(pairs: Sequence[PairNodes], name: str) -> np.ndarray:
    """An array of every pair's contact nodes, one pair after the other."""
    return np.concatenate([getattr(pair, name) for pair in pairs]) if pairs else np.empty(0)


def per_node(pairs: Sequence[PairNodes], values: np.ndarray) -> np.ndarray:
    """A value of each pair (pairs, ...) repeated for its contact nodes (n, ...)."""
    return np.repeat(values, [len(pair.offsets) for pair in pairs], axis=0)
