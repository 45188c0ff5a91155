"""The pair as ROSS has it: the mesh stiffness of `GearElementTVMS` over a mesh cycle, and the natural frequencies of a
`MultiRotor`.

Reads a JSON object from standard input and writes one to standard output; run by a Python that has ROSS, without this
program. N, m, kg, s, rad.

`GearElementTVMS` adds bending, shear and axial compression of the tooth as a beam, the gear body by Sainsot, Velex and
Duverger (2004), and a Hertz stiffness that knows no load. The rotors: a shaft that twists as a torsional spring does,
on a flywheel (the prescribed rotation) or the load at its far end; it is so long that it hardly bends.
"""

import json
import sys
import warnings

import numpy as np

warnings.simplefilter("ignore")
import ross as rs  # noqa: E402
from scipy.linalg import eigh  # noqa: E402

SHAFT_LENGTH = 4.0
# Flywheel, kg m^2, and what holds directions that the plane model does not have, N/m.
FLYWHEEL, HELD = 1e6, 1e10
POINTS = 400


def tvms(given, number):
    """The gear `number` (0 the pinion) with its tooth stiffness."""
    steel = rs.Material("steel_of_the_pair", rho=7850.0, E=given["youngs_modulus"], Poisson=given["poissons_ratio"])
    return rs.GearElementTVMS(
        n=0,
        material=steel,
        width=given["face_width"],
        bore_diameter=given["bores"][number],
        module=given["module"],
        n_teeth=given["teeth"][number],
        pr_angle=given["pressure_angle"],
    )


def rotor(given, number, far_inertia):
    """A gear on its bearings at node 0, and at the far end of its shaft an inertia."""
    shear = given["youngs_modulus"] / (2.0 * (1.0 + given["poissons_ratio"]))
    diameter = (32.0 * given["shaft"] * SHAFT_LENGTH / (shear * np.pi)) ** 0.25
    light = rs.Material("light_steel", rho=1e-3, E=given["youngs_modulus"], Poisson=given["poissons_ratio"])
    shaft = [rs.ShaftElement(L=SHAFT_LENGTH, idl=0.0, odl=diameter, material=light)]
    inertia = given["inertia"][number]
    gear = rs.GearElement(
        n=0,
        m=given["mass"][number],
        Id=0.5 * inertia,
        Ip=inertia,
        n_teeth=given["teeth"][number],
        pitch_diameter=given["module"] * given["teeth"][number],
        pr_angle=given["pressure_angle"],
    )
    far = rs.DiskElement(n=1, m=1e3, Id=FLYWHEEL, Ip=far_inertia)
    bearing = given["bearing"]
    bearings = [
        rs.BearingElement(n=0, kxx=bearing, kyy=bearing, kzz=HELD, cxx=0.0),
        rs.BearingElement(n=1, kxx=HELD, kyy=HELD, kzz=HELD, cxx=0.0),
    ]
    return rs.Rotor(shaft, [gear, far], bearings)


def main():
    """Stiffness (N/m) over a mesh cycle from the start of contact, mean of it, and all natural frequencies (Hz)."""
    given = json.load(sys.stdin)
    mesh = rs.gear_element.Mesh(tvms(given, 0), tvms(given, 1))
    pitch = 2.0 * np.pi / given["teeth"][0]
    phase = (np.arange(POINTS) + 0.5) / POINTS
    stiffness = [float(mesh.get_variable_stiffness(each * pitch)) for each in phase]
    both = rs.MultiRotor(
        rotor(given, 0, FLYWHEEL),
        rotor(given, 1, given["load"]),
        coupled_nodes=(0, 0),
        gear_mesh_stiffness=given["mesh_stiffness"],
    )
    squares = eigh(both.K(0.0), both.M(0.0), eigvals_only=True)
    frequencies = np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi)
    json.dump(
        {
            "version": rs.__version__,
            "contact_ratio": float(mesh.contact_ratio),
            "phase": phase.tolist(),
            "stiffness": stiffness,
            "frequencies": frequencies.tolist(),
        },
        sys.stdout,
    )


if __name__ == "__main__":
    main()
