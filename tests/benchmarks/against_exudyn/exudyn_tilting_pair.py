"""A gear pair in space as Exudyn has it: rigid bodies on bearings along their shafts; run by a Python that has Exudyn,
without this program.

Reads a JSON object from standard input and writes natural frequencies (Hz), and static displacements under a torque, to
standard output. N, mm, s, rad.

Two rigid bodies move about their mid-widths; each bearing is a spring in x and y between a point of the body's axis and
the ground, the mesh two springs along the contact normal between points of both bodies. All that tilts and couples is
Exudyn's own kinematics.
"""

import json
import sys

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    CartesianSpringDamper,
    CoordinateSpringDamper,
    LoadCoordinate,
    MarkerBodyPosition,
    MarkerNodeCoordinate,
    Mass1D,
    Node1D,
    NodePointGround,
    NodeRigidBodyRxyz,
    ObjectGround,
    ObjectRigidBody,
    SpringDamper,
)  # fmt: skip

# Half of the distance between the ends of a mesh spring, mm.
HALF = 20.0
TURN = 5  # about z, among the coordinates of a body


def assembled(given):
    """The system and the nodes of both gears."""
    container = exu.SystemContainer()
    system = container.AddSystem()
    base = system.AddObject(ObjectGround())
    fixed = system.AddMarker(MarkerNodeCoordinate(nodeNumber=system.AddNode(NodePointGround()), coordinate=0))
    nodes, bodies = [], []
    for number in range(2):
        centre = np.array(given["centre"][number])
        node = system.AddNode(NodeRigidBodyRxyz(referenceCoordinates=[*centre, 0.0, 0.0, 0.0]))
        inertia = [given["tilting_inertia"][number]] * 2 + [given["inertia"][number], 0.0, 0.0, 0.0]
        body = system.AddObject(ObjectRigidBody(mass=given["mass"][number], inertia=inertia, nodeNumber=node))
        for place in given["places"][number]:
            spring_in_space(
                system, base, body, centre, place, [*(0.5 * stiffness for stiffness in given["bearing"][number]), 0.0]
            )
        spring_in_space(system, base, body, centre, 0.0, [0.0, 0.0, given["axial"][number]])
        nodes.append(node)
        bodies.append(body)
    normal = np.array(given["normal"])
    for point in np.array(given["contact"]):
        ends = [
            system.AddMarker(
                MarkerBodyPosition(
                    bodyNumber=bodies[i], localPosition=list(point - given["centre"][i] + side * HALF * normal)
                )
            )
            for i, side in ((0, -1.0), (1, 1.0))
        ]
        system.AddObject(
            SpringDamper(markerNumbers=ends, stiffness=0.5 * given["mesh"], damping=0.0, referenceLength=2.0 * HALF)
        )
    spring(system, fixed, at(system, nodes[0], TURN), given["shaft"][0])
    rotor = system.AddNode(Node1D(referenceCoordinates=[0.0]))
    system.AddObject(Mass1D(mass=given["load"], nodeNumber=rotor))
    end = at(system, rotor, 0)
    spring(system, at(system, nodes[1], TURN), end, given["shaft"][1])
    return container, system, nodes, end


def spring_in_space(system, base, body, centre, place, stiffness):
    marks = [
        system.AddMarker(MarkerBodyPosition(bodyNumber=base, localPosition=[centre[0], centre[1], centre[2] + place])),
        system.AddMarker(MarkerBodyPosition(bodyNumber=body, localPosition=[0.0, 0.0, place])),
    ]
    system.AddObject(CartesianSpringDamper(markerNumbers=marks, stiffness=stiffness, damping=[0.0] * 3))


def at(system, node, coordinate):
    return system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))


def spring(system, first, second, stiffness):
    system.AddObject(CoordinateSpringDamper(markerNumbers=[first, second], stiffness=stiffness, damping=0.0))


def main():
    """Frequencies about the unloaded position; displacements of both gears, x, y, z and about x, y, z, under the
    torque."""
    given = json.load(sys.stdin)
    container, system, *_ = assembled(given)
    system.Assemble()
    squares = np.asarray(system.ComputeODE2Eigenvalues()[0], float)
    container, system, nodes, end = assembled(given)
    system.AddLoad(LoadCoordinate(markerNumber=end, load=given["torque"]))
    system.Assemble()
    settings = exu.SimulationSettings()
    settings.solutionSettings.writeSolutionToFile = False
    settings.staticSolver.newton.relativeTolerance = 1e-9
    system.SolveStatic(settings, updateInitialValues=True)
    moved = [list(np.asarray(system.GetNodeOutput(node, exu.OutputVariableType.Coordinates), float)) for node in nodes]
    frequencies = sorted(np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi))
    json.dump({"version": exu.GetVersionString(), "frequencies": frequencies, "moved": moved}, sys.stdout)


if __name__ == "__main__":
    main()
