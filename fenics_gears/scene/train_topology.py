"""Which gears of a train mesh, by the names in its stages, and which stand on one shaft; and mistakes in it.

A stage declares its gears, or names one of another stage, which then has a further mate. The wheel of a stage is on one
shaft with the pinion that the next stage declares, unless a shaft is said to carry one of them.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from fenics_gears.geometry.train_graph import TrainGraph, groups
from fenics_gears.inputs.problem import Problem, did_you_mean
from fenics_gears.inputs.tree import GEARS

Shafts = list[list[str]]


@dataclass(frozen=True)
class NamedMesh:
    """A mesh by the names of its gears: that of this `number` in its stage, which has so many (`count`). `internal`:
    whether its wheel is an internal gear."""

    stage: str
    number: int
    count: int
    gears: tuple[str, str]
    internal: bool = False

    @property
    def name(self) -> str:
        if self.count == 1:
            return self.stage
        return f"{self.stage}: gears {self.number + 1} and {self.number + 2}"

    @property
    def places(self) -> list[tuple[str, ...]]:
        """Where the scene has its gears."""
        if self.count == 1:
            return [("stages", self.stage, name) for name in GEARS]
        return [("stages", self.stage, "gears", str(self.number + place)) for place in (1, 2)]


def gears_within(stage: str, content: Any) -> list[tuple[str, Any]]:
    """Names and what is written of the gears of a stage: STAGE.pinion and STAGE.wheel, in a row STAGE.1 and so on."""
    content = content if isinstance(content, Mapping) else {}
    gears = content.get("gears")
    if isinstance(gears, list):
        return [(f"{stage}.{number}", each) for number, each in enumerate(gears, 1)]
    return [(f"{stage}.{name}", content.get(name)) for name in GEARS]


def named_meshes(stages: Mapping[str, Any]) -> tuple[list[NamedMesh], list[Problem]]:
    """The meshes of the stages, those together in which one gear stands, and what is wrong with the names."""
    known = declared_gears(stages)
    internal = [
        name for stage, own in stages.items() for name, written in gears_within(stage, own) if is_internal_gear(written)
    ]
    meshes: list[NamedMesh] = []
    problems: list[Problem] = []
    for stage, content in stages.items():
        named = [(name if _declared(written) else str(written)) for name, written in gears_within(stage, content)]
        for number, both in enumerate(zip(named, named[1:])):
            mesh = NamedMesh(stage, number, len(named) - 1, both, both[1] in internal)
            wrong = list(_wrong_names(mesh, known, meshes))
            problems += wrong
            meshes += [] if wrong else [mesh]
    # Of a row each gear is in two meshes: its names are told once.
    return _together(meshes), list(dict.fromkeys(problems))


def declared_gears(stages: Mapping[str, Any]) -> list[str]:
    """Names of the gears that stages declare."""
    return [name for stage, own in stages.items() for name, written in gears_within(stage, own) if _declared(written)]


def is_internal_gear(written: Any) -> bool:
    """Whether what is written of a gear is an internal one."""
    if not isinstance(written, Mapping):
        return False
    teeth = written.get("teeth")
    return written.get("internal") is True or isinstance(teeth, int) and teeth < 0


def coupled_stages(stages: Mapping[str, Any]) -> set[str]:
    """Stages of which a gear stands in several meshes."""
    meshes, _ = named_meshes(stages)
    gears = [gear for mesh in meshes for gear in mesh.gears]
    return {mesh.stage for mesh in meshes if any(gears.count(gear) > 1 for gear in mesh.gears)}


def _declared(written: Any) -> bool:
    return not isinstance(written, str)


def _wrong_names(mesh: NamedMesh, known: Sequence[str], before: Sequence[NamedMesh]) -> Iterator[Problem]:
    unknown = [(place, gear) for place, gear in zip(mesh.places, mesh.gears) if gear not in known]
    for place, gear in unknown:
        said = f"is no gear that a stage declares.{did_you_mean(gear, known)} Known: {_quoted(known)}."
        yield Problem(place, f'"{gear}"', said)
    if unknown:
        return
    if mesh.gears[0] == mesh.gears[1]:
        yield Problem(mesh.places[1], f'"{mesh.gears[1]}"', "is the other gear of this mesh: no gear is its own mate.")
    for other in before:
        if set(other.gears) == set(mesh.gears):
            said = f"meshes with this gear in {other.name} already. Allowed: one mesh of two gears."
            yield Problem(mesh.places[1], f'"{mesh.gears[1]}"', said)


def _together(meshes: Sequence[NamedMesh]) -> list[NamedMesh]:
    """Meshes in their order, but those of one gear beside each other."""
    of_gears: dict[str, list[int]] = {}
    for number, mesh in enumerate(meshes):
        for gear in mesh.gears:
            of_gears.setdefault(gear, []).append(number)
    return [meshes[number] for own in groups(range(len(meshes)), of_gears.values()) for number in own]


def shafts_by_order(stages: Mapping[str, Any], carried: Iterable[Sequence[str]] = ()) -> Shafts:
    """Names of the gears on each shaft: those that are `carried` together, and what follows from the order of the
    stages."""
    shafts = [list(each) for each in carried]
    taken = {gear for each in shafts for gear in each}
    last: str | None = None
    for stage, content in stages.items():
        gears = gears_within(stage, content)
        for place, (name, written) in enumerate(gears):
            if not _declared(written) or name in taken:
                continue
            # A gear that the stage names again meshes here: it is not on a shaft with its mate.
            if place == 0 and last is not None and last not in taken and last not in map(str, dict(gears).values()):
                next(each for each in shafts if last in each).append(name)
            else:
                shafts.append([name])
        # A gear of another stage has its place there.
        last = gears[-1][0] if _declared(gears[-1][1]) else None
    return shafts


def in_order(meshes: Sequence[NamedMesh], shafts: Shafts, loaded: Collection[str] = ()) -> tuple[Shafts, list[str]]:
    """The shafts of a train from the driven one on, and what is wrong with them, in words. `loaded`: gears on shafts
    with loads of their own, beside which there is one more; its shaft is the last one."""
    of_gear = {gear: number for number, each in enumerate(shafts) for gear in each}
    between = [(of_gear[mesh.gears[0]], of_gear[mesh.gears[1]]) for mesh in meshes]
    said = list(_wrong_shafts(meshes, shafts, between))
    if said:
        return shafts, said
    driving = {one for one, _ in between}
    behind = [number for number, own in enumerate(shafts) if number not in driving and not {*own} & {*loaded}]
    order: list[int] = []
    left = list(range(len(shafts)))
    while left:
        waiting = {other for one, other in between if one in left}
        # The last shaft waits for all others.
        free = [shaft for shaft in left if shaft not in waiting and (shaft not in behind or len(left) == 1)]
        free = free or [shaft for shaft in left if shaft not in waiting]
        found = free[0] if free else None
        if found is None:
            named = _quoted(gear for number in left for gear in shafts[number])
            return shafts, [f"power would go round in a circle through {named}: each is driven by another one."]
        order.append(found)
        left.remove(found)
    found_shafts = [shafts[number] for number in order]
    return found_shafts, list(_wrong_senses(meshes, graph_of(meshes, found_shafts)))


def graph_of(meshes: Sequence[NamedMesh], shafts: Sequence[Sequence[str]]) -> TrainGraph:
    """The graph of a train, its shafts from the driven one on."""
    of_gear = {gear: number for number, each in enumerate(shafts) for gear in each}
    gears = list(dict.fromkeys(gear for mesh in meshes for gear in mesh.gears))
    of_meshes = tuple((gears.index(mesh.gears[0]), gears.index(mesh.gears[1])) for mesh in meshes)
    internal = frozenset(number for number, mesh in enumerate(meshes) if mesh.internal)
    return TrainGraph(of_meshes, tuple(of_gear[gear] for gear in gears), internal=internal)


def _wrong_shafts(
    meshes: Sequence[NamedMesh], shafts: Sequence[Sequence[str]], between: Sequence[tuple[int, int]]
) -> Iterator[str]:
    for mesh, (one, other) in zip(meshes, between):
        if one == other:
            yield f"{_quoted(mesh.gears)} mesh and stand on one shaft, which cannot turn then."
    parts = groups(range(len(shafts)), between)
    if len(parts) > 1:
        named = " and ".join(_quoted(gear for shaft in part for gear in shafts[shaft]) for part in parts)
        yield f"the train is in {len(parts)} parts that no mesh and no shaft joins: {named}."
        return
    driven = {other for _, other in between}
    first = [each for number, each in enumerate(shafts) if number not in driven]
    if len(first) > 1:
        named = " and ".join(_quoted(each) for each in first)
        yield f"no gear drives the shafts of {named}: two turns would be prescribed. Allowed: one driven shaft."


def _wrong_senses(meshes: Sequence[NamedMesh], graph: TrainGraph) -> Iterator[str]:
    for number, (mesh, (driving, driven)) in enumerate(zip(meshes, graph.between)):
        if graph.senses[driven] != graph.onwards(number) * graph.senses[driving]:
            if mesh.internal:
                yield (
                    f"the loop that {mesh.name} closes locks: its gears, {_quoted(mesh.gears)}, would turn against each"
                    " other. An internal gear turns the same way as the gear within it."
                )
                return
            yield (
                f"the loop that {mesh.name} closes locks: both of its gears, {_quoted(mesh.gears)}, would turn the same"
                " way. Gears that mesh turn against each other, so that a loop has an even number of meshes."
            )
            return


def _quoted(names: Iterable[str]) -> str:
    return ", ".join(f'"{each}"' for each in names)
