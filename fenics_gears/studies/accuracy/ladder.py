"""The knobs of `[accuracy]` and their rungs, and whole settings made of them.

Sizes go by the Hertz half-width, held where the program's defaults hold it: a vanishing load has none.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

from fenics_gears.contact.interpolation import AVERAGED
from fenics_gears.contact.window import ContactGrid
from fenics_gears.elasticity.gear_compliance import DEFAULT_SIZES
from fenics_gears.errors import SceneError
from fenics_gears.model import Model, model
from fenics_gears.resolution import CLOSEST_NODES, ELEMENTS_PER_HALF_WIDTH, EVERY_STEP, ONCE
from fenics_gears.scene.data import Accuracy, Scene

# Elements and contact nodes in a half-width, body elements in parts of their default, the window in parts of the default, steps in a cycle.
FULL = {
    "flank elements": (0.7, 1.0, 2.0, 4.0, 8.0), "contact nodes": (1.0, 2.0, 4.0, 8.0), "body elements": (4.0, 2.0, 1.0, 0.5, 0.25),
    "contact length": (0.25, 0.5, 0.75, 1.0, 1.25), "steps": (20, 40, 80, 160, 320, 640),
}  # fmt: skip
QUICK = {
    "flank elements": (0.7, 1.4, 2.8), "contact nodes": (0.7, 1.4, 2.8), "body elements": (4.0, 2.0, 1.0),
    "contact length": (0.5, 1.0), "steps": (10, 20, 40),
}  # fmt: skip
# Where a knob stands while another is looked at: one halving before its finest rung; steps, whose cost is memory, three.
FINE = {"flank elements": 4.0, "contact nodes": 4.0, "body elements": 0.5, "contact length": 1.0, "steps": 80}
QUICK_FINE = {"flank elements": 1.4, "contact nodes": 1.4, "body elements": 1.0, "contact length": 1.0, "steps": 20}
# Gears meshed anew at every step cost a hundred times as much: both ways of condensing are compared in a setting that is less fine.
REMESHED_FINE = {"flank elements": 2.0, "contact nodes": 2.0, "body elements": 1.0, "steps": 20}
CHOICES = {"element": ("P1", "Q1", "Q1 incompatible", "P2", "Q2"), "interpolation": ("collocated", AVERAGED)}
QUICK_CHOICES = {"element": ("P1", "P2"), "interpolation": CHOICES["interpolation"]}


@dataclass(frozen=True)
class Setting:
    """All knobs: element; sizes along flank and between contact nodes and window (mm); body elements in parts of the default."""

    element: str
    flank: float
    spacing: float
    length: float
    body: float
    steps: int
    interpolation: str = AVERAGED
    elastic_teeth: int | None = None
    condensation: str = ONCE

    @property
    def grid(self) -> ContactGrid:
        """Contact nodes as close as wanted, but not closer than the flank bears; wider windows hold the nodes of narrower ones."""
        flank_nodes = self.flank / (2 if self.order == 2 else 1)
        spacing = max(self.spacing, CLOSEST_NODES * flank_nodes)
        cells = max(2, 2 * round(self.length / (2.0 * spacing)))
        return ContactGrid(cells * spacing, cells + 1, self.interpolation)

    @property
    def order(self) -> int:
        """Of the element's shapes."""
        return 2 if self.element.endswith("2") else 1

    def accuracy(self, module: float) -> Accuracy:
        """The setting as `[accuracy]` has it; `module` in mm."""
        remeshed = self.condensation == EVERY_STEP
        return Accuracy(
            element=self.element,
            flank_element_size=self.flank,
            contact_length=self.grid.length,
            contact_nodes=self.grid.nodes,
            steps_per_mesh_cycle=self.steps,
            body_element_size=self.body * DEFAULT_SIZES[self.order].body * module,
            interpolation=None if remeshed else self.interpolation,
            elastic_teeth=self.elastic_teeth,
            condensation=self.condensation,
        )

    @property
    def words(self) -> str:
        """The setting for a label in a picture."""
        teeth = "" if self.elastic_teeth is None else f", teeth {self.elastic_teeth}"
        collocated = "" if self.interpolation == AVERAGED else f", {self.interpolation}"
        remeshed = "" if self.condensation == ONCE else f", condensed {self.condensation}"
        return f"{self.element} {self.flank:.3g} mm, {self.grid.nodes} nodes, {self.steps} steps, body x{self.body:g}{collocated}{teeth}{remeshed}"


@dataclass(frozen=True)
class Rung:
    """A value of a knob. `size` goes to zero as the knob is refined; None for a choice. `own`: the scene's, off the ladder."""

    label: str
    setting: Setting
    size: float | None = None
    own: bool = False


@dataclass(frozen=True)
class Knob:
    """A knob, its rungs from coarse to fine, the order expected of its error; None where there is no power law.

    base: the setting in which it is turned and from which its rungs are measured, where that is not the fine one.
    """

    name: str
    field: str
    rungs: tuple[Rung, ...]
    expected: float | None
    why: str
    base: Setting | None = None


def checked_model(scene: Scene) -> Model:
    """The model of a scene whose accuracy can be looked into. Raises SceneError for others."""
    built = model(scene)
    if not scene.resolves_contact:
        raise SceneError("gears accuracy needs the full contact of elastic flanks: give [gears.material], and leave out accuracy.model")
    if built.resolution.condensation == EVERY_STEP:
        raise SceneError('accuracy.condensation = "every step": accuracy is measured on the fast route. Take "once", or leave it out.')
    if scene.body_meshes is not None:
        raise SceneError("[body_meshes]: a mesh that is given cannot be refined, and its error not be measured. Leave the section out.")
    if not scene.load.wheel_torque:
        raise SceneError("load.wheel_torque is 0: without load nothing gives way and there is no error to measure. Give a torque.")
    return built


def half_width(scene: Scene) -> float:
    """The half-width (mm) that sizes go by: Hertz's, within the program's bounds."""
    return model(_without_settings(scene)).resolution.flank_element_size * ELEMENTS_PER_HALF_WIDTH


def fine(scene: Scene, quick: bool = False) -> Setting:
    """The setting in which one knob at a time is turned."""
    values, unit = QUICK_FINE if quick else FINE, half_width(scene)
    length = model(_without_settings(scene)).resolution.contact_grid.length
    return Setting(
        "P2", unit / values["flank elements"], unit / values["contact nodes"], length, values["body elements"], values["steps"],
    )  # fmt: skip


def own(scene: Scene) -> Setting:
    """The setting that the scene has, its defaults included."""
    resolution = model(scene).resolution
    grid, size = resolution.contact_grid, resolution.body_element_size
    order = 2 if resolution.element.endswith("2") else 1
    body = 1.0 if size is None else size / (DEFAULT_SIZES[order].body * scene.gears.module)
    return Setting(
        resolution.element, resolution.flank_element_size, grid.spacing, grid.length, body, resolution.steps_per_mesh_cycle,
        grid.interpolation, resolution.elastic_teeth,
    )  # fmt: skip


def knobs(scene: Scene, quick: bool = False) -> tuple[Knob, ...]:
    """All knobs with their rungs, the scene's own values among them."""
    base, unit, values = fine(scene, quick), half_width(scene), QUICK if quick else FULL
    in_time, why_time = _order_in_time(scene)
    powers = (
        Knob("flank element size", "flank", _sizes(base, "flank", [unit / n for n in values["flank elements"]], unit), 2.0,
             "straight sides on a curved flank: h^2, whatever the element's order"),
        Knob("contact node spacing", "spacing", _sizes(base, "spacing", [unit / n for n in values["contact nodes"]], unit),
             *_order_of_nodes(scene)),
        Knob("body element size", "body", _sizes(base, "body", values["body elements"], None), 2.0,
             "straight sides along the outline: h^2"),
        Knob("steps per mesh cycle", "steps", _steps(base, values["steps"]), in_time, why_time),
        Knob("contact length", "length", _lengths(base, values["contact length"]), None, "nothing, once all that touches is inside"),
    )  # fmt: skip
    chosen = QUICK_CHOICES if quick else CHOICES
    choices = [Knob(name, name, _choices(base, name, options), None, "a choice") for name, options in chosen.items()]
    choices.append(Knob("elastic teeth", "elastic_teeth", _choices(base, "elastic_teeth", (1, None)), None, "a choice"))
    # The remeshed route has nodes on the drive flanks and on the path of contact alone.
    if not quick and scene.coast_flanks is None and scene.corner_contact is None:
        choices.append(_condensation(scene))
    return tuple(_with_own(knob, knob.base or base, own(scene), unit) for knob in (*powers, *choices))


def _condensation(scene: Scene) -> Knob:
    """Gears condensed once for all positions, and meshed anew at every one: another model, no finer one."""
    parts, unit = REMESHED_FINE, half_width(scene)
    base = replace(
        fine(scene), flank=unit / parts["flank elements"], spacing=unit / parts["contact nodes"], body=parts["body elements"], steps=parts["steps"],
    )  # fmt: skip
    rungs = tuple(Rung(f"{each}, {parts['steps']} steps", replace(base, condensation=each)) for each in (EVERY_STEP, ONCE))
    return Knob("condensation", "condensation", rungs, None, "another model", base)


def _order_of_nodes(scene: Scene) -> tuple[float, str]:
    """Hat functions and exact averages of the gap leave h^2, but for the edge of a tip.

    A pair that comes or goes touches with it alone, and the gap opens in proportion to the distance from it: its average over the half of a
    hat of width h that is left there is too wide by a third of h times that slope. Relieved tips do not touch.
    """
    if scene.tip_relief is not None:
        return 2.0, "hat functions, exact averages of the gap: h^2"
    return 1.0, "a pair comes and goes with a tip's edge alone, where the gap's average over half a hat is off by a third of its slope times h: h"


def _order_in_time(scene: Scene) -> tuple[float, str]:
    built = model(scene)
    if scene.friction is not None:
        return 1.0, "slip over a step stands for the rate of slip, and reverses a step late: h"
    if built.drivetrain.mass is None:
        return 1.5, "straight lines across the kinks where pairs come and go: h^1.5 in L2"
    return (2.0, "average acceleration: h^2") if built.pace.averages_acceleration else (1.0, "backward Euler: h")


def _sizes(base: Setting, field: str, sizes, unit: float | None) -> tuple[Rung, ...]:
    return tuple(Rung(_label(field, size, unit), replace(base, **{field: size}), size) for size in sizes)


def _steps(base: Setting, counts) -> tuple[Rung, ...]:
    return tuple(Rung(_label("steps", count, None), replace(base, steps=count), 1.0 / count) for count in counts)


def _lengths(base: Setting, parts) -> tuple[Rung, ...]:
    return tuple(Rung(_label("length", part * base.length, None), replace(base, length=part * base.length)) for part in parts)


def _choices(base: Setting, field: str, options) -> tuple[Rung, ...]:
    return tuple(Rung(_label(field, option, None), replace(base, **{field: option})) for option in options)


def _label(field: str, value, unit: float | None) -> str:
    """A value for people; `unit`: the half-width that it is also told in."""
    if field in ("flank", "spacing"):
        return f"{value:.3g} mm = {value / unit:.2g} half-widths"
    words = {"length": f"{value:.3g} mm" if field == "length" else "", "body": f"default x {value}", "steps": f"{value}"}
    return words.get(field, "all that can be loaded" if value is None else str(value))


def _with_own(knob: Knob, base: Setting, mine: Setting, unit: float) -> Knob:
    """The knob with the scene's own value as a rung, where it is none."""
    value = getattr(mine, knob.field)
    if any(_same(getattr(rung.setting, knob.field), value) for rung in knob.rungs):
        return knob
    sized = any(rung.size is not None for rung in knob.rungs)
    size = (1.0 / value if knob.field == "steps" else value) if sized else None
    rung = Rung(_label(knob.field, value, unit), replace(base, **{knob.field: value}), size, own=True)
    return replace(knob, rungs=tuple(sorted((rung, *knob.rungs), key=lambda each: -_coarseness(knob, each))))


def _coarseness(knob: Knob, rung: Rung) -> float:
    """Large for coarse rungs; choices stay in their order, the scene's own first."""
    if rung.size is not None:
        return rung.size
    return -rung.setting.length if knob.field == "length" else inf if rung.own else 0.0


def _same(one, other) -> bool:
    if isinstance(one, float) and isinstance(other, float):
        return abs(one - other) <= 1e-9 * max(abs(one), abs(other))
    return one == other


def rung_of(knob: Knob, setting: Setting) -> int | None:
    """Which rung of a knob a setting stands on; None for none."""
    value = getattr(setting, knob.field)
    return next((place for place, rung in enumerate(knob.rungs) if _same(getattr(rung.setting, knob.field), value)), None)


def _without_settings(scene: Scene) -> Scene:
    return replace(scene, accuracy=Accuracy())
