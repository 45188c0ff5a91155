"""What two gear packages of PyPI say of a pair; JSON in, JSON out, by a Python that has them."""

import json
import math
import sys
import time

import numpy as np
import py_gearworks
from gearbox.standards.iso import __c__ as stiffness
from gearbox.transmition.gears import Gear, Lubricant, Material, Tool, Transmition
from py_gearworks.wrapper import get_contact_ratio_2D


def by_python_gearbox(given: dict) -> dict:
    """Contact ratios and stiffness by ISO 6336-1, N/(mm um)."""
    # It compares angles by identity.
    module, helix, angle = given["module"], given["helix"], 20
    steel = Material(1500.0, 430.0, 286.89, "V(DIN)")
    tool = Tool(1.0, 1.25, given["tip_radius"], 0.0, 0.0, 0.0, 0.0)
    width = given["width"]
    gears = [Gear(tool, steel, teeth, helix, width, width, angle, module, 0.0) for teeth in given["teeth"]]
    pair = Transmition(Lubricant(160.0), 1000.0, 1000.0 * given["teeth"][0] / given["teeth"][1], 1, 10.0, 1e4, gears,
                       1.0, 1.0, 1.0)  # fmt: skip
    of_mesh, _, single = stiffness(pair)
    return {
        "transverse contact ratio": pair.epsilon_alpha, "overlap ratio": pair.epsilon_beta,
        "base diameter of the pinion": gears[0].db, "single": single, "mesh": of_mesh,
    }  # fmt: skip


def by_py_gearworks(given: dict) -> dict:
    """Contact ratio, and the pinion's tooth: radii and transverse thicknesses there, mm."""
    helix = math.radians(given["helix"])
    common = {"module": given["module"], "height": given["width"], "addendum_coefficient": 1.0,
              "dedendum_coefficient": 1.25, "enable_undercut": True}  # fmt: skip
    pinion, wheel = (
        py_gearworks.HelicalGear(number_of_teeth=teeth, helix_angle=sign * helix, **common)
        if helix
        else py_gearworks.SpurGear(number_of_teeth=teeth, **common)
        for teeth, sign in zip(given["teeth"], (1.0, -1.0))
    )
    wheel.mesh_to(pinion)
    section = pinion.gearcore.curve_gen_at_z(0.0)
    points = np.array([section.tooth_curve(each) for each in np.linspace(0.0, 1.0, 400)])
    mirrored = np.array([section.tooth_curve_mirror(each) for each in np.linspace(0.0, 1.0, 400)])
    # Its sections are of module one.
    radii, sides = np.array(given["radii"]) / pinion.module, []
    for side in (points, mirrored):
        radius, angle = np.hypot(side[:, 0], side[:, 1]), np.unwrap(np.arctan2(side[:, 1], side[:, 0]))
        order = np.argsort(radius)
        # Between points by radius squared, in which an involute's angle is smooth.
        sides.append(np.interp(np.square(radii), radius[order] ** 2, angle[order]))
    thickness = np.abs(sides[0] - sides[1]) * given["radii"]
    return {
        "transverse contact ratio": float(get_contact_ratio_2D(pinion, wheel, 0.5)),
        "centre distance": float(np.linalg.norm(pinion.center - wheel.center)),
        "thickness": thickness.tolist(),
    }


found = {}
data = json.load(sys.stdin)
for name, function in (("python-gearbox", by_python_gearbox), ("py-gearworks", by_py_gearworks)):
    begun = time.process_time()
    found[name] = function(data)
    found[name]["seconds"] = time.process_time() - begun
print(json.dumps(found))
