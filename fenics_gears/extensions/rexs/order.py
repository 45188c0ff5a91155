"""The stages and planetary sets of a REXS file in the order in which power goes through them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from .model import Component, Relation, RexsModel
from .planetary_sets import PlanetarySet, found_set
from .stage import Stage, driving_gear, relations_of_pairs, stage_of
from .train import Train
from .transmission import CARRIER, PLANETARY
from .values import ValueProblem, numbered


@dataclass(frozen=True)
class SetStages:
    """A planetary set with the pairs of each planet: the sun drives it, and it drives the ring, as the carrier sees
    it. ``held``, ``input`` and ``output``: names of its members."""

    own: PlanetarySet
    sun_meshes: tuple[Stage, ...]
    ring_meshes: tuple[Stage, ...]
    held: str
    input: str
    output: str

    @property
    def stage(self) -> Component:
        return self.own.stage


Unit = Stage | SetStages


def entry_of(unit: Unit) -> Component:
    """The part by which power comes in."""
    return unit.pinion.gear if isinstance(unit, Stage) else unit.own.members[unit.input]


def exit_of(unit: Unit) -> Component:
    """The part by which power goes out."""
    return unit.wheel.gear if isinstance(unit, Stage) else unit.own.members[unit.output]


def described(unit: Unit) -> str:
    """Who drives whom."""
    ends = f"{entry_of(unit)} drives {exit_of(unit)}"
    return f"{ends}." if isinstance(unit, Stage) else f"{ends}, {unit.own.members[unit.held]} is held."


def units_in_order(model: RexsModel) -> list[Unit]:
    """All of a gearbox, each behind what drives it. Raises ValueProblem where it is not driven by one shaft."""
    return _Gearbox(model).in_order()


def is_series(model: RexsModel, units: Sequence[Unit]) -> bool:
    """Whether each drives the next one alone, without loads on the shafts between."""
    train = Train(model)
    place = train.place
    if any(train.loads(exit_of(each)) for each in units[:-1]):
        return False
    entries = [place(entry_of(each)) for each in units]
    exits = [place(exit_of(each)) for each in units]
    return exits[:-1] == entries[1:] and len({*exits}) == len(units)


class _Gearbox:
    """The units of a model, by the places of their ends."""

    def __init__(self, model: RexsModel) -> None:
        self.model = model
        self.train = Train(model)
        stages = [each for each in model.components.values() if each.type == PLANETARY]
        self.sets = [found_set(model, each) for each in stages]
        inner = {each.roles["stage"] for own in self.sets for each in (*own.sun_meshes, *own.ring_meshes)}
        self.pairs = [each for number, each in relations_of_pairs(model).items() if number not in inner]
        self._check_carriers()

    def in_order(self) -> list[Unit]:
        waiting: list[Unit] = [*map(self._set, self.sets), *map(self._pair, self.pairs)]
        place = self.train.place
        entries = {each.stage.id: place(entry_of(each)) for each in waiting}
        exits = {each.stage.id: place(exit_of(each)) for each in waiting}
        driven = set(exits.values())
        first = list(dict.fromkeys(each for each in entries.values() if each not in driven))
        if len(first) != 1:
            raise ValueProblem(f"has {len(first)} shafts that drive and that no stage drives; a train has one.")
        found: list[Unit] = []
        reached = first[0]
        while waiting:
            undriven = {*entries.values()} - {exits[each.stage.id] for each in waiting}
            reachable = {first[0], *(exits[each.stage.id] for each in found)}
            free = [each for each in waiting if entries[each.stage.id] in undriven & reachable]
            if not free:
                left = numbered([each.stage.id for each in waiting])
                raise ValueProblem(
                    f"only {len(found)} of its {len(found) + len(waiting)} stages follow each other by their shafts,"
                    f" not {left}."
                )
            following = next((each for each in free if entries[each.stage.id] == reached), free[0])
            found.append(following)
            waiting.remove(following)
            reached = exits[following.stage.id]
        if self.sets and not is_series(self.model, found):
            sets = numbered([each.stage.id for each in self.sets])
            raise ValueProblem(
                f"has power on several paths, or loads between stages, beside its planetary sets, {sets}. Allowed: one"
                " path through all stages, with loads at its ends;"
                " import pairs one by one, with --stage."
            )
        return found

    def _pair(self, relation: Relation) -> Stage:
        gears = (self.model.components[relation.roles[role]] for role in ("gear_1", "gear_2"))
        said = driving_gear(self.model, relation, self.train)
        return stage_of(self.model, relation, said or self._nearer(*gears))

    def _nearer(self, one: Component, other: Component) -> Component | None:
        """The one of both ends that is nearer to where power is known to come in; None where that is not known."""
        far = [self._levels.get(self.train.place(each)) for each in (one, other)]
        if None in far or far[0] == far[1]:
            return None
        return one if far[0] < far[1] else other

    @cached_property
    def _levels(self) -> dict[int, int]:
        """Over how many stages each place is from the one that a load drives; empty where not one is known."""
        place = self.train.place
        links: list[tuple[int, int]] = [
            (place(self.model.components[each.roles["gear_1"]]), place(self.model.components[each.roles["gear_2"]]))
            for each in self.pairs
        ]
        for own in self.sets:
            ends = [place(member) for name, member in own.members.items() if name not in self.train.held(own)]
            links += [(ends[0], ends[1])] if len(ends) == 2 else []
        loaded = {place(self.model.components[number]) for number in self._loaded()}
        if len(loaded) != 1:
            return {}
        levels = dict.fromkeys(loaded, 0)
        waiting = list(loaded)
        while waiting:
            here = waiting.pop(0)
            for one, other in (*links, *(each[::-1] for each in links)):
                if one == here and other not in levels:
                    levels[other] = levels[here] + 1
                    waiting.append(other)
        return levels

    def _loaded(self) -> list[int]:
        """Loads that are known to drive."""
        loads = [each for each in self.model.components.values() if each.type == "external_load"]
        shares = [(each.id, share) for each in loads for share in self.train.loads(each)]
        return [number for number, share in shares if share is not None and (share.power or 0.0) > 0.0]

    def _set(self, own: PlanetarySet) -> SetStages:
        """A set with the way of its power. Raises ValueProblem."""
        held = self.train.held(own)
        names = ", ".join(f"{name} (component {member.id})" for name, member in own.members.items())
        if len(held) != 1:
            what = f"{' and '.join(held)} are" if held else "none is"
            raise ValueProblem(
                f"{own.stage}: of its members, {names}, {what} joined to the casing. Allowed: one of them, which is"
                " held."
            )
        ends = [name for name in own.members if name != held[0]]
        driving = self.train.driving(own.stage, *(own.members[name] for name in ends))
        if driving is None:
            driving = self._nearer(*(own.members[name] for name in ends))
        entry = next((name for name in ends if driving is not None and own.members[name].id == driving.id), ends[0])
        suns = tuple(stage_of(self.model, each, own.members["sun"]) for each in own.sun_meshes)
        rings = tuple(stage_of(self.model, each, gear) for each, gear in zip(own.ring_meshes, own.planets))
        return SetStages(own, suns, rings, held[0], entry, next(name for name in ends if name != entry))

    def _check_carriers(self) -> None:
        """Raise ValueProblem for a carrier of no set."""
        known = {own.members["carrier"].id for own in self.sets}
        for each in self.model.components.values():
            if each.type == CARRIER and each.id not in known:
                raise ValueProblem(
                    f"{each} is a part of no {PLANETARY}: which gears are its planets, the file does not say."
                    " Allowed: an assembly of both. Pairs of gears can be imported one by one, with --stage."
                )
