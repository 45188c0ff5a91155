"""The runs that a choice rests on: one knob at a time, its size halved from rung to rung, all others as the base has them.

Flank elements and contact nodes are refined together, as the program's defaults have them. Alone neither shows what it is worth: where a
tip's edge presses, closer nodes pass part of their error on to the elements. Together their error falls with a clean order.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from fenics_gears.contact.interpolation import AVERAGED
from fenics_gears.errors import ComputationError, GearsError
from fenics_gears.model import model
from fenics_gears.resolution import NODE_SPACING
from fenics_gears.scene.data import Accuracy, Output, Scene
from fenics_gears.studies.accuracy import ladder
from fenics_gears.studies.accuracy.ladder import Setting
from fenics_gears.studies.accuracy.measures import Answer, answer
from fenics_gears.studies.accuracy.timing import KeptGears
from fenics_gears.studies.target.choice import Sizes
from fenics_gears.studies.target.cost import STAGES, Cost, cost_exponent
from fenics_gears.studies.target.error_curve import ErrorCurve, error_curve
from fenics_gears.studies.target.errors import TargetNotReached
from fenics_gears.studies.target.limits import Limits
from fenics_gears.studies.work import Ticking
from fenics_gears.validity import WINDOW_REACHED

ELEMENT = "P2"
FLANK, BODY, STEPS = KNOBS = "flank elements and contact nodes", "body element size", "steps per mesh cycle"
# The order of the flank's knob is that of the contact nodes, the lower of the two.
LADDER_NAMES = {FLANK: "contact node spacing", BODY: BODY, STEPS: STEPS}
# Where ladders begin: elements in a half-width, body elements in parts of their default, steps in a cycle.
COARSEST = {FLANK: 0.7, BODY: 4.0, STEPS: 20}
RUNGS = 3
# The rung on which the others stand while one knob is turned.
BASE_RUNG = {FLANK: 2, BODY: 2, STEPS: 2}
# Condensed gears that are kept: pinion and wheel of the base, and of one more rung.
KEPT_GEARS = 4
# By how much the contact window is lengthened where it cuts contact off.
LONGER = 1.25


@dataclass(frozen=True)
class Ran:
    """A run of the pilot: what it is judged by, seconds by stage, and whether the contact window cut contact off."""

    answer: Answer
    seconds: dict[str, float]
    cut: bool


class Pilot:
    """Runs rungs as they are asked for, each setting once; gears are condensed once for all runs that share them.

    `begun`: called with a run's words before it; `tick`: often while it goes on, and may raise KeyboardInterrupt.
    """

    def __init__(self, scene: Scene, begun: Callable[[str], None], tick: Callable[[], None] | None = None):
        self._tick = tick
        self.scene = replace(scene, accuracy=Accuracy(), output=Output(), motion=replace(scene.motion, recorded_cycles=1))
        self._begun, self._gears, self._ran = begun, KeptGears(KEPT_GEARS), {}
        self._limits = Limits(replace(scene, accuracy=Accuracy()), order=2)
        self._unit = ladder.half_width(self.scene)
        self.length = model(self.scene).resolution.contact_grid.length
        expected = {knob.name: knob.expected for knob in ladder.knobs(self.scene)}
        self._expected = {name: expected[LADDER_NAMES[name]] for name in KNOBS}
        self._rungs = dict.fromkeys(KNOBS, RUNGS)

    @property
    def base(self) -> Setting:
        """Where all knobs but one stand."""
        return self.setting(self._base_sizes())

    def setting(self, sizes: Sizes) -> Setting:
        """Sizes by knob as a setting of the contact window in use."""
        return Setting(ELEMENT, sizes[FLANK], NODE_SPACING * sizes[FLANK], self.length, sizes[BODY], round(1.0 / sizes[STEPS]), AVERAGED)

    def refine(self, name: str) -> None:
        """Give a knob's ladder one rung more. Raises TargetNotReached where that run is beyond the limits."""
        finer = {**self._base_sizes(), name: self._size(name, self._rungs[name])}
        if not self.may_run(finer):
            reason = self._limits.why_not(finer[FLANK], finer[BODY], self.length)
            raise TargetNotReached(f"the next halving of the {name} {reason}{self._why_slow}")
        self._rungs[name] += 1

    def may_run(self, sizes: Sizes, stored: bool = False):
        """Whether a run of the pilot stays within the limits; `stored`: one of the whole scene. Arrays of sizes are broadcast."""
        return self._limits.allowed(sizes[FLANK], sizes[BODY], sizes[STEPS], self.length, stored)

    def curves(self) -> list[ErrorCurve]:
        """Every knob's errors, by runs of all its rungs."""
        return [self.curve(name) for name in KNOBS]

    def curve(self, name: str) -> ErrorCurve:
        """Errors of one knob."""
        return error_curve(name, self._sizes(name), [self.run(setting).answer for setting in self._turned(name)], self._expected[name])

    def cost(self) -> Cost:
        """Seconds of each stage against every knob's size."""
        exponents = {stage: {name: self._exponent(name, stage) for name in KNOBS} for stage in STAGES}
        return Cost(self._base_sizes(), self.run(self.base).seconds, exponents)

    def window_cuts_contact(self) -> bool:
        """Whether contact reaches an end of the window; where it does not, a longer window changes nothing but where nodes stand."""
        return self.run(self.base).cut

    def lengthen(self) -> None:
        """Take the longer contact window from now on."""
        self.length *= LONGER

    def run(self, setting: Setting) -> Ran:
        """A run of a setting, or what it gave before. Raises ComputationError."""
        if setting not in self._ran:
            self._begun(setting.words)
            self._ran[setting] = self._run(setting)
        return self._ran[setting]

    @property
    def _why_slow(self) -> str:
        """What makes errors fall slowly, or begin high, in words; empty where nothing is known to."""
        half_width = model(self.scene).resolution.half_width
        if half_width < 0.5 * self._unit:
            return f", for under this load the contact's half-width is {half_width:.2g} mm only"
        if self.scene.tip_relief is not None:
            return ""
        return ", for errors fall slowly where the sharp edges of unrelieved tips press ([tip_relief] takes that away)"

    @property
    def runs(self) -> int:
        """How many runs there were."""
        return len(self._ran)

    def _run(self, setting: Setting) -> Ran:
        try:
            run = self._gears.run(replace(self.scene, accuracy=setting.accuracy(self.scene.gears.module)), Ticking(self._tick))
        except MemoryError:
            raise TargetNotReached(f"there is not enough memory for the run with {setting.words}") from None
        except GearsError as error:
            raise ComputationError(f"while accuracy.target was choosing settings, the run with {setting.words} failed: {error}") from error
        seconds = {"gears": float(run.attrs["time_mesh"] + run.attrs["time_condense"]), "march": float(run.attrs["time_march"])}
        return Ran(answer(run, self.length), seconds, WINDOW_REACHED in run.attrs["warnings"])

    def _exponent(self, name: str, stage: str) -> float:
        return cost_exponent(self._sizes(name), [self.run(setting).seconds[stage] for setting in self._turned(name)])

    def _turned(self, name: str) -> list[Setting]:
        """The settings of a knob's rungs."""
        return [self.setting({**self._base_sizes(), name: size}) for size in self._sizes(name)]

    def _base_sizes(self) -> Sizes:
        return {name: self._size(name, rung) for name, rung in BASE_RUNG.items()}

    def _sizes(self, name: str) -> list[float]:
        return [self._size(name, rung) for rung in range(self._rungs[name])]

    def _size(self, name: str, rung: int) -> float:
        """Size of a rung, halved from one to the next."""
        coarsest = COARSEST[name]
        first = {FLANK: self._unit / coarsest, BODY: coarsest, STEPS: 1.0 / coarsest}[name]
        return first / 2.0**rung
