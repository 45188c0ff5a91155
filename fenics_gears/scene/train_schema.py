"""What the scene file of a train may have, section by section; `train_rules` says what is wrong with one."""

from __future__ import annotations

import functools
from dataclasses import dataclass, field, make_dataclass

from fenics_gears.effects import effect_named
from fenics_gears.inputs.fields import choice, declared, quantities, quantity, text
from fenics_gears.inputs.section import AllowedTables, Section

from .accuracy import Accuracy
from .gear_schema import Gears, GearText
from .train_rules import OF_A_STAGE, PAIR, ROW, SHARED, TrainLoad, TrainMotion

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
    """``[stages.NAME]``: a pair of gears, or a row of them."""

    kind: str | None = choice(PAIR, ROW, meaning="a pair of gears, or a row with idlers", otherwise="`pair`")
    direction: float | None = quantity(
        ANGLES, "35 deg", meaning="direction of the wheel's centre from the pinion's", otherwise="0 deg"
    )
    directions: tuple[float, ...] | None = quantities(
        ANGLES, "60 deg", meaning="direction of each mesh of a row", otherwise="0 deg"
    )
    gears: tuple[GearText, ...] | None = declared(GEARS_OF_A_ROW)


@dataclass(frozen=True, kw_only=True)
class _AlwaysThere(Section):
    title: str | None = text(500, meaning="title in summaries and pictures", otherwise="the name of the file")
    load: TrainLoad
    motion: TrainMotion = TrainMotion()


@functools.cache
def stage_text() -> type[Section]:
    """The section of a stage, with those of its effects."""
    return _with(_Stage, OF_A_STAGE)


@functools.cache
def train_text() -> type[Section]:
    """All sections of a train but its stages."""
    return _with(_AlwaysThere, SHARED)


def _with(base: type[Section], names: tuple[str, ...]) -> type[Section]:
    """A section with further ones within it."""
    kinds = {name: Accuracy if name == ACCURACY else effect_named(name).fields for name in names}
    inner = [(name, kind | None, field(default=None)) for name, kind in kinds.items()]
    return make_dataclass(base.__name__.strip("_"), inner, bases=(base,), frozen=True, kw_only=True)
