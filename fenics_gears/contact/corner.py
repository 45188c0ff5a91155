"""Corner contact: a tip's edge on the mate's flank, before and after the theoretical path of contact.

There the tip touches off the line of action, along the mate's own normal. That normal is tangent to the mate's base
circle and passes through the centre of the edge's arc, and so is a line of action of its own: turned by `lean` from the
theoretical one, at the base radius from the mate's centre and at another distance from the tip's. Along it a pair has
contact nodes, gaps and compliance as any other pair, with the tip at the end of its window. Where the edge leaves the
path of contact the two lines coincide: nothing jumps, and no contact is counted twice. The edge between the involute
and the fillet of an undercut gear is one more such edge.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fenics_gears.geometry.involute import flank_point
from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.tip_edge import TipEdge, form_edge, tip_edge

from .flank_at_height import flank_at_height
from .interpolation import INTERPOLATIONS
from .tooth_pair import DRIVE, Flanks, Line, Place, ToothPair, nodes_on_flanks
from .window import ContactGrid, Ends, node_offsets


@dataclass(frozen=True, eq=False)
class CornerContact:
    """The tip edges of both gears, and the edges at their form circles where they are undercut.

    Equal to itself alone, so that caches can have it as a key.
    """

    edges: tuple[TipEdge, TipEdge]
    form_edges: tuple[TipEdge | None, TipEdge | None] = (None, None)

    def edge_beyond(self, place: Place) -> tuple[int, TipEdge] | None:
        """The gear, 0 or 1, of which an edge has left the path of contact at a place, and the edge; None where its
        flanks touch."""
        for gear, edge in enumerate(self.form_edges):
            if edge is not None and place.contact_rolls[gear] < edge.flank_roll:
                return gear, edge
        for gear, edge in enumerate(self.edges):
            if place.contact_rolls[gear] > edge.flank_roll:
                return gear, edge
        return None

    def ends(self, pair: GearPair, place: Place) -> Ends:
        """Offsets (mm) from the place's line where the flanks end, as of `window.flank_ends`; tips at the far end of
        their edge."""
        ends = []
        line = place.line_in(pair)
        for side, edge, roll, arm in zip(pair.sides, self.edges, place.contact_rolls, line.lever_arms):
            tip = edge_position(edge, roll, edge.centre + edge.radius * edge.tip_normal)[1]
            form = flank_point(side.gear.base_radius, side.gear.form_roll_angle, roll)[1]
            # The first gear's tip is below the line, and the second one's above it.
            ends.append((side.sense * (arm - tip), side.sense * (arm - form))[:: side.sense])
        return tuple(zip(*ends))

    def reaches(self, pair: GearPair, grid: ContactGrid, theoretical: Place) -> bool:
        """Whether a pair's flanks may touch: a window that is not empty, and a tip edge at most a window's length
        beyond the path.

        A tip's gap grows with the distance squared, as the gap between flanks does across the window, but slower: half
        a window's length is not always enough.
        """
        beyond = self.edge_beyond(theoretical)
        if beyond is not None:
            gear, edge = beyond
            if abs(theoretical.contact_rolls[gear] - edge.flank_roll) * pair.base_radii[gear] > grid.length:
                return False
        return len(self._touching(pair, grid, theoretical)[1]) > 0

    def _touching(self, pair: GearPair, grid: ContactGrid, theoretical: Place) -> tuple[Place, np.ndarray]:
        """The place along the mate's normal, and offsets (n,), mm, of contact nodes there; none where flanks cannot
        touch.

        The lines of all nodes pass the centres of both gears on the flanks' side. A line beyond a centre, of a tip far
        from the path of contact, would turn that gear away from its mate; the involute has no point there.
        """
        place = corner_place(pair, self, theoretical)
        presses_both = min(place.line_in(pair).lever_arms) > 0.5 * grid.length
        return place, node_offsets(self.ends(pair, place), grid) if presses_both else np.empty(0)

    def pairs(self, flanks: Flanks, grid: ContactGrid, theoretical: Sequence[Place]) -> list[ToothPair]:
        """The contact nodes of the flanks at those theoretical places, tip edges included, whose window is not
        empty."""
        view = INTERPOLATIONS[grid.interpolation]
        nodes = []
        for place, offsets in (self._touching(flanks.pair, grid, each) for each in theoretical):
            if len(offsets):
                at = view.places(offsets, np.array([0, len(offsets)]))
                nodes.append((place, offsets, *_difference_and_gap(flanks, self, place, at)))
        if not nodes:
            return []
        places, offsets, difference, gap = zip(*nodes)
        at = np.concatenate(offsets), np.cumsum([0, *map(len, offsets)])
        return nodes_on_flanks(flanks, grid, list(places), at, np.concatenate(difference), np.concatenate(gap))

    def warnings(self, pair: GearPair) -> list[str]:
        """A warning where the edges leave the flanks less than one base pitch of the path of contact, so that at times
        only edges carry."""
        end, start = (side.position(edge.flank_roll) for side, edge in zip(pair.sides, self.edges))
        ratio = (min(end, pair.path_end) - max(start, pair.path_start)) / pair.base_pitch
        if ratio >= 1.0:
            return []
        return [
            f"the rounded edges of corner_contact leave the flanks a contact ratio of {ratio:.3g}: at some positions"
            " only the tips' edges touch; lower corner_contact.edge_radius, or see that accuracy.contact_length reaches"
            " to the next pair"
        ]


def corner_contact(pair: GearPair, edge_radius: float | tuple[float, float] = 0.0) -> CornerContact:
    """Corner contact of a pair whose tips have edges of `edge_radius` (mm, one or pinion's and wheel's; 0: sharp).

    Raises GeometryError for a radius that does not fit the tip.
    """
    radii = edge_radius if isinstance(edge_radius, tuple) else (edge_radius, edge_radius)
    gears = [side.gear for side in pair.sides]
    tips = tuple(tip_edge(gear, radius) for gear, radius in zip(gears, radii))
    return CornerContact(tips, tuple(form_edge(gear) if gear.undercut else None for gear in gears))


def corner_place(pair: GearPair, corner: CornerContact, place: Place) -> Place:
    """The place of a pair along the mate's normal where a tip edge is beyond the path of contact; else unchanged."""
    beyond = corner.edge_beyond(place)
    if beyond is None:
        return place
    tip, edge = beyond
    arms = list(pair.base_radii)
    own = arms[1 - tip]
    from_tip, above_tip = edge_position(edge, place.contact_rolls[tip])
    # The same point from the mate's tangent point and centre.
    x = pair.line_of_action_length - from_tip
    height = sum(arms) - above_tip
    tangent = np.sqrt(x**2 + height**2 - own**2)
    lean = np.arctan2(x, height) - np.arctan2(tangent, own)
    cosine = np.cos(lean)
    sine = np.sin(lean)
    length = pair.line_of_action_length * cosine - sum(arms) * sine
    arms[tip] = pair.line_of_action_length * sine + sum(arms) * cosine - own
    line = Line(tuple(arms), length)
    return replace(
        place,
        contact_rolls=tuple(float(roll - lean) for roll in place.contact_rolls),
        axes=_turned(place.axes, cosine, sine),
        line=line,
    )


def _turned(axes, cosine: float, sine: float):
    along, across = np.array(axes)
    return tuple(
        tuple(float(v) for v in axis) for axis in (cosine * along + sine * across, cosine * across - sine * along)
    )


def edge_position(edge: TipEdge, contact_roll: float, point: np.ndarray | None = None) -> tuple[float, float]:
    """Position (x, h), mm as in flank_point, of the arc's centre, or of another `point` (2,) of the tooth's body
    frame."""
    x, y = edge.centre if point is None else point
    cosine = np.cos(contact_roll)
    sine = np.sin(contact_roll)
    return float(cosine * x - sine * y), float(-(sine * x + cosine * y))


def _difference_and_gap(
    flanks: Flanks, corner: CornerContact, place: Place, offsets: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Of the distances of both surfaces from their feet on the place's line at offsets (n,), mm, the difference (n,),
    and the gap (n,) that they leave, mm."""
    line = place.line_in(flanks.pair)
    removals = flanks.removal if place.flank == DRIVE else (None, None)
    each = zip(flanks.pair.sides, corner.edges, place.contact_rolls, line.lever_arms, removals)
    first, second = (
        _surface(side.gear, edge, roll, arm - side.sense * offsets, removal) for side, edge, roll, arm, removal in each
    )
    return first - second, line.length - first - second


def _surface(gear, edge: TipEdge, contact_roll: float, height: np.ndarray, removal) -> np.ndarray:
    """Distance (mm, shape of `height`) from the line's foot to a tooth's surface at heights (mm): involute, then the
    edge's arc."""
    roll, x = flank_at_height(gear.base_radius, contact_roll, height)
    if edge.radius > 0.0:
        centre_x, centre_height = edge_position(edge, contact_roll)
        arc = centre_x + np.sqrt(np.maximum(edge.radius**2 - (height - centre_height) ** 2, 0.0))
        x = np.where(roll > edge.flank_roll, arc, x)
    return x if removal is None else x - removal(roll)
