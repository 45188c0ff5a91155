"""Gears that do not roll: the contact equations stand still."""

from dataclasses import replace

import numpy as np

from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.operator import Position
from fenics_gears.contact.window import ContactGrid
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.stepping import EquationsOfMotion
from fenics_gears.dynamics.steps import Record
from fenics_gears.dynamics.time_integration import State
from fenics_gears.model.drivetrain import drivetrain

GRID = ContactGrid(length=1.5, nodes=20)


class Frozen:
    """The same position of a cycle at every step."""

    face, alike = None, True

    def __init__(self, cycle, step):
        position = cycle.position(step)
        operator = position.operator
        if operator.rigid_slip is not None:
            # What touches now touched before: no rigid slip, and the tangential displacement is that of the same nodes.
            n = operator.nodes
            operator = replace(
                operator,
                rigid_slip=np.zeros(n),
                previous_compliance=operator.compliance[n:].copy(),
                previous_jacobian=operator.jacobian[n:].copy(),
            )
        self._position = Position(operator, np.arange(operator.nodes), position.index, position.nodes)
        self.steps = self.steps_until_alike = cycle.steps
        self.solve = cycle.solve
        self.pair = cycle.pair
        self.longest_lever = cycle.longest_lever
        self.traits = replace(cycle.traits, divisible=False)

    def alike_nodes(self, step):
        """No other mesh is like this one."""
        return []

    def shared(self, kind):
        return kind()

    def build(self, steps):
        """There is one position, which is there."""

    def position(self, step):
        return self._position


def frozen_marcher(scene, pair, flanks, step, phase_step=60):
    """With time step `step` (s) at one position of 100 in the mesh cycle, and its drivetrain."""
    shafts = drivetrain(scene, pair)
    cycle = Cycle(elastic_mesh(flanks, GRID), 100, shafts.indices, tangential=scene.friction is not None)
    return frozen_at(cycle, scene, shafts, step, phase_step), shafts


def frozen_at(cycle, scene, shafts, step, phase_step):
    """With time step `step` (s) at one position of a cycle."""
    friction = 0.0 if scene.friction is None else scene.friction.coefficient
    return Marcher(Frozen(cycle, phase_step), EquationsOfMotion(shafts, step, friction))


def pushed(marcher, shafts, **speeds):
    """The start, with speeds (mm/s) of some coordinates and the accelerations of the equations of motion."""
    rest = marcher.start()[0]
    velocity = np.array([speeds.get(name, 0.0) for name in shafts.coordinates])
    acceleration = (
        np.zeros_like(velocity) if shafts.damping is None else -np.linalg.solve(shafts.mass, shafts.damping @ velocity)
    )
    return Record(0, State(rest.state.position, velocity, acceleration), rest.position, rest.solution)
