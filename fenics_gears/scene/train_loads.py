"""Loads and speed of a train by its shafts: what resists the rotation of each that drives no gear, and of others.

All but one of the outputs have their torques in `load.torques`; that of the one that is left, the last shaft, is given
itself or follows from what drives the first shaft.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from fenics_gears.geometry.train_graph import TrainGraph
from fenics_gears.inputs.allowed import AllowedText
from fenics_gears.inputs.fields import declared, quantity, text, whole_number
from fenics_gears.inputs.problem import Problem, did_you_mean
from fenics_gears.inputs.section import AllowedTables, Section
from fenics_gears.inputs.written import as_written

MOST_LOADS = 100
# Fields of [load] that give the torque of the last shaft.
OF_THE_REST = ("output_torque", "input_torque", "power")


@dataclass(frozen=True, kw_only=True)
class ShaftTorque(Section):
    """An entry of `load.torques`: a torque on one shaft."""

    on: str = declared(
        AllowedText(
            description='a text of at most 200 characters, such as "pump.wheel"',
            meaning="a gear of the shaft, or the name of its `[shafts.NAME]`",
            longest=200,
        )
    )
    torque: float = quantity("1e-6 N m to 1e12 N m", "20 N m", meaning="torque that resists the rotation of this shaft")
    moment_of_inertia: float | None = quantity(
        "0 kg m^2 to 1e12 kg m^2",
        "0.5 kg m^2",
        meaning="moment of inertia of this load; that of the last shaft may stand in `[inertia.load]`",
        otherwise="the load has no inertia",
    )


@dataclass(frozen=True)
class TrainLoad(Section):
    """``[load]`` of a train: by exactly one of the first three fields, and `torques` of further shafts; the gears pass
    them on without losses."""

    alternatives = (OF_THE_REST,)
    empty = "is empty. Add output_torque, input_torque or power."

    output_torque: float | None = quantity(
        "0 N m to 1e12 N m",
        "2 kN m",
        meaning="torque that resists the rotation of the last shaft",
        otherwise="from `input_torque` or `power`",
    )
    input_torque: float | None = quantity(
        "0 N m to 1e12 N m",
        "100 N m",
        meaning="torque that drives the first shaft",
        otherwise="`output_torque` or `power` is given",
    )
    power: float | None = quantity(
        "0 kW to 1e9 kW",
        "20 kW",
        meaning="power that goes through the train at the speed of `[motion]`, which is then required",
        otherwise="`output_torque` or `input_torque` is given",
    )
    torques: tuple[ShaftTorque, ...] | None = declared(
        AllowedTables(
            description='a list of tables, such as [{ on = "pump.wheel", torque = "20 N m" }]',
            section=ShaftTorque,
            singular="load",
            empty="For a train with one load, leave it out.",
            most=MOST_LOADS,
            meaning="torques on further shafts: on all that drive no gear but one, which is then the last shaft, or on"
            " all of them, in place of the fields above; also on shafts that drive gears",
            otherwise="one shaft drives no gear, and has the load",
        )
    )


@dataclass(frozen=True)
class TrainMotion(Section):
    """``[motion]`` of a train."""

    alternatives = (("input_speed", "speed"),)

    input_speed: float | None = quantity(
        "1e-9 rpm to 1e6 rpm",
        "1500 rpm",
        meaning="speed of the first shaft",
        otherwise="from `speed`, or a cycle of the first mesh takes 1 s",
    )
    speed: float | None = quantity(
        "1e-9 rpm to 1e6 rpm",
        "300 rpm",
        meaning="speed of the shaft that `speed_of` names",
        otherwise="`input_speed` is given, or none",
    )
    speed_of: str | None = text(
        200, meaning="a gear of the shaft with that speed, or the name of its `[shafts.NAME]`", otherwise="no `speed`"
    )
    mesh_cycles: int | None = whole_number(
        1,
        1000000,
        2,
        meaning="cycles that each mesh is run; where stages move together, cycles of the slowest mesh",
        otherwise="required with `[inertia]`; else one",
    )
    recorded_cycles: int | None = whole_number(
        1,
        1000000,
        2,
        meaning="cycles at the end of a run with `[inertia]`, or of a planetary set, that its numbers are taken from",
        otherwise="two; all of a set whose gears run out",
    )

    @property
    def given(self) -> bool:
        """Whether there is a speed."""
        return self.input_speed is not None or self.speed is not None


@dataclass(frozen=True)
class LoadOfShaft:
    """What is on a shaft, by its number: torque (N mm) and moment of inertia (N mm s^2), None where it has none."""

    shaft: int
    torque: float
    inertia: float | None = None


@dataclass(frozen=True)
class NamedShafts:
    """Shafts of a train by their gears (`carried`, from the driven one on) and by names of their sections."""

    carried: Sequence[Sequence[str]]
    sections: Mapping[str, Sequence[str]]

    def number(self, name: str) -> int | None:
        """The number of a shaft by the name of a gear or a section."""
        gear = name if name not in self.sections else (*self.sections[name], name)[0]
        return next((number for number, own in enumerate(self.carried) if gear in own), None)

    def unknown(self, name: str) -> str:
        """What is wrong with a name that none of them has."""
        known = [*self.sections, *(gear for own in self.carried for gear in own)]
        said = ", ".join(f'"{each}"' for each in known)
        return f"is no gear and no shaft of this train.{did_you_mean(name, known)} Known: {said}."

    def words(self, number: int) -> str:
        return ", ".join(f'"{gear}"' for gear in self.carried[number])


def loaded_gears(load: TrainLoad | None, sections: Mapping[str, Sequence[str]]) -> list[str]:
    """Names of gears on shafts that have torques of their own."""
    names = [each.on for each in (load.torques or ())] if load is not None else []
    return [gear for name in names for gear in sections.get(name, (name,))]


def loads_of_shafts(
    load: TrainLoad, written: Mapping[str, Any], shafts: NamedShafts, graph: TrainGraph
) -> tuple[tuple[LoadOfShaft, ...], list[Problem]]:
    """The torques on further shafts, and what is wrong with them; `written`: the section [load] in the file."""
    problems: list[Problem] = []
    found: dict[int, LoadOfShaft] = {}
    for place, each in enumerate(load.torques or (), 1):
        number = shafts.number(each.on)
        where = ("load", "torques", str(place), "on")
        if number is None:
            problems.append(Problem(where, as_written(each.on), shafts.unknown(each.on)))
        elif number == 0:
            said = f"is on the driven shaft, of {shafts.words(0)}, whose torque follows from all others. Leave it out."
            problems.append(Problem(where, as_written(each.on), said))
        elif number in found:
            said = f"is on the shaft of {shafts.words(number)}, which has a torque already. Give one for each shaft."
            problems.append(Problem(where, as_written(each.on), said))
        else:
            found[number] = LoadOfShaft(number, each.torque, each.moment_of_inertia)
    return tuple(found.values()), problems or list(_wrong_outputs(load, written, shafts, graph, found))


def _wrong_outputs(
    load: TrainLoad,
    written: Mapping[str, Any],
    shafts: NamedShafts,
    graph: TrainGraph,
    found: Mapping[int, LoadOfShaft],
) -> Iterator[Problem]:
    """Outputs without a torque, or with two."""
    left = [number for number in graph.outputs if number not in found]
    given = [name for name in OF_THE_REST if getattr(load, name) is not None]
    if len(left) > 1:
        named = " and ".join(shafts.words(number) for number in left)
        yield Problem(
            ("load", "torques"),
            "" if load.torques else None,
            f"is missing: the shafts of {named} drive no gear, and each has a load. Allowed: torques of all but one of"
            f' these, as [{{ on = "{shafts.carried[left[0]][0]}", torque = "20 N m" }}].',
        )
    elif left and not given:
        said = f"is missing: that of the shaft of {shafts.words(left[0])}. Allowed: one of {', '.join(OF_THE_REST)}."
        yield Problem(("load",), None, said)
    elif not left and given:
        said = "is given beside load.torques of all shafts that drive no gear, from which it follows. Leave one out."
        yield Problem(("load", given[0]), as_written(written[given[0]]), said)


def misplaced_loads(
    loads: Sequence[LoadOfShaft], tree: Mapping[str, Any], shafts: NamedShafts, graph: TrainGraph, soft: Collection[int]
) -> Iterator[Problem]:
    """Loads that do not fit to what else the parsed train has; `soft`: numbers of the shafts that twist or bend."""
    inert = "inertia" in tree
    at_last = inert and isinstance(tree["inertia"], Mapping) and "load" in tree["inertia"]
    given = {each.shaft: each.inertia for each in loads if each.inertia is not None}
    for each in loads:
        place = ("load", "torques")
        if each.shaft not in graph.outputs and each.shaft in soft:
            said = (
                f"has a torque on the shaft of {shafts.words(each.shaft)}, which drives gears and twists or bends:"
                " where it acts between the gears is not yet computed. Leave out what makes it soft, or the torque."
            )
            yield Problem(place, "", said)
        if each.inertia is not None and not inert:
            said = f"has a moment_of_inertia on the shaft of {shafts.words(each.shaft)}, which needs [inertia]. Add it."
            yield Problem(place, "", said)
    if at_last and graph.last in given:
        said = "is given, and load.torques has a moment_of_inertia of this shaft too. Leave one out."
        yield Problem(("inertia", "load"), "", said)
    for shaft in graph.outputs if inert else ():
        if shaft not in soft or shaft in given or shaft == graph.last and at_last:
            continue
        if shaft == graph.last:
            said = "is missing. The far end of the last shaft needs a moment of inertia: add [inertia.load]."
            yield Problem(("inertia", "load"), None, said)
        else:
            said = (
                f"has no moment_of_inertia on the shaft of {shafts.words(shaft)}, whose far end needs one: it twists or"
                ' bends. Add it, such as moment_of_inertia = "0.5 kg m^2".'
            )
            yield Problem(("load", "torques"), "", said)


def shaft_with_speed(motion: TrainMotion, shafts: NamedShafts) -> tuple[int, list[Problem]]:
    """The number of the shaft whose speed is given, and what is wrong with its name."""
    place = ("motion", "speed_of")
    if (motion.speed is None) != (motion.speed_of is None):
        if motion.speed is None:
            said = "names a shaft without a speed. Add motion.speed, or leave it out."
            return 0, [Problem(place, as_written(motion.speed_of), said)]
        said = 'is missing: motion.speed is of one shaft. Allowed: a gear of it, such as "first.wheel".'
        return 0, [Problem(place, None, said)]
    if motion.speed_of is None:
        return 0, []
    number = shafts.number(motion.speed_of)
    wrong = [] if number is not None else [Problem(place, as_written(motion.speed_of), shafts.unknown(motion.speed_of))]
    return number or 0, wrong
