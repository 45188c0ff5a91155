"""Runs and times the subsets of a scene's effects: results from whole runs, times from shorter runs in turns."""

import statistics
import time
from dataclasses import dataclass, replace
from math import isnan, nan

import xarray as xr

from fenics_gears import ComputationError, GearsError, Scene, SceneError, model_of
from fenics_gears.many_runs import GearStore, Progress, SilentProgress
from fenics_gears.measuring import EVERY_STEP, Cycle, Model, compile_kernels, completed, shared_gears
from fenics_gears.shown import largest_normal_force

from ..machine import machine
from .subsets import ALL, ALONE, BARE, LEFT_OUT, EffectsOfPair, Skipped, Subset, subsets_of

ROUNDS = 5
TIMED_STEPS = 1000
# Contact operators are kept between the rounds up to this size of all subsets; beyond it they are built again.
MOST_BYTES = 1e9


@dataclass(frozen=True)
class MeasuredRow:
    """Costs and results of one subset.

    `contact_rows`: of the contact operator, on the average over the mesh cycle; `step_times` (rounds,), s. `condense`:
    both gears, s, zero for rigid flanks. `operators`: of one mesh cycle, s. `transmission_error`: peak to peak, mm on
    the wheel's base circle. `peak_force`: of the mesh, N. `remarks`: what to know of this row. `peak_pressure`: MPa,
    tip edges left out. `face_load_factor`: K_Hbeta. NaN where there is none.
    """

    subset: Subset
    coordinates: int
    contact_rows: float
    closed_nodes: float
    most_closed_nodes: int
    iterations: float
    step_times: tuple[float, ...]
    condense: float
    operators: float
    transmission_error: float
    peak_force: float
    remarks: tuple[str, ...]
    peak_pressure: float = nan
    face_load_factor: float = nan

    @property
    def elastic(self) -> bool:
        """Whether the teeth are elastic; rigid flanks are solved by another method."""
        return self.subset.scene.tooth_elasticity is not None

    @property
    def unknowns(self) -> float:
        return self.coordinates + self.contact_rows

    @property
    def step_time(self) -> float:
        return statistics.median(self.step_times)


@dataclass(frozen=True)
class EffectReport:
    """All rows of a scene, what was left out and why, and the machine."""

    scene: Scene
    rows: tuple[MeasuredRow, ...]
    skipped: tuple[Skipped, ...]
    machine: dict[str, str]

    @property
    def of_face(self) -> tuple[str, ...]:
        """The numbers that a report adds where runs have a load over their face."""
        return () if all(isnan(row.face_load_factor) for row in self.rows) else ("face_load_factor", "peak_pressure")

    def row(self, kind: str, effect: str = "") -> MeasuredRow | None:
        return next((each for each in self.rows if (each.subset.kind, each.subset.effect) == (kind, effect)), None)

    @property
    def ratios(self) -> tuple[float, ...]:
        """Time of a step of the full scene by that of the bare one, in each round."""
        bare = self.row(BARE)
        full = self.row(ALL)
        if bare is None or full is None:
            return ()
        return tuple(large / small for small, large in zip(bare.step_times, full.step_times))

    def reference(self, row: MeasuredRow) -> MeasuredRow | None:
        """What a row is compared with: the bare scene for an effect alone, the full one for an effect left out; else
        None."""
        return {ALONE: self.row(BARE), LEFT_OUT: self.row(ALL)}.get(row.subset.kind)


def measure(scene: Scene, progress: Progress | None = None, rounds: int = ROUNDS) -> EffectReport:
    """Run and time the subsets of a scene's effects. Raises SceneError, GeometryError, ComputationError where not one
    subset runs."""
    progress = progress or SilentProgress()
    scene = at_one_accuracy(scene)
    subsets, skipped = subsets_of(EffectsOfPair(scene))
    progress.stage("compile")
    for tangential in (False, True):
        compile_kernels(tangential, progress=progress)
    progress.stage("condense, and answers")
    store = shared_gears()
    benches = []
    kept = 0.0
    for subset in progress.counted(subsets, lambda subset: subset.name):
        try:
            bench = Bench(subset, store)
        except GearsError as error:
            skipped.append(Skipped(subset.name, str(error).splitlines()[0]))
            continue
        kept += bench.bytes
        if kept > MOST_BYTES:
            bench.cycle = None
        benches.append(bench)
    if not benches:
        raise ComputationError(
            "no subset of the effects could be run: " + "; ".join(f"{each.name}: {each.reason}" for each in skipped)
        )
    progress.stage("times")
    for bench in progress.counted(benches * rounds, lambda bench: bench.subset.name):
        bench.time_steps()
    return EffectReport(scene, tuple(bench.row() for bench in benches), tuple(skipped), machine())


def at_one_accuracy(scene: Scene) -> Scene:
    """The scene with every accuracy setting written out, so that all subsets have its mesh and steps."""
    resolution = model_of(scene).resolution
    if resolution.condensation == EVERY_STEP:
        raise SceneError('accuracy.condensation = "every step": effects are measured on the fast route. Take "once".')
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


class Bench:
    """One subset: its whole run, made at once, and its shorter runs, which are timed. `cycle`: the contact operators,
    None where they are to be built again for every timed run; `bytes`: of them. Raises GearsError where it cannot be
    run."""

    def __init__(self, subset: Subset, store: GearStore):
        self.subset = subset
        self._store = store
        self._model = model_of(subset.scene)
        self._gears, self.cycle, self._seconds = self._build()
        self._whole = self._run(self._model, self.cycle)
        motion = subset.scene.motion
        cycles = min(motion.mesh_cycles, max(1, round(TIMED_STEPS / self._model.resolution.steps_per_mesh_cycle)))
        shorter = replace(motion, mesh_cycles=cycles, recorded_cycles=1)
        self._shorter = model_of(replace(subset.scene, motion=shorter))
        self._step_times: list[float] = []
        operators = [self.cycle.position(step).operator for step in range(self.cycle.steps)]
        self.bytes = sum(operator.stored.rows.nbytes for operator in operators)
        self._contact_rows = sum(len(operator.jacobian) for operator in operators) / len(operators)

    def _build(self) -> tuple[tuple, Cycle, float]:
        """The gears, which subsets share, the contact operators of a mesh cycle, and the seconds that these took."""
        gears, cycle = self._store.prepared(self._model, SilentProgress(), None)
        begun = time.perf_counter()
        for step in range(cycle.steps):
            cycle.position(step)
        return gears, cycle, time.perf_counter() - begun

    def _run(self, model: Model, cycle: Cycle) -> xr.Dataset:
        return completed(model, lambda model, progress, cache: (self._gears, cycle)).dataset

    def time_steps(self) -> None:
        """One more timed run, of the scene's first mesh cycles."""
        timed = self._run(self._shorter, self.cycle if self.cycle is not None else self._build()[1])
        self._step_times.append(timed.attrs["time_march"] / timed.attrs["steps"])

    def row(self) -> MeasuredRow:
        run = self._whole
        return MeasuredRow(
            subset=self.subset,
            coordinates=len(self._model.drivetrain.coordinates),
            contact_rows=self._contact_rows,
            closed_nodes=float(run.closed_nodes.mean()),
            most_closed_nodes=int(run.closed_nodes.max()),
            iterations=run.attrs["newton_iterations_total"] / run.attrs["steps"],
            step_times=tuple(self._step_times),
            condense=sum(gear.timings["time_mesh"] + gear.timings["time_condense"] for gear in self._gears),
            operators=self._seconds,
            transmission_error=run.attrs["peak_to_peak_transmission_error"] * run.attrs["base_radius_wheel"],
            peak_force=largest_normal_force(run),
            remarks=tuple(_remarks(self.subset, run)),
            peak_pressure=float(run.attrs.get("peak_contact_pressure", nan)),
            face_load_factor=float(run.attrs.get("face_load_factor", nan)),
        )


def _remarks(subset: Subset, run: xr.Dataset) -> list[str]:
    sentences = [subset.note] if subset.note else []
    if subset.scene.inertia is not None and subset.scene.damping is None:
        sentences.append("undamped: the vibration of the start rings on in the answer")
    return sentences + run.attrs["warnings"].splitlines()
