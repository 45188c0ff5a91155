"""A gear pair in space as Exudyn has it, each bearing a spring between a point of the body's axis and the ground,
the mesh two springs along the contact normal; JSON in, JSON out, by a Python that has Exudyn. N, mm, s, rad."""

import json
import sys

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    CartesianSpringDamper,
    LoadCoordinate,
    MarkerBodyPosition,
    MarkerNodeCoordinate,
    NodePointGround,
    NodeRigidBodyRxyz,
    ObjectGround,
    ObjectRigidBody,
    SpringDamper,
)  # fmt: skip
from exudyn_pair import at, at_rest, frequencies_of, rotor, spring

# Half of the distance between the ends of a mesh spring, mm.
HALF = 20.0
TURN = 5  # about z, among the coordinates of a body


def assembled(given):
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
    end = rotor(system, at(system, nodes[1], TURN), given)
    return container, system, nodes, end


def spring_in_space(system, base, body, centre, place, stiffness):
    marks = [
        system.AddMarker(MarkerBodyPosition(bodyNumber=base, localPosition=[centre[0], centre[1], centre[2] + place])),
        system.AddMarker(MarkerBodyPosition(bodyNumber=body, localPosition=[0.0, 0.0, place])),
    ]
    system.AddObject(CartesianSpringDamper(markerNumbers=marks, stiffness=stiffness, damping=[0.0] * 3))


def main():
    """Frequencies about the unloaded position; displacements of both gears, x, y, z and about them, under the
    torque."""
    given = json.load(sys.stdin)
    container, system, *_ = assembled(given)
    frequencies = frequencies_of(system)
    container, system, nodes, end = assembled(given)
    system.AddLoad(LoadCoordinate(markerNumber=end, load=given["torque"]))
    at_rest(system, 1e-9)
    moved = [list(np.asarray(system.GetNodeOutput(node, exu.OutputVariableType.Coordinates), float)) for node in nodes]
    json.dump({"version": exu.GetVersionString(), "frequencies": frequencies, "moved": moved}, sys.stdout)


if __name__ == "__main__":
    main()
