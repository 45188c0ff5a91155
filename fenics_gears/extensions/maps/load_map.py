"""A map over loads and speeds as two studies: quasi-static over the loads, and with inertia over loads and steady
speeds."""

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite, pi, sqrt
from pathlib import Path
from typing import Any

from fenics_gears import Load, Scene, SceneError, as_toml, expected_cost, model_of, units
from fenics_gears.command_line import seconds_in_words
from fenics_gears.many_runs import Study, common_period, effects_on, quasi_static, settling_time, study_of
from fenics_gears.scene_text import LOAD_WORDS, NOTHING_DONE, AxisError, values_in_words, wheel_torque

QUASI_STATIC = "quasi_static"
OVER_SPEED = "over_speed"
LOADS = "--loads"
SPEEDS = "--speeds"
FREQUENCY = "motion.mesh_frequency"
PINION_SPEED = "motion.pinion_speed"
SPEED_KINDS = (units.A_FREQUENCY, units.AN_ANGULAR_SPEED)


@dataclass(frozen=True)
class LoadMap:
    """A scene's file with the scene, and loads and speeds as they are written ("437 N m", "15 kW"; "200 Hz" or "750
    rpm").

    Loads are what the scene gives: torques on the wheel, torques on the pinion, or powers, which go through the pair at
    every speed.
    """

    file: Path
    scene: Scene
    loads: tuple[str, ...]
    speeds: tuple[str, ...] = ()

    @property
    def load_field(self) -> str:
        """The field that the loads are values of."""
        return f"load.{self.scene.load.given}"

    @property
    def numbers(self) -> list[float]:
        """The loads as numbers in the unit of their pictures."""
        unit = units.quantity(f"1 {LOAD_WORDS[self.scene.load.given][0]}")[0]
        return [units.quantity(each)[0] / unit for each in self.loads]

    def wheel_torque(self, load: str, mesh_frequency: float | None = None) -> float:
        """Torque (N mm) on the wheel at a load, a power at a mesh frequency (Hz), the scene's unless given."""
        teeth = self.scene.gears.teeth
        torque = wheel_torque(
            self.scene.load.given, units.quantity(load)[0], teeth, mesh_frequency or self.scene.motion.mesh_frequency
        )
        assert torque is not None, "a load by power has a speed"
        return torque

    @property
    def count(self) -> int:
        return len(self.loads) * (1 + len(self.speeds))

    @property
    def studies(self) -> dict[str, Study]:
        """The studies by the names of their folders. Raises SceneError with the mistakes of any case."""
        over_speed = {OVER_SPEED: self._study(OVER_SPEED, _over_speed(self))} if self.speeds else {}
        return {QUASI_STATIC: self._study(QUASI_STATIC, _quasi_static(self)), **over_speed}

    @property
    def expected_seconds(self) -> float:
        """About how long all runs take on one core, by the cost of those at the ends of loads and speeds."""
        ends = replace(self, loads=ends_of(self.loads), speeds=ends_of(self.speeds))
        seconds = 0.0
        gears = 0.0
        for name, study in ends.studies.items():
            costs = [expected_cost(case.model) for case in study.cases]
            runs = self.count - len(self.loads) if name == OVER_SPEED else len(self.loads)
            seconds += runs * sum(cost.marching for cost in costs) / len(costs)
            gears = max([gears, *(cost.condensing or 0.0 for cost in costs)])
        return seconds + gears

    def _study(self, name: str, changes: dict[str, Any]) -> Study:
        return study_of_map(self.file, self.scene.title, name, changes)


def study_of_map(file: Path, title: str, name: str, changes: dict[str, Any]) -> Study:
    """A study of a map, whose changes of the scene these are. Raises SceneError with the mistakes of any case."""
    tree = {"title": f"{title}: {name.replace('_', ' ')}", "scene": file.name, **changes}
    return study_of(tree, file.with_name(f"{file.stem}_{name}.toml"), as_toml(tree), f"gears map {file}", {})


def load_map(file: Path, scene: Scene, loads: Sequence[str], speeds: Sequence[str], most: int) -> LoadMap:
    """The map of a scene over loads (none: its own) and speeds as a user writes them, values and ranges. Raises
    SceneError for what cannot be computed, and for more runs than `most`."""
    if not loads and not speeds:
        raise SceneError(
            f'gears map: neither {LOADS} nor {SPEEDS} is given. Allowed: such as {LOADS} "100 N m" "200 N m" or {LOADS}'
            f' "50 .. 500 N m in 10". {NOTHING_DONE}'
        )
    unit, words = LOAD_WORDS[scene.load.given]
    kind = "power" if unit == "kW" else "torque"
    torques = values_of_option(LOADS, loads, f"a {kind}", why=f"The scene gives its load as {words}. ")
    torques = torques or (f"{scene.given_load / units.quantity(f'1 {unit}')[0]:.12g} {unit}",)
    written = values_of_option(SPEEDS, speeds, *SPEED_KINDS)
    backwards = [each for each in torques if units.quantity(each)[0] < 0.0]
    if backwards and scene.coast_flanks is None:
        raise SceneError(
            f"{LOADS} {backwards[0]}: a negative {kind} drives the pair from the wheel, and {file} has no section"
            f" [coast_flanks]. Add it, or leave negative loads out. {NOTHING_DONE}"
        )
    if written and scene.inertia is None:
        raise SceneError(
            f"{SPEEDS}: without inertia nothing depends on the speed, and {file} has no section [inertia]. Add it with"
            f" its [damping], or leave {SPEEDS} out. {NOTHING_DONE}"
        )
    if len({_by_pinion(each) for each in written}) > 1:
        raise SceneError(
            f"{SPEEDS}: has both speeds of the pinion and mesh frequencies. Allowed: one of the two. {NOTHING_DONE}"
        )
    planned = LoadMap(file, scene, torques, written)
    check_count(planned, most)
    return planned


def check_count(planned: Any, most: int) -> None:
    """Raise SceneError for a map of more runs than `most`."""
    if planned.count > most:
        speeds = f" with {len(planned.speeds)} speeds each, and at rest," if planned.speeds else ""
        raise SceneError(
            f"gears map: {len(planned.loads)} loads{speeds} are {planned.count} runs, about"
            f" {seconds_in_words(planned.expected_seconds)} on one core of an idle machine. Allowed: up to {most}. Take"
            f" fewer loads or speeds, or allow more by --most-runs {planned.count}. {NOTHING_DONE}"
        )


def values_of_option(option: str, written: Sequence[str], *kinds: str, why: str = "") -> tuple[str, ...]:
    """All values of an option, each once. Raises SceneError for one that is none of these kinds of quantities."""
    words: list[str] = []
    for word in written:
        try:
            words += values_in_words(word)
            units.of_kind(words[-1], *kinds)
        except (AxisError, units.QuantityError) as error:
            raise SceneError(
                f'{option} "{word}" {error} Write each value in quotes with its unit. {why}{NOTHING_DONE}'
            ) from None
    numbers = [units.of_kind(each, *kinds)[0] for each in words]
    for place, number in enumerate(numbers):
        if not isfinite(number) or number in numbers[:place]:
            why = "is given twice or is not a finite number. Allowed: each value once."
            raise SceneError(f'{option} "{words[place]}" {why} {NOTHING_DONE}')
    return tuple(words)


def _by_pinion(speed: str) -> bool:
    return units.of_kind(speed, *SPEED_KINDS)[1] == units.AN_ANGULAR_SPEED


def _frequencies(wanted: LoadMap) -> list[float | None]:
    """Mesh frequencies (Hz) at which a load has a torque each: None for the scene's; a power has one at each speed
    too."""
    speeds = wanted.speeds if wanted.scene.load.given == "power" else ()
    per_turn = wanted.scene.gears.pinion.teeth / (2.0 * pi)
    return [None, *(units.of_kind(each, *SPEED_KINDS)[0] * (per_turn if _by_pinion(each) else 1.0) for each in speeds)]


def ends_of(values: tuple[str, ...]) -> tuple[str, ...]:
    in_order = sorted(values, key=lambda each: units.quantity(each)[0])
    return tuple(dict.fromkeys((in_order[0], in_order[-1]))) if values else ()


def _quasi_static(wanted: LoadMap) -> dict[str, Any]:
    """Changes of the scene: without inertia, two mesh cycles, or all where they differ."""
    still = quasi_static(wanted.scene)
    before, after = ({effect.section for effect in effects_on(each)} for each in (wanted.scene, still))
    without = [*sorted(before - after), "motion.settling_time"]
    fixed = shared_accuracy(wanted)
    if common_period(still) == 1:
        without += ["motion.recorded_cycles", "output.contact_fields"]
        fixed = {"motion.mesh_cycles": 2, **fixed}
    return {"without": without, "set": fixed, "sweep": {wanted.load_field: list(wanted.loads)}}


def _over_speed(wanted: LoadMap) -> dict[str, Any]:
    """Changes of the scene: steady speeds, each run until its start has died down, without contact fields."""
    by_pinion = _by_pinion(wanted.speeds[0])
    without = ["speed_ramp", FREQUENCY if by_pinion else PINION_SPEED, "motion.recorded_cycles"]
    fixed: dict[str, Any] = {"output.contact_fields": False, **shared_accuracy(wanted)}
    steady = replace(wanted.scene, speed_ramp=None)
    seconds = settling_time(model_of(steady))
    if isfinite(seconds) and "settling_time" not in tomllib.loads(wanted.scene.text).get("motion", {}):
        without.append("motion.mesh_cycles")
        fixed["motion.settling_time"] = f"{seconds:.4g} s"
    sweep = {wanted.load_field: list(wanted.loads), PINION_SPEED if by_pinion else FREQUENCY: list(wanted.speeds)}
    return {"without": without, "set": fixed, "sweep": sweep}


def shared_accuracy(wanted: LoadMap) -> dict[str, Any]:
    """Settings that the scene leaves to the program and that depend on the load: the same for all, so that all loads
    share gears and contact operators. Flank elements suit the geometric mean of the loads, the contact length suits the
    largest."""
    scene = wanted.scene
    given = wanted.scene.accuracy
    every = (wanted.wheel_torque(each, speed) for each in wanted.loads for speed in _frequencies(wanted))
    torques = [abs(torque) for torque in every if torque]
    if not scene.resolves_contact or given.target is not None or not torques:
        return {}
    middle, largest = (
        model_of(quasi_static(replace(scene, load=Load(torque)))).resolution
        for torque in (sqrt(min(torques) * max(torques)), max(torques))
    )
    sizes = {"flank_element_size": middle.flank_element_size, "contact_length": largest.contact_grid.length}
    return {f"accuracy.{name}": f"{value:.6g} mm" for name, value in sizes.items() if getattr(given, name) is None}
