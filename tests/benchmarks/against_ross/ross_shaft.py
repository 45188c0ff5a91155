"""A shaft on its bearings as the rotor program ROSS has it; JSON in, JSON out: displacements of a node (x, y, z,
tilts) by the directions of the load, and natural frequencies (Hz) with a disc there. N, mm, s, rad; ROSS counts in
metres."""

import json
import sys

import numpy as np
import ross
from scipy.linalg import eigh


def rotor(given):
    """The shaft with its bearings and the disc."""
    modulus, ratio = given["material"]
    steel = ross.Material("steel", rho=1e12 * given["density"], E=1e6 * modulus, Poisson=ratio)
    elements = [
        ross.ShaftElement(
            L=1e-3 * length, idl=1e-3 * bore, odl=1e-3 * left, idr=1e-3 * bore, odr=1e-3 * right, material=steel
        )
        for length, left, right, bore in given["elements"]
    ]
    bearings = [
        ross.BearingElement(n=node, kxx=1e3 * radial, kzz=1e3 * axial, cxx=0.0)
        for node, radial, axial in given["bearings"]
    ]
    mass, across, about = given["disc"]
    disc = ross.DiskElement(n=given["node"], m=1e3 * mass, Id=1e-3 * across, Ip=1e-3 * about)
    return ross.Rotor(elements, disk_elements=[disc], bearing_elements=bearings)


def displacements(stiffness, given):
    """Motions (5, 5) of the node per load."""
    stiffness = stiffness.copy()
    # The shaft turns freely.
    stiffness[5, 5] += 1.0
    metres = np.array([1e3, 1e3, 1e3, 1.0, 1.0])
    newtons = np.array([1.0, 1.0, 1.0, 1e-3, 1e-3])
    found = np.linalg.inv(stiffness)
    node = 6 * given["node"] + np.arange(5)
    return metres[:, None] * found[np.ix_(node, node)] * newtons


given = json.load(sys.stdin)
found = rotor(given)
squares = eigh(found.K(0.0), found.M(0.0), eigvals_only=True)
frequencies = np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi)
print(json.dumps([displacements(found.K(0.0), given).tolist(), frequencies.tolist()]), file=sys.__stdout__)
