"""Every field that a scene can have, found in the schema itself, and a scene that has them all."""

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any

from fenics_gears import as_toml
from fenics_gears.inputs import units
from fenics_gears.inputs.allowed import Allowed, AllowedEither, AllowedList
from fenics_gears.inputs.section import allowed_in, required_in, section_within
from fenics_gears.scene.schema import known_paths, scene_text
from fenics_gears.studies.fields import ABSENT, changed

DEMO = Path(__file__).parents[2] / "demos" / "lundvall2004.toml"
RING = DEMO.parent / "internal_gears" / "planet_in_ring.toml"
RELIEF = {"depth": "31 um", "start": "HPSTC"}
LUMPED = {"mass": "4.9 kg", "moment_of_inertia": "24.5e-3 kg m^2"}
RAYLEIGH = {"stiffness_proportional": "0.4e-3 s", "mass_proportional": "0.5e-3 1/s"}
SHAFT = {"torsional_stiffness": "0.203e9 N mm/rad"}
# What a field stands instead of: it cannot be beside these.
INSTEAD = {
    ("motion", "pinion_speed"): ["mesh_frequency"],
    ("wheel_points", "angles"): ["count"],
    **{("load", name): ["wheel_torque"] for name in ("pinion_torque", "power")},
    **{(*path, "density"): [*LUMPED] for path in (("inertia",), ("inertia", "pinion"), ("inertia", "wheel"))},
    **{("damping", name): [*RAYLEIGH, "pinion", "wheel"] for name in ("ratio", "ratios")},
    **{
        (section, *gear, "exponent"): ["shape"]
        for section in ("tip_relief", "root_relief")
        for gear in ((), ("pinion",), ("wheel",))
    },
}
POINTS = {"count": 8, "radial_stiffness": "2e5 N/mm", "tangential_stiffness": "2e5 N/mm"}
SUPPORT = dict.fromkeys(("stiffness", "stiffness_x", "stiffness_y"), "0.155e6 N/mm")
# Units of every kind of quantity that a scene has, by what `units` calls it.
UNITS = {
    "a length": "mm", "an angle": "deg", "a stress": "GPa", "a torque": "N m", "a frequency (1/time)": "Hz",
    "an angular speed": "rpm", "a diametral pitch (1/length)": "1/mm",
    "a torsional stiffness": "N mm/rad", "a stiffness": "N/mm", "a mass": "kg", "a moment of inertia": "kg m^2",
    "a density": "g/cm^3", "a time": "s", "a stiffness per area": "N/mm^3",
    "a percentage": "%", "a power": "kW", "a dynamic viscosity": "mPa s",
}  # fmt: skip


@dataclass(frozen=True)
class Field:
    """A field of a scene; bounds in N, mm, s, rad, None without."""

    path: tuple[str, ...]
    allowed: Allowed
    required: bool
    bounds: tuple[float, float] | None
    excluded: tuple[bool, bool]

    @property
    def name(self) -> str:
        return ".".join(self.path)

    @property
    def unit(self) -> str:
        return "1/s" if self.path[-1] == "mass_proportional" else UNITS[self.allowed.kind] if self.allowed.kind else ""

    @property
    def whole(self) -> bool:
        """Whether the field takes whole numbers only."""
        return "whole number" in self.allowed.description

    def takes(self, number: float) -> bool:
        """Whether a number, in the field's unit, lies within its bounds."""
        if self.allowed.kind:
            number = units.quantity(f"{number!r} {self.unit}")[0]
        if getattr(self.allowed, "either_sign", False):
            number = abs(number)
        (lowest, highest), (above, below) = self.bounds, self.excluded
        return (lowest < number if above else lowest <= number) and (number < highest if below else number <= highest)

    @property
    def kinds(self) -> tuple[str, ...]:
        return (
            tuple(self.allowed.ranges)
            if isinstance(self.allowed, AllowedEither)
            else (self.allowed.kind,)
            if self.allowed.kind
            else ()
        )

    def literal(self, number: Any) -> str:
        """A number as this field's text in TOML; a list of it alone where the field takes lists."""
        text = f'"{number} {self.unit}"' if self.allowed.kind else f"{number}"
        return f"[{text}]" if isinstance(self.allowed, AllowedList) else text


def fields() -> list[Field]:
    """All of them; a new one joins by itself."""
    return list(_fields())


def _fields() -> Iterator[Field]:
    for path, is_section in known_paths().items():
        # A pinion is external: of its shaper cutter nothing but the section is refused.
        if is_section or path[:3] == ("gears", "pinion", "cutter"):
            continue
        section: Any = scene_text()
        for name in path[:-1]:
            section = section_within(section, name)
        allowed = allowed_in(section, path[-1])
        excluded = (getattr(allowed, "above_lowest", False), getattr(allowed, "below_highest", False))
        yield Field(path, allowed, path[-1] in required_in(section), _bounds(allowed), excluded)


def _bounds(allowed: Allowed) -> tuple[float, float] | None:
    """The bounds of a number, of a list's entries, or of a quantity of the first of several kinds."""
    if isinstance(allowed, AllowedEither):
        return allowed.ranges[allowed.kind]
    return (allowed.lowest, allowed.highest) if isfinite(allowed.lowest) else None


def whole_scene() -> dict[str, Any]:
    tree = tomllib.loads(DEMO.read_text(encoding="utf-8"))
    tree["tip_relief"] = {**RELIEF, "pinion": RELIEF, "wheel": RELIEF}
    tree["root_relief"] = {"depth": "5 um", "start": "LPSTC"}
    wavy = {gear: {"waviness": {"amplitude": "1 um", "waves": 37}} for gear in ("pinion", "wheel")}
    tree["flank_errors"] = {"tolerance_class": 6, "seed": 1, **wavy}
    tree["eccentricity"] = {"pinion": {"distance": "10 um"}, "wheel": {"distance": "10 um"}}
    tree["bearings"] = {**SUPPORT, "pinion": SUPPORT, "wheel": SUPPORT}
    for gear in ("pinion", "wheel"):
        tree["gears"][gear] |= {
            "rack_tip_radius": 0.38,
            "face_width": "15 mm",
            "axial_offset": "1 mm",
            "material": {**tree["gears"]["material"]},
        }
    tree["shafts"] = {**SHAFT, "input": {**SHAFT}, "output": {**SHAFT}}
    tree["inertia"] = {
        **LUMPED,
        "pinion": {**LUMPED},
        "wheel": {**LUMPED},
        "load": {"moment_of_inertia": "24.5e-3 kg m^2"},
    }
    tree["damping"] = {**RAYLEIGH, "pinion": {**RAYLEIGH}, "wheel": {**RAYLEIGH}}
    tree["gears"] |= {"helix_angle": "1 deg", "pinion_hand": "right"}
    end_relief = {"depth": "10 um", "length": "4 mm", "sides": "both", "shape": "linear"}
    tree["lead_modifications"] = {
        gear: {"crowning": "6 um", "helix_slope": "8 um", "end_relief": {**end_relief}} for gear in ("pinion", "wheel")
    }
    tree["misalignment"] = {"in_plane": "12 um", "out_of_plane": "1 um"}
    tree["accuracy"] |= {"slices": 40, "layers": 12}
    tree["accuracy"] |= {
        "body_element_size": "1.3 mm",
        "interpolation": "averaged",
        "elastic_teeth": 2,
        "model": "elastic",
    }
    ripple = {"harmonics": [{"order": 1, "amplitude": "20 N m", "phase": "30 deg"}]}
    return tree | {
        "coast_flanks": {},
        "output": {"root_stress": True},
        "torque_ripple": ripple,
        "speed_ramp": {"end_frequency": "260 Hz", "hold_cycles": 0},
    }


def plane_scene() -> dict[str, Any]:
    tree = whole_scene()
    for path in (
        ("lead_modifications",),
        ("misalignment",),
        *(("gears", name) for name in ("helix_angle", "pinion_hand")),
        *(("accuracy", name) for name in ("slices", "layers")),
    ):
        tree = changed(tree, path, ABSENT)
    for gear in ("pinion", "wheel"):
        tree = changed(tree, ("gears", gear, "axial_offset"), ABSENT)
    return tree


def plane_scene_on_points() -> dict[str, Any]:
    tree = plane_scene()
    for path in (("coast_flanks",), ("output",), ("accuracy", "elastic_teeth")):
        tree = changed(tree, path, ABSENT)
    return tree | {"wheel_points": POINTS}


def plane_scene_with_webs() -> dict[str, Any]:
    tree = plane_scene()
    for gear, rim, hub in (("pinion", "50 mm", "36 mm"), ("wheel", "80 mm", "50 mm")):
        tree["gears"][gear]["web"] = {"rim_inner_diameter": rim, "width": "8 mm", "hub_diameter": hub}
    return tree


def scene_with(path: tuple[str, ...], literal: str | None, name: str | None = None, tree: dict | None = None) -> str:
    """The text of a scene (`tree`, or the whole one) with `literal` (TOML) at a path, nothing where that is None,
    under another `name` if given."""
    if "cutter" in path:
        tree = tomllib.loads(RING.read_text(encoding="utf-8"))
    if path[0] == "wheel_points":
        tree = plane_scene_on_points()
    tree = tree or (whole_scene() if "web" not in path else plane_scene_with_webs())
    for other in INSTEAD.get(path, ()):
        tree = changed(tree, (*path[:-1], other), ABSENT)
    tree = changed(tree, path, ABSENT)
    if literal is None:
        return as_toml(tree)
    text = as_toml(changed(tree, (*path[:-1], name or path[-1]), "@@"))
    return text.replace('"@@"', literal)
