"""Rows 1 to 3 at every step of scenes drawn at random. A step converges, or the run ends with a typed error that it
may end with; without friction, a convex problem, none but that of rigid teeth wider than the spaces between them."""

import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st
from tests.hard_cases.invariants import run_of, worst_of
from tests.hard_cases.random_scenes import valid_scenes
from tests.stand_in import stand_in_compliance

from fenics_gears import model_of
from fenics_gears.contact.errors import MoreThanOneSolution, NoStaticEquilibrium, SelfLocking
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Body
from fenics_gears.simulation.bodies import gear_bodies
from fenics_gears.system.progress import SilentProgress

# Row, words, limit and unit of each residual of `invariants.step_residuals`.
LAWS = {
    "penetration": (1, "largest penetration", 1e-4, "um"),
    "tension": (1, "largest tension / load", 1e-6, ""),
    "complementarity": (1, "p_n gap / (load x length)", 1e-10, ""),
    "cone": (2, "friction beyond mu p_n / load", 1e-6, ""),
    "wrong_way": (2, "work of friction in the direction of slip / (load x length)", 1e-10, ""),
    "dissipation": (2, "energy gained by friction / (load x length)", 1e-10, ""),
    "sum_of_forces": (3, "sum of forces on the two gears / load", 1e-12, ""),
    "sum_of_moments": (3, "sum of moments on the two gears / load torque", 1e-12, ""),
    "sum_of_axial_forces": (3, "sum of axial forces on the two gears / load", 1e-12, ""),
    "sum_of_tilting_moments": (3, "sum of tilting moments on the two gears / load torque", 1e-12, ""),
    "couples_by_base_radii": (3, "T1/rb1 - T2/rb2 without friction / load", 1e-12, ""),
    "equilibrium": (3, "residual of the quasi-static equilibrium / load", 1e-6, ""),
}


def obeys_the_laws(found):
    """Rows 1 to 3 at every step; the largest penetration, um."""
    worst = worst_of(found)
    for name, value in worst.items():
        assert value <= LAWS[name][2], f"{name}: {value}"
    return worst["penetration"]


class Tally:
    """The worst of each law over all scenes, and how the scenes ended."""

    def __init__(self):
        self.worst, self.scenes, self.steps, self.failed = {}, 0, 0, 0

    def judge(self, scene, compliances_of):
        model = model_of(scene)
        run = run_of(model, compliances_of(model))
        self.scenes, self.steps, self.failed = (
            self.scenes + 1,
            self.steps + len(run.records),
            self.failed + (run.failure is not None),
        )
        event("converged" if run.failure is None else run.failure.reason)
        residuals = worst_of(run)
        for name, value in residuals.items():
            self.worst[name] = max(self.worst.get(name, 0.0), value)
        for name, value in residuals.items():
            assert value <= LAWS[name][2], f"{name}: {value}\n{scene.text}"
        if run.failure is not None:
            assert is_right(run.failure, scene), f"{run.failure}\n{scene.text}"
        return run

    def tell(self, measured, gears):
        for name, value in self.worst.items():
            row, words, limit, unit = LAWS[name]
            measured(f"{words}, {gears}", value, f"{limit:g} {unit}".rstrip(), unit, row=row)
        ended = f"{self.scenes} scenes, {self.steps} steps, {self.failed} errors with their cause"
        measured(f"random scenes, {gears}", ended, "all converge or end with the cause", row=1)


def is_right(failure, scene) -> bool:
    """Whether a run of that scene may end so."""
    if scene.tooth_elasticity is None:
        return isinstance(failure, NoStaticEquilibrium) and "wedged" in str(failure) and scene.bearings is None
    return scene.friction is not None and isinstance(failure, (SelfLocking, MoreThanOneSolution))


def on_stand_ins(model):
    if model.scene.tooth_elasticity is None:
        return None
    reach, coast = model.touching.reach.farthest, model.scene.coast_flanks is not None
    return tuple(
        Body(stand_in_compliance(gear, offsets=reach, coast_flank=coast))
        for gear in (model.pair.pinion, model.pair.wheel)
    )


def on_elements(cache):
    return lambda model: None if model.scene.tooth_elasticity is None else gear_bodies(model, SilentProgress(), cache)


def judged(tally, measured, gears, compliances_of, examples, scenes=valid_scenes()):
    """Draw scenes, judge each, and tell the worst also where one fails."""

    @settings(max_examples=examples)
    @given(scenes)
    def every_scene(scene):
        tally.judge(scene, compliances_of)

    try:
        every_scene()
    finally:
        tally.tell(measured, gears)


@pytest.mark.parametrize("examples", [3, pytest.param(40, marks=pytest.mark.nightly)])
def test_every_step_of_any_scene_on_stand_in_teeth(measured, examples):
    """The contact laws and Newton's third law, from the equations."""
    judged(Tally(), measured, "stand-in teeth", on_stand_ins, examples)


@pytest.mark.parametrize(
    ("gears", "examples"),
    [("finite elements", 1), pytest.param("finite elements, by night", 150, marks=pytest.mark.nightly)],
)
def test_every_step_of_any_scene(measured, tmp_path, gears, examples):
    """As above, on finite elements."""
    judged(Tally(), measured, gears, on_elements(Cache(tmp_path)), examples)


@pytest.mark.parametrize("examples", [2, pytest.param(30, marks=pytest.mark.nightly)])
def test_every_step_of_any_frictionless_scene_without_load(measured, examples):
    """As above: with no load to measure by, round-off is no force that nothing balances."""
    scenes = valid_scenes(torques=st.just(0.0)).filter(lambda scene: scene.friction is None)
    judged(Tally(), measured, "stand-in teeth, no load, no friction", on_stand_ins, examples, scenes)
