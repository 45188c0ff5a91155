"""What a scene is and what it will cost, told without computing it: the rows of `gears check`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import lcm

import numpy as np

from fenics_gears.dynamics.frequencies import PERIOD_ERROR
from fenics_gears.dynamics.guidance import NOTABLE, effect_of_inertia, resolved_frequency
from fenics_gears.effects import EFFECTS, Effect, effects_on, result_variables
from fenics_gears.geometry.characteristics import characteristics
from fenics_gears.memory import flank_bytes, flank_unknowns, loaded_pairs, operator_bytes
from fenics_gears.model import Model, model
from fenics_gears.resolution import EVERY_STEP
from fenics_gears.scene.data import Scene

Rows = list[tuple[str, object, str]]

# Unknowns of a sector mesh: a body part and one part per flank node; fitted to meshes from 0.16 to 0.01 mm of the paper's pair.
SECTOR_UNKNOWNS = {"P1": (5200, 35.0), "P2": (2300, 30.0), "Q1": (6500, 31.0), "Q1 incompatible": (6500, 31.0), "Q2": (3000, 35.0)}
# Seconds, on one core of 2020s: a gear's mesh and set-up, each unknown, the cube of flank dofs, the square of contact rows, a step.
SECONDS_PER_GEAR, SECONDS_PER_UNKNOWN, SECONDS_PER_FLANK_CUBE = 0.2, 2e-5, 1e-10
SECONDS_PER_CONTACT_SQUARE, SECONDS_PER_STEP = 6e-8, 8e-5
# The same of the reference route: an unknown of a remeshed sector, the cube of contact rows of a step, matrices of a position.
SECONDS_PER_REMESHED_UNKNOWN, SECONDS_PER_ROW_CUBE, MATRICES_PER_POSITION = 1.2e-5, 1.5e-10, 7
BYTES_OF_PROGRAM = 300e6


@dataclass(frozen=True)
class Description:
    """Headings, each with rows (label, value, unit)."""

    sections: tuple[tuple[str, Rows], ...]


@dataclass(frozen=True)
class EffectState:
    """An effect of a scene: whether it is on, what the model is by it or without it, and what it adds."""

    effect: Effect
    on: bool
    words: str
    adds: str = ""


def effect_states(scene: Scene) -> list[EffectState]:
    """Every effect there is, as the scene has it."""
    states, there = [], {variable.name for variable in result_variables(scene)}
    for effect in EFFECTS:
        if getattr(scene, effect.section) is None:
            states.append(EffectState(effect, False, effect.absent))
            continue
        results = [variable.name for variable in effect.variables if variable.name in there]
        added = {"unknowns": effect.unknowns, "terms": effect.terms, "results": results}
        states.append(EffectState(effect, True, effect.description, "; ".join(f"{kind}: {', '.join(names)}" for kind, names in added.items() if names)))
    return states


def describe(scene: Scene) -> Description:
    """Describe a scene: geometry, model, accuracy, natural frequencies, cost. Raises GeometryError for impossible gears."""
    built = model(scene)
    sections = [("Gear pair", characteristics(built.pair)), ("Model", _model_rows(built)), ("Accuracy", _accuracy_rows(built))]
    if built.drivetrain.mass is not None:
        sections.append(("Natural frequencies with one tooth pair in mesh (about)", _frequency_rows(built)))
    sections.append(("Expected cost (about)", _cost_rows(built)))
    if built.warnings:
        sections.append(("Warnings", [("", warning, "") for warning in built.warnings]))
    return Description(tuple(sections))


def _tangential(built: Model) -> int:
    return 2 if built.scene.friction is not None else 1


def _contact_rows(built: Model) -> float:
    """Rows of the contact operator, on the average over the mesh cycle."""
    return _tangential(built) * built.resolution.contact_grid.nodes * loaded_pairs(built)


def _model_rows(built: Model) -> Rows:
    grid = built.resolution.contact_grid
    each = "normal and tangential force" if built.scene.friction is not None else "normal force"
    touching = f"each a {each} where closed" if built.scene.tooth_elasticity is not None else "the first to touch carries all"
    return [
        ("centre coordinates", len(built.drivetrain.coordinates), ", ".join(built.drivetrain.coordinates)),
        ("contact nodes of a tooth pair", grid.nodes, touching),
        ("equations in time", _method(built), ""),
        ("nominal transmitted force T/rb2", built.scene.load.wheel_torque / built.pair.wheel.base_radius, "N"),
    ]


def _method(built: Model) -> str:
    if built.drivetrain.mass is None:
        return "quasi-static"
    if built.pace.averages_acceleration:
        return "average acceleration"
    return "backward Euler, " + ("forces of rigid flanks being impulsive" if built.pace.impulsive else "no vibration being sampled")


def _accuracy_rows(built: Model) -> Rows:
    resolution, asked = built.resolution, built.scene.accuracy

    def origin(value) -> str:
        return "" if value is None else ", from the scene"

    elastic: Rows = [
        ("Hertz half-width at full load", resolution.half_width, "mm"),
        ("element", resolution.element, origin(asked.element).lstrip(", ")),
        ("flank element size", resolution.flank_element_size, "mm" + origin(asked.flank_element_size)),
        *([("body element size", asked.body_element_size, "mm, from the scene")] if asked.body_element_size else []),
        *([("interpolation", asked.interpolation, "from the scene")] if asked.interpolation else []),
        *([("elastic teeth", asked.elastic_teeth, "from the scene")] if asked.elastic_teeth else []),
    ]
    condensation: Rows = [("condensation", resolution.condensation, origin(asked.condensation).lstrip(", "))]
    return [
        *([("target", f"{asked.target:.3%}", "a run chooses settings first, by ten to sixteen test runs; what follows is without a target")] if asked.target else []),
        *([("model of the mesh", asked.model, "from the scene")] if asked.model else []),
        *(elastic if built.resolution.element in SECTOR_UNKNOWNS else []),
        ("contact length", resolution.contact_grid.length, "mm" + origin(asked.contact_length)),
        ("contact node spacing", resolution.contact_grid.spacing, "mm" + origin(asked.contact_nodes)),
        *(condensation if built.scene.tooth_elasticity is not None else []),
        ("steps per mesh cycle", resolution.steps_per_mesh_cycle, origin(asked.steps_per_mesh_cycle).lstrip(", ")),
        ("time step" if built.scene.speed_ramp is None else "time step, the longest", built.time_step, "s"),
        ("steps", built.steps, f"the last {built.stored_steps} stored"),
    ]


def _frequency_rows(built: Model) -> Rows:
    """Each natural frequency with the steps that a period has, and the limits of what a step resolves and samples."""
    rows: Rows = []
    for number, vibration in enumerate(built.vibrations, 1):
        steps, unmoved = vibration.steps_per_period(built.time_step), "" if vibration.excited else ", not excited by the mesh"
        damped = f", damping ratio {vibration.damping_ratio:.2g}" if vibration.damping_ratio > 0.0 else ", undamped"
        rows.append((f"mode {number}", vibration.frequency, f"Hz: {steps:.3g} steps a period{damped}{unmoved}"))
    rows.append(("resolved by the time step", resolved_frequency(built.time_step), f"Hz: periods right within {PERIOD_ERROR:.0%}"))
    rows.append(("highest frequency that is sampled", 0.5 / built.time_step, "Hz: two steps a period"))
    return rows


def _cost_rows(built: Model) -> Rows:
    """Expected cost; where inertia hardly matters also that of the quasi-static scene, at its own number of steps."""
    rows = _cost(built)
    slowest = next((vibration for vibration in built.vibrations if vibration.excited), None)
    if slowest is None or effect_of_inertia(slowest, built.scene.mesh_frequencies[1]) >= NOTABLE:
        return rows
    static = model(replace(built.scene, inertia=None, damping=None, speed_ramp=None))
    cost = {label: (value, unit) for label, value, unit in _cost(static)}
    return rows + [
        ("quasi-static instead: steps per mesh cycle", static.resolution.steps_per_mesh_cycle, ""),
        *((f"quasi-static instead: {label}", *cost[label]) for label in ("marching", "memory")),
    ]


def _cost(built: Model) -> Rows:
    if built.resolution.element not in SECTOR_UNKNOWNS:
        memory = BYTES_OF_PROGRAM + built.stored_bytes
        return [("marching", f"{built.steps * SECONDS_PER_STEP:.1f}", "s"), ("memory", f"{memory / 1e6:.0f}", "MB")]
    order = 2 if built.resolution.element.endswith("2") else 1
    body, per_node = SECTOR_UNKNOWNS[built.resolution.element]
    unknowns, flank_dofs, of = [], [], []
    for name in ("pinion", "wheel"):
        gear, meshed = getattr(built.pair, name), _meshed(built, name)
        dofs = flank_unknowns(gear, order, built.resolution.flank_element_size)
        unknowns.append(body + per_node * 0.5 * dofs if meshed is None else meshed)
        # Of all teeth, where each has a compliance of its own: memory goes by the square.
        flank_dofs.append(dofs * (1.0 if meshed is None else np.sqrt(gear.teeth)))
        of.append(f"a {name} sector" if meshed is None else f"the whole {name}")
    if built.resolution.condensation == EVERY_STEP:
        condensing, marching, memory = _reference_cost(built, unknowns, order)
    else:
        condensing, marching, memory = _fast_cost(built, unknowns, flank_dofs)
    return [
        *((f"unknowns of {words}", f"{count:.0f}", "") for words, count in zip(of, unknowns)),
        ("meshing and condensing, unless cached", f"{condensing:.1f}", "s"),
        ("marching", f"{marching:.1f}", "s"),
        ("memory", f"{memory / 1e6:.0f}", "MB"),
    ]


def _meshed(built: Model, name: str) -> int | None:
    """Unknowns of a gear that an effect has a mesh of its own for; None for a ring of sectors."""
    for effect in effects_on(built.scene):
        if effect.unknowns_of is not None:
            return effect.unknowns_of(getattr(built.scene, effect.section), built, name)
    return None


def _unlike_cycles(built: Model) -> int:
    """Mesh cycles of the run that can have contact operators of their own: as many as pass until the same teeth of meshed gears meet."""
    teeth = [getattr(built.pair, name).teeth for name in ("pinion", "wheel") if _meshed(built, name) is not None]
    return min(lcm(*teeth), built.scene.motion.mesh_cycles)


def _fast_cost(built: Model, unknowns: list[float], flank_dofs: list[float]) -> tuple[float, float, float]:
    """Seconds of condensing and of marching, bytes."""
    rows = _contact_rows(built)
    positions = min(_unlike_cycles(built) * built.resolution.steps_per_mesh_cycle, built.steps + 2)
    condensing = sum(
        SECONDS_PER_GEAR + SECONDS_PER_UNKNOWN * n + SECONDS_PER_FLANK_CUBE * dofs**3 for n, dofs in zip(unknowns, flank_dofs)
    )
    marching = positions * SECONDS_PER_CONTACT_SQUARE * rows**2 + built.steps * SECONDS_PER_STEP
    operators = operator_bytes(positions, rows, built.scene.friction is not None)
    return condensing, marching, BYTES_OF_PROGRAM + built.stored_bytes + operators + sum(map(flank_bytes, flank_dofs))


def _reference_cost(built: Model, unknowns: list[float], order: int) -> tuple[float, float, float]:
    """The same where every loaded sector is meshed anew at every position."""
    positions, grid = built.resolution.steps_per_mesh_cycle, built.resolution.contact_grid
    pairs = _contact_rows(built) / (_tangential(built) * grid.nodes)
    rows = 2 * pairs * (order * (grid.nodes - 1) + 1)
    condensing = positions * pairs * SECONDS_PER_REMESHED_UNKNOWN * sum(unknowns)
    marching = built.steps * (5.0 * SECONDS_PER_STEP + SECONDS_PER_ROW_CUBE * rows**3)
    return condensing, marching, BYTES_OF_PROGRAM + 8.0 * positions * MATRICES_PER_POSITION * rows**2
