"""Whether the largest pressure is at the kink where a linear relief starts: linear elasticity has infinite pressure there, as at an edge."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from math import pi

import numpy as np

from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.operator import ContactOperator, node_slices
from fenics_gears.geometry.involute import flank_point

# The largest pressure of Hertz's half ellipse over its mean, weighted by the pressure itself.
HERTZ_PEAK = 3.0 * pi / 8.0
# A peak this many times that of a half ellipse of the same mean comes from the kink, not from the load: the paper's pair with linear relief
# of 31 and 60 um has 1.12 and 1.20, with half the element size 1.21 and 1.33, with parabolic relief at most 0.99.
NOTABLE_PEAK = 1.1

Solved = Iterable[tuple[ContactOperator, np.ndarray]]


def kink_at_the_peak(cycle: Cycle, solved: Solved, kinks: Mapping[str, float]) -> tuple[str | None, float]:
    """The gear whose kink has the largest pressure of some solved steps, None where the peak lies elsewhere, and that pressure (MPa).

    solved: contact operator and nodal forces (N) of each step. kinks: roll angle (rad) of the kink in the flank of the "pinion", of the
    "wheel" or of both. A peak is the kink's where it stands out of its contact and lies within a node's spacing of the kink.
    """
    pressed = max(_pressed(cycle, solved), key=lambda each: each[1].max(), default=None)
    if pressed is None:
        return None, 0.0
    pair, pressure, forces = pressed
    largest, place = float(pressure.max()), pair.offsets[pressure.argmax()]
    if largest <= NOTABLE_PEAK * HERTZ_PEAK * float(pressure @ forces / forces.sum()):
        return None, largest
    near = (gear for gear, roll in kinks.items() if abs(_offset(cycle, pair, gear, roll) - place) <= cycle.grid.spacing)
    return next(near, None), largest


def _pressed(cycle: Cycle, solved: Solved) -> Iterator[tuple]:
    """Every loaded tooth pair with its pressure (n,), MPa, and its forces (n,), N."""
    for operator, all_forces in solved:
        for nodes, pair in zip(node_slices(operator.pairs), operator.pairs):
            forces = all_forces[nodes]
            if len(forces) and forces.max() > NO_FORCE:
                yield pair, forces / (pair.lengths * cycle.contact_width(pair.place)), forces


def _offset(cycle: Cycle, pair, gear: str, roll: float) -> float:
    """Offset (mm) from the line of action, towards the pinion, of the point of a gear's flank at a roll angle (rad)."""
    number, side = (0, -1.0) if gear == "pinion" else (1, 1.0)
    radius = getattr(cycle.pair, gear).base_radius
    return side * (float(flank_point(radius, roll, pair.place.contact_rolls[number])[1]) - radius)
