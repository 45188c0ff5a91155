"""The pair as Exudyn has it: two rigid bodies, a load, springs, and a mesh whose force is read from a table over the
mesh cycle.

Reads a JSON object from standard input and writes one to standard output; run by a Python that has Exudyn, without this
program. N, mm, t, s, rad.

The mesh force is F(phase) + k(phase) (x - x(phase)): force, tangent stiffness and displacement of the flanks at each
phase of the mesh cycle in static equilibrium are this program's; x is their displacement in motion. The pinion turns
about (0, 0), the wheel about (L, -(rb1 + rb2)), with x along the line of action.
"""

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


def assembled(given, mesh_force=None):
    """The system under its torque; nodes of both gears. `mesh_force`: of time and the flanks' displacement; a spring of
    the mean stiffness where None."""
    container = exu.SystemContainer()
    system = container.AddSystem()
    ground = system.AddMarker(MarkerNodeCoordinate(nodeNumber=system.AddNode(NodePointGround()), coordinate=0))

    def at(node, coordinate):
        return system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))

    def spring(first, second, stiffness):
        damping = given["damping"] * stiffness
        system.AddObject(CoordinateSpringDamper(markerNumbers=[first, second], stiffness=stiffness, damping=damping))

    (rb1, rb2), length = given["base_radii"], given["line_length"]
    nodes, marks = [], []
    for number, (place, point) in enumerate(
        zip([(0.0, 0.0), (length, -(rb1 + rb2))], [(0.0, -rb1, 0.0), (0.0, rb2, 0.0)])
    ):
        node = system.AddNode(NodeRigidBody2D(referenceCoordinates=[*place, 0.0]))
        body = system.AddObject(
            ObjectRigidBody2D(mass=given["mass"][number], inertia=given["inertia"][number], nodeNumber=node)
        )
        for axis in range(2):
            spring(ground, at(node, axis), given["bearing"])
        nodes.append(node)
        marks.append(system.AddMarker(MarkerBodyRigid(bodyNumber=body, localPosition=point)))
    mesh = (
        {"stiffness": given["mesh_stiffness"]}
        if mesh_force is None
        else {"springForceUserFunction": lambda system, time, item, longer, *rest: mesh_force(time, longer)}
    )
    system.AddObject(SpringDamper(markerNumbers=marks, damping=0.0, referenceLength=length, **mesh))
    spring(ground, at(nodes[0], 2), given["shaft"])
    load = system.AddNode(Node1D(referenceCoordinates=[0.0]))
    system.AddObject(Mass1D(mass=given["load"], nodeNumber=load))
    spring(at(nodes[1], 2), at(load, 0), given["shaft"])
    if mesh_force is not None:
        # A torque against the wheel's rotation turns it by a positive angle.
        system.AddLoad(LoadCoordinate(markerNumber=at(load, 0), load=given["torque"]))
    return container, system, nodes


def main():
    """Natural frequencies (Hz) with the mean mesh stiffness; rotations (2, steps) in the last mesh cycle."""
    given = json.load(sys.stdin)
    container, system, _ = assembled(given)
    system.Assemble()
    frequencies = np.sqrt(np.maximum(np.asarray(system.ComputeODE2Eigenvalues()[0], float), 0.0)) / (2.0 * np.pi)

    table = {name: np.array(given[name]) for name in ("phase", "displacement", "stiffness", "force")}

    def mesh_force(time, longer):
        displacement, stiffness, force = (
            np.interp(time * given["mesh_frequency"] % 1.0, table["phase"], table[name])
            for name in ("displacement", "stiffness", "force")
        )
        return float(-force + stiffness * (longer + displacement))

    container, system, nodes = assembled(given, mesh_force)
    sensors = [
        system.AddSensor(
            SensorNode(nodeNumber=node, outputVariableType=exu.OutputVariableType.Coordinates, storeInternal=True)
        )
        for node in nodes
    ]
    system.Assemble()
    settings = exu.SimulationSettings()
    settings.solutionSettings.writeSolutionToFile = False
    settings.staticSolver.newton.relativeTolerance = 1e-10
    system.SolveStatic(settings, updateInitialValues=True)
    a_cycle, cycles = given["steps_of_a_cycle"], given["cycles"]
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = (
        a_cycle * cycles,
        cycles / given["mesh_frequency"],
    )
    settings.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    settings.timeIntegration.generalizedAlpha.useNewmark = True
    settings.timeIntegration.newton.relativeTolerance = 1e-10
    settings.timeIntegration.newton.useModifiedNewton = False
    settings.solutionSettings.sensorsWritePeriod = 1.0 / (a_cycle * given["mesh_frequency"])
    system.SolveDynamic(settings)
    # Exudyn divides a step whose iterations fail, and writes from there on between the steps.
    times = (cycles - 1 + np.arange(a_cycle + 1) / a_cycle) / given["mesh_frequency"]
    stored = [system.GetSensorStoredData(sensor) for sensor in sensors]
    rotations = [np.interp(times, each[:, 0], each[:, 3]).tolist() for each in stored]
    json.dump({"version": exu.config.Version(), "frequencies": sorted(frequencies), "rotations": rotations}, sys.stdout)


if __name__ == "__main__":
    main()
