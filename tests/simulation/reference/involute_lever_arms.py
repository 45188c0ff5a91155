"""The reference route with the base radii as arms of normal forces: an involute turned by phi moves by rb phi along
its own normal wherever it is touched. The published equations see a material point at the height h off the line of
action, which moves by h phi along e_x."""

from dataclasses import replace

import numpy as np

from fenics_gears.contact.kinematics import displacement_jacobian, lines_of
from fenics_gears.contact.mesh import MeshTraits, by_newton
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.simulation.reference_route import reference_route


class InvoluteArms(Cycle):
    def __init__(self, cycle):
        mesh = replace(cycle.mesh, solve=by_newton, traits=MeshTraits())
        super().__init__(mesh, cycle.steps, cycle.coordinates, cycle.tangential)

    def position(self, step: int):
        position = super().position(step)
        operator = position.operator
        lines = lines_of(operator.pairs, operator.sides)
        rigid = displacement_jacobian(lines, operator.rigid_slip is not None)[:, self.coordinates]
        changed = replace(operator, jacobian=np.ascontiguousarray(rigid), normal_lever_arms=lines.lever_arms)
        return replace(position, operator=changed)


def with_involute_arms(model, progress, cache):
    gears, cycle = reference_route(model, progress, cache)
    return gears, InvoluteArms(cycle)
