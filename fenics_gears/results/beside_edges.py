"""Which contact nodes are beside an edge or a kink of the flanks, where linear elasticity has infinite pressure.

Place alone decides, neither the pressure nor the sizes of elements and nodes. An edge or a kink changes the pressure
about as far as half of the contact is wide (Johnson, Contact Mechanics, 1985, 5.1 to 5.3), and lengths are therefore
counted in the Hertz half-width under full load on one pair, from either side along the flank.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fenics_gears.model.model import Model
from fenics_gears.model.modification import kinks
from fenics_gears.results.side_by_side import SideBySide

# What a node is beside; where it is beside several, the last.
NOTHING, KINK, EDGE = range(3)
# In half-widths: the infinite pressure of a kink is in the contact itself. An edge makes the whole contact softer whose
# border comes within a half-width of it; its peak is another half-width away.
REACH = {KINK: 1.0, EDGE: 2.0}


@dataclass(frozen=True)
class _Place:
    """A place on the flank of the pinion (0) or the wheel (1): `arc` (mm) along the involute from the base circle, and
    whether it is a kink or an edge."""

    gear: int
    arc: float
    kind: int


class EdgesAndKinks:
    """The edges and kinks of a model's flanks; `end_slices` (S,): which slices are edges, none where None."""

    def __init__(self, model: Model, end_slices: np.ndarray | None = None):
        self.half_width, self._end_slices = model.resolution.half_width, end_slices
        self._places: list[_Place] = []
        gears = model.pair.pinion, model.pair.wheel
        for number, (gear, removal) in enumerate(zip(gears, model.removal)):
            rolls = [(roll, KINK) for roll in kinks(removal)] + [(gear.tip_roll_angle, EDGE)]
            rolls += [(gear.form_roll_angle, EDGE)] if gear.undercut else []
            self._places += [_Place(number, 0.5 * gear.base_radius * roll**2, kind) for roll, kind in rolls]
        self._places.sort(key=lambda place: place.kind)

    def beside(self, nodes: SideBySide) -> np.ndarray:
        """What each contact node (N,) is beside: NOTHING, KINK or EDGE. Reliefs are of drive flanks alone."""
        found, arcs = np.full(len(nodes.step), NOTHING), nodes.of("arcs")
        for place in self._places:
            near = np.abs(arcs[place.gear] - place.arc) <= REACH[place.kind] * self.half_width
            found[near & nodes.drive if place.kind == KINK else near] = place.kind
        if self._end_slices is not None:
            found[self._end_slices[nodes.of("slice")]] = EDGE
        return found
