"""Shafts joined by gear meshes of constant stiffness as the rotor program ROSS has them (MultiRotor); JSON in, natural
frequencies (Hz) out. N, mm, s, rad; ROSS counts in metres.

Each shaft is a row of discs with weightless elements between them that twist and hardly bend."""

import json
import sys

import numpy as np
import ross
from scipy.linalg import eigh

# Of the elements: m, and what is as good as nothing, N/m^2 and kg/m^3.
LENGTH, DIAMETER, NO_BENDING, NO_MASS = 1.0, 0.05, 1.0, 1e-6
# kg m^2 about a diameter: where nothing holds a disc against tilting, it moves slowly and alone.
ACROSS = 1.0


def element(torsional_stiffness):
    """Between two discs, N m/rad."""
    polar = np.pi * DIAMETER**4 / 32.0
    shear = torsional_stiffness * LENGTH / polar
    soft = ross.Material("shaft", rho=NO_MASS, E=NO_BENDING, G_s=shear)
    return ross.ShaftElement(L=LENGTH, idl=0.0, odl=DIAMETER, material=soft, shear_effects=False)


def disc(node, given):
    """A gear, or what is at an end of the train."""
    mass, inertia = given["mass"] * 1e3, given["inertia"] * 1e-3
    if "pitch_radius" not in given:
        return ross.DiskElement(n=node, m=mass, Id=ACROSS, Ip=inertia)
    return ross.GearElement(
        n=node, m=mass, Id=ACROSS, Ip=inertia, n_teeth=given["teeth"], pitch_diameter=2e-3 * given["pitch_radius"],
        pr_angle=given["pressure_angle"],
    )  # fmt: skip


def rotor(given):
    elements = [element(1e-3 * each) for each in given["torsion"]]
    discs = [disc(node, each) for node, each in enumerate(given["discs"])]
    bearings = [
        ross.BearingElement(n=node, kxx=1e3 * each["bearing"], cxx=0.0) for node, each in enumerate(given["discs"])
    ]
    return ross.Rotor(elements, disk_elements=discs, bearing_elements=bearings)


given = json.load(sys.stdin)
first, *others = map(rotor, given["shafts"])
train, last = first, len(first.nodes) - 1
for shaft, stiffness, direction in zip(others, given["stiffness"], given["direction"]):
    # The last gear so far with the first one of the next shaft.
    train = ross.MultiRotor(train, shaft, (last, 0), 1e3 * stiffness, orientation_angle=direction)
    last += len(shaft.nodes)
squares = eigh(train.K(0.0), train.M(0.0), eigvals_only=True)
frequencies = np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi)
print(json.dumps(frequencies.tolist()), file=sys.__stdout__)
