"""Two-node Timoshenko elements: J. S. Przemieniecki, Theory of Matrix Structural Analysis (1968), 5.6. Only the
shear coefficient is the program's, which is checked by itself."""

import numpy as np

from fenics_gears.dynamics.shaft_system import ShaftSystem

FIVE = 5


def alone(shaft, housing=None):
    """An elastic shaft by itself."""
    return ShaftSystem((shaft,), housing)


def element(length, modulus, ratio, outer, bore, shear):
    """Stiffness (10, 10) over x, y, z, tilt x, tilt y of both ends of a cylinder."""
    area, second = np.pi * (outer**2 - bore**2) / 4.0, np.pi * (outer**4 - bore**4) / 64.0
    phi = 12.0 * modulus * second / (shear * modulus / (2.0 * (1.0 + ratio)) * area * length**2)
    own, other, cross = (4.0 + phi) * length**2, (2.0 - phi) * length**2, 6.0 * length
    bending = modulus * second / ((1.0 + phi) * length**3) * np.array([
        [12.0, cross, -12.0, cross], [cross, own, -cross, other],
        [-12.0, -cross, 12.0, -cross], [cross, other, -cross, own],
    ])  # fmt: skip
    found = np.zeros((10, 10))
    found[np.ix_([0, 4, 5, 9], [0, 4, 5, 9])] = bending
    # A positive tilt about x moves what lies further along the axis to negative y.
    turned = np.diag([1.0, -1.0, 1.0, -1.0])
    found[np.ix_([1, 3, 6, 8], [1, 3, 6, 8])] = turned @ bending @ turned
    found[np.ix_([2, 7], [2, 7])] = modulus * area / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return found


def assembled(shaft, shear, more=(), seat_stiffness=1.0):
    """Places along an elastic shaft of cylinders, also `more`, and its stiffness (5 p, 5 p), bearings with it;
    `shear`: coefficient by outer and inner diameter; `seat_stiffness`: of what the gear sits on."""
    ends = np.cumsum([0.0, *(each.length for each in shaft.sections)])
    (gear,) = shaft.seats
    seat = gear.ends
    places = sorted({*ends, *seat, gear.at, *more, *(each.at for each in shaft.bearings)})
    stiffness = np.zeros((FIVE * len(places),) * 2)
    for number, (left, right) in enumerate(zip(places, places[1:])):
        section = shaft.sections[int(np.searchsorted(ends, 0.5 * (left + right))) - 1]
        modulus = shaft.material[0] * (seat_stiffness if seat[0] <= left and right <= seat[1] else 1.0)
        of_both = slice(FIVE * number, FIVE * (number + 2))
        stiffness[of_both, of_both] += element(
            right - left, modulus, shaft.material[1], section.diameter, section.bore,
            shear(section.diameter, section.bore),
        )  # fmt: skip
    for bearing in shaft.bearings:
        own = slice(FIVE * places.index(bearing.at), FIVE * (places.index(bearing.at) + 1))
        stiffness[own, own] += bearing.matrix
    return places, stiffness


def condensed(shaft, shear, seat_stiffness=1.0):
    """Stiffness (5, 5) at the middle of the gear."""
    places, stiffness = assembled(shaft, shear, (), seat_stiffness)
    kept = np.arange(FIVE) + FIVE * places.index(shaft.seats[0].at)
    others = np.setdiff1d(np.arange(len(stiffness)), kept)
    return stiffness[np.ix_(kept, kept)] - stiffness[np.ix_(kept, others)] @ np.linalg.solve(
        stiffness[np.ix_(others, others)], stiffness[np.ix_(others, kept)]
    )
