"""What couples the stages of a train: shafts that twist, masses, bearings and damping; and mistakes in their sections.

Without any of it rigid shafts hand on torque and rotation alone, and each stage is by itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from fenics_gears.dynamics.damping import Damping
from fenics_gears.dynamics.shafts import HousingFile
from fenics_gears.effects.elastic_shaft_housing import located_housing
from fenics_gears.geometry.train_graph import TrainGraph
from fenics_gears.inputs.problem import Problem, did_you_mean
from fenics_gears.inputs.section import names_in, read, read_by_itself
from fenics_gears.inputs.written import as_written

from .carrier import Carrier
from .train_loads import LoadOfShaft, NamedShafts, loaded_gears, loads_of_shafts, misplaced_loads, shaft_with_speed
from .train_shaft import BentShaft, TrainHousing, TrainShaft, wrong_sections
from .train_topology import NamedMesh, Shafts, declared_gears, graph_of, in_order, named_meshes, shafts_by_order
from .train_whole import TrainRamp, WholeTrain

# Sections of a train of which each makes its stages move together.
COUPLING = ("shafts", "inertia", "bearings")


@dataclass(frozen=True)
class TrainShafts:
    """What the shafts of a train carry, from the driven one on, by the names of gears; and of each its torsional
    stiffness (N mm/rad) and clocking (rad), None where they are not given. The moment of inertia (N mm s^2) of the
    load, and the damping, None where there is none. `loads`: on further shafts; `speed_of`: number of the shaft whose
    speed is given. `ramp`: of the speed. `moving`: whether stages move together. `bent`: the shafts that
    also bend, and the `housing` of all of these. `carrier`: of a planetary set, in whose frame the train is."""

    carried: tuple[tuple[str, ...], ...] = ()
    torsion: tuple[float | None, ...] = ()
    clocking: tuple[float | None, ...] = ()
    load: float | None = None
    damping: Damping | None = None
    moving: bool = False
    bent: tuple[BentShaft, ...] = ()
    housing: HousingFile | None = None
    carrier: Carrier | None = None
    loads: tuple[LoadOfShaft, ...] = ()
    speed_of: int = 0
    ramp: TrainRamp | None = None

    @property
    def inertias(self) -> dict[int, float]:
        """Moments of inertia (N mm s^2) of the loads by the numbers of their shafts."""
        last = {} if self.load is None else {len(self.carried) - 1: self.load}
        return {each.shaft: each.inertia for each in self.loads if each.inertia is not None} | last

    @property
    def housed(self) -> bool:
        """Whether files have the stiffness of a housing, or of a carrier."""
        of_carrier = self.carrier is not None and self.carrier.file is not None
        return of_carrier or self.housing is not None or any(each.own.housing is not None for each in self.bent)


def checked_shafts(tree: Mapping[str, Any], whole: WholeTrain | None) -> tuple[TrainShafts, list[Problem]]:
    """What couples the stages of a parsed train, and what is wrong with it; `whole`: None where something is wrong with
    that, or with its stages."""
    problems: list[Problem] = []
    housing, wrong = _housing(tree)
    problems += wrong
    sections: dict[str, TrainShaft] = {}
    for name, content in _sections(tree, "shafts", problems):
        shaft, wrong = read_by_itself(TrainShaft, content, ("shafts", name))
        problems += wrong
        sections |= {} if shaft is None else {name: shaft}
    meshes, wrong = named_meshes(tree["stages"])
    problems += wrong
    problems += _wrong_carries(sections, tree["stages"])
    found = TrainShafts(housing=housing)
    graph = None
    if whole is not None and not problems:
        named = {name: each.carries for name, each in sections.items()}
        shafts = shafts_by_order(tree["stages"], list(named.values()))
        carried, wrong_shafts = in_order(meshes, shafts, loaded_gears(whole.load, named))
        place, by_order = (("shafts",), f" {_by_order(tree['stages'])}") if sections else (("stages",), "")
        problems += [Problem(place, "", f"{each}{by_order}") for each in wrong_shafts]
        if not wrong_shafts:
            graph = graph_of(meshes, carried)
            number_of = {gear: number for number, gears in enumerate(carried) for gear in gears}
            numbered = [BentShaft(name, number_of[own.carries[0]], own) for name, own in sections.items()]
            found = _of_sections(numbered, carried, housing)
            problems += _misplaced(tree, meshes, numbered, found)
    if whole is not None and graph is not None:
        by_name = NamedShafts(carried, named)
        loads, wrong = loads_of_shafts(whole.load, tree["load"], by_name, graph)
        speed_of, wrong_speed = shaft_with_speed(whole.motion, by_name)
        soft = {number for number, each in enumerate(found.torsion) if each is not None}
        soft |= {each.number for each in found.bent}
        problems += [*wrong, *wrong_speed, *misplaced_loads(loads, tree, by_name, graph, soft)]
        found = replace(found, loads=loads, speed_of=speed_of)
        found = replace(found, load=whole.load_inertia, damping=whole.damping, ramp=whole.speed_ramp)
    moving = any(name in each for each in (tree, *_tables(tree["stages"])) for name in COUPLING)
    # A torque between meshes is one of the equations of motion of all.
    moving |= graph is not None and not (graph.is_chain and {each.shaft for each in found.loads} <= {*graph.outputs})
    return replace(found, moving=moving), problems


def _of_sections(numbered: Sequence[BentShaft], carried: Shafts, housing: HousingFile | None) -> TrainShafts:
    """What sections say of the shafts that carry such gears."""
    own = {each.number: each.own for each in numbered}
    said = (
        tuple(getattr(own.get(number), name, None) for number in range(len(carried)))
        for name in ("torsional_stiffness", "clocking")
    )
    bent = tuple(each for each in numbered if each.own.sections is not None)
    return TrainShafts(tuple(map(tuple, carried)), *said, bent=bent, housing=housing)


def _misplaced(
    tree: Mapping[str, Any], meshes: Sequence[NamedMesh], numbered: Sequence[BentShaft], found: TrainShafts
) -> Iterator[Problem]:
    """What sections say that their shafts cannot have."""
    graph = graph_of(meshes, found.carried)
    gears = [gear for mesh in meshes for gear in mesh.gears]
    shared = {gear for gear in gears if gears.count(gear) > 1}
    for each in numbered:
        yield from _wrong_twist(each, graph)
        yield from wrong_sections(each.own, ("shafts", each.name), graph, each.number, shared)
    yield from _misplaced_housings(found.housing, found.bent)
    if "bearings" in tree and {each.number for each in found.bent} == {*range(len(found.carried))}:
        said = "has no effect: all gears are on shafts with bearings of their own. Leave it out."
        yield Problem(("bearings",), "", said)


def _sections(tree: Mapping[str, Any], name: str, problems: list[Problem]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Sections with names of the user's."""
    written = tree.get(name, {})
    if not isinstance(written, Mapping):
        problems.append(Problem((name,), as_written(written), f"is not a section. Allowed: sections [{name}.NAME]."))
        return
    for each, content in written.items():
        if isinstance(content, Mapping):
            yield each, content
        elif each in names_in(TrainHousing):
            continue
        else:
            said = (
                f"is not of a train. Allowed: sections [{name}.NAME], each of a shaft with the gears that it carries."
            )
            problems.append(Problem((name, each), as_written(content), said))


def _housing(tree: Mapping[str, Any]) -> tuple[HousingFile | None, list[Problem]]:
    """The housing of all shafts that bend, and what is wrong with it."""
    written = tree.get("shafts")
    own = written.get("housing") if isinstance(written, Mapping) else None
    if own is None or isinstance(own, Mapping):
        return None, []
    found, wrong = read(TrainHousing, {"housing": own}, ("shafts",))
    return None if found is None else found.housing, wrong


def _misplaced_housings(housing: HousingFile | None, bent: Sequence[BentShaft]) -> Iterator[Problem]:
    if housing is None:
        return
    if not bent:
        said = "is the housing of shafts with sections, and none has any. Add sections, or leave it out."
        yield Problem(("shafts", "housing"), as_written(housing.path), said)
    for each in bent:
        if each.own.housing is not None:
            said = "is given together with the housing of [shafts], which is that of all shafts. Leave one out."
            yield Problem(("shafts", each.name, "housing"), as_written(each.own.housing.path), said)


def located_shafts(shafts: TrainShafts, folder: Path) -> TrainShafts:
    """The same with the matrices of their housings, whose files are looked for from a folder on."""
    bent = tuple(replace(each, own=located_housing(each.own, folder)) for each in shafts.bent)
    return located_housing(replace(shafts, bent=bent), folder)


def _tables(written: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return [each for each in written.values() if isinstance(each, Mapping)]


def _wrong_carries(sections: Mapping[str, TrainShaft], stages: Mapping[str, Any]) -> Iterator[Problem]:
    """What is wrong with the gears that shafts carry."""
    declared = declared_gears(stages)
    carried: dict[str, str] = {}
    for name, shaft in sections.items():
        place = ("shafts", name, "carries")
        if not shaft.carries:
            yield Problem(place, "[]", f"names no gear. {_by_order(stages)}")
        for gear in shaft.carries:
            if gear not in declared:
                said = f"is no gear of this train.{did_you_mean(gear, declared)} {_by_order(stages)}"
                yield Problem(place, f'"{gear}"', said)
        for gear in shaft.carries:
            if gear in carried:
                yield Problem(place, f'"{gear}"', f"is on the shaft of [shafts.{carried[gear]}] already.")
            carried[gear] = name


def _by_order(stages: Mapping[str, Any]) -> str:
    known = "; ".join(", ".join(f'"{gear}"' for gear in each) for each in shafts_by_order(stages))
    return f"By the order of the stages alone, shafts carry: {known}."


def _wrong_twist(shaft: BentShaft, graph: TrainGraph) -> Iterator[Problem]:
    """Stiffness and clocking of a shaft that cannot have them."""
    gears = graph.on(shaft.number)
    idler = shaft.number and graph.out_of(shaft.number) and all(graph.driven(gear) for gear in gears)
    if shaft.own.torsional_stiffness is not None and idler:
        said = "is of an idler, between whose gears nothing twists. Leave it out."
        yield Problem(("shafts", shaft.name, "torsional_stiffness"), "", said)
    looped = [gear for gear in gears if any(graph.in_loop(mesh) for mesh, _ in graph.sides[gear])]
    if shaft.own.clocking is not None and (len(gears) != 2 or looped != gears):
        said = "is not of a shaft with two gears in a loop of meshes, where it moves load. Leave it out."
        yield Problem(("shafts", shaft.name, "clocking"), f'"{shaft.own.clocking:g} rad"', said)
