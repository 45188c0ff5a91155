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
from .tooth_pair import DRIVE, SENSES, Flanks, Line, Place, ToothPair, nodes_on_flanks
from .window import ContactGrid, Ends, node_offsets, window


@dataclass(frozen=True, eq=False)
class CornerContact:
    """The tip edges of pinion and wheel, and those at their form circles where they are undercut; equal to itself
    alone, so that what depends on it can be kept by it."""

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


def corner_contact(pair: GearPair, edge_radius: float | tuple[float, float] = 0.0) -> CornerContact:
    """Corner contact of a pair whose tips have edges of `edge_radius` (mm, one or pinion's and wheel's; 0: sharp).

    Raises GeometryError for a radius that does not fit the tip.
    """
    radii = edge_radius if isinstance(edge_radius, tuple) else (edge_radius, edge_radius)
    gears = pair.pinion, pair.wheel
    first, second = (tip_edge(gear, radius) for gear, radius in zip(gears, radii))
    form_1, form_2 = (form_edge(gear) if gear.undercut else None for gear in gears)
    return CornerContact((first, second), (form_1, form_2))


def edge_warnings(pair: GearPair, corner: CornerContact) -> list[str]:
    """A warning where the edges leave the flanks less than one base pitch of the path of contact, so that at times only
    edges carry."""
    pinion, wheel = corner.edges
    start = max(pair.line_of_action_length - pair.wheel.base_radius * wheel.flank_roll, pair.path_start)
    ratio = (min(pair.pinion.base_radius * pinion.flank_roll, pair.path_end) - start) / pair.base_pitch
    if ratio >= 1.0:
        return []
    return [
        f"the rounded edges of corner_contact leave the flanks a contact ratio of {ratio:.3g}: at some positions only"
        " the tips' edges touch; lower corner_contact.edge_radius, or see that accuracy.contact_length reaches to the"
        " next pair"
    ]


def corner_place(pair: GearPair, corner: CornerContact, place: Place) -> Place:
    """The place of a pair along the mate's normal where a tip edge is beyond the path of contact; else unchanged."""
    beyond = corner.edge_beyond(place)
    if beyond is None:
        return place
    (tip, edge), radii = beyond, (pair.pinion.base_radius, pair.wheel.base_radius)
    mate = 1 - tip
    x, height = edge_position(edge, place.contact_rolls[tip])
    # The same point from the mate's tangent point and centre.
    x, height = pair.line_of_action_length - x, sum(radii) - height
    tangent = np.sqrt(x**2 + height**2 - radii[mate] ** 2)
    lean = np.arctan2(x, height) - np.arctan2(tangent, radii[mate])
    cosine, sine = np.cos(lean), np.sin(lean)
    across = pair.line_of_action_length * sine + sum(radii) * cosine
    arms = (across - radii[1], radii[1]) if tip == 0 else (radii[0], across - radii[0])
    line = Line(arms, pair.line_of_action_length * cosine - sum(radii) * sine)
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
    cosine, sine = np.cos(contact_roll), np.sin(contact_roll)
    return float(cosine * x - sine * y), float(-(sine * x + cosine * y))


def corner_pairs(
    flanks: Flanks, grid: ContactGrid, corner: CornerContact, theoretical: Sequence[Place]
) -> list[ToothPair]:
    """The contact nodes of the flanks at those theoretical places, tip edges included, whose window is not empty."""
    pair, view, found = flanks.pair, INTERPOLATIONS[grid.interpolation], []
    for place in (corner_place(pair, corner, each) for each in theoretical):
        offsets = node_offsets(edge_ends(pair, corner, place), grid)
        if len(offsets):
            at = view.places(offsets, np.array([0, len(offsets)]))
            found.append((place, offsets, *_distances(flanks, corner, place, at)))
    if not found:
        return []
    places, counts = [place for place, *_ in found], [len(offsets) for _, offsets, *_ in found]
    offsets, x_1, x_2, lengths = (np.concatenate([each[at] for each in found]) for at in range(1, 5))
    nodes = offsets, np.cumsum([0, *counts])
    return nodes_on_flanks(flanks, grid, places, nodes, x_1 - x_2, lengths - x_1 - x_2)


def _distances(flanks: Flanks, corner: CornerContact, place: Place, offsets: np.ndarray) -> tuple[np.ndarray, ...]:
    """Distances (mm) of pinion's and wheel's surface from their foot on the place's line at offsets (n,), mm, and the
    line's length (n,), mm."""
    line, removals = place.line_in(flanks.pair), flanks.removal if place.flank == DRIVE else (None, None)
    gears = flanks.pair.pinion, flanks.pair.wheel
    x_1, x_2 = (
        _surface(gear, edge, roll, arm + sense * offsets, removal)
        for gear, edge, roll, arm, sense, removal in zip(
            gears, corner.edges, place.contact_rolls, line.lever_arms, SENSES, removals
        )
    )
    return x_1, x_2, np.full(len(offsets), line.length)


def edge_ends(pair: GearPair, corner: CornerContact, place: Place) -> Ends:
    """Offsets (mm) where the flanks end, seen along the place's line, as of `window.flank_ends`; tips at the far end of
    their edge."""
    line, ends = place.line_in(pair), []
    for gear, edge, roll, arm, sense in zip(
        (pair.pinion, pair.wheel), corner.edges, place.contact_rolls, line.lever_arms, SENSES
    ):
        tip = edge_position(edge, roll, edge.centre + edge.radius * edge.tip_normal)[1]
        form = flank_point(gear.base_radius, gear.form_roll_angle, roll)[1]
        ends.append((sense * (tip - arm), sense * (form - arm)))
    (pinion_tip, pinion_form), (wheel_tip, wheel_form) = ends
    return (pinion_tip, wheel_form), (pinion_form, wheel_tip)


def _surface(gear, edge: TipEdge, contact_roll: float, height: np.ndarray, removal) -> np.ndarray:
    """Distance (mm, shape of `height`) from the line's foot to a tooth's surface at heights (mm): involute, then the
    edge's arc."""
    roll, x = flank_at_height(gear.base_radius, contact_roll, height)
    if edge.radius > 0.0:
        centre_x, centre_height = edge_position(edge, contact_roll)
        arc = centre_x + np.sqrt(np.maximum(edge.radius**2 - (height - centre_height) ** 2, 0.0))
        x = np.where(roll > edge.flank_roll, arc, x)
    return x if removal is None else x - removal(roll)


def pair_reaches(pair: GearPair, grid: ContactGrid, corner: CornerContact, theoretical: Place) -> bool:
    """Whether a pair's flanks may touch: a window that is not empty, and a tip edge at most a window's length beyond
    the path.

    A tip's gap grows with the distance squared, as the gap between flanks does across the window, but slower: half a
    window's length is not always enough.
    """
    beyond = corner.edge_beyond(theoretical)
    if beyond is not None:
        gear, edge = beyond
        if (
            abs(theoretical.contact_rolls[gear] - edge.flank_roll) * (pair.pinion, pair.wheel)[gear].base_radius
            > grid.length
        ):
            return False
    return window(edge_ends(pair, corner, corner_place(pair, corner, theoretical)), grid) is not None
