"""The subsets of a scene's effects run and timed: answers from whole runs, times from shorter ones in turn."""

from __future__ import annotations

import statistics
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import xarray as xr

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.effects import effects_on
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.errors import ComputationError, GearsError, SceneError
from fenics_gears.model.model import Model, model_of
from fenics_gears.model.resolution import EVERY_STEP
from fenics_gears.results.contact_variables import largest_normal_force
from fenics_gears.scene.data import Scene
from fenics_gears.simulation.elastic_route import gear_compliance, mesh_cycle, tooth_reach
from fenics_gears.simulation.routes import prepared
from fenics_gears.simulation.simulate import simulate
from fenics_gears.simulation.warm_up import compile_kernels
from fenics_gears.studies.effect_lattice.cost_model import Expectation, StepWork, expected_ratio
from fenics_gears.studies.effect_lattice.machine import machine
from fenics_gears.studies.effect_lattice.subsets import ALL, ALONE, BARE, LEFT_OUT, Skipped, Subset, lattice
from fenics_gears.studies.gear_store import GEARS, gear_key
from fenics_gears.system.progress import Progress, SilentProgress

ROUNDS = 5
TIMED_STEPS = 1000
CONDENSED, MOST_SECONDS_CONDENSING = 3, 30.0
# Contact operators of all subsets are kept between the rounds up to here; beyond it they are built again.
MOST_BYTES = 1e9


@dataclass(frozen=True)
class Row:
    """What one subset costs and answers.

    `contact_rows`: of the contact operator, on the average over the mesh cycle; `step_times` (rounds,), s; `condense`: both gears, s,
    zero for rigid flanks; `operators`: of one mesh cycle, s; `transmission_error`: peak to peak, mm on the wheel's base circle;
    `peak_force`: largest contact force of the mesh, N; `remarks`: what the reader must know of this row.
    """

    subset: Subset
    coordinates: int
    contact_rows: float
    closed_nodes: float
    most_closed_nodes: int
    iterations: float
    work: StepWork
    step_times: tuple[float, ...]
    condense: float
    operators: float
    transmission_error: float
    peak_force: float
    remarks: tuple[str, ...]

    @property
    def elastic(self) -> bool:
        """Whether the flanks give way; rigid ones are solved by another method."""
        return self.subset.scene.tooth_elasticity is not None

    @property
    def unknowns(self) -> float:
        """Centre coordinates and contact rows."""
        return self.coordinates + self.contact_rows

    @property
    def step_time(self) -> float:
        """Median time of a step, s."""
        return statistics.median(self.step_times)


@dataclass(frozen=True)
class Report:
    """All rows of a scene, what was left out and why, the ratio of full to bare scene (measured round by round, s/s), and the machine.

    `ratios` (rounds,) is empty where bare and full scene are the same or one failed; then `expected` is None.
    """

    scene: Scene
    rows: tuple[Row, ...]
    skipped: tuple[Skipped, ...]
    ratios: tuple[float, ...]
    expected: Expectation | None
    machine: dict[str, str]

    def row(self, kind: str, effect: str = "") -> Row | None:
        """The row of that kind of subset; None where it is not there."""
        return next((each for each in self.rows if (each.subset.kind, each.subset.effect) == (kind, effect)), None)

    def reference(self, row: Row) -> Row | None:
        """What a row is compared with: the bare scene for an effect alone, the full one for an effect left out; else None."""
        return {ALONE: self.row(BARE), LEFT_OUT: self.row(ALL)}.get(row.subset.kind)


def measure(scene: Scene, progress: Progress | None = None, rounds: int = ROUNDS) -> Report:
    """Run and time the subsets of a scene's effects. Raises SceneError, GeometryError, ComputationError where not one subset runs."""
    progress = progress or SilentProgress()
    scene = at_one_accuracy(scene)
    subsets, skipped = lattice(scene)
    progress.stage("compile")
    for tangential in (False, True):
        compile_kernels(tangential)
    progress.stage("condense, and answers")
    gears, benches = Gears(), []
    for done, subset in enumerate(subsets):
        progress.update(done, len(subsets), subset.name)
        try:
            benches.append(Bench(subset, gears))
        except GearsError as error:
            skipped.append(Skipped(subset.name, str(error).splitlines()[0]))
    if not benches:
        raise ComputationError("no subset of the effects could be run: " + "; ".join(f"{each.name}: {each.reason}" for each in skipped))
    _keep_what_fits(benches)
    progress.stage("times")
    for turn in range(rounds):
        for done, bench in enumerate(benches):
            progress.update(turn * len(benches) + done, rounds * len(benches), bench.subset.name)
            bench.time_steps()
    progress.stage("condense for the time")
    gears.condense_again()
    rows = tuple(bench.row() for bench in benches)
    return Report(scene, rows, tuple(skipped), *_full_by_bare(rows), machine())


def at_one_accuracy(scene: Scene) -> Scene:
    """The scene with every accuracy setting written out, so that all subsets have the mesh and the steps of the scene as a whole."""
    resolution = model_of(scene).resolution
    if resolution.condensation == EVERY_STEP:
        raise SceneError('accuracy.condensation = "every step": the effects are measured on the fast route. Take "once", or leave it out.')
    grid = resolution.contact_grid
    settings = replace(
        scene.accuracy,
        element=resolution.element,
        flank_element_size=resolution.flank_element_size,
        contact_length=grid.length,
        contact_nodes=grid.nodes,
        steps_per_mesh_cycle=resolution.steps_per_mesh_cycle,
        condensation=resolution.condensation,
    )
    return replace(scene, accuracy=settings)


class Gears:
    """The gears of all subsets, each condensed once without the cache and shared; how long it took, s."""

    def __init__(self):
        self._kept, self._models, self._seconds = {}, {}, {}

    def of(self, model: Model) -> tuple:
        """Flank compliances of pinion and wheel."""
        reach = tooth_reach(model)
        return tuple(self._gear(model, name, reach) for name in GEARS)

    def seconds(self, model: Model) -> float:
        """Median time to mesh and condense both gears; compiling does not count."""
        reach = tooth_reach(model)
        return sum(statistics.median(self._seconds[gear_key(model, name, reach)]) for name in GEARS)

    def condense_again(self) -> None:
        """Repeat all condensations in turn for their time, where they do not take too long."""
        if sum(sum(each) for each in self._seconds.values()) * (CONDENSED - 1) > MOST_SECONDS_CONDENSING:
            return
        for _ in range(CONDENSED - 1):
            for key, arguments in self._models.items():
                self._seconds[key].append(_condensing(gear_compliance(*arguments, None)))

    def _gear(self, model: Model, name: str, reach: Reach):
        key = gear_key(model, name, reach)
        if key not in self._kept:
            self._kept[key], self._models[key] = gear_compliance(model, name, reach, None), (model, name, reach)
            self._seconds[key] = [_condensing(self._kept[key])]
        return self._kept[key]


def _condensing(gear) -> float:
    return gear.timings["time_mesh"] + gear.timings["time_condense"]


class Bench:
    """One subset: its whole run, made at once, and its shorter runs, which are timed. Raises GearsError where it cannot be run."""

    def __init__(self, subset: Subset, gears: Gears):
        self.subset, self._gears = subset, gears
        self._model = model_of(subset.scene)
        self._cycle, self._operators = self._build()
        self._whole = self._run(subset.scene, self._cycle)
        self._step_times: list[float] = []
        operators = [self._cycle.position(step).operator for step in range(self._cycle.steps)]
        self.bytes = sum(operator.compliance.nbytes for operator in operators)
        self._contact_rows = sum(len(operator.jacobian) for operator in operators) / len(operators)

    def _build(self) -> tuple[Cycle, float]:
        """The contact operators of a mesh cycle, all of them, and the seconds they took."""
        elastic = self._model.scene.resolves_contact
        compliances = self._gears.of(self._model) if elastic else ()
        begun = time.perf_counter()
        cycle = mesh_cycle(self._model, compliances) if elastic else prepared(self._model, SilentProgress(), None)[1]
        for step in range(cycle.steps):
            cycle.position(step)
        return cycle, time.perf_counter() - begun

    def _run(self, scene: Scene, cycle: Cycle) -> xr.Dataset:
        compliances = self._gears.of(self._model) if self._model.scene.resolves_contact else ()
        result = simulate(scene, preparation=lambda model, progress, cache: (compliances, cycle))
        if not result.attrs["complete"]:
            raise KeyboardInterrupt
        return result

    def forget(self) -> None:
        """Free the contact operators; they are built again for every timed run."""
        self._cycle = None

    def time_steps(self) -> None:
        """One more timed run, of the scene's first mesh cycles."""
        motion = self._model.scene.motion
        cycles = min(motion.mesh_cycles, max(1, round(TIMED_STEPS / self._model.resolution.steps_per_mesh_cycle)))
        shorter = replace(self.subset.scene, motion=replace(motion, mesh_cycles=cycles, recorded_cycles=1))
        self._timed = self._run(shorter, self._cycle if self._cycle is not None else self._build()[0])
        self._step_times.append(self._timed.attrs["time_march"] / self._timed.attrs["steps"])

    def row(self) -> Row:
        """What was measured."""
        run, coordinates = self._whole, len(self._model.drivetrain.coordinates)
        closed, scene = float(run.closed_nodes.mean()), self._model.scene
        iterations = self._timed.attrs["newton_iterations_total"] / self._timed.attrs["steps"]
        return Row(
            subset=self.subset,
            coordinates=coordinates,
            contact_rows=self._contact_rows,
            closed_nodes=closed,
            most_closed_nodes=int(run.closed_nodes.max()),
            iterations=run.attrs["newton_iterations_total"] / run.attrs["steps"],
            work=StepWork(
                coordinates, self._contact_rows, closed, iterations, scene.inertia is not None, scene.friction is not None, _varying(scene)
            ),
            step_times=tuple(self._step_times),
            condense=self._gears.seconds(self._model) if scene.resolves_contact else 0.0,
            operators=self._operators,
            transmission_error=run.attrs["peak_to_peak_transmission_error"] * run.attrs["base_radius_wheel"],
            peak_force=largest_normal_force(run),
            remarks=tuple(_remarks(self.subset, run)),
        )


def _varying(scene: Scene) -> int:
    """How many of a scene's effects are asked at every step."""
    return sum(any((each.gaps, each.load, each.clock)) for each in effects_on(scene))


def _remarks(subset: Subset, run: xr.Dataset) -> list[str]:
    found = [subset.note] if subset.note else []
    if subset.scene.inertia is not None and subset.scene.damping is None:
        found.append("undamped: the vibration of the start rings on in the answer")
    return found + run.attrs["warnings"].splitlines()


def _keep_what_fits(benches: Sequence[Bench]) -> None:
    kept = 0.0
    for bench in benches:
        kept += bench.bytes
        if kept > MOST_BYTES:
            bench.forget()


def _full_by_bare(rows: tuple[Row, ...]) -> tuple[tuple[float, ...], Expectation | None]:
    """Ratio of the times of a step of full and bare scene in every round, and what the unknowns lead one to expect."""
    ends = {row.subset.kind: row for row in rows if row.subset.kind in (BARE, ALL)}
    if len(ends) < 2:
        return (), None
    bare, full = ends[BARE], ends[ALL]
    others = [(row.work, row.step_time) for row in rows if row.subset.kind in (ALONE, LEFT_OUT) and row.elastic]
    ratios = tuple(large / small for small, large in zip(bare.step_times, full.step_times))
    return ratios, expected_ratio(bare.work, full.work, others)
