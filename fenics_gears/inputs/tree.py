"""Values of a parsed scene file, of which some may be wrong."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import atan, cos, pi, tan
from typing import Any, Self

from . import units
from .problem import LISTED, Path, nearest

Tree = Mapping[str, Any]
GEARS = ("pinion", "wheel")
SHAFTS = ("input", "output")  # of pinion and wheel
MOST_TEETH = 1000
# Tables and lists within one another: ``set.bearings.pinion.1.rolling.clearance`` of a study has six.
MOST_NESTED = 12
# In modules. The model moves flanks by errors of manufacture but not their points of contact.
LARGEST_ERROR = 0.1


def table(tree: Tree, name: str) -> Tree | None:
    """The section of that name; None where there is none."""
    value = tree.get(name)
    return value if isinstance(value, Mapping) else None


def value_at(tree: Tree, *path: str) -> Any:
    """What a parsed scene has at a path, in which listed tables have numbers from 1; None where there is nothing."""
    value: Any = tree
    for name in path:
        if name.isdigit():
            listed = value.get(LISTED) if isinstance(value, Mapping) else value
            value = listed[int(name) - 1] if isinstance(listed, list) and 1 <= int(name) <= len(listed) else None
        else:
            value = value.get(name) if isinstance(value, Mapping) else None
    return value


def with_gears(tree: Tree, name: str) -> dict[Path, Tree]:
    """A section and the sections of single gears within it, by their paths; empty ones where the scene has none."""
    both = table(tree, name) or {}
    return {(name,): both, **{(name, gear): table(both, gear) or {} for gear in GEARS}}


def given_for(both: Tree, gear: str) -> set[str]:
    """Names that a section gives for the "pinion" or the "wheel": for both gears, and in the gear's own section."""
    return {*both, *(table(both, gear) or {})}


def shafts_with_sections(tree: Tree) -> list[str]:
    """The shafts, "input" and "output", that a parsed scene divides into sections."""
    return [shaft for shaft in SHAFTS if value_at(tree, "shafts", shaft, "sections") is not None]


def written_out(tree: dict[str, Any]) -> dict[str, Any]:
    """A parsed file with its short forms written out: ``material = "steel"`` is a section with that name, ``support =
    "held"`` one of that kind, ``internal = true`` makes the number of teeth negative, and listed bearings,
    ``[[bearings.pinion]]``, are in the gear's section."""
    gears, shafts = (table(tree, name) or {} for name in ("gears", "shafts"))
    bearings: Any = table(tree, "bearings") or {}
    homes: tuple[Any, ...] = (
        gears,
        *(table(gears, gear) for gear in GEARS),
        *(table(shafts, shaft) for shaft in SHAFTS),
    )
    for home in homes:
        if home is not None and isinstance(home.get("material"), str):
            home["material"] = {"name": home["material"]}
    for gear in GEARS:
        own: Any = table(gears, gear) or {}
        if isinstance(own.get("support"), str):
            own["support"] = {"kind": own["support"]}
        if isinstance(own.get("internal"), bool) and type(own.get("teeth")) is int:
            own["teeth"] = -abs(own["teeth"]) if own.pop("internal") else own["teeth"]
        if isinstance(bearings.get(gear), list):
            bearings[gear] = {LISTED: bearings[gear]}
    return tree


def nested_too_deeply(tree: Tree) -> str:
    """The beginning of a path, in words, on which tables and lists lie deeper in one another than any file of ours
    has them; empty without one. What walks through them is recursive."""
    level: list[tuple[str, Any]] = [("", tree)]
    for _ in range(MOST_NESTED):
        level = [
            (f"{place}.{name}".strip("."), inner)
            for place, value in level
            for name, inner in (value.items() if isinstance(value, Mapping) else enumerate(value, 1))
            if isinstance(inner, Mapping | list)
        ]
    return level[0][0] if level else ""


def quantity_at(tree: Tree, *path: str) -> float | None:
    """The number in N, mm, s, rad at a path of a parsed scene; None where there is no quantity."""
    return quantity_in(value_at(tree, *path))


def quantity_in(value: Any, *kinds: str) -> float | None:
    """The number in N, mm, s, rad; None for what is no quantity, or none of some kinds."""
    if not isinstance(value, str):
        return None
    try:
        return units.of_kind(value, *kinds)[0] if kinds else units.quantity(value)[0]
    except units.QuantityError:
        return None


def teeth_in(tree: Tree, gear: str) -> int | None:
    """Number of teeth of the "pinion" or the "wheel", without sign; None where it is missing or none that a gear
    has."""
    teeth = value_at(tree, "gears", gear, "teeth")
    return abs(teeth) if type(teeth) is int and 0 < abs(teeth) <= MOST_TEETH else None


# Fields of internal gears alone, and other names by which one is asked for.
OF_INTERNAL = ("outer_diameter", "cutter", "support")
INTERNAL = ("internal", "internal_gear", "internal_teeth", "ring", "ring_gear")


def is_internal(tree: Tree, gear: str) -> bool:
    """Whether the "pinion" or the "wheel" of a parsed scene is an internal gear, with a negative number of teeth."""
    teeth = value_at(tree, "gears", gear, "teeth")
    return type(teeth) is int and teeth < 0


# What the size of the teeth may be given by, and their pressure angle; the first is that of the normal section, which
# the program has. Without a helix angle both sections are one.
MODULES = ("module", "transverse_module", "diametral_pitch", "normal_diametral_pitch")
PRESSURE_ANGLES = ("pressure_angle", "transverse_pressure_angle")


def in_normal_section(name: str, number: float, helix_angle: float) -> float:
    """Module (mm) or pressure angle (rad) of the normal section, of one of `MODULES` or `PRESSURE_ANGLES`: m_n = m_t
    cos(beta), tan(alpha_n) = tan(alpha_t) cos(beta). A diametral pitch (1/mm) is one over its module."""
    if name.endswith("diametral_pitch"):
        number = 1.0 / number
    if name in ("transverse_module", "diametral_pitch"):
        return number * cos(helix_angle)
    return atan(tan(number) * cos(helix_angle)) if name == "transverse_pressure_angle" else number


def module_in(tree: Tree) -> float | None:
    """The normal module (mm) of a parsed scene, however it is given; None where there is none that can be read."""
    return _of_teeth(tree, MODULES, "a length", "a diametral pitch (1/length)")


def pressure_angle_in(tree: Tree) -> float | None:
    """The pressure angle (rad) of the normal section of a parsed scene, like ``module_in``."""
    return _of_teeth(tree, PRESSURE_ANGLES, "an angle")


def _of_teeth(tree: Tree, names: Sequence[str], *kinds: str) -> float | None:
    given = [(name, number) for name in names if (number := quantity_in(value_at(tree, "gears", name), *kinds))]
    return in_normal_section(*given[0], quantity_at(tree, "gears", "helix_angle") or 0.0) if given else None


# What a load may be given by: torque that resists the wheel, torque that drives the pinion, power that goes through,
# without losses.
LOADS = ("wheel_torque", "pinion_torque", "power")


def wheel_torque(name: str, number: float, teeth: Sequence[int], mesh_frequency: float | None) -> float | None:
    """Torque on the wheel, N mm, of one of `LOADS` (N mm, N mm/s); None for a power without a mesh frequency (Hz)."""
    if name == "power":
        return number * abs(teeth[1]) / (2.0 * pi * mesh_frequency) if mesh_frequency else None
    return number if name == "wheel_torque" else number * abs(teeth[1]) / teeth[0]


def load_in(tree: Tree) -> tuple[Path, float] | None:
    """The field that gives the load, and the torque (N mm) on the wheel; None where there is none that can be read."""
    teeth = [teeth_in(tree, gear) or 1 for gear in GEARS]
    frequency = quantity_at(tree, "motion", "mesh_frequency")
    speed = quantity_at(tree, "motion", "pinion_speed")
    frequency = speed / (2.0 * pi) * teeth[0] if frequency is None and speed is not None else frequency
    given = [(name, number) for name in LOADS if (number := quantity_at(tree, "load", name)) is not None]
    torque = wheel_torque(*given[0], teeth, frequency) if given else None
    return None if torque is None else (("load", given[0][0]), torque)


# What makes a scene three-dimensional, in the order in which messages name it.
OVER_THE_FACE: tuple[Path, ...] = (
    ("gears", "helix_angle"),
    ("lead_modifications",),
    ("misalignment",),
    ("bearings", "places"),
    *(("shafts", shaft, "sections") for shaft in SHAFTS),
)


def dotted(path: Path) -> str:
    """A path in words: a section in brackets, a field with its section."""
    return ".".join(path) if len(path) > 1 else f"[{path[0]}]"


def over_the_face(tree: Tree) -> list[Path]:
    """What of a scene makes it three-dimensional; nothing of a plane one."""
    valued = ((path, value_at(tree, *path)) for path in OVER_THE_FACE)
    return [path for path, value in valued if isinstance(value, Mapping) or len(path) > 1 and value is not None]


NOT_IN_THE_PLANE = (
    f"is of three-dimensional scenes: allowed with {', '.join(map(dotted, OVER_THE_FACE[:-1]))} or"
    f" {dotted(OVER_THE_FACE[-1])}. Leave it out."
)


def material_sections(tree: Tree) -> list[Path]:
    """Paths of the sections, misspelt ones too, that say what gears are made of; none of rigid gears."""
    homes = with_gears(tree, "gears").items()
    return [(*path, name) for path, home in homes for name in home if nearest(name, ["material"])]


class PerGear:
    """A dataclass with the fields `pinion` and `wheel`: a part for each of the two gears of a pair."""

    @property
    def of_gears(self) -> tuple[Any, Any]:
        """The parts of both, in the order of a pair's sides."""
        first, second = (getattr(self, gear) for gear in GEARS)
        return first, second

    def changed(self, change: Callable[[Any], Any], **others: Any) -> Self:
        """The same with both parts changed alike, and `others` of its fields replaced."""
        parts = {gear: change(own) for gear, own in zip(GEARS, self.of_gears)}
        return replace(self, **parts, **others)  # type: ignore[type-var]
