"""A train of gears as its scene file describes it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from math import gcd, lcm, prod

from fenics_gears.effects import common_period
from fenics_gears.geometry.gear_train import Layout

from .accuracy import Accuracy
from .train_joints import Joint
from .train_mesh import MeshOfScene, OfMeshes, rows_of
from .train_shafts import TrainShafts


@dataclass(frozen=True)
class Link:
    """A mesh of a train, or a planetary set (`of_set`): its name, the number of its first `mesh`, the `turns` of its
    output in one of its input, how often in a second its lag repeats (`frequency`, Hz), and in how many mesh `cycles`.
    `twist`: of a shaft behind it, rad."""

    name: str
    mesh: int
    turns: float
    frequency: float
    twist: float = 0.0
    of_set: bool = False
    cycles: int = 1


@dataclass(frozen=True)
class TrainScene(OfMeshes):
    """A train of gears: its meshes from the driven shaft on, torques (N mm) on the first and the last shaft, of a
    planetary set on its input and its output, what its shafts are, and the text that it was read from.
    `recorded_cycles`: of the slowest mesh, whose steps numbers are taken from where stages move together.

    A planetary set beside other stages is `joined` with them, in the order of the power: each part is a train by
    itself, of which the next one's input is on one shaft with the output, by `joints`. Layout, shafts and loads are
    those of each part then."""

    title: str
    name: str
    meshes: tuple[MeshOfScene, ...]
    input_torque: float
    output_torque: float
    speed_given: bool
    text: str
    shafts: TrainShafts = TrainShafts()
    recorded_cycles: int = 1
    joined: tuple[TrainScene, ...] = ()
    joints: tuple[Joint, ...] = ()

    @property
    def parts(self) -> tuple[TrainScene, ...]:
        """The trains in series that it is made of; itself, where no set stands beside other stages."""
        return self.joined or (self,)

    def with_accuracy(self, change: Callable[[MeshOfScene], Accuracy]) -> TrainScene:
        """The train with another accuracy of each mesh, and so its parts."""
        meshes = tuple(replace(mesh, scene=replace(mesh.scene, accuracy=change(mesh))) for mesh in self.meshes)
        return replace(self, meshes=meshes, joined=tuple(part.with_accuracy(change) for part in self.joined))

    @property
    def loads(self) -> list[float]:
        """Torque (N mm) that resists the rotation of each shaft from outside, 0 where there is none."""
        found = [0.0] * self.graph.last + [self.output_torque]
        for each in self.shafts.loads:
            found[each.shaft] = each.torque
        return found

    @property
    def path_of_output_torque(self) -> tuple[str, ...]:
        """The field of the scene that gives the torque of the last shaft."""
        entries = [each.shaft for each in self.shafts.loads]
        if self.graph.last not in entries:
            return "load", "output_torque"
        return "load", "torques", str(entries.index(self.graph.last) + 1), "torque"

    @property
    def rows(self) -> list[list[int]]:
        """Numbers of its meshes, those together that are computed together."""
        if not self.joined:
            return rows_of(self.meshes, self.shafts.moving)
        return [[first + each for each in row] for first, part in self.numbered for row in part.rows]

    @property
    def rows_of_parts(self) -> list[tuple[TrainScene, list[int]]]:
        """The same, each with its part and the numbers there."""
        return [(part, row) for part in self.parts for row in part.rows]

    @property
    def alone(self) -> list[int]:
        """Numbers of the meshes that are pairs by themselves."""
        if self.joined:
            return [first + each for first, part in self.numbered for each in part.alone]
        return [row[0] for row in self.rows if len(row) == 1 and not self.shafts.moving]

    @property
    def together(self) -> list[str]:
        """Names of the stages whose meshes are computed together."""
        alone = {self.meshes[number].name for number in self.alone}
        return list(dict.fromkeys(each.name.partition(":")[0] for each in self.meshes if each.name not in alone))

    @property
    def numbered(self) -> list[tuple[int, TrainScene]]:
        """Its parts, and the number of the first mesh of each."""
        counts = [len(part.meshes) for part in self.parts]
        return [(sum(counts[:place]), part) for place, part in enumerate(self.parts)]

    @property
    def links(self) -> list[Link]:
        """What hands on rotation one after the other: meshes, and planetary sets as a whole; not of stages that move
        together otherwise."""
        found = []
        for (first, part), joint in zip(self.numbered, (*self.joints, None)):
            twist = 0.0 if joint is None or joint.stiffness is None else part.output_torque / joint.stiffness
            if (carrier := part.shafts.carrier) is not None:
                # Recorded are cycles of the slowest mesh; the lag is over those of the first.
                of_first, of_ring = carrier.set.cycles
                cycles = part.recorded_cycles * max(of_first, of_ring) // of_ring
                frequency = part.meshes[0].scene.motion.mesh_frequency / cycles
                found.append(Link(carrier.stage, first, 1.0 / part.ratio, frequency, twist, True, cycles))
                continue
            last = len(part.meshes) - 1
            for number, mesh in enumerate(part.meshes):
                run = mesh.scene.motion
                # Of a part of its period that is run no more is known.
                cycles = int(min(common_period(mesh.scene), run.mesh_cycles))
                own = abs(mesh.pair.rotation_ratio), run.mesh_frequency / cycles
                found.append(Link(mesh.name, first + number, *own, twist if number == last else 0.0, cycles=cycles))
        return found

    @property
    def input_speed(self) -> float:
        """Turns of the first shaft in a second."""
        if self.joined:
            return self.joined[0].input_speed
        first = self.meshes[self.graph.out_of(0)[0]]
        own = first.scene.motion.mesh_frequency / first.pair.pinion.teeth
        carrier = self.shafts.carrier
        return own if carrier is None else own / abs(float(carrier.set.sun_by_carrier))

    @property
    def ratio(self) -> float:
        """Turns of the first shaft in one turn of the last; of a planetary set of its input and its output."""
        carrier = self.shafts.carrier
        return 1.0 / self.turns_of_last if carrier is None else abs(float(carrier.set.ratio))

    @property
    def period(self) -> Fraction:
        """Turns of the first shaft after which all meshes and all that differs between their cycles repeats."""
        turned = self.layout.turns
        own = [
            int(common_period(mesh.scene)) / (turned[self.graph.between[number][0]] * mesh.pair.pinion.teeth)
            for number, mesh in enumerate(self.meshes)
        ]
        return Fraction(lcm(*(each.numerator for each in own)), gcd(*(each.denominator for each in own)))

    @property
    def turns_of_last(self) -> float:
        """Turns of the last shaft in one turn of the first."""
        return prod(1.0 / part.ratio for part in self.joined) if self.joined else self.turns[-1]

    @cached_property
    def turns(self) -> list[float]:
        """Turns of each shaft in one turn of the first, in either sense."""
        return turns_of(self.layout)


def turns_of(layout: Layout) -> list[float]:
    """Turns of each shaft in one turn of the first, in either sense."""
    return list(map(float, layout.turns))
