"""A shaft on its bearings as the rotor program ROSS has it; run by a Python that has ROSS, without this program.

Reads a JSON object from standard input and writes the displacements of a node (x, y, z, tilts about x and y) under a
force and a moment on it, by the directions of the load, to standard output. N, mm, rad; ROSS counts in metres.
"""

import json
import sys

import numpy as np
import ross


def displacements(given):
    """Motions (5, 5) of the node per load."""
    modulus, ratio = given["material"]
    steel = ross.Material("steel", rho=7850.0, E=1e6 * modulus, Poisson=ratio)
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
    stiffness = ross.Rotor(elements, bearing_elements=bearings).K(0.0)
    # The shaft turns freely.
    stiffness[5, 5] += 1.0
    metres = np.array([1e3, 1e3, 1e3, 1.0, 1.0])
    newtons = np.array([1.0, 1.0, 1.0, 1e-3, 1e-3])
    found = np.linalg.inv(stiffness)
    node = 6 * given["node"] + np.arange(5)
    return metres[:, None] * found[np.ix_(node, node)] * newtons


print(json.dumps(displacements(json.load(sys.stdin)).tolist()), file=sys.__stdout__)
