"""The rows of `gears check`: what a scene is and what it will cost, without computing it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isinf, log

import numpy as np

from fenics_gears.dynamics.guidance import NOTABLE, effect_of_inertia
from fenics_gears.effects import Effect, every_effect, result_variables
from fenics_gears.geometry.characteristics import characteristics
from fenics_gears.geometry.flank_deviations import v_roll_angle
from fenics_gears.geometry.flank_errors import MEAN
from fenics_gears.geometry.gear_data import Material
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import ISO_6336, Scene

from .cost import SECTOR_UNKNOWNS, expected_cost
from .drivetrain import bore_twist_stiffness, mesh_stiffness
from .expected_errors import error_rows
from .face_resolution import face_discretisation, layers_of_common_face
from .model import Model, model_of
from .motion_rows import Rows, frequency_rows, inertia_rows, period_rows, speed_rows, unknown_rows


@dataclass(frozen=True)
class EffectState:
    """An effect of a scene: whether it is on, what the model is by it or without it, and what it adds."""

    effect: Effect
    on: bool
    words: str
    adds: str = ""


def effect_states(scene: Scene) -> list[EffectState]:
    """Each effect that a scene may have, on or off, in words."""
    states = []
    there = {variable.name for variable in result_variables(scene)}
    for effect in every_effect():
        data = getattr(scene, effect.section)
        if data is None:
            states.append(EffectState(effect, False, effect.absent))
            continue
        if data is scene.misalignment and data.is_none:
            states.append(EffectState(effect, True, f"{effect.absent}, flanks resolved over the face"))
            continue
        results = [variable.name for variable in effect.variables if variable.name in there]
        added = {"unknowns": effect.unknowns, "terms": effect.terms, "results": results}
        words = "; ".join(f"{kind}: {', '.join(names)}" for kind, names in added.items() if names)
        states.append(EffectState(effect, True, effect.description, words))
    return states


def derived_rows(scene: Scene) -> Rows:
    """The figures that a scene leaves out."""
    return [(each.name, each.value, f"{each.unit}, {each.formula}".lstrip(", ")) for each in scene.derived]


def describe(scene: Scene) -> list[tuple[str, Rows]]:
    """Geometry, model, accuracy, natural frequencies and cost of a scene: headings, each with rows (label, value,
    unit). Raises GeometryError for impossible gears."""
    model = model_of(scene)
    derived = derived_rows(scene)
    sections: list[tuple[str, Rows]] = [("Derived, since the scene leaves it out", derived)] if derived else []
    sections += [
        ("Gear pair", [*characteristics(model.pair, scene.measured_over)]),
        ("Model", _model_rows(model)),
        ("Accuracy", _accuracy_rows(model)),
    ]
    if model.drivetrain.mass is not None:
        sections.append(("Inertia", inertia_rows(model)))
        frequencies = frequency_rows(model.vibrations, model.time_step)
        sections.append(("Natural frequencies with one tooth pair in mesh (about)", frequencies))
    sections.append(("Expected cost (about, alone on an idle machine)", _cost_rows(model)))
    if model.warnings:
        sections.append(("Warnings", [("", warning, "") for warning in model.warnings]))
    return sections


def _model_rows(model: Model) -> Rows:
    grid = model.resolution.contact_grid
    force = model.scene.load.wheel_torque / abs(model.pair.wheel.base_radius)
    cut = ", the outermost cut in two" if model.face.slices > model.face.evenly else ""
    each = "normal and tangential force" if model.scene.friction is not None else "normal force"
    touching = "the first to touch carries all"
    friction = model.scene.friction
    if model.scene.tooth_elasticity is not None:
        touching = f"each with a {each} where flanks touch"
    rows: Rows = [*_face_rows(model), *_curve_rows(model), *_stiffness_rows(model), *unknown_rows(model)]
    if model.face.slices == 1:
        rows.append(("contact nodes of a tooth pair", f"{grid.nodes},", touching))
    else:
        rows.append(("slices of the face", f"{model.face.evenly}{cut};", f"their contact nodes: {touching}"))
    rows.append(("equations in time", _method(model), ""))
    if not model.scene.motion.speed_given:
        rows.append(("time", "counts mesh cycles, 1 s each", "for the scene has no speed and needs none"))
    rows.append(("nominal force along the line of action", f"{force:.4g}", "N"))
    if friction is not None:
        origin = f"after {friction.formula}" if friction.formula else ""
        rows.append(("coefficient of friction", model.friction_coefficient, origin))
    return rows + (speed_rows(model) if model.scene.motion.speed_given else [])


def _face_rows(model: Model) -> Rows:
    """Widths, where they or their places differ; of three-dimensional scenes also hands, modifications along the face
    and misalignment."""
    pair = model.pair
    scene = model.scene
    widths: Rows = []
    if pair.axial_offsets != (0.0, 0.0) or pair.face_widths[0] != pair.face_widths[1]:
        places = pair.gear_middles if pair.axial_offsets != (0.0, 0.0) else (None, None)
        each = (
            f"{name} {width:g} mm" + ("" if middle is None else f" about {round(middle, 9) + 0.0:g} mm")
            for name, width, middle in zip(GEARS, pair.face_widths, places)
        )
        widths = [("face width in common", pair.face_width, f"mm: {', '.join(each)}")]
    if not scene.three_dimensional:
        return [*widths, *_plane_rows(model)]
    low, high = pair.common_face
    rows: Rows = [
        *widths,
        ("flanks are resolved over the face", f"z from {low:g} mm to {high:g} mm", "from its middle, left to right"),
    ]
    if pair.helix is not None:
        hand = pair.helix.pinion_hand
        of_wheel = hand if pair.wheel.internal else "left" if hand == "right" else "right"
        rows.append(("hand of the helix", f"pinion {hand}, wheel {of_wheel}", ""))
    for name in GEARS if scene.lead_modifications is not None else ():
        own = getattr(scene.lead_modifications, name)
        relief = None if own is None else own.end_relief
        amounts = _amounts(own, ("crowning", "helix_slope"))
        rows += [(f"{name} {words}", 1e3 * amount, "um") for words, amount in amounts]
        if relief is not None:
            ends = "both ends" if relief.sides == "both" else f"the {relief.sides} end"
            rows.append(
                (f"{name} end relief", 1e3 * relief.depth, f"um, {relief.shape} over {relief.length:g} mm at {ends}")
            )
    if scene.tooth_elasticity is not None:
        common = layers_of_common_face(scene, pair)
        layers = [f"{name} {face_discretisation(model, gear).layers}" for gear, name in enumerate(GEARS)]
        rows.append(("layers of the bodies", f"{', '.join(layers)},", f"{common} of them on the common face"))
    about = "um over the common face, about the pitch point in its middle"
    return rows + [
        (f"misalignment {words}", 1e3 * amount, about)
        for words, amount in _amounts(scene.misalignment, ("in_plane", "out_of_plane"))
    ]


def _stiffness_rows(model: Model) -> Rows:
    """About what stiffness a tooth pair has in the run, and how much of it is twist of the bodies."""
    scene = model.scene
    pair = model.pair
    one = mesh_stiffness(scene, pair)
    twist = bore_twist_stiffness(scene, pair)
    if isinf(one):
        return []
    each = 1e-3 / pair.face_width
    words = "N/(mm um), about"
    if not isinf(twist):
        share = f"{one / twist:.0%} of its deflection is twist of the bodies on their bores"
        words = f"{words}; {share}, {twist * each:.3g} N/(mm um)"
    return [("stiffness of one tooth pair", f"{one * each:.3g}", words)]


def _curve_rows(model: Model) -> Rows:
    rows: Rows = []
    for name in GEARS if model.scene.flank_errors is not None else ():
        own = getattr(model.scene.flank_errors, name)
        gear = getattr(model.pair, name)
        zero = "in their mean" if own.anchor == MEAN else ""
        if own.measured_profile is not None:
            place = zero or f"at diameter {2.0 * float(gear.radius(v_roll_angle(gear))):.6g} mm"
            rows.append((f"{name} profile curves are zero", place, "" if zero else "(V cylinder, d + 2 x m)"))
        if own.measured_helix is not None:
            rows.append((f"{name} helix curves are zero", zero or "at mid-width", ""))
    return rows


OVER_THE_FACE = '[misalignment] with in_plane = "0 um" computes the pair over the face, without this error'


def _plane_rows(model: Model) -> Rows:
    """Of elastic gears in the plane: the widths that count where a gear is wider than the common face, and what plane
    strain leaves out of a narrow face."""
    pair = model.pair
    scene = model.scene
    rows: Rows = []
    if scene.tooth_elasticity is None or scene.accuracy.model == ISO_6336:
        return []
    if pair.effective_face_widths != (pair.face_width, pair.face_width):
        counts = ", ".join(f"{name} {width:.4g} mm" for name, width in zip(GEARS, pair.effective_face_widths))
        words = "of the bodies: the common width, and of what stands out beyond it as much as helps to carry"
        rows.append(("face width that counts", counts, words))
    modules = pair.face_width / pair.pinion.module
    softer = too_stiff(modules, scene.gears.materials)
    if softer >= NOTABLE_STIFFNESS:
        words = f"too stiff (mean transmission error): the face is {modules:.3g} modules wide; {OVER_THE_FACE}"
        rows.append(("plane strain", f"about {softer:.1f}%", words))
    return rows


# By how many per cent the mean transmission error in three dimensions is larger, over the face width in modules:
# docs/third_dimension.md, plane limits, of steel; from how many on it is told.
SOFTER = {0.5: 6.19, 1.0: 5.74, 2.0: 5.02, 4.0: 3.92, 8.0: 2.69, 15.0: 1.77, 30.0: 0.97, 60.0: 0.47}
STEEL = 0.3
NOTABLE_STIFFNESS = 2.0


def too_stiff(widths: float, materials: Sequence[Material]) -> float:
    """Per cent by which the transmission error of a spur pair in plane strain is too small; `widths`: its common face
    width in modules. Its ends are nearer to plane stress, which differs by nu^2."""
    squares = sum(each.poissons_ratio**2 for each in materials) / len(materials)
    return float(np.interp(log(widths), np.log(list(SOFTER)), list(SOFTER.values()))) * squares / STEEL**2


def _amounts(data, names: tuple[str, ...]) -> list[tuple[str, float]]:
    return [(name.replace("_", " "), getattr(data, name)) for name in names if data is not None and getattr(data, name)]


def _method(model: Model) -> str:
    if model.drivetrain.mass is None:
        return "quasi-static"
    if model.time_scales.averages_acceleration:
        return "average acceleration"
    return "backward Euler, " + (
        "forces of rigid flanks being impulsive" if model.time_scales.impulsive else "no vibration being sampled"
    )


def _accuracy_rows(model: Model) -> Rows:
    resolution = model.resolution
    asked = model.scene.accuracy

    def origin(value) -> str:
        return "" if value is None else ", from the scene"

    def given(label: str, value) -> Rows:
        return [(label, f"{value}, from the scene", "")] if value else []

    elastic: Rows = [
        ("Hertz half-width at full load", f"{resolution.half_width:.4g}", "mm"),
        ("element", resolution.element + origin(asked.element), ""),
        ("flank element size", f"{resolution.flank_element_size:.4g}", "mm" + origin(asked.flank_element_size)),
        *([("body element size", asked.body_element_size, "mm, from the scene")] if asked.body_element_size else []),
        *given("interpolation", asked.interpolation),
        *given("elastic teeth", asked.elastic_teeth),
    ]
    condensation: Rows = [("condensation", resolution.condensation + origin(asked.condensation), "")]
    how = "a run chooses settings first, by two or three coarse test runs; what follows is without a target"
    return [
        *([("target", f"{asked.target:.3%}:", how)] if asked.target else []),
        *given("model of the mesh", asked.model),
        *(elastic if model.resolution.element in SECTOR_UNKNOWNS else []),
        ("contact length", f"{resolution.contact_grid.length:.4g}", "mm" + origin(asked.contact_length)),
        ("contact node spacing", f"{resolution.contact_grid.spacing:.4g}", "mm" + origin(asked.contact_nodes)),
        *(condensation if model.scene.tooth_elasticity is not None else []),
        ("steps per mesh cycle", f"{resolution.steps_per_mesh_cycle}{origin(asked.steps_per_mesh_cycle)}", ""),
        ("time step" if model.scene.speed_ramp is None else "time step, the longest", f"{model.time_step:.4g}", "s"),
        ("steps", f"{model.steps}, {_contact_fields(model)}", ""),
        *period_rows(model),
        *error_rows(model),
    ]


def _contact_fields(model: Model) -> str:
    if not model.scene.resolves_contact:
        return "curves are stored for all"
    count = f"the last {model.contact_steps}" if model.contact_steps else "none"
    return f"curves are stored for all, contact fields for {count}"


# Bytes; fewer are always kept.
NOTABLE_OPERATORS = 1e9


def _cost_rows(model: Model) -> Rows:
    """Expected cost; where inertia hardly matters also that of the quasi-static scene, at its own number of steps."""
    rows = _cost(model)
    slowest = next((vibration for vibration in model.vibrations if vibration.excited), None)
    if slowest is None or effect_of_inertia(slowest, model.scene.mesh_frequencies[1]) >= NOTABLE:
        return rows
    static = model_of(replace(model.scene, inertia=None, damping=None, speed_ramp=None))
    cost = {label: (value, unit) for label, value, unit in _cost(static)}
    return rows + [
        ("quasi-static instead: steps per mesh cycle", static.resolution.steps_per_mesh_cycle, ""),
        *((f"quasi-static instead: {label}", *cost[label]) for label in ("marching", "memory")),
    ]


def _cost(model: Model) -> Rows:
    cost = expected_cost(model)
    rows: Rows = [(f"unknowns of {words}", f"{count:.0f}", "") for words, count in cost.unknowns]
    rows += [(f"condensing {words}", way, "") for words, way in cost.ways]
    if cost.condensing is not None:
        rows.append(("meshing and condensing, unless cached", f"{cost.condensing:.1f}", "s"))
    rows += [("marching", f"{cost.marching:.1f}", "s"), ("memory", f"{cost.memory / 1e6:.0f}", "MB")]
    if cost.operators > NOTABLE_OPERATORS:
        rows.append(("memory if contact operators are not kept", f"{cost.held / 1e6:.0f}", "MB"))
    return rows
