"""Natural frequencies (Hz) of a shaft on its bearings with a disc, by Exudyn's shear deformable beams along its x;
JSON in, JSON out, by a Python that has Exudyn. N, mm, s, rad."""

import json
import sys

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    CartesianSpringDamper,
    MarkerBodyPosition,
    MarkerNodePosition,
    NodeRigidBodyRotVecLG,
    ObjectBeamGeometricallyExact,
    ObjectGround,
    ObjectRigidBody,
)  # fmt: skip
from scipy.linalg import eigh


def section(modulus, ratio, density, shear_area, area, second):
    """Stiffness and mass of a round section per length."""
    found = exu.BeamSection()
    shear = modulus / (2.0 * (1.0 + ratio))
    found.stiffnessMatrix = np.diag(
        [modulus * area, *[shear * shear_area] * 2, 2.0 * shear * second, *[modulus * second] * 2]
    )
    found.massPerLength = density * area
    found.inertia = density * np.diag([2.0 * second, second, second])
    return found


def mass_and_stiffness(given):
    """Of beams between the places, with bearings and the disc at nodes."""
    container = exu.SystemContainer()
    system = container.AddSystem()
    nodes = [
        system.AddNode(NodeRigidBodyRotVecLG(referenceCoordinates=[place, 0.0, 0.0, 0.0, 0.0, 0.0]))
        for place in given["places"]
    ]
    for number, (length, *of_section) in enumerate(given["elements"]):
        system.AddObject(
            ObjectBeamGeometricallyExact(
                nodeNumbers=nodes[number : number + 2],
                length=length,
                sectionData=section(*given["material"], given["density"], *of_section),
            )
        )
    ground = system.AddObject(ObjectGround())
    for node, radial, axial in given["bearings"]:
        place = [given["places"][node], 0.0, 0.0]
        ends = [
            system.AddMarker(MarkerBodyPosition(bodyNumber=ground, localPosition=place)),
            system.AddMarker(MarkerNodePosition(nodeNumber=nodes[node])),
        ]
        system.AddObject(
            CartesianSpringDamper(markerNumbers=ends, stiffness=[axial, radial, radial], damping=[0.0] * 3)
        )
    mass, across, about = given["disc"]
    system.AddObject(
        ObjectRigidBody(mass=mass, inertia=[about, across, across, 0.0, 0.0, 0.0], nodeNumber=nodes[given["node"]])
    )
    system.Assemble()
    return system.ComputeLinearizedSystem()[:2]


given = json.load(sys.stdin)
heavy, stiff = mass_and_stiffness(given)
squares = eigh(0.5 * (stiff + stiff.T), 0.5 * (heavy + heavy.T), eigvals_only=True)
found = np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi)
json.dump({"version": exu.GetVersionString(), "frequencies": found.tolist()}, sys.stdout)
