"""How a flank gives way beside a free end of the face, below the size of the body's elements.

A line load on the face of a wedge, along the line that is normal to its edge, moves that line by

    -(2 (1 - nu^2) / (pi E)) kappa ln(l)

more than in plane strain, per unit line load, with the distance l from the edge along the line: no length but l is
there. kappa depends on Poisson's ratio and on the wedge's angle alone: positive where the end face leans away under
the flank (acute), negative where it supports it (obtuse). At an end of helical gears one flank's edge is acute and the
mate's obtuse by the base helix angle. Beside the line, at an offset x, it is ln of the distance from the point of the
edge, sqrt(l^2 + x^2), as of a load mirrored at the end face.

A body of elements knows this down to their size. What it leaves out is

    (2 (1 - nu^2) / (pi E)) kappa / 2 ln(1 + r^2 / (l^2 + x^2)),    r = REACH times the elements' length on the flank
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, degrees, exp, pi

import numpy as np

from fenics_gears.geometry.gear_data import Material

# Of the elements' length, of a right edge: 0.16 and 0.12 of edges 20 degrees more acute and more obtuse (measured:
# docs/evidence/third_dimension.md, "Ends of the face").
REACH = 0.14
# Degrees by which the wedge's angle is more than a right one, and ln(1 + kappa) for a row of POISSON's ratios
# (tests.wedge computes them).
ANGLES = (-40.0, -30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0, 40.0)
POISSON = (0.0, 0.15, 0.3, 0.4, 0.48)
LOGARITHMS = (
    (1.876, 1.268, 0.756, 0.333, 0.000, -0.243, -0.407, -0.507, -0.562),
    (2.011, 1.400, 0.878, 0.436, 0.073, -0.207, -0.406, -0.534, -0.605),
    (2.181, 1.573, 1.049, 0.595, 0.211, -0.102, -0.339, -0.503, -0.602),
    (2.319, 1.717, 1.194, 0.737, 0.343, 0.014, -0.248, -0.440, -0.565),
    (2.445, 1.851, 1.332, 0.877, 0.479, 0.138, -0.140, -0.353, -0.499),
)


@dataclass(frozen=True)
class FreeEnds:
    """`softness` (2,), mm^2/N: 2 (1 - nu^2) kappa / (pi E) at the lower and the upper end of drive flanks; coast flanks
    have the other one. `reach`: mm, r above."""

    softness: tuple[float, float]
    reach: float

    def of_flank(self, flank: int) -> tuple[float, float]:
        """Of drive (0) or coast (1) flanks."""
        return self.softness[::-1] if flank else self.softness


def free_ends(slope: float, material: Material, element: float) -> FreeEnds:
    """Of drive flanks whose lines of contact move out of the material by `slope` mm per mm along z; `element`: mm, of
    the body along the flank."""
    surface = 2.0 * (1.0 - material.poissons_ratio**2) / (pi * material.youngs_modulus)
    lower, upper = (surface * wedge_softening(degrees(atan(rise)), material.poissons_ratio) for rise in (slope, -slope))
    return FreeEnds((lower, upper), REACH * element)


def wedge_softening(angle: float, poissons_ratio: float) -> float:
    """kappa of a wedge whose angle is `angle` degrees more than a right one.

    >>> round(wedge_softening(0.0, 0.3), 3), round(wedge_softening(-20.0, 0.3), 2)
    (0.235, 1.85)
    """
    of_angles = [np.interp(angle, ANGLES, row) for row in LOGARITHMS]
    return exp(float(np.interp(poissons_ratio, POISSON, of_angles))) - 1.0
