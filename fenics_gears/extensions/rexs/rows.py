"""Stages that share a gear, an idler, as one row of gears in the scene of a train."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import isclose

from fenics_gears.scene_text import GEARS

from .attributes import Reading
from .circles import ROUNDED
from .gears import Sections, distance_of_shifts
from .stage import Stage
from .values import SAME, Value, ValueProblem, agreed, computed, together

# What a row has once, for all of its gears.
SHARED = ("module", "pressure_angle", "helix_angle")
ONE_BY_ONE = "Import its stages one by one, with --stage."


def in_rows(stages: Sequence[Stage]) -> list[list[Stage]]:
    """Stages one after the other, those together between which idlers are."""
    rows: list[list[Stage]] = []
    for stage in stages:
        if rows and rows[-1][-1].wheel.gear.id == stage.pinion.gear.id:
            rows[-1].append(stage)
        else:
            rows.append([stage])
    return rows


def names_of_gears(rows: Sequence[Sequence[Stage]], name_of: Callable[[Stage], str]) -> dict[int, str]:
    """What a train calls the gears, by the numbers of their components."""
    found: dict[int, str] = {}
    for row in rows:
        home = name_of(row[0])
        for number, stage in enumerate(row, start=1):
            names = (
                (f"{home}.{number}", f"{home}.{number + 1}") if len(row) > 1 else (f"{home}.pinion", f"{home}.wheel")
            )
            found |= dict(zip((stage.pinion.gear.id, stage.wheel.gear.id), names))
    return found


def row_sections(reading: Reading, row: Sequence[Stage], meshes: Sequence[Sections]) -> Sections:
    """The sections of a row from those of its meshes as pairs; its gears are ``gears.1``, ``gears.2``, ..."""
    numbers = [row[0].pinion.gear.id, *(stage.wheel.gear.id for stage in row)]
    said = f"components {', '.join(map(str, numbers))} are a row of gears"
    pairs = [mesh["gears"] for mesh in meshes]
    shared: dict[str, Value | None] = {"kind": Value(0.0, '"row"', f"{said}, with idlers between two stages each")}
    for name in SHARED:
        if any(name in pair for pair in pairs):
            values = [pair.get(name) for pair in pairs]
            shared[name] = reading.attempt(agreed, values, f"{said} whose meshes differ in {name}")
    if "pinion_hand" in pairs[0]:
        shared["pinion_hand"] = pairs[0]["pinion_hand"]
    shared["directions"] = _directions([pair.get("direction") for pair in pairs])
    shared |= reading.attempt(_distance, said, meshes) or {}
    gears = [_gear(reading, said, meshes, number) for number in range(len(numbers))]
    materials = [each.pop("material") for each in gears]
    found: Sections = {"gears": shared, **(reading.attempt(_modifications, said, meshes) or {})}
    if all(_same(each, materials[0]) for each in materials):
        found["gears.material"] = materials[0]
        materials = []
    for number, gear in enumerate(gears, start=1):
        found |= {f"gears.{number}{part and '.'}{part}": fields for part, fields in gear.items() if fields}
    return found | {f"gears.{number}.material": each for number, each in enumerate(materials, start=1)}


def _gear(reading: Reading, said: str, meshes: Sequence[Sections], number: int) -> dict[str, dict[str, Value | None]]:
    """The fields of a gear under "", those of its rack and its material under their names."""
    roles = [(meshes[number - 1], "gears.wheel")] if number else []
    roles += [(meshes[number], "gears.pinion")] if number < len(meshes) else []
    mesh, name = roles[0]
    widths = [each[own].get("face_width") or each["gears"].get("face_width") for each, own in roles]
    shifts = [each[own]["profile_shift"] for each, own in roles]
    fields = {
        **mesh[name],
        "profile_shift": reading.attempt(agreed, shifts, f"{said}, of which one has two profile shifts"),
        "face_width": reading.attempt(agreed, widths, f"{said}, of which one has two face widths"),
    }
    material = mesh.get(f"{name}.material") or mesh.get("gears.material") or {}
    # The pinion of every second mesh turns the other way, so that its right end is the left one of the first.
    offsets = [mesh["gears.wheel"].get("axial_offset") for mesh in meshes[:number]]
    along = sum((-1.0) ** place * each.number for place, each in enumerate(offsets) if each is not None)
    if along:
        fields["axial_offset"] = computed(
            along, 1.0, "mm", together(each.origin for each in offsets if each is not None)
        )
    return {"": fields, "rack": mesh.get(f"{name}.rack", {}), "material": material}


def _directions(stated: Sequence[Value | None]) -> Value:
    words = ", ".join('"0 deg"' if each is None else each.written for each in stated)
    origins = [each.origin for each in stated if each is not None]
    if len(origins) < len(stated):
        origins.append("0 deg where the file has neither positions nor an angle")
    return Value(0.0, f"[{words}]", together(origins), assumed=len(origins) < len(stated) or None in stated)


def _distance(said: str, meshes: Sequence[Sections]) -> dict[str, Value | None]:
    """The one centre distance of all meshes; none where they are those of the profile shifts. Raises ValueProblem."""
    stated = [mesh["gears"]["centre_distance"] for mesh in meshes]
    known = [each for each in stated if each is not None]
    if len(known) < len(stated):
        return {}
    if all(isclose(each.number, known[0].number, rel_tol=SAME) for each in known):
        return {"centre_distance": replace(known[0], origin=together(each.origin for each in known))}
    for mesh, distance in zip(meshes, known):
        pair = mesh["gears"]
        both = [mesh[f"gears.{name}"] for name in GEARS]
        figures = [each[name] for name in ("teeth", "profile_shift") for each in both]
        beta = pair["helix_angle"].number if "helix_angle" in pair else 0.0
        if any(each is None for each in (pair["module"], pair["pressure_angle"], *figures)):
            continue
        follows = distance_of_shifts(beta, pair["module"], pair["pressure_angle"], *figures)
        if abs(distance.number - follows.number) > ROUNDED * pair["module"].number:
            raise ValueProblem(
                f"{said} at the centre distance {distance.words} ({distance.origin}), while its profile shifts give"
                f" {follows.words} without backlash. Allowed: this one, or one centre distance in all meshes."
                f" {ONE_BY_ONE}"
            )
    return {}


def _modifications(said: str, meshes: Sequence[Sections]) -> Sections:
    """What modifies the flanks of all meshes alike. Raises ValueProblem where it is of some."""
    of_meshes = [
        {name: fields for name, fields in mesh.items() if not name.startswith("gears") and fields} for mesh in meshes
    ]
    names = sorted({name.partition(".")[0] for each in of_meshes for name in each})
    alike = all(
        each.keys() == of_meshes[0].keys() and all(_same(each[name], of_meshes[0][name]) for name in each)
        for each in of_meshes
    )
    if not alike or "lead_modifications" in names:
        raise ValueProblem(
            f"{said} with {', '.join(names)}. A row of a scene has the same modifications in all of its meshes,"
            f" and none of leads. {ONE_BY_ONE}"
        )
    return of_meshes[0]


def _same(one: Mapping[str, Value | None], other: Mapping[str, Value | None]) -> bool:
    return {name: value and value.written for name, value in one.items()} == {
        name: value and value.written for name, value in other.items()
    }
