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
from fenics_gears.elasticity.cache import Cache, user_cache
from fenics_gears.geometry.lead_modification import LeadModification, LeadModifications
from fenics_gears.model.face_resolution import FEWEST_LOADED_SLICES, loaded_part
from fenics_gears.model.model import Model
from fenics_gears.model.resolution import plane_contact_modulus, relative_radius
from fenics_gears.results.mesh_curves import without_oscillation
from fenics_gears.scene.accuracy import SECTION_SIZE
from fenics_gears.scene.data import Accuracy
from fenics_gears.simulation.elastic_route import elastic_route
from fenics_gears.system.progress import SilentProgress

NAME = "crowned"
# Modules: half of the ellipse's length.
LONG_AXIS = 0.5
RATIOS = (3.0, 5.0, 10.0, 20.0, 40.0)
THEIR_RATIO = 10.0
# Flank elements in half the short axis, window in short half-axes, distance of contact nodes in elements, the smaller
# load.
ELEMENTS, WINDOW, SPACING, SMALLER = 4, 5.0, 0.7, 0.25
QUANTITIES = ("peak_pressure", "short_axis", "long_axis", "line_load")


@dataclass(frozen=True)
class Sizes:
    """Face, layers and slices; elements of the body's section, and the face, in modules. `fine`: whether flank elements
    and contact nodes are those of the ellipse, the program's own else."""

    layers: int | None = 8
    slices: int = 31
    width: float = 1.5
    section: float = 0.2
    fine: bool = True


FINE = Sizes()
# Coarser bodies, slices that are narrow in thick layers, and default sizes on a wide face, whose slices are those that
# `gears check` asks for: some of them even, so that the ellipse's middle is between two.
COARSER = (Sizes(4, 8), Sizes(2, 4), Sizes(2, 31), Sizes(2, 31, section=0.5))
WIDE = 6.0


@dataclass(frozen=True)
class Pressed:
    """A solution: approach (mm), and errors of QUANTITIES against Hertz."""

    approach: float
    errors: dict[str, float]


def crowned(ratio: float, sizes: Sizes = FINE) -> tuple[Model, PointContact]:
    """The pair crowned so that an ellipse of LONG_AXIS and an axis ratio comes out under Hertz's load."""
    gears = standard_pair(sizes.width * MODULE)
    pair, plain = gear_pair(gears), scene_of(gears, Accuracy())
    long_axis, radius = LONG_AXIS * MODULE, relative_radius(pair, pair.pitch_point)
    exact = PointContact(long_axis, long_axis / ratio, radius, plane_contact_modulus(plain))
    accuracy = Accuracy(
        steps_per_mesh_cycle=1, slices=sizes.slices, layers=sizes.layers, body_element_size=sizes.section * MODULE
    )
    if sizes.fine:
        size, length = exact.short_axis / ELEMENTS, WINDOW * exact.short_axis
        accuracy = replace(
            accuracy, flank_element_size=size, contact_length=length,
            contact_nodes=2 * ceil(0.5 * length / (SPACING * size)) + 1,
        )  # fmt: skip
    crowning = LeadModification(crowning=gears.face_width**2 / (8.0 * exact.radius_along))
    scene = scene_of(gears, accuracy, exact.load / gears.face_width)
    scene = replace(scene, misalignment=None, lead_modifications=LeadModifications(pinion=crowning))
    return model_of(scene), exact


class CrownedFlanks:
    """The pair at the pitch point. The middle of the face stands on the boundary of two layers, where the coarse body
    errs most."""

    def __init__(self, ratio: float, sizes: Sizes = FINE, cache: Cache | None = None):
        self.model, self.exact = crowned(ratio, sizes)
        pair = self.model.pair
        self.cycle = elastic_route(self.model, SilentProgress(), cache or user_cache())[1]
        phase = (pair.pitch_point - pair.path_start) / pair.base_pitch % 1.0
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


def default_sizes(ratio: float) -> Sizes:
    """On a wide face, with the slices that the program's warning asks for."""
    sizes = Sizes(layers=None, width=WIDE, section=SECTION_SIZE, fine=False)
    part = loaded_part(crowned(ratio, sizes)[0])
    return replace(sizes, slices=ceil(FEWEST_LOADED_SLICES / part))


def measure() -> list[Row]:
    rows: list[Row] = []
    for ratio, sizes in [
        *((ratio, FINE) for ratio in RATIOS),
        *((THEIR_RATIO, coarser) for coarser in COARSER),
        *((ratio, default_sizes(ratio)) for ratio in RATIOS),
    ]:
        flanks = CrownedFlanks(ratio, sizes)
        slices, layers = flanks.model.slices_and_layers
        kept = {
            "ratio": ratio, "width": sizes.width, "section": sizes.section, "fine": sizes.fine,
            "layer": sizes.width / layers / LONG_AXIS, "slice": sizes.width / slices / LONG_AXIS,
        }  # fmt: skip
        rows.append(kept | flanks.errors())
        print(rows[-1], flush=True)
        write_rows(NAME, rows)
    return rows


def section() -> str:
    names = (*QUANTITIES, "approach")
    lines = [
        [
            f"{row['ratio']:g}", f"{row['width']:g}", "ellipse" if row["fine"] else "default",
            *(f"{row[name]:.2g}" for name in ("section", "layer", "slice")),
            *(f"{100 * row[name]:+.1f}" for name in names),
        ]
        for row in read_rows(NAME)
    ]  # fmt: skip
    headings = [
        "axis ratio", "face in modules", "flank elements of the", "section's elements, modules",
        "layer in half-lengths", "slice in half-lengths",
        "peak pressure, %", "half-width, %", "half-length, %", "line load at the middle, %", "approach, %",
    ]  # fmt: skip
    return "\n".join(table(headings, lines))
