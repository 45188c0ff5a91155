"""A gear pair as Exudyn has it: rigid bodies, point masses and springs; JSON in, JSON out, by a Python that has
Exudyn. N, mm, s, rad. The mesh is a spring between the points of both bodies where the line of action touches their
base circles."""

import json
import sys

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    CoordinateSpringDamper,
    LoadCoordinate,
    MarkerBodyRigid,
    MarkerNodeCoordinate,
    Mass1D,
    Node1D,
    NodePointGround,
    NodeRigidBody2D,
    ObjectRigidBody2D,
    SensorNode,
    SpringDamper,
)  # fmt: skip


def assembled(given):
    """The system under its couple, the nodes of both gears, and the load."""
    container = exu.SystemContainer()
    system = container.AddSystem()
    ground = system.AddMarker(MarkerNodeCoordinate(nodeNumber=system.AddNode(NodePointGround()), coordinate=0))
    (rb1, rb2), length = given["base_radii"], given["line_length"]
    places = [(0.0, 0.0), (length, -(rb1 + rb2))]
    points = [(0.0, -rb1, 0.0), (0.0, rb2, 0.0)]
    nodes, marks = [], []
    for number in range(2):
        node = system.AddNode(NodeRigidBody2D(referenceCoordinates=[*places[number], 0.0]))
        body = system.AddObject(
            ObjectRigidBody2D(mass=given["mass"][number], inertia=given["inertia"][number], nodeNumber=node)
        )
        for axis in range(2):
            spring(system, ground, at(system, node, axis), given["bearing"][number][axis])
        nodes.append(node)
        marks.append(system.AddMarker(MarkerBodyRigid(bodyNumber=body, localPosition=points[number])))
    system.AddObject(SpringDamper(markerNumbers=marks, stiffness=given["mesh"], damping=0.0, referenceLength=length))
    spring(system, ground, at(system, nodes[0], 2), given["shaft"][0])
    end = rotor(system, at(system, nodes[1], 2), given)
    # A couple against the wheel's rotation turns it by a positive angle.
    couple = system.AddLoad(LoadCoordinate(markerNumber=end, load=given["couple"]))
    return container, system, nodes, couple


def at(system, node, coordinate):
    return system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))


def spring(system, first, second, stiffness):
    system.AddObject(CoordinateSpringDamper(markerNumbers=[first, second], stiffness=stiffness, damping=0.0))


def rotor(system, shaft, given):
    """The load on the output shaft's end; its marker."""
    node = system.AddNode(Node1D(referenceCoordinates=[0.0]))
    system.AddObject(Mass1D(mass=given["load"], nodeNumber=node))
    spring(system, shaft, end := at(system, node, 0), given["shaft"][1])
    return end


def frequencies_of(system):
    """Hz, about the unloaded position."""
    system.Assemble()
    squares = np.asarray(system.ComputeODE2Eigenvalues()[0], float)
    return sorted(np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi))


def at_rest(system, tolerance=1e-10):
    """Moves the system into static equilibrium; the settings."""
    system.Assemble()
    settings = exu.SimulationSettings()
    settings.solutionSettings.writeSolutionToFile = False
    settings.staticSolver.newton.relativeTolerance = tolerance
    system.SolveStatic(settings, updateInitialValues=True)
    return settings


def main():
    """Frequencies about the unloaded position; the response of both rotations to the added couple."""
    given = json.load(sys.stdin)
    container, system, *_ = assembled({**given, "couple": 0.0})
    frequencies = frequencies_of(system)
    container, system, nodes, couple = assembled(given)
    sensors = [
        system.AddSensor(
            SensorNode(nodeNumber=node, outputVariableType=exu.OutputVariableType.Coordinates, storeInternal=True)
        )
        for node in nodes
    ]
    settings = at_rest(system)
    system.SetLoadParameter(couple, "load", given["couple"] + given["couple_after"])
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = (
        given["steps"],
        given["steps"] * given["step"],
    )
    settings.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    settings.timeIntegration.generalizedAlpha.useNewmark = True
    settings.timeIntegration.newton.relativeTolerance = 1e-10
    settings.solutionSettings.sensorsWritePeriod = given["step"]
    system.SolveDynamic(settings)
    stored = [system.GetSensorStoredData(sensor)[:, 3] for sensor in sensors]
    json.dump(
        {"version": exu.GetVersionString(), "frequencies": frequencies, "rotations": [list(each) for each in stored]},
        sys.stdout,
    )


if __name__ == "__main__":
    main()
