"""The trial runs by which settings are chosen: one setting at a time is halved from level to level, the others stay as in the base.

Flank elements and contact nodes are refined together, as in the program's defaults. Where a tip's edge presses, closer nodes alone pass part of
their error on to the elements; together their error falls with a clear order.

What a run with some sizes costs is counted, by the weights of `fenics_gears.model.cost`, so that a scene gets the same settings on every
machine. Only ratios of costs matter.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf

import numpy as np

from fenics_gears.elasticity.element_sizes import DEFAULT_SIZES
from fenics_gears.errors import ComputationError, GearsError
from fenics_gears.model import cost
from fenics_gears.model.cost import SECTOR_UNKNOWNS, flank_bytes, flank_unknowns, loaded_pairs, operator_bytes
from fenics_gears.model.model import MOST_STORED_BYTES, Model, model_of
from fenics_gears.model.resolution import NODE_SPACING
from fenics_gears.results.validity import WINDOW_REACHED
from fenics_gears.scene.data import Output, Scene
from fenics_gears.scene.rules import FINEST_BODY, FINEST_ELEMENT
from fenics_gears.scene.schema import MOST_CONTACT_NODES
from fenics_gears.studies.accuracy.convergence import ErrorCurve, error_curve
from fenics_gears.studies.accuracy.measures import Answer, judged_answer
from fenics_gears.studies.accuracy.refinement import BODY, NODES, STEPS, expected_orders
from fenics_gears.studies.accuracy.runs import run_sharing, shared_gears
from fenics_gears.studies.accuracy.setting import Setting, half_width, without_settings
from fenics_gears.studies.work import Ticking

ELEMENT, ORDER = "P2", 2
FLANK = "flank elements and contact nodes"
NAMES = (FLANK, BODY, STEPS)
# Coarsest level: elements in a half-width, body elements in parts of their default, steps in a cycle; and the number of levels.
COARSEST = {FLANK: 0.7, BODY: 4.0, STEPS: 20}
LEVELS = 3
# The level on which the others stand while one setting is refined.
BASE_LEVEL = {FLANK: 2, BODY: 2, STEPS: 2}
# Gears kept in memory: pinion and wheel of the base, and of one more level.
KEPT_GEARS = 4
# Factor by which the contact window is lengthened where contact reaches its end.
LONGER = 1.25
# Most memory for the contact operators and condensed flanks of a run.
MOST_BYTES = 4e9

Size = float | np.ndarray
Sizes = dict[str, float]


class TargetNotReached(ComputationError):
    """No settings within the limits reach the target."""


class Limits:
    """Limits and costs of a scene's runs; its `[accuracy]` is empty.

    Sizes are those of flank elements (mm), body elements (parts of their default) and steps (mesh cycles), `length` that of the contact
    window (mm). Arrays of sizes are broadcast.
    """

    def __init__(self, scene: Scene):
        self._model: Model = model_of(scene)
        self._gears = self._model.pair.pinion, self._model.pair.wheel
        self._friction, self._module = scene.friction is not None, scene.gears.module
        self._pairs = loaded_pairs(self._model)

    def cost(self, flank: Size, body: Size, step: Size, length: float) -> Size:
        """Cost of the whole run: meshing and condensing both gears, contact operators of a mesh cycle, all steps."""
        of_body, per_node = SECTOR_UNKNOWNS[ELEMENT]
        total = 0.0
        for gear in self._gears:
            dofs = flank_unknowns(gear, ORDER, flank)
            # In the plane half the size is four times as many.
            unknowns = of_body * np.asarray(body, dtype=float) ** -2 + 0.5 * per_node * dofs
            total = total + cost.GEAR + cost.UNKNOWN * unknowns + cost.FLANK_CUBE * dofs**3
        loaded, positions = self._pairs * self._nodes(flank, length), 1.0 / np.asarray(step, dtype=float)
        rows = loaded * (2 if self._friction else 1)
        of_step = cost.STEP + cost.ROW * rows
        of_operator = cost.PAIR * self._pairs + cost.NODES_SQUARE * loaded**2
        return total + positions * (of_operator + self._model.scene.motion.mesh_cycles * of_step)

    def bytes_of(self, flank: Size, step: Size, length: float) -> Size:
        """Memory of contact operators over one mesh cycle, and of both gears."""
        rows = self._pairs * self._nodes(flank, length) * (2 if self._friction else 1)
        return operator_bytes(1.0 / step, rows, self._friction) + sum(flank_bytes(flank_unknowns(gear, ORDER, flank)) for gear in self._gears)

    def stored_bytes(self, flank: Size, step: Size, length: float) -> Size:
        """Size of the scene's own result: curves of all steps, and the contact fields that it stores."""
        grid, steps = self._model.resolution.contact_grid, self._model.resolution.steps_per_mesh_cycle
        curves = replace(self._model, contact_cycles=0).stored_bytes
        fields = self._model.stored_bytes - curves
        return (curves + fields * self._nodes(flank, length) / grid.nodes) / (step * steps)

    def too_fine(self, flank: Size, body: Size, length: float) -> Size:
        """Whether elements or contact nodes are finer than a scene file may ask for."""
        body_size = body * DEFAULT_SIZES[ORDER].body * self._module
        too_fine = (flank < FINEST_ELEMENT * self._module) | (body_size < FINEST_BODY * self._module)
        return too_fine | (body_size < flank) | (self._nodes(flank, length) > MOST_CONTACT_NODES)

    def allowed(self, flank: Size, body: Size, step: Size, length: float, stored: bool = True) -> Size:
        """Whether a run may have these sizes; `stored`: with the whole of its result, as the run that is asked for has it."""
        held = (self.bytes_of(flank, step, length) <= MOST_BYTES) & ~np.asarray(self.too_fine(flank, body, length))
        return held & (self.stored_bytes(flank, step, length) <= (MOST_STORED_BYTES if stored else inf))

    def why_not(self, flank: float, body: float, length: float) -> str:
        """Which limit a run exceeds, in words that follow "the next halving of ..."."""
        if self.too_fine(flank, body, length):
            return f"takes elements or contact nodes finer than a scene may ask for ({FINEST_ELEMENT:g} modules on the flank, {MOST_CONTACT_NODES} nodes)"
        return f"takes more than {MOST_BYTES / 1e9:g} GB for contact operators and gears"

    def _nodes(self, flank: Size, length: float) -> Size:
        return length / (NODE_SPACING * flank) + 2.0


class TrialRuns:
    """Trial runs, each setting once; gears are condensed once for all runs that share them.

    `factors`: by setting, the correction of its errors that a check found.
    `begun`: called before each run with its settings in words; `tick`: called often during a run, may raise KeyboardInterrupt.
    """

    def __init__(self, scene: Scene, begun: Callable[[str], None], tick: Callable[[], None] | None = None):
        self.scene = replace(without_settings(scene), output=Output(), motion=replace(scene.motion, recorded_cycles=1))
        self._begun, self._tick, self._gears = begun, tick, shared_gears(KEPT_GEARS)
        self._limits = Limits(without_settings(scene))
        self._unit, model = half_width(self.scene), model_of(self.scene)
        self.length = model.resolution.contact_grid.length
        orders = expected_orders(self.scene)
        # Of flank elements and contact nodes the lower order counts, the nodes'.
        self._expected = {FLANK: orders[NODES][0], BODY: orders[BODY][0], STEPS: orders[STEPS][0]}
        # Without friction and inertia steps are independent: every other step of a run is a run of half as many steps, so that one more
        # level of steps costs less than a run.
        self._steps_stand_alone = scene.friction is None and model.drivetrain.mass is None
        self._levels = {**dict.fromkeys(NAMES, LEVELS), STEPS: LEVELS + self._steps_stand_alone}
        self._known: dict[Setting, Answer] = {}
        self._cut: dict[float, bool] = {}
        self.factors: dict[str, float] = {}
        self.runs = 0

    def setting(self, sizes: Sizes) -> Setting:
        """Sizes as a setting with the contact window in use."""
        return Setting(ELEMENT, sizes[FLANK], NODE_SPACING * sizes[FLANK], self.length, sizes[BODY], round(1.0 / sizes[STEPS]))

    def refine(self, name: str) -> None:
        """Add a finer level to a setting. Raises TargetNotReached where its run is beyond the limits."""
        finer = {**self._base_sizes(), name: self._size(name, self._levels[name])}
        if not self.may_run(finer):
            reason = self._limits.why_not(finer[FLANK], finer[BODY], self.length)
            raise TargetNotReached(f"the next halving of the {name} {reason}{self._why_slow}")
        self._levels[name] += 1

    def may_run(self, sizes: dict[str, Size], stored: bool = False) -> Size:
        """Whether a trial run stays within the limits; `stored`: the whole scene's run. Arrays of sizes are broadcast."""
        return self._limits.allowed(sizes[FLANK], sizes[BODY], sizes[STEPS], self.length, stored)

    def cost(self, sizes: dict[str, Size]) -> Size:
        """Cost of the whole scene's run; arrays of sizes are broadcast."""
        return self._limits.cost(sizes[FLANK], sizes[BODY], sizes[STEPS], self.length)

    def curves(self) -> list[ErrorCurve]:
        """The errors of every setting from runs of all its levels; the run with most steps comes first, for it may hold those with fewer."""
        found = {}
        for name in NAMES[::-1]:
            sizes = [self._size(name, level) for level in range(self._levels[name])]
            answers = [self.answer(self.setting({**self._base_sizes(), name: size})) for size in sizes[::-1]]
            found[name] = replace(error_curve(name, sizes, answers[::-1], self._expected[name]), factor=self.factors.get(name, 1.0))
        return [found[name] for name in NAMES]

    def window_cuts_contact(self) -> bool:
        """Whether contact reaches an end of the window; if not, a longer window only moves the contact nodes."""
        self.answer(self.setting({**self._base_sizes(), STEPS: self._size(STEPS, self._levels[STEPS] - 1)}))
        return self._cut[self.length]

    def lengthen(self) -> None:
        """Lengthen the contact window for all further runs."""
        self.length *= LONGER

    def answer(self, setting: Setting) -> Answer:
        """The judged measures of a setting, which is run unless it has run before. Raises ComputationError."""
        if setting not in self._known:
            self._begun(setting.words)
            self._run(setting)
        return self._known[setting]

    @property
    def _why_slow(self) -> str:
        """Known reason why errors fall slowly or begin high, in words; empty without one."""
        width = model_of(self.scene).resolution.half_width
        if width < 0.5 * self._unit:
            return f", because the contact's half-width under this load is only {width:.2g} mm"
        if self.scene.tip_relief is not None:
            return ""
        return ", because errors decrease slowly where sharp edges of unrelieved tips are in contact ([tip_relief] avoids this)"

    def _run(self, setting: Setting) -> None:
        self.runs += 1
        try:
            run, _ = run_sharing(setting.of(self.scene), self._gears, Ticking(self._tick))
        except MemoryError:
            raise TargetNotReached(f"there is not enough memory for the run with {setting.words}") from None
        except GearsError as error:
            raise ComputationError(f"while accuracy.target was choosing settings, the run with {setting.words} failed: {error}") from error
        self._cut.setdefault(setting.length, WINDOW_REACHED in run.attrs["warnings"])
        self._known[setting] = judged_answer(run)
        if self._steps_stand_alone:
            steps = setting.steps
            for every in (each for each in range(2, steps // 2) if steps % each == 0):
                self._known.setdefault(replace(setting, steps=steps // every), judged_answer(run, every))

    def _base_sizes(self) -> Sizes:
        return {name: self._size(name, level) for name, level in BASE_LEVEL.items()}

    def _size(self, name: str, level: int) -> float:
        """Size of a level, halved from one to the next."""
        first = {FLANK: self._unit / COARSEST[FLANK], BODY: COARSEST[BODY], STEPS: 1.0 / COARSEST[STEPS]}[name]
        return first / 2.0**level
