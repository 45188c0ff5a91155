"""The settings of `[accuracy]`, each refined alone from level to level, and the expected order of its error."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isclose

from fenics_gears.contact.interpolation import AVERAGED
from fenics_gears.errors import SceneError
from fenics_gears.model.model import Model, model_of
from fenics_gears.model.resolution import EVERY_STEP, ONCE
from fenics_gears.scene.data import Scene
from fenics_gears.studies.accuracy.setting import Setting, half_width, own_setting, without_settings

# Elements and contact nodes in a half-width, body elements in parts of their default, the window in parts of the default, steps in a cycle.
FULL = {
    "flank elements": (0.7, 1.0, 2.0, 4.0, 8.0), "contact nodes": (1.0, 2.0, 4.0, 8.0), "body elements": (4.0, 2.0, 1.0, 0.5, 0.25),
    "contact length": (0.25, 0.5, 0.75, 1.0, 1.25), "steps": (20, 40, 80, 160, 320, 640),
}  # fmt: skip
QUICK = {
    "flank elements": (0.7, 1.4, 2.8), "contact nodes": (0.7, 1.4, 2.8), "body elements": (4.0, 2.0, 1.0),
    "contact length": (0.5, 1.0), "steps": (10, 20, 40),
}  # fmt: skip
# Values of the settings while another one is refined: one halving before the finest level; steps, which cost memory, three.
FINE = {"flank elements": 4.0, "contact nodes": 4.0, "body elements": 0.5, "contact length": 1.0, "steps": 80}
QUICK_FINE = {"flank elements": 1.4, "contact nodes": 1.4, "body elements": 1.0, "contact length": 1.0, "steps": 20}
# Gears meshed anew at every step take a hundred times as long, so that both ways of condensing are compared at a coarser setting.
REMESHED_FINE = {"flank elements": 2.0, "contact nodes": 2.0, "body elements": 1.0, "steps": 20}
CHOICES = {"element": ("P1", "Q1", "Q1 incompatible", "P2", "Q2"), "interpolation": ("collocated", AVERAGED)}
QUICK_CHOICES = {"element": ("P1", "P2"), "interpolation": CHOICES["interpolation"]}
FLANK, NODES, BODY, STEPS, LENGTH = "flank element size", "contact node spacing", "body element size", "steps per mesh cycle", "contact length"


@dataclass(frozen=True)
class Level:
    """A value of a setting. `size` goes to zero as it is refined; None for a choice. `own`: the scene's, between the levels."""

    label: str
    setting: Setting
    size: float | None = None
    own: bool = False


@dataclass(frozen=True)
class Refinement:
    """A setting, its levels from coarse to fine, the order expected of its error; None where there is no power law.

    base: the whole setting in which it is refined and from which its levels are measured, where that is not the fine one.
    """

    name: str
    field: str
    levels: tuple[Level, ...]
    expected: float | None
    why: str
    base: Setting | None = None

    def level_of(self, setting: Setting) -> int | None:
        """On which level a whole setting stands; None for none."""
        value = getattr(setting, self.field)
        return next((place for place, level in enumerate(self.levels) if _same(getattr(level.setting, self.field), value)), None)


def checked_model(scene: Scene) -> Model:
    """The model of a scene whose accuracy can be measured. Raises SceneError for others."""
    model = model_of(scene)
    if not scene.resolves_contact:
        raise SceneError("gears accuracy needs the full contact of elastic flanks: give [gears.material], and leave out accuracy.model")
    if model.resolution.condensation == EVERY_STEP:
        raise SceneError('accuracy.condensation = "every step": accuracy is measured on the fast route. Take "once", or leave it out.')
    if scene.body_meshes is not None:
        raise SceneError("[body_meshes]: a mesh that is given cannot be refined, and its error not be measured. Leave the section out.")
    if not scene.load.wheel_torque:
        raise SceneError("load.wheel_torque is 0: without load nothing gives way and there is no error to measure. Give a torque.")
    return model


def expected_orders(scene: Scene) -> dict[str, tuple[float, str]]:
    """For each setting the expected order of its error, and why."""
    return {
        FLANK: (2.0, "straight sides on a curved flank: h^2, whatever the element's order"),
        NODES: _order_of_nodes(scene),
        BODY: (2.0, "straight sides along the outline: h^2"),
        STEPS: _order_in_time(scene),
    }


def fine(scene: Scene, quick: bool = False) -> Setting:
    """The setting in which one at a time is refined."""
    values, unit = QUICK_FINE if quick else FINE, half_width(scene)
    length = model_of(without_settings(scene)).resolution.contact_grid.length
    return Setting("P2", unit / values["flank elements"], unit / values["contact nodes"], length, values["body elements"], values["steps"])


def refinements(scene: Scene, quick: bool = False) -> tuple[Refinement, ...]:
    """All settings with their levels, the scene's own values among them."""
    base, unit, values = fine(scene, quick), half_width(scene), QUICK if quick else FULL
    found = {
        "flank": (FLANK, [unit / each for each in values["flank elements"]]),
        "spacing": (NODES, [unit / each for each in values["contact nodes"]]),
        "body": (BODY, values["body elements"]),
        "steps": (STEPS, values["steps"]),
        "length": (LENGTH, [each * base.length for each in values["contact length"]]),
        **{field: (field.replace("_", " "), options) for field, options in (QUICK_CHOICES if quick else CHOICES).items()},
        "elastic_teeth": ("elastic teeth", (1, None)),
    }
    orders = {**expected_orders(scene), LENGTH: (None, "nothing, once all that touches is inside")}
    all_of_them = [
        Refinement(name, field, tuple(_level(base, field, each, unit) for each in levels), *orders.get(name, (None, "a choice")))
        for field, (name, levels) in found.items()
    ]
    # The remeshed route has nodes on the drive flanks and on the path of contact alone.
    if not quick and scene.coast_flanks is None and scene.corner_contact is None:
        all_of_them.append(condensation(scene))
    return tuple(_with_own(each, each.base or base, own_setting(scene), unit) for each in all_of_them)


def condensation(scene: Scene) -> Refinement:
    """Gears condensed once for all positions, and meshed anew at every one: another model, no finer one."""
    parts, unit = REMESHED_FINE, half_width(scene)
    base = replace(
        fine(scene), flank=unit / parts["flank elements"], spacing=unit / parts["contact nodes"], body=parts["body elements"], steps=parts["steps"],
    )  # fmt: skip
    levels = tuple(Level(f"{each}, {parts['steps']} steps", replace(base, condensation=each)) for each in (EVERY_STEP, ONCE))
    return Refinement("condensation", "condensation", levels, None, "another model", base)


def _order_of_nodes(scene: Scene) -> tuple[float, str]:
    """Hat functions with exact averages of the gap give h^2, except at the edge of a tip, where they give h.

    A pair that enters or leaves contact touches with the tip's edge alone. The gap grows in proportion to the distance from it, and its average
    over the half hat of width h at the edge is too large by a third of h times that slope. Relieved tips do not touch.
    """
    if scene.tip_relief is not None:
        return 2.0, "hat functions, exact averages of the gap: h^2"
    return 1.0, "a pair comes and goes with a tip's edge alone, where the gap's average over half a hat is off by a third of its slope times h: h"


def _order_in_time(scene: Scene) -> tuple[float, str]:
    model = model_of(scene)
    if model.drivetrain.mass is None:
        return 1.5, "straight lines across the kinks where pairs come and go: h^1.5 in L2"
    return (2.0, "average acceleration: h^2") if model.time_scales.averages_acceleration else (1.0, "backward Euler: h")


def _level(base: Setting, field: str, value, unit: float, own: bool = False) -> Level:
    """The level at which a field of `base` has a value; what goes to zero is the size, or the length of a step."""
    size = 1.0 / value if field == "steps" else value if field in ("flank", "spacing", "body") else None
    return Level(_label(field, value, unit), replace(base, **{field: value}), size, own)


def _label(field: str, value, unit: float) -> str:
    """A value in words; `unit`: the half-width in mm, in which sizes are given, too."""
    if field in ("flank", "spacing"):
        return f"{value:.3g} mm = {value / unit:.2g} half-widths"
    words = {"length": f"{value:.3g} mm" if field == "length" else "", "body": f"default x {value}", "steps": f"{value}"}
    return words.get(field, "all that can be loaded" if value is None else str(value))


def _with_own(refinement: Refinement, base: Setting, mine: Setting, unit: float) -> Refinement:
    """The refinement with the scene's own value as a level, where it is none: between coarser and finer ones, before choices."""
    if refinement.level_of(mine) is not None:
        return refinement
    level = _level(base, refinement.field, getattr(mine, refinement.field), unit, own=True)

    def coarseness(each: Level) -> float:
        return each.size or (-each.setting.length if refinement.field == "length" else float(each.own))

    return replace(refinement, levels=tuple(sorted((level, *refinement.levels), key=coarseness, reverse=True)))


def _same(one, other) -> bool:
    return isclose(one, other, rel_tol=1e-9) if isinstance(one, float) and isinstance(other, float) else one == other
