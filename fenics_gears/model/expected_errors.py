"""Errors that numbers over the face are expected to have by the sizes of slices, flank elements and layers.

Each size adds an error with a power of its own; they add as roots of squares. Errors and powers are the upper limits of
ten helical pairs of 12 to 33 degrees, each size twice as coarse and up to four times as fine as by default
(docs/evidence/third_dimension.md, "Defaults"). Steps of a mesh cycle and plane strain near the contact are not in them.
"""

from __future__ import annotations

from math import hypot
from typing import TYPE_CHECKING

from fenics_gears.scene.accuracy import LAYER_THICKNESS, RESOLVED, SLICE_RISE

from .drivetrain import line_load, mesh_stiffness
from .face_resolution import layers_of_common_face, lines_in_step, loaded_part

if TYPE_CHECKING:
    from .model import Model
    from .motion_rows import Rows

# Sizes, in those of the defaults: width of slices in modules, how far a line of contact moves within one in base
# pitches, the larger of the two; flank elements in the Hertz half-width; layers in modules.
WIDTH = "width"
RISE = "rise"
SLICES = "slices"
FLANK = "flank elements"
LAYERS = "layers"
OF_SLICES = (WIDTH, RISE, SLICES)
MEAN = "mean transmission error"
# In parts of the mean.
SPAN = "peak to peak"
FACE_LOAD = "K_Hbeta"
LINE_LOAD = "line load away from edges"
PRESSURE = "peak pressure"
# By size the relative error at that of the defaults, and the power of the size that it goes with. K_Hbeta is averaged
# over half a module.
MEASURED = {
    MEAN: {RISE: (0.0025, 1.3), FLANK: (0.0001, 2.0), LAYERS: (0.0012, 2.0)},
    SPAN: {SLICES: (0.003, 2.5), FLANK: (0.0002, 2.0), LAYERS: (0.0002, 2.0)},
    FACE_LOAD: {WIDTH: (0.0013, 1.0), FLANK: (0.001, 2.0), LAYERS: (0.0013, 2.0)},
    LINE_LOAD: {SLICES: (0.01, 3.3), FLANK: (0.006, 2.0), LAYERS: (0.0055, 2.0)},
    PRESSURE: {SLICES: (0.026, 1.6), FLANK: (0.02, 2.0), LAYERS: (0.004, 2.0)},
}
LEAST_IN_STEP = 0.5
# The default when these were measured, in modules.
MEASURED_WIDTH = 0.7


def expected_errors(model: Model) -> dict[str, dict[str, float]]:
    """Relative errors by number and size, of a helical pair that is loaded."""
    pair = model.pair
    module = model.scene.gears.module
    slice_width = pair.face_width / model.face.evenly
    width = slice_width / (MEASURED_WIDTH * module)
    rise = slice_width * abs(pair.slope) / (SLICE_RISE * pair.base_pitch)
    sizes = {
        WIDTH: width,
        RISE: rise,
        SLICES: max(width, rise),
        FLANK: RESOLVED * model.resolution.flank_element_size / model.resolution.half_width,
        LAYERS: pair.face_width / layers_of_common_face(model.scene, pair) / (LAYER_THICKNESS * module),
    }
    errors = {
        name: {size: error * sizes[size] ** power for size, (error, power) in parts.items()}
        for name, parts in MEASURED.items()
    }
    if rise:
        errors[SPAN][SLICES] *= max(lines_in_step(pair.overlap_ratio, 1.0 / (rise * SLICE_RISE)), LEAST_IN_STEP)
    return errors


def all_together(model: Model) -> dict[str, float]:
    """Relative errors by number: sizes have nothing to do with one another."""
    return {name: hypot(*parts.values()) for name, parts in expected_errors(model).items()}


def error_rows(model: Model) -> Rows:
    """The row of `gears check`; none in the plane, or where nothing gives way."""
    label = "expected errors"
    if model.face.slices == 1 or model.scene.tooth_elasticity is None or not model.resolution.half_width:
        return []
    if not model.pair.slope or loaded_part(model) < 1.0:
        where = "of helical pairs alone" if not model.pair.slope else "where the whole face carries"
        return [(label, "not known,", f"they are {where}; `gears accuracy` measures yours")]
    errors = all_together(model)
    force = line_load(model.scene, model.pair) * model.pair.face_width
    span = 1e6 * errors[SPAN] * force / mesh_stiffness(model.scene, model.pair)
    words = [
        f"{name} {float(f'{span:.1g}'):g} nm" if name == SPAN else f"{name} {100.0 * error:.1f} %"
        for name, error in errors.items()
    ]
    return [(label, ", ".join(words), "")]
