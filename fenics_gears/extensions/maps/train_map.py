"""A map of a train over loads and speeds as two studies, as of a pair: quasi-static over the loads, and with inertia
over loads and steady speeds of the first shaft."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, log, pi, sqrt
from pathlib import Path
from typing import Any

from fenics_gears import SceneError, expected_cost, units
from fenics_gears.many_runs import Study
from fenics_gears.scene_text import NOTHING_DONE

from .load_map import LOADS, OVER_SPEED, QUASI_STATIC, SPEEDS, check_count, ends_of, study_of_map, values_of_option

# By the field of [load]: unit of its pictures, and its name.
LOADS_OF_TRAIN = {
    "output_torque": ("N m", "torque on the last shaft"),
    "input_torque": ("N m", "torque on the first shaft"),
    "power": ("kW", "power"),
}
SPEED = "motion.input_speed"
# A ramp, and the speed of another shaft in its place.
RAMP = "speed_ramp"
OTHER_SPEED = (RAMP, "motion.speed", "motion.speed_of")
# Of an entry of load.torques, with [inertia] alone.
INERT = "moment_of_inertia"
# Of a start, when it has died down.
QUIET = 1e-3


@dataclass(frozen=True)
class TrainMap:
    """A train's file with the train, its parsed text, and loads and speeds as they are written."""

    file: Path
    scene: Any
    tree: Mapping[str, Any]
    loads: tuple[str, ...]
    speeds: tuple[str, ...] = ()

    @property
    def given(self) -> str:
        """The field of [load] that the train has."""
        return next(name for name in LOADS_OF_TRAIN if name in self.tree["load"])

    @property
    def numbers(self) -> list[float]:
        """The loads in the unit of their pictures."""
        unit = units.quantity(f"1 {LOADS_OF_TRAIN[self.given][0]}")[0]
        return [units.quantity(each)[0] / unit for each in self.loads]

    @property
    def rpm(self) -> list[float]:
        """The speeds in turns a minute."""
        unit = units.quantity("1 rpm")[0]
        return [units.quantity(each)[0] / unit for each in self.speeds]

    @property
    def count(self) -> int:
        return len(self.loads) * (1 + len(self.speeds))

    @cached_property
    def studies(self) -> dict[str, Study]:
        """The studies by the names of their folders. Raises SceneError with the mistakes of any case."""
        found = {QUASI_STATIC: study_of_map(self.file, self.scene.title, QUASI_STATIC, self._quasi_static())}
        if self.speeds:
            found[OVER_SPEED] = study_of_map(self.file, self.scene.title, OVER_SPEED, self._over_speed())
        return found

    @property
    def expected_seconds(self) -> float:
        """About how long all runs take on one core, by the cost of those at the ends of loads and speeds."""
        ends = replace(self, loads=ends_of(self.loads), speeds=ends_of(self.speeds))
        seconds = 0.0
        condensing = 0.0
        for name, study in ends.studies.items():
            costs = [[expected_cost(model) for model in case.model.models] for case in study.cases]
            runs = self.count - len(self.loads) if name == OVER_SPEED else len(self.loads)
            seconds += runs * sum(each.marching for cost in costs for each in cost) / len(costs)
            condensing = max([condensing, *(sum(each.condensing or 0.0 for each in cost) for cost in costs)])
        return seconds + condensing

    def _present(self, *paths: str) -> list[str]:
        """Those of the sections and fields that the train's text has."""
        found = []
        for path in paths:
            home, _, name = path.rpartition(".")
            if name in (self.tree.get(home, {}) if home else self.tree):
                found.append(path)
        return found

    def _quasi_static(self) -> dict[str, Any]:
        """Changes of the scene: without inertia, each mesh one cycle."""
        without = self._present("inertia", "damping", RAMP, "motion.mesh_cycles", "motion.recorded_cycles")
        without += [f"stages.{name}.inertia" for name, stage in self.tree["stages"].items() if "inertia" in stage]
        of_loads = enumerate(self.tree["load"].get("torques", ()), 1)
        without += [f"load.torques.{number}.{INERT}" for number, load in of_loads if INERT in load]
        return {"without": without, "set": self._shared(), "sweep": {f"load.{self.given}": list(self.loads)}}

    def _over_speed(self) -> dict[str, Any]:
        """Changes of the scene: each run so long, at every speed, that its start has died down before what is
        recorded."""
        own = self.scene.meshes[0].scene.motion.mesh_cycles
        sweep = {f"load.{self.given}": list(self.loads), SPEED: list(self.speeds)}
        of_run = {"motion.mesh_cycles": max(own, self._cycles()), **self._shared()}
        return {"without": self._present(*OTHER_SPEED), "set": of_run, "sweep": sweep}

    def _cycles(self) -> int:
        """Cycles of the slowest mesh at the highest speed in which the start dies down, and the recorded ones; none
        where nothing is damped."""
        model = self._model(ends_of(self.loads)[-1], ends_of(self.speeds)[-1])
        rates = [2.0 * pi * each.frequency * each.damping_ratio for each in model.rows[0].vibrations if each.excited]
        if not rates or min(rates) <= 0.0:
            return 0
        slowest = min(mesh.scene.motion.mesh_frequency for mesh in model.scene.meshes)
        return ceil(log(1.0 / QUIET) / min(rates) * slowest) + model.scene.recorded_cycles

    def _shared(self) -> dict[str, Any]:
        """Flank elements that the train leaves to the program: for all loads those of their geometric mean, so that
        all runs share gears."""
        torques = [units.quantity(each)[0] for each in self.loads]
        if min(torques) <= 0.0:
            return {}
        middle = sqrt(min(torques) * max(torques)) / units.quantity("1 " + LOADS_OF_TRAIN[self.given][0])[0]
        model = self._model(f"{middle:.12g} {LOADS_OF_TRAIN[self.given][0]}", self.speeds[:1])
        sizes: dict[str, list[float]] = {}
        for mesh, own in zip(self.scene.meshes, model.models):
            accuracy = mesh.scene.accuracy
            if mesh.scene.resolves_contact and accuracy.target is None and accuracy.flank_element_size is None:
                sizes.setdefault(mesh.gears[0].partition(".")[0], []).append(own.resolution.flank_element_size)
        return {f"stages.{stage}.accuracy.flank_element_size": f"{min(each):.6g} mm" for stage, each in sizes.items()}

    def _model(self, load: str, speeds: str | Sequence[str]) -> Any:
        """The model of the train at a load, at a speed where one is given."""
        speed = [speeds] if isinstance(speeds, str) else list(speeds)
        sweep = {f"load.{self.given}": [load], **({SPEED: speed} if speed else {})}
        without = self._present(*OTHER_SPEED) if speed else []
        wanted = {"without": without, "sweep": sweep}
        return study_of_map(self.file, self.scene.title, OVER_SPEED, wanted).cases[0].model


def train_map(file: Path, scene: Any, loads: Sequence[str], speeds: Sequence[str], most: int) -> TrainMap:
    """The map of a train over loads (none: its own) and speeds as a user writes them, values and ranges. Raises
    SceneError for what cannot be computed, and for more runs than `most`."""
    tree = tomllib.loads(scene.text)
    if not {*LOADS_OF_TRAIN} & {*tree["load"]}:
        raise SceneError(
            f"{file}: load.torques are of all shafts that drive no gear; a map is over one of"
            f" {', '.join(LOADS_OF_TRAIN)}. Allowed: load.torques of all but the last shaft. {NOTHING_DONE}"
        )
    planned = TrainMap(file, scene, tree, (), ())
    unit, words = LOADS_OF_TRAIN[planned.given]
    kind = "power" if unit == "kW" else "torque"
    if not loads and not speeds:
        raise SceneError(f'gears map: neither {LOADS} nor {SPEEDS} is given. Allowed: such as {LOADS} "50 .. 500 {unit}'
                         f' in 10". {NOTHING_DONE}')  # fmt: skip
    written = values_of_option(LOADS, loads, f"a {kind}", why=f"The train gives its load as {words}. ")
    turning = values_of_option(SPEEDS, speeds, units.AN_ANGULAR_SPEED, why="Speeds are of the first shaft. ")
    if backwards := [each for each in written if units.quantity(each)[0] < 0.0]:
        raise SceneError(
            f"{LOADS} {backwards[0]}: a train is driven by its first shaft. Allowed: above 0. {NOTHING_DONE}"
        )
    if turning and "inertia" not in tree:
        raise SceneError(
            f"{SPEEDS}: without inertia nothing depends on the speed, and {file} has no section [inertia]. Add it with"
            f" its [damping], or leave {SPEEDS} out. {NOTHING_DONE}"
        )
    planned = replace(planned, loads=written or (str(tree["load"][planned.given]),), speeds=turning)
    check_count(planned, most)
    return planned
