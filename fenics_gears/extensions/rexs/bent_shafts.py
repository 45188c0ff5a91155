"""Shafts of a REXS file that bend, as ``[shafts.NAME]`` of a train: their sections, gears and bearings.

Places are from the left end, as the train's first gear is seen to turn counter-clockwise from the right: those of a
shaft whose axis points to the left count from its other end.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import isclose

import numpy as np

from .attributes import Reading
from .gears import Sections
from .model import Component, RexsModel
from .placing import turning_axis
from .shaft_parts import SectionOfShaft, place_along, sections_of
from .stage import Stage
from .transmission import TORQUE, axis_of
from .values import Value, ValueProblem, computed, numbered, value_of, word_of

# N/mm: what holds without giving way. Files write 1e22 N/m, or that a bearing absorbs axial forces, and no stiffness.
RIGID = 1e9
# Sections that follow each other without a gap, mm.
GAP = 1e-3
STIFFNESSES = {
    "radial_stiffness": ("radial_stiffness", "N/mm"),
    "axial_stiffness": ("axial_stiffness", "N/mm"),
    "tilting_stiffness": ("bending_stiffness", "N mm/rad"),
}


def shaft_sections(reading: Reading, model: RexsModel, stages: Sequence[Stage], names: Mapping[int, str]) -> Sections:
    """The sections of all shafts that the file describes completely; ``names``: the train's of the gears. Of others it
    is told as left out what they lack."""
    turning = turning_axis(stages[0])
    parts = [part for stage in stages for part in (stage.pinion, stage.wheel)]
    shafts = {shaft.id: shaft for part in parts for shaft in part.shafts}
    found: Sections = {}
    for number, shaft in shafts.items():
        gears = {part.gear.id: part.gear for part in parts if shaft in part.shafts}
        try:
            own = _Shaft(model, shaft, turning).sections(list(gears.values()), names)
        except _Incomplete as lacking:
            reading.left_out.append(f"{shaft}, which is rigid here: {lacking}")
            continue
        except ValueProblem as problem:
            reading.problems.append(str(problem))
            continue
        home = f"shafts.shaft_{number}"
        found |= {f"{home}{name and '.'}{name}": fields for name, fields in own.items()}
    return found


class _Incomplete(Exception):
    """What a shaft lacks to bend."""


class _Shaft:
    """A shaft with what is on it."""

    def __init__(self, model: RexsModel, shaft: Component, turning: np.ndarray) -> None:
        self.model = model
        self.shaft = shaft
        self.on_it = model.partners("assembly", "part", assembly=shaft)
        axis = axis_of(shaft)
        self.turned = axis is not None and float(axis @ turning) < 0.0
        self.pieces = sections_of(self.on_it)
        self._check()
        self.length = self.pieces[-1].end - self.pieces[0].start.number

    def sections(self, gears: Sequence[Component], names: Mapping[int, str]) -> Sections:
        """Its section of a scene, under "", and its tables of bearings."""
        carried = ", ".join(f'"{names[gear.id]}"' for gear in gears)
        places = [self.place(gear) for gear in gears]
        fields: dict[str, Value | None] = {
            "carries": Value(0.0, f"[{carried}]", numbered([gear.id for gear in gears])),
            "sections": self._sections(),
            "gears_at": Value(0.0, f"[{', '.join(each.written for each in places)}]", places[0].origin),
        }
        loads = [each for each in self.on_it if each.type == "external_load" and TORQUE in each.attributes]
        coupled = loads or [each for each in self.on_it if each.type == "external_load"]
        if coupled:
            fields["torque_at"] = self.place(coupled[0])
        found: Sections = {"": fields}
        if material := self._material():
            found["material"] = material
        bearings = list(self._bearings())
        if len(bearings) < 2:
            raise _Incomplete("it has not two bearings in the casing with a radial_stiffness")
        return found | {f"bearings.{number}": each for number, each in enumerate(bearings, start=1)}

    def place(self, part: Component) -> Value:
        """Where a part is, from the left end."""
        along = place_along(part, self.shaft)
        if along is None:
            raise _Incomplete(f"the place of {part} is not given")
        at = along.number - self.pieces[0].start.number
        if not 0.0 <= at <= self.length:
            raise _Incomplete(f"{part} is at {at:.6g} mm, not within its sections of {self.length:.6g} mm")
        return computed(self.length - at if self.turned else at, 1.0, "mm", along.origin)

    def _check(self) -> None:
        if not self.pieces:
            raise _Incomplete("it has no sections with their places, lengths and diameters")
        for one, other in zip(self.pieces, self.pieces[1:]):
            if not isclose(one.end, other.start.number, abs_tol=GAP):
                raise _Incomplete(f"{one.component} and {other.component} do not follow each other")

    def _sections(self) -> Value:
        ordered = self.pieces[::-1] if self.turned else self.pieces
        lines = "".join(f"    {{ {self._written(each)} }},\n" for each in ordered)
        return Value(0.0, f"[\n{lines}]", numbered([each.component.id for each in ordered]))

    def _written(self, section: SectionOfShaft) -> str:
        sign = -1 if self.turned else 1
        diameters = section.diameters[::sign]
        words = [f"length = {section.length.written}", f"diameter = {diameters[0].written}"]
        if diameters[0].number != diameters[1].number:
            words.append(f"end_diameter = {diameters[1].written}")
        bores = [each.number for each in section.bores]
        if bores[0] != bores[1]:
            raise _Incomplete(f"{section.component} has a bore that is a cone")
        return ", ".join([*words, f"bore = {section.bores[0].written}"] if bores[0] else words)

    def _material(self) -> dict[str, Value | None]:
        names = {
            "youngs_modulus": ("elastic_modulus", "MPa"),
            "poissons_ratio": ("poisson_ratio", ""),
            "density": ("density", "g / cm^3"),
        }
        materials = self.model.partners("reference", "referenced", origin=self.shaft)
        stated = [each for each in materials if each.type == "material"][:1]
        return {
            field: value_of(each, name, unit)
            for each in stated
            for field, (name, unit) in names.items()
            if name in each.attributes
        }

    def _bearings(self) -> Iterator[dict[str, Value | None]]:
        for relation in self.model.related("side", inner_part=self.shaft):
            bearing, outer = (self.model.components[relation.roles[role]] for role in ("assembly", "outer_part"))
            if "bearing" not in bearing.type:
                continue
            if outer.type != "gear_casing":
                raise _Incomplete(f"{bearing} holds it in {outer}")
            yield {"at": self.place(bearing), **self._stiffnesses(bearing)}

    def _stiffnesses(self, bearing: Component) -> dict[str, Value]:
        found = {}
        for field, (name, unit) in STIFFNESSES.items():
            value = value_of(bearing, name, unit) if name in bearing.attributes else None
            if value is not None and value.number > 0.0:
                found[field] = value if value.number < RIGID or field == "tilting_stiffness" else _rigid(value)
        if "radial_stiffness" not in found:
            raise _Incomplete(f"{bearing} has no radial_stiffness")
        absorbs = bearing.attributes.get("axial_force_absorption")
        if "axial_stiffness" not in found and absorbs and word_of(bearing, absorbs.id) != "no_direction":
            why = f"axial_force_absorption of component {bearing.id} without a stiffness"
            found["axial_stiffness"] = computed(RIGID, 1.0, "N/mm", why, assumed=True)
        return found


def _rigid(value: Value) -> Value:
    return computed(RIGID, 1.0, "N/mm", f"{value.origin} is {value.words}, as good as rigid", assumed=True)
