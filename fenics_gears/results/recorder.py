"""Records a march while it goes: curves of all steps, contact fields of the last steps, and what the warnings need.

Steps are evaluated some at a time and then dropped; their values are kept (`model.storage`), and those of a long march
are written to a journal now and then (`results.journal`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.places import Touching, touching_at
from fenics_gears.dynamics.marched import March
from fenics_gears.dynamics.stepping import VaryingLoad
from fenics_gears.dynamics.steps import Steps
from fenics_gears.effects import effects_on, from_effects
from fenics_gears.model.model import Model
from fenics_gears.model.storage import ArraysInMemory, KeptArrays, sizes, stored_arrays, support_points

from .contact_variables import (
    energy_variables,
    mesh_variables,
    node_variables,
    pair_variables,
    watched_contact,
    work_variables,
)
from .journal import Journal
from .mesh_curves import EdgesAndKinks, pressure_curves, stiffness_curves
from .side_by_side import KnownLayouts, SideBySide

if TYPE_CHECKING:
    from .face_variables import AlongTheFace
    from .journal import JournalPlace, Recorded
    from .root_stress_variables import RootStress

# Begin of the names of values that the warnings need and the result does not have.
WATCHED = "watched: "


def _along_face(model: Model, cycle: Cycle) -> tuple[AlongTheFace, ...]:
    if cycle.face.slices == 1:
        return ()
    # Runs in the plane load neither a face nor shafts that bend.
    from .bent_shafts import along_face

    return (along_face(model, cycle),)


class KnownTouching:
    """Where pairs touch over a mesh cycle; runs on the same operators share it (`Cycle.shared`)."""

    touching: Touching | None = None

    def of(self, cycle: Cycle) -> Touching:
        if self.touching is None:
            self.touching = touching_at(
                lambda step: [pair.place for pair in cycle.pairs_at(step)], cycle.steps, cycle.coast_flanks
            )
        return self.touching


class Recorder:
    """Takes the steps of a march, block by block. `loads`: the varying ones, the model's unless given. `stress`: root
    stress, if asked for. `journal`: where a long march is written down; nowhere where None.

    `steps`: how many are recorded. `first_number`: of the pair that reaches the start of contact as the run begins.
    """

    def __init__(
        self,
        model: Model,
        cycle: Cycle,
        loads: Sequence[VaryingLoad] | None = None,
        stress: RootStress | None = None,
        journal: JournalPlace | None = None,
    ):
        self.model = model
        self.cycle = cycle
        self.stress = stress
        self.loads = model.loads if loads is None else loads
        ways = cycle.shared(KnownTouching).of(cycle)
        self.first_number = 1 + ways.latest
        self.slots = ways.slots
        nodes = cycle.grid.most_nodes
        counts = model.drivetrain.bearings, support_points(model.scene)
        self.size = sizes(model.steps + 1, model.contact_steps, self.slots, nodes, cycle.face.slices, *counts)
        self.stored = stored_arrays(model.scene, self.size)
        self._room = ArraysInMemory(self.stored, model.steps + 1, model.contact_steps)
        self._journal = None if journal is None else Journal(journal, model.scene)
        self.kept: KeptArrays = self._room
        # Complete when the recorder has finished.
        self.arrays: dict[str, np.ndarray] = {}
        self.watched: dict[str, np.ndarray] = {}
        self.steps = 0
        self._watched: tuple[str, ...] = ()
        # Steps that are not evaluated yet, and the last that is, from which the account goes on.
        self._waiting: list[Steps] = []
        self._last: Steps | None = None
        self._worked: dict[str, float] = {}
        self.along_face = _along_face(model, cycle)
        self._singular = EdgesAndKinks(model)
        cycle.shared(KnownLayouts).forget_beyond(cycle.steps)

    def take(self, solved: Steps, march: March | None = None) -> None:
        """The next steps, and the march so far, which a journal keeps too."""
        self._waiting.append(solved)
        self._evaluate()
        if self._journal is not None and march is not None:
            self._journal.write(self._room, self.steps, march)

    def finish(self) -> None:
        """After the last step: put all into the order of time."""
        self._evaluate()
        if not self.steps:
            none = self.size | {"time": 0, "contact_time": 0}
            for name, (dims, kind) in self.stored.items():
                self.arrays[name] = np.empty([none[each] for each in dims], kind)
            return
        self.arrays = {name: self.kept.get(name, self.steps) for name in self.stored}
        self.watched = {name: self.kept.get(f"{WATCHED}{name}", self.steps) for name in self._watched}

    def counted(self, first: int) -> dict[str, np.ndarray]:
        """Curves over all steps from the first one that counts."""
        return {name: self.arrays[name][first:] for name, (dims, _) in self.stored.items() if dims[0] == "time"}

    def recall(self, recorded: Recorded) -> None:
        """Take over what a journal holds, in place of a march."""
        self.kept = recorded
        self.steps = len(recorded.values["time"])
        self._watched = tuple(name.removeprefix(WATCHED) for name in recorded.values if name.startswith(WATCHED))

    def _evaluate(self) -> None:
        while self._waiting:
            self._evaluate_block(self._waiting[0])

    def _evaluate_block(self, block: Steps) -> None:
        scene = self.model.scene
        cycle = self.cycle
        nodes = SideBySide(cycle.shared(KnownLayouts), cycle, block, self.slots, self.first_number)
        numbers = block.numbers
        times = self.model.clock.times(block.numbers)
        phases = numbers / cycle.steps + cycle.mesh.ahead
        values = {"time": times, "mesh_phase": phases, "pair_number": nodes.pair_number}
        values |= self._centres(block) | mesh_variables(scene, nodes) | pair_variables(scene, nodes)
        if scene.tooth_elasticity is not None:
            values |= stiffness_curves(block, self.model.drivetrain.bending_faces)
        energies, worked = self._energies(block)
        values |= energies
        for effect in effects_on(scene):
            if any(variable.dims == ("time",) for variable in effect.variables) and effect.results is not None:
                of_effect = effect.results(getattr(scene, effect.section), scene, cycle, numbers)
                values |= {name: curve for name, (_, curve) in of_effect.items()}
        fields = {
            "contact_time": times,
            "contact_mesh_phase": values["mesh_phase"],
            "contact_pair_number": nodes.pair_number,
        }
        watched = watched_contact(nodes)
        if scene.resolves_contact:
            fields |= node_variables(scene, nodes)
            for along in self.along_face:
                fields |= along.fields(nodes)
                values |= along.curves(values, nodes)
            values |= pressure_curves(nodes, fields, self._singular)
        if self.stress is not None:
            fields |= self.stress.values(nodes)
        for watched_by_effect in from_effects(scene, "watched", cycle, block):
            watched |= watched_by_effect
        evaluated = values | fields | watched
        kept = {
            name: self._in_shape(evaluated[name], dims) for name, (dims, _) in self.stored.items() if name in evaluated
        }
        beside = {name: of for name, of in watched.items() if name not in self.stored}
        self._room.put(self.steps, kept | {f"{WATCHED}{name}": of for name, of in beside.items()})
        # Last of all: a march that is interrupted before this line evaluates these steps again.
        self._watched = tuple(beside)
        del self._waiting[0]
        self._last = block.between(len(block) - 1, len(block))
        self._worked = worked
        self.steps += len(block)

    def _in_shape(self, values: np.ndarray, dims: Sequence[str]) -> np.ndarray:
        """Values of some steps over the dimensions of their variable: one slice is none."""
        return values.reshape(len(values), *(self.size[each] for each in dims[1:]))

    def _centres(self, block: Steps) -> dict[str, np.ndarray]:
        scene = self.model.scene
        drivetrain = self.model.drivetrain
        states = block.states[:, 0]

        def of_gears(motion: str) -> np.ndarray:
            return drivetrain.values(states, (f"{motion}1", f"{motion}2"))

        values = {"transmission_error": self.model.transmission_error(states), "rotation": of_gears("rotation_")}
        if scene.bearings is not None:
            values |= {name: of_gears(name) for name in ("centre_x", "centre_y")}
            if scene.bearings.places is not None or scene.bearings.each is not None:
                values |= {name: of_gears(name) for name in ("tilt_x", "tilt_y")}
                values["axial_position"] = of_gears("axial_")
        if scene.shafts is not None:
            values["shaft_end_rotation"] = drivetrain.value(states, "shaft_end")
        return values

    def _energies(self, block: Steps) -> tuple[dict[str, np.ndarray], dict[str, float]]:
        """Energies and the work since the first step; and the work at the last step, from which the next block goes
        on."""
        model = self.model
        before = 0 if self._last is None else 1
        together = block if self._last is None else self._last.followed_by(block)
        energies = energy_variables(model.scene, model.drivetrain, together)
        drivetrain = model.drivetrain
        clock = model.clock
        work = work_variables(model.scene, self.cycle, drivetrain, clock, self.loads, together, energies["energy"])
        work = {name: value + self._worked.get(name, 0.0) for name, value in work.items()}
        worked = {name: value[-1] for name, value in work.items()}
        return {name: value[before:] for name, value in (energies | work).items()}, worked
