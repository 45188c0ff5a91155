"""Crowned spur flanks at the pitch point against Hertz's point contact, over the axis ratio of the ellipse. What the
bodies' shape adds cancels in the difference of approach per load of two loads."""

from dataclasses import dataclass, replace
from math import ceil, sqrt

import numpy as np
from tests.benchmarks.third_dimension.pairs import MODULE, scene_of, standard_pair
from tests.benchmarks.third_dimension.table import Row, read_rows, table, write_rows
from tests.contact.problems import pressed
from tests.hertz_point_contact import PointContact

from fenics_gears import gear_pair, model_of
from fenics_gears.contact.kinematics import CENTRE_COORDINATES
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.geometry.lead_modification import LeadModification, LeadModifications
from fenics_gears.model.resolution import plane_contact_modulus, relative_radius
from fenics_gears.results.mesh_curves import without_oscillation
from fenics_gears.scene.data import Accuracy
from fenics_gears.simulation.elastic_route import elastic_route
from fenics_gears.system.progress import SilentProgress

NAME = "crowned"
# Modules: half of the ellipse's length, the face, layers of the body; and elements of its section.
LONG_AXIS, WIDTH, SECTION = 0.5, 1.5, 0.2
LAYERS, SLICES, RATIOS = 8, 31, (3.0, 5.0, 10.0, 20.0, 40.0)
# Layers and slices of a coarser body, and of slices that are too narrow for it.
COARSER, THEIR_RATIO = ((4, 8), (2, 4), (2, 31)), 10.0
# Flank elements in half the short axis, window in short half-axes, distance of contact nodes in elements, the smaller
# load.
ELEMENTS, WINDOW, SPACING, SMALLER = 4, 5.0, 0.7, 0.25
QUANTITIES = ("peak_pressure", "short_axis", "long_axis", "line_load")


@dataclass(frozen=True)
class Pressed:
    """A solution: approach (mm), and errors of QUANTITIES against Hertz."""

    approach: float
    errors: dict[str, float]


class CrownedFlanks:
    """The pair crowned so that an ellipse of LONG_AXIS and an axis ratio comes out under Hertz's load. The middle of
    the face stands on the boundary of two layers, where the coarse body errs most."""

    def __init__(self, ratio: float, layers: int = LAYERS, slices: int = SLICES):
        gears = standard_pair(WIDTH * MODULE)
        self.pair, plain = gear_pair(gears), scene_of(gears, Accuracy())
        long_axis, radius = LONG_AXIS * MODULE, relative_radius(self.pair, self.pair.pitch_point)
        self.exact = PointContact(long_axis, long_axis / ratio, radius, plane_contact_modulus(plain))
        size, length = self.exact.short_axis / ELEMENTS, WINDOW * self.exact.short_axis
        accuracy = Accuracy(
            flank_element_size=size, contact_length=length, contact_nodes=2 * ceil(0.5 * length / (SPACING * size)) + 1,
            steps_per_mesh_cycle=1,
            slices=slices, layers=layers, body_element_size=SECTION * MODULE,
        )  # fmt: skip
        crowning = LeadModification(crowning=gears.face_width**2 / (8.0 * self.exact.radius_along))
        scene = scene_of(gears, accuracy, self.exact.load / gears.face_width)
        scene = replace(scene, misalignment=None, lead_modifications=LeadModifications(pinion=crowning))
        self.cycle = elastic_route(model_of(scene), SilentProgress(), user_cache())[1]
        phase = (self.pair.pitch_point - self.pair.path_start) / self.pair.base_pitch % 1.0
        self.operator = self.cycle.between(phase, phase).operator

    def pressed(self, part: float) -> Pressed:
        operator, exact = self.operator, self.exact.under(part)
        rotation = np.abs(operator.jacobian[:, [self.cycle.coordinates.index(CENTRE_COORDINATES.index("rotation_2"))]])
        solution = pressed(operator, exact.load, rotation)
        return Pressed(float(solution.coordinates[0]), self._errors(solution.forces, exact))

    def _errors(self, forces: np.ndarray, exact: PointContact) -> dict[str, float]:
        face, load = self.cycle.face, np.zeros(self.cycle.face.slices)
        np.add.at(load, [self.operator.pairs[pair].place.slice for pair in self.operator.node_pair], forces)
        # Of a parabola of line loads the second moment is a^2/5, of half an ellipse of pressures b^2/4.
        along = sqrt(5.0 * load @ (face.positions**2 + face.widths**2 / 12.0) / load.sum())
        middle = next(
            k
            for k, pair in enumerate(self.operator.pairs)
            if pair.place.slice == face.slices // 2 and forces[self.operator.node_pair == k].any()
        )
        nodes, own = self.operator.pairs[middle], forces[self.operator.node_pair == middle]
        centre = own @ nodes.offsets / own.sum()
        across = 2.0 * sqrt(own @ (nodes.offsets - centre) ** 2 / own.sum())
        peak = without_oscillation(own / (nodes.lengths * face.widths[face.slices // 2])).max()
        line_load = own.sum() / face.widths[face.slices // 2]
        found = (
            peak / exact.peak_pressure,
            across / exact.short_axis,
            along / exact.long_axis,
            line_load / (0.75 * exact.load / exact.long_axis),
        )
        return {name: float(value) - 1.0 for name, value in zip(QUANTITIES, found)}

    def errors(self) -> dict[str, float]:
        """Of QUANTITIES under the whole load, and of the approach between it and the smaller one."""
        large, small, exact = self.pressed(1.0), self.pressed(SMALLER), (self.exact, self.exact.under(SMALLER))
        found = small.approach / exact[1].load - large.approach / exact[0].load
        return large.errors | {
            "approach": found / (exact[1].approach / exact[1].load - exact[0].approach / exact[0].load) - 1.0
        }


def measure() -> list[Row]:
    rows: list[Row] = []
    for ratio, layers, slices in [
        *((ratio, LAYERS, SLICES) for ratio in RATIOS),
        *((THEIR_RATIO, *coarser) for coarser in COARSER),
    ]:
        rows.append(
            {
                "ratio": ratio,
                "layer": WIDTH / layers / LONG_AXIS,
                "slices": slices / layers,
                **CrownedFlanks(ratio, layers, slices).errors(),
            }
        )
        write_rows(NAME, rows)
    return rows


def section() -> str:
    names = (*QUANTITIES, "approach")
    lines = [
        [
            f"{row['ratio']:g}",
            f"{row['layer']:.2g}",
            f"{row['slices']:.2g}",
            *(f"{100 * row[name]:+.1f}" for name in names),
        ]
        for row in read_rows(NAME)
    ]
    headings = [
        "axis ratio",
        "layer in half-lengths",
        "slices in a layer",
        "peak pressure, %",
        "half-width, %",
        "half-length, %",
        "line load at the middle, %",
        "approach, %",
    ]
    return "\n".join(table(headings, lines))
