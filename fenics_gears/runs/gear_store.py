"""What runs of one process share in memory: the gears condensed last, and contact operators."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.window import ContactGrid
from fenics_gears.effects import ALONG_THE_FACE, effects_on
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Bodies, Body
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model
from fenics_gears.model.shared_gears import couplings
from fenics_gears.scene.data import Scene
from fenics_gears.simulation.bodies import body_key, gear_bodies, gear_body
from fenics_gears.simulation.elastic_route import gaps_of, mesh_cycle, sections_of_gaps
from fenics_gears.simulation.routes import CONDENSED, prepared, route_of
from fenics_gears.system.progress import Progress

if TYPE_CHECKING:
    from fenics_gears.contact.row import RowCycle
    from fenics_gears.model.row_model import RowModel

# How many mesh cycles of the same gears are kept, such as for torques with other elements or contact nodes. The part of
# the memory for contact operators that they and their bodies may take in addition to another one.
MOST_CYCLES = 8
SHARE_OF_OTHERS = 0.35
NO_TIME = {"time_mesh": 0.0, "time_compile": 0.0, "time_condense": 0.0}


class GearStore:
    """Keeps the gears used last, `most` of them (None: all), and those that mesh cycles need. With `cycles` it keeps
    the last mesh cycles, so that a frequency sweep builds its operators once.

    Two runs share a mesh cycle when gears, flanks, contact grid, steps, moving coordinates and the presence of friction
    are the same: speed, masses, springs, torque and coefficient may differ. Where only gaps differ (reliefs, lead
    modifications, misalignment, errors of teeth) each has gaps of its own. Shared gears keep the times that condensing
    them took; with a shared mesh cycle these times are zero.
    """

    def __init__(self, most: int | None = 2, cycles: bool = True):
        self._gears: dict[tuple, Body] = {}
        self._most = most
        self._pairs = 1
        self._cycles = cycles
        self._operators: dict[tuple, tuple[Bodies, Cycle]] = {}
        self._cycle_key: tuple | None = None
        self._cycle: Cycle | None = None
        self._row: tuple[tuple, list[tuple], RowCycle] | None = None

    def of_pairs(self, pairs: int) -> None:
        """Keep from now on the contact operators and gears of so many pairs of gears that come one after the other:
        those of the stages of a train."""
        self._pairs = pairs
        self._most = None if self._most is None else 2 * pairs

    def prepared(self, model: Model, progress: Progress, cache: Cache | None) -> tuple[Bodies, Cycle]:
        """Bodies and mesh cycle for ``simulate``, kept or made."""
        if not self._cycles:
            return self._made(model, progress, cache)
        key = operators_key(model)
        of_cycle = cycle_key(model, key)
        operators = self._operators.pop(key, None)
        shared = operators is not None
        if operators is None:
            # Frees memory before the next is made.
            self._cycle_key = self._cycle = None
            self._make_room(key)
            operators = self._made(model, progress, cache)
        # Last in the dictionary, last to be given up.
        self._operators[key] = operators
        bodies, cycle = operators
        cycle.kept.others = self._taken - cycle.kept.taken - _bytes_of(bodies)
        if of_cycle != self._cycle_key:
            self._cycle = cycle.with_gaps(gaps_of(model, cycle)) if shared else cycle
            self._cycle_key = of_cycle
        if shared:
            # Of springs there are none.
            bodies = tuple(replace(gear, timings={**gear.timings, **NO_TIME}) for gear in bodies)
        return bodies, self._cycle

    def row(self, row: RowModel, make: Callable[[], RowCycle]) -> RowCycle:
        """The contact equations of meshes that move together: those of the last ones where operators are the same,
        with offsets and gaps of their own, as of pins beside their places, reliefs and gears that run out; else
        made."""
        shared = [(tuple(couplings(row.layout, gear)), row.keys_of_shared(gear)) for gear in row.graph.shared]
        of_meshes = [coordinates.tobytes() for coordinates, _ in row.placed]
        offsets = [offset for _, offset in row.placed]
        said = [(each.tobytes(), _key_of_gaps(model)) for each, model in zip(offsets, row.models)]
        key = (
            tuple(map(operators_key, row.models)), tuple(row.layout.phases), tuple(shared), tuple(of_meshes),
            tuple(row.frictions),
        )  # fmt: skip
        if self._row is None or self._row[0] != key:
            # Frees memory before the next is made.
            self._row = None
            self._row = key, said, make()
        elif self._row[1] != said:
            gaps = [functools.partial(gaps_of, model) for model in row.models]
            self._row = key, said, self._row[2].with_gaps_of(offsets, gaps)
        return self._row[2]

    @property
    def _taken(self) -> float:
        """Bytes that all contact operators and their bodies take."""
        return sum(cycle.kept.taken + _bytes_of(bodies) for bodies, cycle in self._operators.values())

    def _make_room(self, key: tuple) -> None:
        """Give up the contact operators of other gears than a key's, and the oldest where there are many or they take
        much."""
        # Keys begin with the gears.
        others = [gears for gears in dict.fromkeys(each[0] for each in self._operators) if gears != key[0]]
        for gears in others[: max(len(others) + 1 - self._pairs, 0)]:
            self._operators = {each: of for each, of in self._operators.items() if each[0] != gears}
        while self._operators and (
            len(self._operators) >= MOST_CYCLES
            or self._taken > SHARE_OF_OTHERS * min(cycle.kept.most for _, cycle in self._operators.values())
        ):
            del self._operators[next(iter(self._operators))]

    def body(self, model: Model, name: str, cache: Cache | None) -> Body:
        """The "pinion" or the "wheel", kept, from the cache, or condensed."""
        key = body_key(model, name)
        # Last in the dictionary, last to be given up.
        self._gears[key] = body = self._gears.pop(key, None) or gear_body(model, name, cache)
        self._give_up_oldest()
        return body

    def bodies(self, model: Model, progress: Progress, cache: Cache | None) -> Bodies:
        """Pinion and wheel; where neither is kept, both are condensed at once where that pays."""
        keys = [body_key(model, name) for name in GEARS]
        if keys[0] != keys[1] and not self._gears.keys() & set(keys):
            self._gears.update(zip(keys, gear_bodies(model, progress, cache)))
        pinion, wheel = (self.body(model, name, cache) for name in GEARS)
        return pinion, wheel

    def _give_up_oldest(self) -> None:
        if self._most is None:
            return
        held = [body for bodies, _ in self._operators.values() for body in bodies]
        free = [key for key, body in self._gears.items() if not any(body is each for each in held)]
        for key in free[: -self._most]:
            del self._gears[key]

    def _made(self, model: Model, progress: Progress, cache: Cache | None) -> tuple[Bodies, Cycle]:
        if route_of(model) is not CONDENSED:
            return prepared(model, progress, cache)
        bodies = self.bodies(model, progress, cache)
        return bodies, mesh_cycle(model, bodies)


def _bytes_of(bodies: Bodies) -> float:
    """What bodies over the face take, which lie once more in the slices of their mesh cycle."""
    return 2.0 * sum(body.solid.blocks.nbytes for body in bodies if body.solid is not None)


@functools.lru_cache(maxsize=1)
def own_gear_store() -> GearStore:
    """The store of this process."""
    return GearStore()


def operators_key(model: Model, grid: ContactGrid | None = None) -> tuple:
    """What the contact operators of a mesh cycle depend on, whatever opens their nodes; `grid`: the model's unless
    given."""
    scene = model.scene
    resolution = model.resolution
    apart = sections_of_gaps(model)
    accuracy = resolution.condensation, grid or resolution.contact_grid, resolution.steps_per_mesh_cycle
    shaping = (section for section in _shaping(scene) if section not in apart)
    in_operators = (scene.corner_contact, *(getattr(scene, section) for section in shaping))
    springs = scene.accuracy.model, None if scene.resolves_contact else scene.load
    divided = ((resolution.discretisation(gear), model.solid_discretisation(gear)) for gear in (0, 1))
    return (
        scene.gears,
        (model.face.slices, *divided),
        in_operators,
        scene.coast_flanks is not None,
        (accuracy, springs, tuple(seat.system.key for seat in model.drivetrain.seats)),
        tuple(model.drivetrain.indices),
        scene.friction is not None,
        bool(apart),
    )


def cycle_key(model: Model, of_operators: tuple | None = None) -> tuple:
    """What the contact equations of a mesh cycle depend on; `of_operators`: what its operators do, where that is
    known."""
    return *(of_operators or operators_key(model)), *_key_of_gaps(model)


def _key_of_gaps(model: Model) -> tuple:
    """What opens the nodes of a model's contact operators."""
    return tuple(getattr(model.scene, section) for section in sections_of_gaps(model))


def _shaping(scene: Scene) -> list[str]:
    """The sections that say how teeth are shaped, misplaced or yield."""
    own = (effect.section for effect in effects_on(scene) if effect.gaps or effect.elasticity or effect.removal)
    return [*ALONG_THE_FACE, *own]
