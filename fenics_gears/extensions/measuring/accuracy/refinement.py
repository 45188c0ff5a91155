"""The settings of `[accuracy]`, each refined alone from level to level, and the expected order of its error."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import isclose

from fenics_gears import Scene, SceneError, model_of
from fenics_gears.measuring import (
    AVERAGED,
    EVERY_STEP,
    ISO_6336,
    NODE_SPACING,
    ONCE,
    RIGID_TEETH,
    STIFFNESS_TABLE,
    Answer,
    Setting,
    comparable,
    default_setting,
    half_width,
    own_setting,
)

from . import over_face
from .convergence import Limit, last_of, richardson
from .over_face import BODY, FAMILY, FLANK, LAYERS, LENGTH, PLANE, SLICES, STEPS

# A limit and its order are found from so many of the finest terms.
LAST_TERMS = 3
NODES = "contact node spacing"
CONDENSATION = "condensation"
# Flank elements, and contact nodes at NODE_SPACING elements. Their errors interact: nodes refined alone converge to
# what fixed elements give. So whole settings and the reference take both together.
OF_FAMILY = (FLANK, NODES)
# Gears meshed anew at every step take a hundred times as long, so that both ways of condensing are compared at a
# coarser setting.
REMESHED_FINE = {FLANK: 2.0, NODES: 2.0, BODY: 1.0, STEPS: 20}


@dataclass(frozen=True)
class Plan:
    """What is refined and compared.

    `values`: of the settings that are numbers: elements and contact nodes in a half-width, body elements and the window
    in parts of their defaults, steps in a cycle. `choices`: of the other settings. `fine`: all settings while another
    one is refined; `beside`: changes of these for some. `elastic_teeth` that are compared. `remeshed`, `root_stress`:
    whether gears meshed at every step and root stress are compared. `models`: cheaper ones. `targets` whose settings
    are run. `rounds` of timing. `columns` of a legend.
    """

    values: dict[str, tuple[float, ...]]
    fine: dict[str, float]
    models: tuple[str, ...]
    columns: int
    rounds: int = 1
    choices: dict[str, tuple[str, ...]] = field(default_factory=dict)
    beside: dict[str, dict[str, float]] = field(default_factory=dict)
    elastic_teeth: tuple[int | None, ...] = ()
    remeshed: bool = False
    root_stress: bool = False
    targets: tuple[float, ...] = ()


IN_THE_PLANE = Plan(
    values={
        FAMILY: (0.7, 1.0, 2.0, 4.0, 8.0, 16.0), FLANK: (1.0, 2.0, 4.0, 8.0), NODES: (1.0, 2.0, 4.0, 8.0),
        BODY: (4.0, 2.0, 1.0, 0.5, 0.25),
        LENGTH: (0.25, 0.5, 0.75, 1.0, 1.25), STEPS: (20, 40, 80, 160, 320, 640, 1280),
    },
    fine={FLANK: 4.0, BODY: 1.0, LENGTH: 1.0, STEPS: 80},
    # Changes by one setting depend on the others only in second order. A longer window moves the contact nodes a
    # little where an edge enters it, which matters less the closer they are.
    beside={
        FAMILY: {STEPS: 40, LENGTH: 0.75}, BODY: {FLANK: 2.0}, LENGTH: {FLANK: 8.0, STEPS: 40}, STEPS: {FLANK: 2.0},
    },
    choices={"element": ("P1", "Q1", "Q1 incompatible", "P2", "Q2"), "interpolation": ("collocated", AVERAGED)},
    elastic_teeth=(1, None), remeshed=True, root_stress=True,
    models=(STIFFNESS_TABLE, ISO_6336, RIGID_TEETH), rounds=5, columns=2,
)  # fmt: skip
QUICK_IN_THE_PLANE = replace(
    IN_THE_PLANE,
    values={
        FAMILY: (0.7, 1.4, 2.8), FLANK: (0.7, 1.4, 2.8), NODES: (0.7, 1.4, 2.8), BODY: (4.0, 2.0, 1.0),
        LENGTH: (0.5, 1.0), STEPS: (10, 20, 40),
    },
    fine={FLANK: 1.4, BODY: 1.0, LENGTH: 1.0, STEPS: 20},
    beside={},
    choices=IN_THE_PLANE.choices | {"element": ("P1", "P2")},
    remeshed=False, rounds=1,
)  # fmt: skip
# The legend has all settings with an order in words, too long for two columns.
OVER_THE_FACE = Plan(over_face.FULL, over_face.FINE, models=(PLANE,), columns=1, targets=over_face.TARGETS)
QUICK_OVER_THE_FACE = replace(OVER_THE_FACE, values=over_face.QUICK, fine=over_face.QUICK_FINE, targets=())


def plan_of(scene: Scene, quick: bool = False) -> Plan:
    if scene.three_dimensional:
        return QUICK_OVER_THE_FACE if quick else OVER_THE_FACE
    return QUICK_IN_THE_PLANE if quick else IN_THE_PLANE


# Settings that are numbers, whose inverse is a size.
COUNTED = ("steps", SLICES, LAYERS)
# Whose value a level has that stands between the others.
SCENE = "scene"
DEFAULT = "default"


@dataclass(frozen=True)
class Level:
    """A value of a setting. `size` goes to zero as it is refined; None for a choice. `own`: whose it is where it stands
    between the others."""

    label: str
    setting: Setting
    size: float | None = None
    own: str = ""


@dataclass(frozen=True)
class Refinement:
    """A setting, its levels from coarse to fine, the order expected of its error; None where there is no power law.

    fields: of a whole setting that the levels differ in. base: the whole setting whose others all levels have.
    """

    name: str
    fields: tuple[str, ...]
    levels: tuple[Level, ...]
    expected: float | None
    why: str
    base: Setting

    def level_of(self, setting: Setting) -> int | None:
        """The level of a whole setting; None for none."""

        def same(other: Setting) -> bool:
            return all(_same(getattr(setting, field), getattr(other, field)) for field in self.fields)

        return next((place for place, level in enumerate(self.levels) if same(level.setting)), None)

    def moved(self, setting: Setting, place: int) -> Setting:
        return replace(setting, **{field: getattr(self.levels[place].setting, field) for field in self.fields})


def check_measurable(scene: Scene) -> None:
    if not scene.resolves_contact:
        raise SceneError(
            "gears accuracy needs the full contact of elastic flanks: give [gears.material], and leave out"
            " accuracy.model"
        )
    if model_of(scene).resolution.condensation == EVERY_STEP:
        raise SceneError('accuracy.condensation = "every step": accuracy is measured on the fast route. Take "once".')
    if scene.body_meshes is not None:
        raise SceneError("[body_meshes]: a mesh that is given cannot be refined. Leave the section out.")
    if not scene.load.wheel_torque:
        raise SceneError("load.wheel_torque is 0: without load there is no error to measure. Give a torque.")


def expected_orders(scene: Scene) -> dict[str, tuple[float, str]]:
    """For each setting the expected order of its error, and why."""
    return {
        FLANK: (2.0, "straight sides on a curved flank: h^2, whatever the element's order"),
        NODES: (2.0, "functions whose averages of a parabola are exact, closer at tip edges: h^2"),
        FAMILY: (2.0, "both have h^2"),
        BODY: (2.0, "straight sides along the outline: h^2"),
        STEPS: _order_in_time(scene),
        **over_face.ORDERS,
    }


def fine(scene: Scene, quick: bool = False) -> Setting:
    """The setting in which one at a time is refined."""
    return _setting(scene, plan_of(scene, quick).fine)


def _setting(scene: Scene, values: dict[str, float]) -> Setting:
    """A whole setting with elements of second order and, unless `values` says otherwise, contact nodes at NODE_SPACING
    of them."""
    unit = half_width(scene)
    default = default_setting(scene)
    flank = unit / values[FLANK]
    spacing = unit / values[NODES] if NODES in values else NODE_SPACING * flank
    setting = Setting("P2", flank, spacing, values.get(LENGTH, 1.0) * default.length, values[BODY], values[STEPS])
    if default.slices is None:
        return setting
    return replace(
        setting, slices=_whole(values[SLICES], default.slices), layers=_whole(values[LAYERS], default.layers)
    )


def _whole(part: float, default: int) -> int:
    return max(2, round(part * default))


def refinements(scene: Scene, quick: bool = False) -> tuple[Refinement, ...]:
    """All settings with their levels, the values of the scene and of the program's defaults among them."""
    plan = plan_of(scene, quick)
    unit = half_width(scene)
    orders = expected_orders(scene)
    default = default_setting(scene)
    orders[LENGTH] = (None, "nothing, once all that touches is inside")
    whole_length = fine(scene, quick).length
    of_value = {
        FAMILY: lambda each: {"flank": unit / each, "spacing": NODE_SPACING * unit / each},
        FLANK: lambda each: {"flank": unit / each},
        NODES: lambda each: {"spacing": unit / each},
        BODY: lambda each: {"body": each},
        STEPS: lambda each: {"steps": each},
        LENGTH: lambda each: {"length": each * whole_length},
        SLICES: lambda each: {"slices": _whole(each, default.slices)},
        LAYERS: lambda each: {"layers": _whole(each, default.layers)},
    }
    sizes: dict[str, list[dict]] = {
        name: [of_value[name](each) for each in levels] for name, levels in plan.values.items()
    }
    sizes |= {field: [{field: each} for each in options] for field, options in plan.choices.items()}
    if plan.elastic_teeth:
        sizes["elastic teeth"] = [{"elastic_teeth": each} for each in plan.elastic_teeth]
    settings = []
    for name, levels in sizes.items():
        base = _setting(scene, plan.fine | plan.beside.get(name, {}))
        expected = orders.get(name, (None, "a choice"))
        settings.append(
            Refinement(name, tuple(levels[0]), tuple(_level(base, each, unit) for each in levels), *expected, base)
        )
    # The remeshed route has nodes on the drive flanks and on the path of contact alone.
    if plan.remeshed and scene.coast_flanks is None and scene.corner_contact is None:
        settings.append(condensation(scene))
    mine = {SCENE: own_setting(scene), DEFAULT: default_setting(scene)}
    return tuple(_with_own(each, mine, unit) for each in settings)


def condensation(scene: Scene) -> Refinement:
    """Gears condensed once for all positions, and meshed anew at every one: another model, no finer one."""
    base = _setting(scene, REMESHED_FINE)
    levels = tuple(
        Level(f"{each}, {base.steps} steps", replace(base, condensation=each)) for each in (EVERY_STEP, ONCE)
    )
    return Refinement(CONDENSATION, ("condensation",), levels, None, "another model", base)


def _order_in_time(scene: Scene) -> tuple[float, str]:
    model = model_of(scene)
    if model.drivetrain.mass is not None:
        average = model.time_scales.averages_acceleration
        return (2.0, "average acceleration: h^2") if average else (1.0, "backward Euler: h")
    if scene.friction is not None:
        return 2.0, "the exact slip over a step in place of the rate of slip: h^2"
    return 2.0, "no error at all: positions do not depend on one another"


def _level(base: Setting, values: dict, unit: float, own: str = "") -> Level:
    """The level at which fields of `base` have other values; what goes to zero is the size, or the length of a step."""
    field, value = next(iter(values.items()))
    size = 1.0 / value if field in COUNTED else value if field in ("flank", "spacing", "body") else None
    return Level(_label(field, value, unit), replace(base, **values), size, own)


def _label(field: str, value, unit: float) -> str:
    """A value in words; `unit`: the half-width in mm, in which sizes are given, too."""
    if field in ("flank", "spacing"):
        return f"{value:.3g} mm = {value / unit:.2g} half-widths"
    if field == "length":
        return f"{value:.3g} mm"
    if field == "body":
        return f"default x {value:.3g}"
    return "all that can be loaded" if value is None else str(value)


def _with_own(refinement: Refinement, settings: dict[str, Setting], unit: float) -> Refinement:
    """The refinement with the values of whole `settings` as levels, where they are none: between coarser and finer
    ones, before choices."""

    def coarseness(level: Level) -> float:
        return level.size or (-level.setting.length if refinement.name == LENGTH else float(bool(level.own)))

    for own, setting in settings.items():
        if refinement.level_of(setting) is None:
            level = _level(refinement.base, {field: getattr(setting, field) for field in refinement.fields}, unit, own)
            levels = sorted((level, *refinement.levels), key=coarseness, reverse=True)
            refinement = replace(refinement, levels=tuple(levels))
    return refinement


def _same(one, other) -> bool:
    return isclose(one, other, rel_tol=1e-9) if isinstance(one, float) and isinstance(other, float) else one == other


def limit_of(refinement: Refinement, ran: Sequence[tuple[Level, Answer]], base: Answer, name: str) -> Limit:
    """The limit of a measure as a setting is refined; that of its base where the setting has no finest value."""
    if len(ran) < 2 or (refinement.expected is None and refinement.name != LENGTH):
        return Limit(base[name], None, 0.0)
    last = ran[-LAST_TERMS:]
    values = comparable([found[name] for _, found in last], name)
    if refinement.expected is None:
        return last_of(values)
    return richardson(values, [level.size for level, _ in last], refinement.expected)
