"""Runs of a search whose numbers alone are asked for: those that share contact operators are solved together."""

from collections.abc import Collection, Sequence
from functools import partial

from fenics_gears.contact.mesh_cycle import SHARE_KEPT, SHARE_OF_A_BLOCK, Cycle, Gaps
from fenics_gears.contact.relief_gaps import Profiles
from fenics_gears.effects import ALONG_THE_FACE, common_period, effects_on
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.model.cost import expected_cost, too_large
from fenics_gears.model.model import RELIEFS, Model, differ_only
from fenics_gears.results.extrema import repeating_steps
from fenics_gears.results.together import OFFERED, NumbersOfRun, numbers_together
from fenics_gears.system.memory import give_back
from fenics_gears.system.progress import SilentProgress

from .elastic_route import openings_of, reliefs_apart
from .routes import Preparation
from .simulate import memory_for_operators
from .warm_up import compile_kernels


def can_be_solved_together(model: Model, asked: Collection[str]) -> bool:
    """Whether the numbers `asked` of a run can be had so: of a quasi-static pair of elastic teeth, all alike, under a
    constant load."""
    scene = model.scene
    drivetrain = model.drivetrain
    teeth_alike = reliefs_apart(model) and common_period(scene) == 1
    steady = drivetrain.mass is None and drivetrain.rolling is None and not model.loads
    own = scene.output.root_stress or scene.accuracy.target is not None or scene.speed_ramp is not None
    gaps = any(effect.gaps for effect in effects_on(scene))
    # Friction that can lock the teeth is looked at step by step.
    locking = model.friction_coefficient * model.pair.wheel.tip_roll_angle >= 1.0
    held = scene.friction is None or repeating_steps(model) > 0
    return OFFERED.issuperset(asked) and teeth_alike and steady and held and not (own or gaps or locking)


def alike(one: Model, other: Model) -> bool:
    """Whether the runs of two models with the same contact operators differ in nothing but load, reliefs and
    what opens the flanks along the face."""
    return one.scene is other.scene or differ_only(one.scene, other.scene, ("load", *RELIEFS, *ALONG_THE_FACE))


def solved_together(
    models: Sequence[Model], preparation: Preparation, asked: Collection[str]
) -> list[NumbersOfRun | None]:
    """The numbers `asked` of runs that can be solved together and are `alike`; None of a run that has to be run by
    itself. Raises GearsError as `simulate` does."""
    model = models[0]
    try:
        most = memory_for_operators(expected_cost(model), partial(too_large, model))
        _, cycle = preparation(model, SilentProgress(), user_cache())
        cycle.kept.most = most
        compile_kernels(model.scene.friction is not None)
        involutes = cycle.with_gaps(Gaps())
        at_once = _most_at_once(model, cycle)
        numbers = []
        for first in range(0, len(models) if at_once else 0, max(at_once, 1)):
            some = models[first : first + at_once]
            gaps = Profiles(involutes, [each.removal for each in some], [openings_of(each, involutes) for each in some])
            numbers += numbers_together(some, involutes, gaps, asked)
        return numbers or [None] * len(models)
    finally:
        give_back()


def _most_at_once(model: Model, cycle: Cycle) -> int:
    """How many runs on the operators of a cycle may be marched together; none where these cannot all be held."""
    kept = cycle.kept
    position = cycle.position(0)
    if position.bytes * cycle.steps > SHARE_KEPT * kept.most - kept.others:
        return 0
    kinds = 2 if model.scene.friction is not None else 1
    # Forces and displacements, gaps, and sets before and after.
    of_node = 8 * (2 * kinds + 1) + 2
    return max(int(SHARE_OF_A_BLOCK * kept.most / (of_node * position.operator.nodes * (model.steps + 1))), 1)
