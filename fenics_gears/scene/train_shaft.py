"""One shaft of a train: which gears it carries, and what it is made of; and mistakes in its sections."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any

from fenics_gears.dynamics.bearings import MOST_BEARINGS, Bearing
from fenics_gears.dynamics.shafts import (
    INTEGRAL,
    MOST_SECTIONS,
    PRESS_FIT,
    RIGID_SEAT,
    HousingFile,
    ShaftMaterial,
    ShaftSection,
    housing_file,
)
from fenics_gears.geometry.train_graph import TrainGraph
from fenics_gears.inputs.allowed import Allowed, Refused
from fenics_gears.inputs.fields import declared, quantities, quantity
from fenics_gears.inputs.problem import Path, Problem
from fenics_gears.inputs.section import AllowedTables, Section, names_in
from fenics_gears.inputs.written import as_written

SEATS = (RIGID_SEAT, PRESS_FIT, INTEGRAL)


@dataclass(frozen=True, kw_only=True)
class AllowedGears(Allowed):
    """A list of names of gears."""

    def convert(self, value: Any) -> tuple[str, ...]:
        if not isinstance(value, list) or not all(isinstance(each, str) for each in value):
            raise Refused("is no list of names of gears.")
        return tuple(value)


@dataclass(frozen=True, kw_only=True)
class AllowedSeats(Allowed):
    """A list of kinds of seats."""

    def convert(self, value: Any) -> tuple[str, ...]:
        if not isinstance(value, list) or not all(each in SEATS for each in value):
            raise Refused("is no list of seats.")
        return tuple(value)


@dataclass(frozen=True)
class TrainShaft(Section):
    """``[shafts.NAME]`` of a train: the gears on one shaft, and how it twists between them, or between its gear and the
    drive or the load; with `sections` it also bends."""

    alternatives = (("torsional_stiffness", "sections"),)

    carries: tuple[str, ...] = declared(
        AllowedGears(description='a list of gears, such as ["first.wheel", "second.pinion"]'), default=()
    )
    torsional_stiffness: float | None = quantity(
        "1e-6 N mm/rad to 1e24 N mm/rad",
        "0.2e9 N mm/rad",
        meaning="torsional stiffness between the gears of the shaft; of the first shaft between drive and gear, of"
        " one that drives no gear between gear and load",
        otherwise="the shaft is rigid, or it follows from `sections`",
    )
    sections: tuple[ShaftSection, ...] | None = declared(
        AllowedTables(
            description='a list of sections, such as [{ length = "32 mm", diameter = "28 mm" }], each with the fields'
            f" {', '.join(names_in(ShaftSection))}",
            section=ShaftSection,
            singular="section",
            empty="For a shaft that does not bend, leave it out.",
            most=MOST_SECTIONS,
            meaning="parts of the shaft from left to right, the right end being that from which the first gear of the"
            " train is seen to turn counter-clockwise: it then bends, twists and stretches on bearings of its own",
            otherwise="the shaft does not bend",
        )
    )
    gears_at: tuple[float, ...] | None = quantities(
        "0 mm to 100 m",
        "25 mm",
        "115 mm",
        meaning="middles of the faces of the gears, in the order of `carries`, from the left end",
        otherwise="required with `sections`",
    )
    seats: tuple[str, ...] | None = declared(
        AllowedSeats(
            description=f'a list such as ["{RIGID_SEAT}", "{INTEGRAL}"] of {", ".join(map(as_written, SEATS))}',
            meaning="how the gears sit, in the order of `carries`, as those of a pair",
            otherwise=f"all of them {RIGID_SEAT}",
        )
    )
    torque_at: float | None = quantity(
        "0 mm to 100 m",
        "0 mm",
        meaning="where the motor or the load is coupled, from the left end, of the first shaft and those that drive no"
        " gear",
        otherwise="required there with `sections`",
    )
    material: ShaftMaterial = ShaftMaterial()
    bearings: tuple[Bearing, ...] | None = declared(
        AllowedTables(
            description='a list of bearings, such as [{ at = "12 mm", radial_stiffness = "0.3e6 N/mm" }], each with the'
            f" fields {', '.join(names_in(Bearing))}",
            section=Bearing,
            singular="bearing",
            empty="A shaft with sections turns in bearings.",
            most=MOST_BEARINGS,
            meaning="bearings of a shaft with sections, also written as tables `[[shafts.NAME.bearings]]`, as a pair"
            " has them",
            otherwise="required with `sections`",
        )
    )
    housing: HousingFile | None = housing_file(
        "this shaft's bearings, in the form of a pair's, but along x to the right and y upwards, as directions of"
        " stages are counted",
        "the housing is rigid, or that of `[shafts]`",
    )
    clocking: float | None = quantity(
        "-1 rad to 1 rad",
        "0.002 rad",
        meaning="of a shaft in a loop: angle by which the second of its two gears is turned ahead, as the shaft turns,"
        " of where the loop closes exactly",
        otherwise="0 rad",
    )


@dataclass(frozen=True)
class TrainHousing(Section):
    """What `[shafts]` of a train has beside its shafts."""

    housing: HousingFile | None = housing_file(
        "the bearings of all shafts with sections, which it ties together, in the order of the scene and in the form of"
        " that of one shaft",
        "each shaft has its own, if any",
    )


@dataclass(frozen=True)
class BentShaft:
    """A shaft with a section of its own, its `name` and its `number` in the train; it bends where it has sections."""

    name: str
    number: int
    own: TrainShaft


def wrong_sections(
    shaft: TrainShaft, place: Path, graph: TrainGraph, number: int, shared: Collection[str]
) -> Iterator[Problem]:
    """A shaft with sections says where its gears are, has bearings and, at an end of the train, a coupling; another one
    has nothing of it; its `number` in the train; `shared`: the gears that stand in several meshes."""
    if shaft.sections is None:
        for name in ("gears_at", "seats", "torque_at", "material", "bearings", "housing"):
            if getattr(shaft, name) not in (None, ShaftMaterial()):
                said = "has no effect: it is of a shaft with sections. Add sections, or leave it out."
                yield Problem((*place, name), "", said)
        return
    at_an_end = number == 0 or number in graph.outputs
    count = len(shaft.carries)
    if shaft.gears_at is None or len(shaft.gears_at) != count:
        allowed = (
            f"Allowed: {count} {'length' if count == 1 else 'lengths'} from the left end, in the order of carries."
        )
        said = (
            "is missing"
            if shaft.gears_at is None
            else f"has another number of places, {len(shaft.gears_at)}, than gears, {count}"
        )
        yield Problem((*place, "gears_at"), None if shaft.gears_at is None else "", f"{said}. {allowed}")
    if shaft.seats is not None and len(shaft.seats) != count:
        said = f"has another number of seats, {len(shaft.seats)}, than gears, {count}. Allowed: one for each."
        yield Problem((*place, "seats"), "", said)
    for gear, seat in zip(shaft.carries, shaft.seats or ()):
        if gear in shared and seat != RIGID_SEAT:
            said = f'of {gear}, which is in several meshes, is not yet computed. Allowed for it: "{RIGID_SEAT}".'
            yield Problem((*place, "seats"), f'"{seat}"', said)
    if shaft.bearings is None:
        said = (
            f"is missing: nothing holds the shaft, which has sections. Add its bearings, each as a table"
            f" [[{'.'.join(place)}.bearings]] with at and radial_stiffness."
        )
        yield Problem((*place, "bearings"), None, said)
    if at_an_end and shaft.torque_at is None:
        said = 'is missing. Allowed: a length from the left end of the shaft, such as "0 mm".'
        yield Problem((*place, "torque_at"), None, said)
    elif not at_an_end and shaft.torque_at is not None:
        said = "is of the first shaft or one that drives no gear, where the drive or a load is coupled. Leave it out."
        yield Problem((*place, "torque_at"), "", said)
