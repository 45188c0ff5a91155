"""The meshes of a train, each as the scene of its pair, and where they stand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from fenics_gears.geometry.gear_train import Layout
from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.train_graph import TrainGraph
from fenics_gears.inputs.tree import GEARS

from .carrier import OfSet
from .data import Scene
from .train_pair_shafts import OfPair, in_words_of_train


@dataclass(frozen=True)
class MeshOfScene:
    """A mesh of a train: the `scene` of its pair, its name, and the direction (rad) of its wheel from its pinion.
    `gears`: names of pinion and wheel; of a gear in several meshes it is the same in all. `shafts`: the numbers of
    those that it joins. `sense`: how its pinion turns, 1 counter-clockwise, -1 clockwise. `bent`: with shafts that
    bend, those that both are on. `of_set`: how a planetary set calls it; its meshes are `like` its first two, but for
    the mesh cycles that they are `ahead`, numerator and denominator, of a planet at place 0. `begins`: the phase at
    which the first of meshes that have gears in common is as the run begins."""

    name: str
    scene: Scene
    pair: GearPair
    direction: float
    gears: tuple[str, str] = GEARS
    shafts: tuple[int, int] = (0, 1)
    sense: int = 1
    bent: OfPair = ()
    of_set: OfSet | None = None
    like: int | None = None
    ahead: tuple[int, int] = (0, 1)
    begins: float = 0.0

    def words(self, said: str) -> str:
        """What is said of its pair, in words of the train."""
        return in_words_of_train(self.bent, said) if self.of_set is None else self.of_set.words(said)


def gear_names(meshes: Sequence[MeshOfScene]) -> list[str]:
    """Names of all gears in the order of their numbers."""
    return list(dict.fromkeys(name for mesh in meshes for name in mesh.gears))


def layout_of(meshes: Sequence[MeshOfScene]) -> Layout:
    """Where some meshes of a train stand, their gears and shafts numbered from 0."""
    names = gear_names(meshes)
    of_gear = {name: shaft for mesh in meshes for name, shaft in zip(mesh.gears, mesh.shafts)}
    shafts = sorted({*of_gear.values()})
    internal = frozenset(number for number, mesh in enumerate(meshes) if mesh.pair.wheel.internal)
    turning = {
        shaft: sense
        for number, mesh in enumerate(meshes)
        for shaft, sense in zip(mesh.shafts, (mesh.sense, mesh.sense if number in internal else -mesh.sense))
    }
    graph = TrainGraph(
        tuple((names.index(mesh.gears[0]), names.index(mesh.gears[1])) for mesh in meshes),
        tuple(shafts.index(of_gear[name]) for name in names),
        tuple(turning[shaft] for shaft in shafts),
        internal,
    )
    begun = [mesh.begins for mesh in meshes]
    return Layout(graph, [mesh.pair for mesh in meshes], [mesh.direction for mesh in meshes], begun)


class OfMeshes:
    """What has `meshes` of a train: where they stand, and their graph."""

    meshes: tuple[MeshOfScene, ...]

    @cached_property
    def layout(self) -> Layout:
        return layout_of(self.meshes)

    @property
    def graph(self) -> TrainGraph:
        return self.layout.graph


def rows_of(meshes: Sequence[MeshOfScene], moving: bool = False) -> list[list[int]]:
    """Numbers of meshes, those together that have a gear in common, or all where stages move together (`moving`)."""
    return [list(range(len(meshes)))] if moving else layout_of(meshes).graph.members
