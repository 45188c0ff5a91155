"""Which gears of a train mesh and which stand on one shaft: a graph, whose loops are paths beside each other.

A mesh leads from the shaft of its pinion, which drives, to that of its wheel.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

# Of a gear in a mesh: it is the pinion, or the wheel.
PINION, WHEEL = 0, 1


@dataclass(frozen=True)
class TrainGraph:
    """Meshes between shafts. `gears`: of each mesh the numbers of its pinion and its wheel; `shafts`: of each gear the
    number of its shaft. Shafts are numbered from the driven one, 0, to that of the load, the last one, so that each
    mesh leads to a higher number. `turning`: how each turns, 1 counter-clockwise, -1 clockwise; unless given the first
    one counter-clockwise. Gears that mesh turn against each other, but in the meshes of `internal` the same way: their
    wheel is an internal gear."""

    gears: tuple[tuple[int, int], ...]
    shafts: tuple[int, ...]
    turning: tuple[int, ...] = ()
    internal: frozenset[int] = frozenset()

    @property
    def last(self) -> int:
        """The shaft of the load, of several the one that the others are beside."""
        return max(self.shafts)

    @cached_property
    def between(self) -> list[tuple[int, int]]:
        """Of each mesh the shafts of its pinion and its wheel."""
        return [(self.shafts[pinion], self.shafts[wheel]) for pinion, wheel in self.gears]

    def into(self, shaft: int) -> list[int]:
        """Meshes that drive a shaft."""
        return [mesh for mesh, (_, driven) in enumerate(self.between) if driven == shaft]

    def out_of(self, shaft: int) -> list[int]:
        """Meshes that a shaft drives."""
        return [mesh for mesh, (driving, _) in enumerate(self.between) if driving == shaft]

    @property
    def outputs(self) -> list[int]:
        """Shafts that drive no gear: each has a load. The last one is among them."""
        return [shaft for shaft in range(self.last + 1) if not self.out_of(shaft)]

    def on(self, shaft: int) -> list[int]:
        """Gears of a shaft."""
        return [gear for gear, own in enumerate(self.shafts) if own == shaft]

    @cached_property
    def sides(self) -> list[list[tuple[int, int]]]:
        """Of each gear its meshes, and what it is in them."""
        found: list[list[tuple[int, int]]] = [[] for _ in self.shafts]
        for mesh, both in enumerate(self.gears):
            for side, gear in enumerate(both):
                found[gear].append((mesh, side))
        return found

    @property
    def shared(self) -> list[int]:
        """Gears that stand in several meshes."""
        return [gear for gear, meshes in enumerate(self.sides) if len(meshes) > 1]

    def driven(self, gear: int) -> bool:
        """Whether a mesh drives a gear."""
        return any(gear == wheel for _, wheel in self.gears)

    def in_loop(self, mesh: int) -> bool:
        """Whether its shafts are joined also without a mesh."""
        return self.loops > 0 and len(self._parts_without(mesh)) == 1

    @property
    def loops(self) -> int:
        """How many meshes there are beyond those that reach every shaft once."""
        return len(self.gears) - self.last

    @property
    def is_chain(self) -> bool:
        """Whether each mesh follows the one before it."""
        return self.between == [(mesh, mesh + 1) for mesh in range(len(self.gears))]

    @cached_property
    def senses(self) -> Sequence[int]:
        """How each shaft turns, as `turning` has it."""
        if self.turning:
            return self.turning
        found = {0: 1}
        for mesh, (driving, driven) in sorted(enumerate(self.between), key=lambda each: each[1]):
            found.setdefault(driven, self.onwards(mesh) * found[driving])
        return [found[shaft] for shaft in range(self.last + 1)]

    def onwards(self, mesh: int) -> int:
        """1 where both gears of a mesh turn the same way, -1 where they turn against each other."""
        return 1 if mesh in self.internal else -1

    def sense(self, mesh: int) -> int:
        """How the pinion of a mesh turns, whose frame is the mirror image where this is -1."""
        return self.senses[self.between[mesh][0]]

    @property
    def members(self) -> list[list[int]]:
        """Numbers of meshes, those together in which one gear stands."""
        return [list(each) for each in groups(range(len(self.gears)), [[m for m, _ in own] for own in self.sides])]

    @cached_property
    def cuts(self) -> list[list[int]]:
        """Shafts that some meshes alone hold: those behind each least set of meshes that would part them from the first
        shaft if they opened. Largest parts first."""
        if not self.loops:
            found = self._branches
        else:
            bridges = [mesh for mesh in range(len(self.gears)) if not self.in_loop(mesh)]
            joined = groups(range(self.last + 1), [self.between[mesh] for mesh in bridges])
            number = {shaft: place for place, own in enumerate(joined) for shaft in own}
            rest = {(number[one], number[other]) for one, other in self.between if number[one] != number[other]}
            found = [{*part} for mesh in bridges for part in self._parts_without(mesh)[1:]]
            found += [{shaft for each in own for shaft in joined[each]} for own in _bonds(len(joined), rest)]
        return sorted((sorted(each) for each in found), key=lambda each: (-len(each), each))

    @property
    def _branches(self) -> list[set[int]]:
        """Where there are no loops, the shafts behind each mesh."""
        behind: dict[int, set[int]] = {}
        for driven in range(self.last, 0, -1):
            behind[driven] = {driven}.union(*(behind[self.between[mesh][1]] for mesh in self.out_of(driven)))
        return list(behind.values())

    def _parts_without(self, mesh: int) -> list[list[int]]:
        """Shafts that are joined without a mesh, those of the first one first."""
        left = [own for number, own in enumerate(self.between) if number != mesh]
        return groups(range(self.last + 1), left)


def groups(members: Iterable[int], together: Iterable[Sequence[int]]) -> list[list[int]]:
    """Members, those together that follow from what is together; in the order of the first of each."""
    of = {each: [each] for each in members}
    for some in together:
        for other in some[1:]:
            one = of[some[0]]
            if of[other] is not one:
                joined = sorted({*one, *of[other]})
                of |= dict.fromkeys(joined, joined)
    return [own for first, own in of.items() if own[0] == first]


def _bonds(count: int, edges: set[tuple[int, int]]) -> Iterator[frozenset[int]]:
    """Sets of nodes without node 0 that are joined among themselves, as those left are."""
    near: dict[int, set[int]] = {node: set() for node in range(count)}
    for one, other in edges:
        near[one].add(other)
        near[other].add(one)
    known: set[frozenset[int]] = set()
    waiting = [frozenset((node,)) for node in range(1, count)]
    while waiting:
        own = waiting.pop()
        if own in known:
            continue
        known.add(own)
        left = {*range(count)} - own
        if len(groups(sorted(left), [edge for edge in edges if {*edge} <= left])) == 1:
            yield own
        waiting += [own | {node} for each in own for node in near[each] - own if node]


def turns_of_shafts(graph: TrainGraph, teeth: Sequence[tuple[int, int]]) -> list[Fraction]:
    """Turns of each shaft in one turn of the first, by the teeth of both gears of each mesh; in either sense."""
    found = [Fraction(1)] * (graph.last + 1)
    for mesh, (driving, driven) in sorted(enumerate(graph.between), key=lambda each: each[1]):
        found[driven] = found[driving] * abs(Fraction(*teeth[mesh]))
    return found
