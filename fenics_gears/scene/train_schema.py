"""What the scene file of a train may have, section by section; `train_rules` says what is wrong with one."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, fields, make_dataclass
from typing import Any, get_type_hints

from fenics_gears.contact.eccentricity import Eccentricity
from fenics_gears.effects import effect_named
from fenics_gears.geometry.planetary import RING
from fenics_gears.inputs.fields import choice, declared, quantities, quantity
from fenics_gears.inputs.section import AllowedTables, Section

from .accuracy import Accuracy
from .gear_schema import Gears, GearText
from .planetary_points import RingText
from .planetary_schema import (
    GEARS_OF_SET,
    MESHES,
    OF_A_MESH,
    OF_THE_STEP,
    PLANETARY,
    SUN_MESH,
    PlanetaryText,
    RunOutsOfSet,
)
from .train_joints import JoinsText
from .train_rules import OF_A_STAGE, PAIR, ROW, RUN_OUT, SHARED
from .train_whole import WholeTrain

ACCURACY = "accuracy"
ANGLES = "-360 deg to 360 deg"
GEARS_OF_A_ROW = AllowedTables(
    description="a list of tables, a gear each",
    section=GearText,
    singular="gear",
    empty="A row has at least two gears.",
    otherwise="`pinion` and `wheel`",
    most=1000,
)


@dataclass(frozen=True, kw_only=True)
class _Stage(Gears):
    """``[stages.NAME]``: a pair of gears, a row of them, or a planetary set."""

    kind: str | None = choice(
        PAIR,
        ROW,
        PLANETARY,
        meaning="a pair of gears, a row with idlers, or a planetary set (`demos/planetary_sets/README.md`)",
        otherwise="`pair`",
    )
    direction: float | None = quantity(
        ANGLES, "35 deg", meaning="direction of the wheel's centre from the pinion's", otherwise="0 deg"
    )
    directions: tuple[float, ...] | None = quantities(
        ANGLES, "60 deg", meaning="direction of each mesh of a row", otherwise="0 deg"
    )
    gears: tuple[GearText, ...] | None = declared(GEARS_OF_A_ROW)


@dataclass(frozen=True, kw_only=True)
class _RunOuts(RunOutsOfSet, Eccentricity):
    """``[stages.NAME.eccentricity]``: of the gears of a pair, or of a set."""


@dataclass(frozen=True, kw_only=True)
class _AlwaysThere(WholeTrain, JoinsText):
    pass


@functools.cache
def stage_text() -> type[Section]:
    """The section of a stage, with those of its effects, and what a planetary set has."""
    return make_dataclass("Stage", list(_of_planets()), bases=(_with(_Stage, OF_A_STAGE),), frozen=True, kw_only=True)


def _of_planets() -> Iterator[tuple[str, Any, Any]]:
    """Name, kind and field of what a planetary set has beside the fields of all stages."""
    hints = get_type_hints(PlanetaryText)
    for each in fields(PlanetaryText):
        kind = _RunOuts | None if each.name == RUN_OUT else hints[each.name]
        yield each.name, kind, field(default=None, metadata=each.metadata)
    for gear in GEARS_OF_SET:
        yield gear, (RingText if gear == RING else GearText) | None, field(default=None)
    effects = _with(Section, OF_A_MESH)
    of_steps = make_dataclass(
        "SecondMesh", list(_optional(Gears, OF_THE_STEP)), bases=(effects,), frozen=True, kw_only=True
    )
    for mesh in MESHES:
        yield mesh, (effects if mesh == SUN_MESH else of_steps) | None, field(default=None)


def _optional(section: type[Section], names: Sequence[str]) -> Iterator[tuple[str, Any, Any]]:
    """Name, kind and field of some fields of a section, which may be left out."""
    hints = get_type_hints(section)
    for each in fields(section):
        if each.name in names:
            yield each.name, hints[each.name] | None, field(default=None, metadata=each.metadata)


@functools.cache
def train_text() -> type[Section]:
    """All sections of a train but its stages."""
    return _with(_AlwaysThere, SHARED)


def _with(base: type[Section], names: tuple[str, ...]) -> type[Section]:
    """A section with further ones within it."""
    kinds = {name: Accuracy if name == ACCURACY else effect_named(name).fields for name in names}
    inner = [(name, kind | None, field(default=None)) for name, kind in kinds.items()]
    return make_dataclass(base.__name__.strip("_"), inner, bases=(base,), frozen=True, kw_only=True)
