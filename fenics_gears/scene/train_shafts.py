"""What couples the stages of a train: shafts that twist, masses, bearings and damping; and mistakes in their sections.

Without any of it rigid shafts hand on torque and rotation alone, and each stage is by itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import Any

from fenics_gears.dynamics.bearings import MOST_BEARINGS, Bearing
from fenics_gears.dynamics.damping import Damping
from fenics_gears.dynamics.inertia import LoadInertia
from fenics_gears.dynamics.shafts import MOST_SECTIONS, ShaftMaterial, ShaftSection
from fenics_gears.inputs.allowed import Allowed, Refused
from fenics_gears.inputs.fields import declared, quantities, quantity
from fenics_gears.inputs.problem import Path, Problem, did_you_mean
from fenics_gears.inputs.section import AllowedTables, Section, names_in, read
from fenics_gears.inputs.written import as_written

# What shafts of pairs have beside.
NOT_YET = {
    "seat": "is not yet computed in trains: gears sit rigidly over their width. Leave it out.",
    "housing": "is not yet computed in trains: bearings stand in a rigid housing. Leave it out.",
}
# Sections of a train of which each makes its stages move together.
COUPLING = ("shafts", "inertia", "bearings")


@dataclass(frozen=True, kw_only=True)
class AllowedGears(Allowed):
    """A list of names of gears."""

    def convert(self, value: Any) -> tuple[str, ...]:
        if not isinstance(value, list) or not all(isinstance(each, str) for each in value):
            raise Refused("is no list of names of gears.")
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
        meaning="torsional stiffness between the gears of the shaft; of the first shaft between drive and gear, of the"
        " last between gear and load",
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
    torque_at: float | None = quantity(
        "0 mm to 100 m",
        "0 mm",
        meaning="where the motor or the load is coupled, from the left end, of the first and the last shaft",
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


@dataclass(frozen=True)
class BentShaft:
    """A shaft with sections, its `name` and its `number` in the train."""

    name: str
    number: int
    own: TrainShaft


@dataclass(frozen=True)
class TrainShafts:
    """Torsional stiffness (N mm/rad) of each shaft of a train, None where it is rigid; the moment of inertia
    (N mm s^2) of the load, and the damping, None where there is none. `moving`: whether stages move together. `bent`:
    the shafts that also bend."""

    torsion: tuple[float | None, ...] = ()
    load: float | None = None
    damping: Damping | None = None
    moving: bool = False
    bent: tuple[BentShaft, ...] = ()


def gears_of_shafts(stages: Mapping[str, Any]) -> list[list[str]]:
    """Names of the gears on each shaft of a train, from the driven one on: STAGE.pinion and STAGE.wheel, in a row
    STAGE.1, STAGE.2 and so on."""
    shafts: list[list[str]] = []
    for stage, content in stages.items():
        gears = content.get("gears") if isinstance(content, Mapping) else None
        own = [f"{stage}.pinion", f"{stage}.wheel"]
        if isinstance(gears, list):
            own = [f"{stage}.{number}" for number in range(1, len(gears) + 1)]
        if shafts:
            shafts[-1].append(own[0])
        else:
            shafts.append(own[:1])
        shafts += [[each] for each in own[1:]]
    return shafts


def checked_shafts(tree: Mapping[str, Any], shafts: Sequence[Sequence[str]]) -> tuple[TrainShafts, list[Problem]]:
    """What couples the stages of a parsed train, and what is wrong with it; `shafts`: names of the gears on each."""
    problems: list[Problem] = []
    torsion: list[float | None] = [None] * len(shafts)
    bent: list[BentShaft] = []
    for name, content in _sections(tree, "shafts", problems):
        place = ("shafts", name)
        shaft, wrong = read(TrainShaft, content, place)
        problems += [explained(each, TrainShaft) for each in wrong]
        if shaft is not None:
            problems += _put(torsion, bent, shaft, shafts, place)
    if "bearings" in tree and {gear for each in bent for gear in each.own.carries} >= {*chain(*shafts)}:
        said = "has no effect: all gears are on shafts with bearings of their own. Leave it out."
        problems.append(Problem(("bearings",), "", said))
    load = _load(tree, problems)
    damping = _damping(tree, problems)
    moving = any(name in tree for name in COUPLING) or any(
        name in content for content in _tables(tree["stages"]) for name in COUPLING
    )
    if damping is not None and "inertia" not in tree:
        problems.append(Problem(("damping",), "", "needs the section [inertia], which is missing. Add it."))
    at_load = torsion[-1] is not None or any(each.number == len(shafts) - 1 for each in bent)
    if "inertia" in tree and load is None and at_load:
        said = "is missing. The far end of the last shaft needs a moment of inertia: add [inertia.load]."
        problems.append(Problem(("inertia", "load"), None, said))
    return TrainShafts(tuple(torsion), load, damping, moving, tuple(bent)), problems


def _sections(tree: Mapping[str, Any], name: str, problems: list[Problem]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Sections with names of the user's."""
    written = tree.get(name, {})
    if not isinstance(written, Mapping):
        problems.append(Problem((name,), as_written(written), f"is not a section. Allowed: sections [{name}.NAME]."))
        return
    for each, content in written.items():
        if isinstance(content, Mapping):
            yield each, content
        else:
            said = (
                f"is not of a train. Allowed: sections [{name}.NAME], each of a shaft with the gears that it carries."
            )
            problems.append(Problem((name, each), as_written(content), said))


def _tables(written: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return [each for each in written.values() if isinstance(each, Mapping)]


def _put(
    torsion: list[float | None], bent: list[BentShaft], shaft: TrainShaft, shafts: Sequence[Sequence[str]], place: Path
) -> Iterator[Problem]:
    """Enter the stiffness of a shaft, or its sections."""
    carried = [sorted(each) for each in shafts]
    if sorted(shaft.carries) not in carried:
        known = "; ".join(", ".join(f'"{gear}"' for gear in each) for each in shafts)
        unknown = next((gear for gear in shaft.carries if not any(gear in each for each in shafts)), None)
        meant = "" if unknown is None else did_you_mean(unknown, [gear for each in shafts for gear in each])
        said = f"are not the gears of one shaft.{meant} The shafts of this train carry: {known}."
        yield Problem((*place, "carries"), as_written(list(shaft.carries)), said)
        return
    number = carried.index(sorted(shaft.carries))
    if torsion[number] is not None or any(each.number == number for each in bent):
        yield Problem((*place, "carries"), as_written(list(shaft.carries)), "are on another shaft too. Leave one out.")
        return
    at_an_end = number in (0, len(shafts) - 1)
    yield from _of_sections(shaft, place, at_an_end)
    if shaft.sections is not None:
        bent.append(BentShaft(place[-1], number, shaft))
    if shaft.torsional_stiffness is None:
        return
    if not at_an_end and len(shafts[number]) == 1:
        said = "is of an idler, between whose gears nothing twists. Leave it out."
        yield Problem((*place, "torsional_stiffness"), "", said)
        return
    torsion[number] = shaft.torsional_stiffness


def _of_sections(shaft: TrainShaft, place: Path, at_an_end: bool) -> Iterator[Problem]:
    """A shaft with sections says where its gears are, has bearings and, at an end of the train, a coupling; another one
    has nothing of it."""
    if shaft.sections is None:
        for name in ("gears_at", "torque_at", "material", "bearings"):
            if getattr(shaft, name) not in (None, ShaftMaterial()):
                said = "has no effect: it is of a shaft with sections. Add sections, or leave it out."
                yield Problem((*place, name), "", said)
        return
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
        said = "is of the first or the last shaft, where the drive or the load is coupled. Leave it out."
        yield Problem((*place, "torque_at"), "", said)


def _load(tree: Mapping[str, Any], problems: list[Problem]) -> float | None:
    inertia = tree.get("inertia")
    if not isinstance(inertia, Mapping) or "load" not in inertia:
        return None
    place = ("inertia", "load")
    if not isinstance(inertia["load"], Mapping):
        problems.append(Problem(place, as_written(inertia["load"]), "is not a section with moment_of_inertia."))
        return None
    load, wrong = read(LoadInertia, inertia["load"], place)
    problems += [explained(each, LoadInertia) for each in wrong]
    return None if load is None else load.moment_of_inertia


def _damping(tree: Mapping[str, Any], problems: list[Problem]) -> Damping | None:
    written = tree.get("damping")
    if written is None:
        return None
    if not isinstance(written, Mapping):
        problems.append(Problem(("damping",), as_written(written), "is not a section, such as one with ratio = 0.05."))
        return None
    for gear in ("pinion", "wheel"):
        if gear in written:
            said = "is of a pair. Allowed: one damping of the whole train."
            problems.append(Problem(("damping", gear), "", said))
    damping, wrong = read(Damping, written, ("damping",))
    problems += [explained(each, Damping) for each in wrong]
    return damping


def explained(problem: Problem, section: type[Section]) -> Problem:
    """A problem with an unknown name told with those of its section."""
    if not problem.unknown:
        return problem
    if section is TrainShaft and problem.path[-1] in NOT_YET:
        return replace(problem, message=NOT_YET[problem.path[-1]])
    names = names_in(section)
    said = f"is not known here.{did_you_mean(problem.path[-1], names)} Known: {', '.join(names)}."
    return replace(problem, message=said)
