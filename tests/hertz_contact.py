"""Involute flanks pressed together at the pitch point, and Hertz's line contact (Johnson, Contact Mechanics, 1985,
4.2 (c), 5.6). What the bodies' shape adds to the approach is proportional to the load, so that the approach per line
load of two loads F1 > F2 differs by ln(F1/F2)/(pi E*), whatever the bodies."""

from dataclasses import dataclass, replace

import numpy as np
from tests.contact.problems import pressed

from fenics_gears import Gear, Scene, model_of
from fenics_gears.contact.kinematics import CENTRE_COORDINATES
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.contact.window import ContactGrid
from fenics_gears.elasticity.compliance import FlankCompliance, Reach
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.geometry.involute import arc_length, canonical_normal, roll_angle_at_arc_length
from fenics_gears.model.model import Model
from fenics_gears.model.resolution import hertz_half_width, plane_contact_modulus, relative_radius
from fenics_gears.results.mesh_curves import without_oscillation

# The smaller load, in parts of the larger: half its half-width.
SMALLER = 0.25
# The window in half-widths of the larger load.
WINDOW = 5.0
# Points at which a pressure is summed, even in the angle whose sine it is.
SAMPLES = 20_000
QUANTITIES = ("peak pressure", "half-width", "approach")


@dataclass(frozen=True)
class Pressed:
    """Approach (mm) along the line of action; offsets (n,), mm, and pressures (n,), MPa."""

    approach: float
    offsets: np.ndarray
    pressure: np.ndarray

    @property
    def peak(self) -> float:
        """Of five nodes together, as the program tells it."""
        return float(without_oscillation(self.pressure).max())

    @property
    def half_width(self) -> float:
        """From the second moment: of an ellipse b^2/4."""
        centre = self.pressure @ self.offsets / self.pressure.sum()
        return 2.0 * float(np.sqrt(self.pressure @ (self.offsets - centre) ** 2 / self.pressure.sum()))


class HertzContact:
    """The flanks of a scene at the pitch point, without friction."""

    def __init__(self, scene: Scene):
        self.scene = replace(scene, friction=None)
        model = model_of(self.scene)
        self.pair, self.line_load = (
            model.pair,
            abs(scene.load.wheel_torque / model.pair.wheel.base_radius) / model.pair.face_width,
        )
        self.modulus, self.radius = plane_contact_modulus(scene), relative_radius(model.pair, model.pair.pitch_point)

    def half_width(self, line_load: float) -> float:
        """Hertz's, mm, under a line load (N/mm)."""
        return hertz_half_width(line_load, self.radius, self.modulus)

    def model(self, flank_element_size: float, element: str = "P2") -> Model:
        accuracy = replace(self.scene.accuracy, element=element, flank_element_size=flank_element_size)
        return model_of(replace(self.scene, accuracy=accuracy))

    def compliances(self, flank_element_size: float, element: str = "P2", cache=None):
        model = self.model(flank_element_size, element)
        return tuple(
            flank_compliance(gear, material, model.resolution.discretisation(number), Reach(2), cache)
            for number, (gear, material) in enumerate(
                zip((self.pair.pinion, self.pair.wheel), self.scene.gears.materials)
            )
        )

    def pressed(self, compliances, spacing: float, line_load: float) -> Pressed:
        """Under a line load (N/mm), contact nodes `spacing` (mm) apart, one of them on the line of action."""
        cells = 2 * int(np.ceil(0.5 * WINDOW * self.half_width(self.line_load) / spacing))
        flanks = Flanks(self.pair, compliances, (None, None))
        cycle = Cycle(
            elastic_mesh(flanks, ContactGrid(cells * spacing, cells + 1)),
            1,
            [CENTRE_COORDINATES.index("rotation_2")],
            tangential=False,
        )
        phase = (self.pair.pitch_point - self.pair.path_start) / self.pair.base_pitch % 1.0
        operator = cycle.between(phase, phase).operator
        solution = pressed(operator, line_load * self.pair.face_width, np.abs(operator.jacobian))
        forces, (loaded,) = solution.forces, np.unique(operator.node_pair[solution.forces > 0.0])
        own = operator.node_pair == loaded
        tooth_pair = operator.pairs[loaded]
        pressure = forces[own] / (tooth_pair.lengths * self.pair.face_width)
        return Pressed(float(solution.coordinates[0]), tooth_pair.offsets, pressure)

    def errors(self, compliances, spacing: float) -> dict[str, float]:
        """Of the scene's load, and of the approach between it and the smaller one."""
        large, small = (self.line_load, SMALLER * self.line_load)
        one, other = (self.pressed(compliances, spacing, load) for load in (large, small))
        width = self.half_width(large)
        logarithm = (other.approach / small - one.approach / large) * np.pi * self.modulus
        return {
            "peak pressure": one.peak / (2.0 * large / (np.pi * width)) - 1.0,
            "half-width": one.half_width / width - 1.0,
            "approach": logarithm / np.log(large / small) - 1.0,
        }

    def flank_error(self, gear: Gear, compliance: FlankCompliance) -> float:
        """Of the flank's elements alone, under Hertz's own pressure: the mean displacement per line load differs by
        2 (1 - nu^2)/(pi E) ln(b1/b2) between two half-widths."""
        large, small = (self.half_width(load) for load in (self.line_load, SMALLER * self.line_load))
        given = [
            force @ compliance.blocks[0] @ force
            for force in (self._elliptic(gear, compliance, width) for width in (large, small))
        ]
        return float((given[1] - given[0]) * np.pi * self.modulus / np.log(large / small)) - 1.0

    def _elliptic(self, gear: Gear, compliance: FlankCompliance, width: float) -> np.ndarray:
        """Consistent forces (2 f,) on flank nodes of an elliptic pressure of 1 N/mm at the pitch point."""
        order, arcs = compliance.element_order, arc_length(gear.base_radius, compliance.roll_angle)
        roll = {id(self.pair.pinion): self.pair.pinion_roll_angle, id(self.pair.wheel): self.pair.wheel_roll_angle}[
            id(gear)
        ](self.pair.pitch_point)
        angles = (np.arange(SAMPLES) + 0.5) * np.pi / SAMPLES
        at = arc_length(gear.base_radius, roll) + width * np.cos(angles)
        shares = 2.0 * np.sin(angles) ** 2 / SAMPLES
        vertices = arcs[::order]
        element = np.searchsorted(vertices, at) - 1
        local = (at - vertices[element]) / np.diff(vertices)[element]
        shapes = (
            [1.0 - local, local]
            if order == 1
            else [(1 - local) * (1 - 2 * local), 4 * local * (1 - local), local * (2 * local - 1)]
        )
        normals = -canonical_normal(roll_angle_at_arc_length(gear.base_radius, at))
        forces = np.zeros((len(arcs), 2))
        for ahead, shape in enumerate(shapes):
            np.add.at(forces, order * element + ahead, (shares * shape)[:, None] * normals)
        return forces.ravel()
