"""The trial runs from which the errors of settings are estimated: a few that are coarse in different ways.

A setting has two sizes: of the mesh, with which flank elements, contact nodes and body elements grow together from
their defaults, and the number of steps. Over a face it also has the number of slices. Layers of the bodies keep their
defaults, which err by less than any target (docs/evidence/third_dimension.md). All errors fall with the square of the
size, so that a run with twice the size differs by three times the error.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Any

import numpy as np

from fenics_gears.errors import ComputationError, GearsError
from fenics_gears.model.cost import expected_cost
from fenics_gears.model.cost_parts import ExpectedCost
from fenics_gears.model.expected_errors import FACE_LOAD, FLANK, LINE_LOAD, OF_SLICES, SPAN, expected_errors
from fenics_gears.model.model import Model, model_of
from fenics_gears.results.validity import WINDOW_REACHED
from fenics_gears.runs.one_run import Ticking
from fenics_gears.scene.accuracy import MOST_CONTACT_NODES, Accuracy
from fenics_gears.scene.accuracy_rules import FINEST_BODY, FINEST_ELEMENT
from fenics_gears.scene.data import Output, Scene
from fenics_gears.system.memory import allowed_memory
from fenics_gears.system.progress import Progress

from .convergence import NotComparable, errors_of_two
from .measures import LEAST_SPAN, Answer, judged_answer
from .setting import Setting, own_setting, without_settings
from .setting_runs import SettingRuns

# Steps in a mesh cycle are multiples of this, so that curves of different runs have phases in common.
ROUND_STEPS = 20
# Fewest steps in a mesh cycle of the finer trial runs, where steps matter, and the most that are taken for the sake of
# vibrations. If vibrations are still faster, the motion follows the static one.
FEWEST_STEPS = 40
MOST_STEPS = 1280
MESH = "finite elements and contact nodes"
STEPS = "steps per mesh cycle"
SLICES = "slices"
COARSER = 2
# Steps that barely follow a vibration err by more than order 2 says. From 40 to 80 of them errors fell by order 1, and
# were 2.2 times the estimate of the two runs, more than the factor of every estimate.
MORE_OF_VIBRATIONS = 1.25
# Gears kept in memory: pinion and wheel of two meshes.
KEPT_GEARS = 4
# Factor by which the contact window is lengthened where contact reaches its end, and how often.
LONGER = 1.25
MOST_LENGTHENED = 4


class TargetNotReached(ComputationError):
    """No settings within the limits reach the target."""


@dataclass(frozen=True)
class Sizes:
    """Size of the mesh in that of the defaults, steps in a mesh cycle, and slices of the face, 0 in the plane."""

    mesh: float
    steps: int
    slices: int = 0


class Trials(ABC):
    """Trial runs, each setting once. `begun`: called before each run with its settings in words; `tick`: called often
    during a run, may raise KeyboardInterrupt. `models`: of each mesh, with the settings that the program chooses;
    `cost` of what is run. `vibrates`: whether masses do; `steps_matter`: whether their number has an error of its own.

    Of a pair `TrialRuns`, of meshes that are computed together `row_trials.TrialsOfRow`.
    """

    # What numbers of steps are multiples of, halves being whole.
    step_unit = ROUND_STEPS

    def __init__(
        self, models: Sequence[Model], cost: Callable[[Any], ExpectedCost], vibrates: bool, steps_matter: bool,
        begun: Callable[[str], None], tick: Callable[[], None] | None,
    ):  # fmt: skip
        self.models = models
        self._cost = cost
        self.vibrates = vibrates
        self.steps_matter = steps_matter
        self._begun = begun
        self._tick = tick
        self._answers: dict[Any, tuple[Answer, ...]] = {}
        self._allowed = allowed_memory()
        self.runs = 0
        # The default number of slices, 0 in the plane.
        self.slices = max(model.slices_and_layers[0] or 0 for model in models)

    @abstractmethod
    def setting(self, sizes: Sizes) -> Any:
        """Sizes as a setting, with its `words`."""

    @abstractmethod
    def _model(self, sizes: Sizes) -> Any:
        """What is run with these sizes; raises TargetNotReached where they are beyond the limits."""

    @abstractmethod
    def _run(self, setting: Any, progress: Progress) -> Any:
        """Run a setting, and keep its answers."""

    @abstractmethod
    def _with_window_long_enough(self, sizes: Sizes) -> None:
        """Lengthen the contact window until no contact reaches its ends, where the program tells that it does."""

    def resolving_mesh(self, elements: float) -> float:
        """Size of the mesh that has so many flank elements in the Hertz half-width."""
        resolved = [each.resolution for each in self.models]
        return min(each.half_width / (elements * each.flank_element_size) or inf for each in resolved)

    @property
    def expected(self) -> dict[str, float]:
        """By setting the largest error over the face that the defaults are expected to have in what is judged."""
        expected = {MESH: 0.0, SLICES: 0.0}
        for errors in map(expected_errors, self.models):
            for name, scale in ((SPAN, LEAST_SPAN), (FACE_LOAD, 1.0), (LINE_LOAD, 1.0)):
                parts = errors[name]
                expected[MESH] = max(expected[MESH], parts[FLANK] / scale)
                of_slices = (parts[size] / scale for size in OF_SLICES if size in parts)
                expected[SLICES] = max(expected[SLICES], *of_slices)
        return expected

    @property
    def fewest_steps(self) -> int:
        """Fewest steps of the finer of two runs, where the other has half as many: both can represent the slowest
        vibration that matters."""
        steps = FEWEST_STEPS
        if not self.steps_matter:
            return steps // COARSER
        while not self._model(Sizes(COARSER, steps // COARSER)).time_scales.averages_acceleration:
            steps *= 2
            if steps > MOST_STEPS:
                return FEWEST_STEPS
        return steps

    def errors(self, sizes: Sizes) -> dict[str, np.ndarray]:
        """Estimated relative errors of a run, by setting: of each judged measure of each mesh over the face, where
        settings tell on different ones; in the plane of the worst. Raises ComputationError."""
        # Each error is measured where runs are short: the mesh's with fewer steps and slices, the slices' with a
        # coarser mesh.
        short = sizes
        if self.steps_matter:
            short = replace(short, steps=sizes.steps // COARSER)
        if self.slices:
            short = replace(short, slices=sizes.slices // COARSER)
        self._with_window_long_enough(replace(short, steps=sizes.steps))
        coarse = replace(short, mesh=COARSER * sizes.mesh)
        errors = {MESH: self._error(short, coarse)}
        if self.steps_matter:
            vibrating = MORE_OF_VIBRATIONS if self.vibrates else 1.0
            errors[STEPS] = vibrating * self._error(replace(short, steps=sizes.steps), short)
        if self.slices:
            errors[SLICES] = self._error(replace(coarse, slices=sizes.slices), coarse)
        return errors

    def cost(self, sizes: Sizes) -> float:
        """Expected seconds of the whole run, which are counted. Raises TargetNotReached where it is beyond the
        limits."""
        expected = self._cost(self._model(sizes))
        if expected.held > self._allowed:
            raise TargetNotReached(
                f"{self.setting(sizes).words} would take {expected.held / 1e9:.3g} GB of memory, and"
                f" {self._allowed / 1e9:.3g} GB are allowed (`--memory`, FENICS_GEARS_MEMORY)"
            )
        return (expected.condensing or 0.0) + expected.marching

    def _error(self, sizes: Sizes, coarser: Sizes) -> np.ndarray:
        try:
            of_meshes = zip(self._answered(sizes), self._answered(coarser))
            errors = np.concatenate([errors_of_two(*both, COARSER) for both in of_meshes])
        except NotComparable as measure:
            one, other = (self.setting(each).words for each in (sizes, coarser))
            raise TargetNotReached(
                f"the runs with {one} and with {other} do not both have the {measure}: so little of the flanks carries"
                " that coarse settings miss it. Raise the load, or lower what lifts the flanks off each other"
            ) from None
        return errors if self.slices else errors.max(keepdims=True)

    def _answered(self, sizes: Sizes) -> tuple[Answer, ...]:
        """The answers of all meshes."""
        setting = self.setting(sizes)
        if setting not in self._answers:
            self._tried(setting)
        return self._answers[setting]

    def _tried(self, setting: Any) -> Any:
        self.runs += 1
        self._begun(setting.words)
        try:
            return self._run(setting, Ticking(self._tick))
        except MemoryError:
            raise TargetNotReached(f"there is not enough memory for the run with {setting.words}") from None
        except GearsError as error:
            raise ComputationError(
                f"while accuracy.target was choosing settings, the run with {setting.words} failed: {error}"
            ) from error


class TrialRuns(Trials):
    """Of a pair; gears are condensed once for all runs that share them."""

    def __init__(self, scene: Scene, begun: Callable[[str], None], tick: Callable[[], None] | None = None):
        self._whole = without_settings(scene)
        self._trial = replace(self._whole, output=Output(), motion=replace(scene.motion, recorded_cycles=1))
        self._known = SettingRuns(self._trial, lambda run, model, cycle: judged_answer(run), KEPT_GEARS)
        self._default = own_setting(self._whole)
        vibrates = scene.inertia is not None
        # Without friction and inertia the value at a step does not depend on the steps before.
        matter = scene.friction is not None or vibrates
        super().__init__((model_of(self._whole),), expected_cost, vibrates, matter, begun, tick)

    def setting(self, sizes: Sizes) -> Setting:
        """Sizes as a setting with the contact window in use."""
        default = self._default
        return replace(
            default,
            flank=sizes.mesh * default.flank,
            spacing=sizes.mesh * default.spacing,
            body=sizes.mesh,
            steps=sizes.steps,
            slices=sizes.slices or default.slices,
        )

    def _model(self, sizes: Sizes) -> Model:
        setting = self.setting(sizes)
        module = self._whole.gears.module
        check_sizes(setting.words, setting.accuracy(module), module)
        try:
            return model_of(setting.of(self._whole))
        except GearsError as error:
            raise TargetNotReached(f"{setting.words}: {error}") from None

    def _with_window_long_enough(self, sizes: Sizes) -> None:
        for _ in range(MOST_LENGTHENED):
            setting = self.setting(sizes)
            if setting in self._answers:
                return
            if WINDOW_REACHED not in self._tried(setting).attrs["warnings"]:
                return
            self._default = replace(self._default, length=LONGER * self._default.length)
        raise TargetNotReached("contact reaches the ends of the contact window however long it is")

    def _run(self, setting: Setting, progress: Progress) -> Any:
        run = self._known.run(setting, progress)
        self._answers[setting] = (self._known.answers[setting],)
        return run


def check_sizes(words: str, accuracy: Accuracy, module: float) -> None:
    """Raise TargetNotReached for settings, in `words`, that are finer than a scene of this module (mm) may have."""
    if (
        (accuracy.flank_element_size or inf) < FINEST_ELEMENT * module
        or (accuracy.body_element_size or inf) < FINEST_BODY * module
        or (accuracy.contact_nodes or 0) > MOST_CONTACT_NODES
    ):
        raise TargetNotReached(
            f"{words}: finer than a scene may ask for ({FINEST_ELEMENT:g} modules on the flank,"
            f" {FINEST_BODY:g} in the body, {MOST_CONTACT_NODES} nodes)"
        )
