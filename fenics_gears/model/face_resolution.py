"""How finely the face of a pair is resolved: the scene's own `[accuracy]` values, and for the rest defaults."""

from __future__ import annotations

from cmath import exp, pi
from collections.abc import Callable
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.contact.face import Face, even_slices, finer_ends
from fenics_gears.elasticity.face.coarse_cuts import ENOUGH
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.elasticity.face.layers import SweptWeb
from fenics_gears.geometry.face import coast_face_opening as coast_face_opening
from fenics_gears.geometry.face import face_opening as face_opening
from fenics_gears.geometry.gear_data import mean_youngs_modulus
from fenics_gears.geometry.pair import GearPair
from fenics_gears.scene.accuracy import (
    FEWEST_LAYERS,
    FEWEST_SLICES,
    LARGEST_LAYER_TURN,
    LAYER_THICKNESS,
    SECTION_SIZE,
    SLICE_RISE,
    SLICE_WIDTH,
)
from fenics_gears.scene.data import Scene

if TYPE_CHECKING:
    from .model import Model

# Where part of the face carries.
FEWEST_LOADED_SLICES = 6
# From so many slices on the outermost of helical pairs are cut in two.
FEWEST_WITH_FINER_ENDS = 8
# Of lines of contact that come to the next slice at the same time, and how many slices more are tried against it.
IN_STEP = 0.5
MORE_SLICES = 3
# An overhang of less than this part of a layer belongs to the layer beside it.
LEAST_OVERHANG = 0.1


def face_of(scene: Scene, pair: GearPair) -> Face:
    """The slices of the common face, all of one width; of helical pairs the outermost are cut in two.

    There a line of contact begins and ends, and the transmission error has a cusp: near a whole overlap its
    peak-to-peak value was up to 6 % too large without the cut (30 degrees, sharp tips), 1 % with it.
    """
    slices = scene.accuracy.slices or _fewest_slices(scene, pair)
    even = even_slices(pair.face_width, slices)
    cut = pair.slope and slices >= FEWEST_WITH_FINER_ENDS
    return Face(*(finer_ends(*even) if cut else even), pair.slope, pair.gear_middles)


def _fewest_slices(scene: Scene, pair: GearPair) -> int:
    """Slices by their width and, of a helical pair, by how far its line of contact moves within one; some more where
    else lines of contact came to the next slice at the same time."""
    moves = SLICE_RISE * pair.base_pitch / abs(pair.slope) if pair.slope else np.inf
    fewest = max(ceil(pair.face_width / min(SLICE_WIDTH * scene.gears.module, moves) - 1e-9), FEWEST_SLICES)
    if round(pair.overlap_ratio) < 2:
        return fewest
    counts = range(fewest, fewest + MORE_SLICES + 1)
    in_step = {count: lines_in_step(pair.overlap_ratio, count / pair.overlap_ratio) for count in counts}
    return next((count for count in counts if in_step[count] <= IN_STEP), min(counts, key=in_step.__getitem__))


def lines_in_step(overlap_ratio: float, slices: float) -> float:
    """How far lines of contact come to the next slice at the same time, up to 1; `slices` in a base pitch: of a whole
    number all do, and what each slice adds to the transmission error adds up."""
    lines = max(round(overlap_ratio), 1)
    return abs(sum(exp(2j * pi * line * slices) for line in range(lines))) / lines


def layers_of_common_face(scene: Scene, pair: GearPair) -> int:
    """How many layers of either body are on the common face; an even number of many (`coarse_cuts.narrow_sweep`)."""
    if scene.accuracy.layers:
        return scene.accuracy.layers
    turn = abs(pair.slope) / min(map(abs, pair.base_radii))
    turns = LARGEST_LAYER_TURN / turn if turn else np.inf
    fewest = max(ceil(pair.face_width / min(LAYER_THICKNESS * scene.gears.module, turns) - 1e-9), FEWEST_LAYERS)
    return fewest + fewest % 2 if fewest > ENOUGH else fewest


# Length of the window of contact nodes where no edge is near, in half-widths of the contact; and mesh stiffness per
# face width, as a part of Young's modulus:
# the largest line load is the mean one and this stiffness times the largest difference of openings along the face.
INNER_HALF_WIDTHS = 3.0
# Deviations of single teeth along the face are not among these openings.
INNER_HALF_WIDTHS_OF_ERRORS = 4.5
MESH_STIFFNESS = 0.1


def inner_length(scene: Scene, pair: GearPair, line_load: float, half_width_of: Callable[[float], float]) -> float:
    """Length (mm) of that window, for the largest line load that is expected; `half_width_of`: half-width (mm) of the
    contact under a line load (N/mm)."""
    opening = face_opening(pair, scene.lead_modifications, scene.misalignment, np.linspace(*pair.common_face, 21))
    largest = line_load + MESH_STIFFNESS * mean_youngs_modulus(scene.tooth_elasticity) * float(np.ptp(opening))
    many = INNER_HALF_WIDTHS if scene.flank_errors is None else INNER_HALF_WIDTHS_OF_ERRORS
    return many * half_width_of(largest)


def face_discretisation(model: Model, gear: int) -> FaceDiscretisation:
    """How the body of the pinion (0) or the wheel (1) is divided over its face."""
    pair = model.pair
    common = layers_of_common_face(model.scene, model.pair)
    width = pair.face_widths[gear]
    thickness = pair.face_width / common
    overhang = 0.5 * (width - pair.face_width)
    beyond = 0
    # Where a gear reaches as far beyond the common face at either end, layers begin with that face, and are alike
    # towards both ends.
    if overhang > LEAST_OVERHANG * thickness and abs(pair.gear_middles[gear]) < LEAST_OVERHANG * thickness:
        beyond = ceil(overhang / thickness - LEAST_OVERHANG)
    layers = common + 2 * beyond if beyond else ceil(width / thickness - LEAST_OVERHANG)
    twist = (1.0, -1.0)[gear] * pair.slope / pair.gears[gear].base_radius
    section_size = model.scene.accuracy.body_element_size or SECTION_SIZE * model.scene.gears.module
    web = pair.gears[gear].web
    swept = web and SweptWeb(
        web.hub_radius, web.rim_radius, *(width * (web.offset + side * web.share) for side in (-0.5, 0.5))
    )
    return FaceDiscretisation(section_size, layers, width, twist, overhang if beyond else 0.0, beyond, swept)


def check_layers(model: Model) -> None:
    for gear in range(2):
        face_discretisation(model, gear).check()


def face_warnings(model: Model) -> list[str]:
    """Sentences where too few slices carry the load."""
    slices = model.face.evenly
    sentences = []
    part = loaded_part(model)
    if part < 1.0 and part * slices < FEWEST_LOADED_SLICES:
        sentences.append(
            f"accuracy.slices = {slices}: about {part:.2g} of the face carries under this load, {part * slices:.2g}"
            " slices of it; pairs that carry on less than a slice are missed. Take accuracy.slices ="
            f" {ceil(FEWEST_LOADED_SLICES / part)}"
        )
    return sentences


def loaded_part(model: Model) -> float:
    """About which part of the face carries, from its opening at the pitch point and the mesh stiffness."""
    places = np.linspace(*model.pair.common_face, 401)
    # How far each place stands back from the first that touches, by increasing distance, and the approach at which the
    # load reaches so far.
    opening = np.sort(model.face_opening(places))
    stiffness = MESH_STIFFNESS * mean_youngs_modulus(model.scene.tooth_elasticity)
    carried = stiffness * (opening * np.arange(len(places)) - np.cumsum(np.insert(opening[:-1], 0, 0.0))) / len(places)
    line_load = model.pair.force_of(model.scene.load.wheel_torque) / model.pair.face_width
    return float((carried <= line_load).mean())
