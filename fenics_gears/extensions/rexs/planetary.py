"""A planetary set of a REXS file as the section of a stage, ``kind = "planetary"``."""

from __future__ import annotations

from dataclasses import replace
from math import degrees, isclose, pi, remainder

from fenics_gears.scene_text import GEARS

from .attributes import Reading
from .circles import without_derived_tip
from .flanks import note_what_is_left_out, relief_sections
from .gears import Sections, gear_sections
from .lead import lead_sections
from .model import Component, RexsModel
from .order import SetStages
from .placing import direction, turning_axis
from .stage import Stage
from .train import Train
from .values import Value, ValueProblem, agreed, computed, numbered, together, value_of

# N/mm: pins that are stiffer do not give way.
RIGID = 1e9
# Directions that a program rounded, rad.
ROUNDED = 1e-4
SHARED = ("module", "pressure_angle", "helix_angle")
GEARS_OF_MESHES = (("sun", "planet"), ("planet", "ring"))
MESHES = ("sun_mesh", "ring_mesh")


def set_sections(reading: Reading, model: RexsModel, unit: SetStages) -> Sections:
    """The section of the stage under "", and those within it under their names."""
    of_planets = []
    for meshes in zip(unit.sun_meshes, unit.ring_meshes):
        own = Reading()
        of_planets.append(_of_planet(own, meshes))
        reading.problems += [each for each in own.problems if each not in reading.problems]
        reading.left_out = [*dict.fromkeys([*reading.left_out, *own.left_out])]
    reading.attempt(_check_alike, unit, of_planets)
    meshes = of_planets[0]
    shared = {"kind": Value(0.0, '"planetary"', f"component {unit.stage.id}")}
    shared |= _shared(reading, unit, meshes)
    shared |= reading.attempt(_planets, unit) or {}
    joined = {"fixed": (unit.held, "held"), "input": (unit.input, "driven"), "output": (unit.output, "with the load")}
    for field, (name, what) in joined.items():
        shared[field] = Value(0.0, f'"{name}"', f"component {unit.own.members[name].id}, which is {what}")
    floating = reading.attempt(_floating, model, unit)
    shared |= {} if floating is None else {"floating": floating}
    found: Sections = {"": shared, **_gears(reading, unit, meshes)}
    pins = reading.attempt(_pin_stiffness, reading, model, unit)
    if pins:
        found["carrier"] = {"pin_stiffness": pins}
    for name, sections in zip(MESHES, meshes):
        found |= {
            f"{name}.{section}": fields for section, fields in sections.items() if not section.startswith("gears")
        }
    return found


def _of_planet(reading: Reading, meshes: tuple[Stage, Stage]) -> list[Sections]:
    """The sections of both pairs of a planet."""
    found = []
    for stage in meshes:
        sections = gear_sections(reading, stage)
        sections |= relief_sections(reading, stage, sections)
        sections |= lead_sections(reading, stage, sections)
        without_derived_tip(sections)
        note_what_is_left_out(reading, stage)
        found.append(sections)
    return found


def _check_alike(unit: SetStages, of_planets: list[list[Sections]]) -> None:
    """Raise ValueProblem where planets differ."""

    def written(meshes: list[Sections]) -> list[dict[str, dict[str, str | None]]]:
        return [
            {
                section: {name: value and value.written for name, value in fields.items()}
                for section, fields in mesh.items()
            }
            for mesh in meshes
        ]

    texts = [written(each) for each in of_planets]
    for planet, text in zip(unit.own.planets, texts):
        if text != texts[0]:
            names = {
                f"{section}.{name}".removeprefix("gears.").replace("wheel", "planet")
                for one, other in zip(text, texts[0])
                for section in one.keys() | other.keys()
                for name in one.get(section, {}).keys() | other.get(section, {}).keys()
                if one.get(section, {}).get(name) != other.get(section, {}).get(name)
            }
            raise ValueProblem(
                f"{unit.stage}: {planet} and its meshes differ from those of {unit.own.planets[0]} in"
                f" {', '.join(sorted(names))}. The planets of a scene are alike."
            )


def _shared(reading: Reading, unit: SetStages, meshes: list[Sections]) -> dict[str, Value | None]:
    """What all gears have alike."""
    pairs = [mesh["gears"] for mesh in meshes]
    found = {}
    for name in SHARED:
        if any(name in pair for pair in pairs):
            found[name] = reading.attempt(
                agreed, [pair.get(name) for pair in pairs], f"{unit.stage}: its meshes differ in {name}"
            )
    if "pinion_hand" in pairs[0]:
        found["sun_hand"] = pairs[0]["pinion_hand"]
    distances = [pair["centre_distance"] for pair in pairs]
    lengths = [each and replace(each, number=abs(each.number)) for each in distances]
    found["centre_distance"] = reading.attempt(
        agreed, lengths, f"{unit.stage}: its meshes with sun and ring differ in the centre distance"
    )
    widths = [pair.get("face_width") for pair in pairs]
    if None not in widths and isclose(widths[0].number, widths[1].number):
        found["face_width"] = widths[0]
    return found


def _gears(reading: Reading, unit: SetStages, meshes: list[Sections]) -> Sections:
    """Sun, planet and ring, and what is within their sections."""
    found: Sections = {}
    materials = {}
    for mesh, names in zip(meshes, GEARS_OF_MESHES):
        for name, role in zip(names, GEARS):
            home = f"gears.{role}"
            fields = {each: value for each, value in mesh[home].items() if each != "axial_offset"}
            width = mesh["gears"].get("face_width")
            if width is not None:
                fields["face_width"] = width
            materials[name] = mesh.get(f"{home}.material") or mesh.get("gears.material")
            if name in found:
                for each in ("profile_shift", "face_width"):
                    both = [found[name].get(each), fields.get(each)]
                    said = f"{unit.stage}: its meshes differ in {each} of the planet"
                    found[name][each] = reading.attempt(agreed, both, said)
                continue
            if name == "ring" and fields["teeth"] is not None:
                count = abs(int(fields["teeth"].number))
                fields["teeth"] = replace(fields["teeth"], number=count, written=str(count))
            found[name] = fields
            for part in ("rack", "cutter"):
                if f"{home}.{part}" in mesh:
                    found[f"{name}.{part}"] = mesh[f"{home}.{part}"]
    if "face_width" in _shared(Reading(), unit, meshes):
        for name in ("sun", "planet", "ring"):
            found[name].pop("face_width", None)
    written = [{each: value.written for each, value in own.items()} for own in materials.values()]
    if all(each == written[0] for each in written):
        return {**found, "material": materials["sun"]}
    return found | {f"{name}.material": own for name, own in materials.items()}


def _planets(unit: SetStages) -> dict[str, Value]:
    """How many planets there are, or their directions where they are not equally spaced."""
    count = len(unit.own.planets)
    turning = turning_axis(unit.sun_meshes[0])
    found = [direction(each, turning) for each in unit.sun_meshes]
    if None in found:
        why = f"{numbered([each.id for each in unit.own.planets])}; equally spaced, since the file has not all places"
        return {"planets": Value(count, str(count), why, assumed=True)}
    beside = sorted((each.number - found[0].number) % (2.0 * pi) for each in found)
    even = [2.0 * pi * place / count for place in range(count)]
    origin = together(each.origin for each in found)
    if all(abs(remainder(one - other, 2.0 * pi)) < ROUNDED for one, other in zip(beside, even)):
        return {"planets": Value(count, str(count), f"{origin}, equally spaced")}
    words = ", ".join(f'"{degrees(each):.8g} deg"' for each in beside)
    return {"planet_angles": Value(0.0, f"[{words}]", origin)}


def _floating(model: RexsModel, unit: SetStages) -> Value | None:
    """The sun, where bearings hold the carrier and none holds the sun, and three planets centre it."""
    members = unit.own.members
    held = {name: _bearings(model, member) for name, member in members.items()}
    if held["carrier"] and not held["sun"] and len(unit.own.planets) > 2:
        return Value(0.0, '["sun"]', f"no bearing holds the shaft of component {members['sun'].id}", assumed=True)
    return None


def _bearings(model: RexsModel, member: Component) -> list[Component]:
    """Bearings of what turns as one with a member."""
    return Train(model).bearings(member)


def _pin_stiffness(reading: Reading, model: RexsModel, unit: SetStages) -> Value | None:
    """That of the bearings of a planet together; None where they do not give way, or differ, which is left out."""
    stiffnesses = []
    for planet in unit.own.planets:
        bearings = _bearings(model, planet)
        own = [value_of(each, "radial_stiffness", "N/mm") for each in bearings if "radial_stiffness" in each.attributes]
        if len(own) < len(bearings):
            lacking = [each.id for each in bearings if "radial_stiffness" not in each.attributes]
            reading.left_out.append(f"radial_stiffness of the bearings of planets, which {numbered(lacking)} has not")
            return None
        stiffnesses.append((sum(each.number for each in own), together(each.origin for each in own)))
    number, origin = stiffnesses[0]
    if any(not isclose(each, number) for each, _ in stiffnesses):
        reading.left_out.append(f"pins of {unit.stage}, whose planets have bearings of different stiffness")
        return None
    return computed(number, 1.0, "N/mm", origin) if 0.0 < number < RIGID else None
