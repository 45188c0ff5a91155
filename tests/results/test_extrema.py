"""Extrema between steps."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, quasi_static, teeth_alone
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears import model_of, simulate
from fenics_gears.contact.mesh import elastic_mesh
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.spring_mesh import PairSprings, spring_mesh
from fenics_gears.contact.tooth_pair import DRIVE
from fenics_gears.dynamics.batch import Batch
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.marched import BetweenSteps
from fenics_gears.results import extrema
from fenics_gears.results.crests import MOST_SOLVED, Searches
from fenics_gears.results.numbers import SOLVED, largest_of_cubics
from fenics_gears.scene.data import ISO_6336, Accuracy
from fenics_gears.simulation.elastic_route import mesh_cycle

CREST = 7.3137
CURVES = {
    "smooth crest": lambda x: np.cos(0.35 * (x - CREST)),
    "corner of straight lines": lambda x: np.where(x < CREST, 0.8, -0.05) * (x - CREST),
    "corner of curves": lambda x: np.where(
        x < CREST, 0.4 * (x - CREST) + 0.05 * (x - CREST) ** 2, np.exp(0.1 * (CREST - x)) - 1.0
    ),
    "jump down": lambda x: 0.1 * (x - CREST) - 1.0 * (x > CREST),
    "jump up": lambda x: 0.1 * (CREST - x) - 1.0 * (x < CREST),
}


def located(steps, values, value, sought):
    """Place and largest value by a search, to which `value` gives what it asks for."""
    search = Searches(steps, np.array([values]), np.array([sought]), 0.125)
    while not np.isnan(search.asked[0]):
        search.take([value(float(search.asked[0]))])
    return tuple(search.tops[0].tolist())


@pytest.mark.parametrize("name", CURVES)
def test_the_highest_place_of_a_curve_between_its_steps(name):
    """Exact: at 7.3137 by construction; a jump is found within an eighth of a step. Places are eighths of a step,
    none asked for twice."""
    curve, steps, asked = CURVES[name], np.arange(16.0), []

    def value(place):
        asked.append(place)
        return float(curve(place))

    sought = 1e-4 * np.ptp(curve(steps))
    place, found = located(steps, curve(steps), value, sought)
    top = float(curve(np.array(CREST)))
    jumps = name.startswith("jump")
    least = curve(np.array([CREST - 0.125, CREST + 0.125])).max() if jumps else top - 2.0 * sought
    assert least <= found <= top + (1e-12 if "straight" in name or jumps else sought)
    assert abs(place - CREST) < (0.125 if jumps else 0.01) and len(asked) <= MOST_SOLVED
    assert top - curve(steps).max() > 20.0 * sought
    assert all(8.0 * place % 1.0 == 0.0 for place in asked) and len(set(asked)) == len(asked) <= 7
    # The cubic is known to hold with the first value between steps.
    assert len(asked) == 1 or name != "smooth crest"


def test_the_crest_of_a_cubic():
    """Exact: -(x - 3.3)^2 (x + 9) + 5."""
    steps = np.arange(8)
    place, found = largest_of_cubics(steps, 5.0 - (steps - 3.3) ** 2 * (steps + 9.0))
    assert place == pytest.approx(3.3, abs=1e-12) and found == pytest.approx(5.0, abs=1e-12)


def test_a_curve_that_is_level_at_its_top_is_not_searched():
    """Exact: one pair bears the whole load."""
    steps = np.arange(16.0)
    force = np.minimum(np.abs(steps - 7.5) / 4.0 + 0.3, 1.0)[::-1]

    def value(place):
        raise AssertionError(place)

    assert located(steps, force, value, 1e-4) == (0.0, 1.0)


def on_stand_ins(scene, flanks, steps):
    scene = replace(scene, accuracy=replace(scene.accuracy, steps_per_mesh_cycle=steps))
    model = model_of(scene)
    grid, tangential = model.resolution.contact_grid, scene.friction is not None
    return simulate(
        scene,
        preparation=lambda *_: (
            (),
            Cycle(elastic_mesh(flanks, grid), steps, model.drivetrain.indices, tangential=tangential),
        ),
    )


@pytest.mark.parametrize("friction", [False, True], ids=["frictionless", "with friction"])
def test_peak_to_peak_does_not_depend_on_the_steps(paper_scene, stand_in_flanks, friction):
    """Brute force: 25 and 320 steps a mesh cycle within 0.05 %; no sample is outside."""
    scene = quasi_static(coarse_scene(paper_scene, cycles=1))
    scene = scene if friction else frictionless(scene)
    few, many = (on_stand_ins(scene, stand_in_flanks, steps) for steps in (25, 320))
    for name in ("peak_to_peak_transmission_error", "largest_pair_force"):
        assert few.attrs[name] == pytest.approx(many.attrs[name], rel=5e-4)
    samples = many.transmission_error.values
    missed = many.attrs["peak_to_peak_transmission_error"] - np.ptp(samples)
    assert 0.0 <= missed < np.abs(np.diff(samples)).max()
    assert np.ptp(few.transmission_error.values) < 0.995 * many.attrs["peak_to_peak_transmission_error"]
    assert few.attrs["peak_to_peak_transmission_error_from"] == SOLVED
    for name, place in (("largest", samples.argmax()), ("least", samples.argmin())):
        assert many.attrs[f"{name}_transmission_error_mesh_phase"] == pytest.approx(place / 320, abs=1.0 / 320)


def test_over_a_face_extremes_are_sought_to_a_tenth_of_what_is_promised(monkeypatch):
    """Brute force: the same run that seeks them to 0.2 % of the span. What is promised of the peak-to-peak value is
    0.2 % of the mean, of either extreme a tenth is missed at most; and positions are saved."""
    accuracy = "slices = 20\ncontact_nodes = 41\nsteps_per_mesh_cycle = 50"
    scene = helical_scene(helix=28.0, width=60.0, accuracy=accuracy)
    model = model_of(scene)
    asked = []
    between = Batch.between

    def counted(batch, places, lasts):
        asked.append(places)
        return between(batch, places, lasts)

    monkeypatch.setattr(Batch, "between", counted)

    def attributes():
        asked.clear()
        found = simulate(model, preparation=lambda *_: ((), mesh_cycle(model, on_stand_in_bodies(model)))).attrs
        return found, sum(map(len, asked))

    near, few = attributes()
    monkeypatch.setattr(extrema, "LEAST_SOUGHT_OVER_FACE", 0.0)
    nearest, many = attributes()
    assert few < many
    apart = [abs(near[name] - nearest[name]) for name in ("peak_to_peak_transmission_error", "largest_pair_force")]
    assert apart[0] < 2 * 2e-4 * near["mean_transmission_error"]
    assert apart[1] < 2e-4 * near["largest_pair_force"]


def test_springs_in_closed_form(paper_scene):
    """Exact: k (1 + 0.3 cos) on rigid shafts: T_EPP is F/k (1/0.7 - 1/1.3) at phases 0.637 and 0.137."""
    scene = teeth_alone(frictionless(coarse_scene(paper_scene, cycles=2)))
    scene = replace(scene, accuracy=Accuracy(model=ISO_6336, steps_per_mesh_cycle=20))
    model, stiffness = model_of(scene), 2e5

    def springs(phase):
        return [
            PairSprings(
                0,
                DRIVE,
                np.zeros(1),
                np.zeros(1),
                np.array([stiffness * (1.0 + 0.3 * np.cos(2.0 * np.pi * (phase - 0.137)))]),
            )
        ]

    cycle = Cycle(
        spring_mesh(model.pair, springs, 1, coast_flanks=False), 20, model.drivetrain.indices, tangential=False
    )
    attributes = simulate(scene, preparation=lambda *_: ((), cycle)).attrs
    radius = model.pair.wheel.base_radius
    exact = scene.load.wheel_torque / radius / stiffness * (1.0 / 0.7 - 1.0 / 1.3) / radius
    assert attributes["peak_to_peak_transmission_error"] == pytest.approx(exact, rel=1e-5)
    assert attributes["largest_transmission_error_mesh_phase"] % 1.0 == pytest.approx(0.637, abs=2e-3)
    assert attributes["least_transmission_error_mesh_phase"] % 1.0 == pytest.approx(0.137, abs=2e-3)


def test_a_step_solved_again_is_that_of_the_march(paper_scene, stand_in_flanks):
    """Identity: at the next step the march's position and forces, with friction turning at the pitch point."""
    scene = quasi_static(coarse_scene(paper_scene, cycles=2))
    model, records = model_of(scene), []
    cycle = Cycle(
        elastic_mesh(stand_in_flanks, model.resolution.contact_grid), 40, model.drivetrain.indices, tangential=True
    )
    Marcher(cycle, model.equations_of_motion).run(80, 1, observe=lambda steps, _: records.extend(steps.records))

    def marched(record):
        return np.allclose(record.state.position, records[record.step].state.position, rtol=1e-9, atol=1e-12)

    between = BetweenSteps(Batch(cycle, [model.equations_of_motion]), marched)
    for step in range(1, 81):
        again = between.at([(0, float(step))])[0, step]
        np.testing.assert_allclose(again.state.position, records[step].state.position, rtol=1e-8, atol=1e-12)
        np.testing.assert_allclose(
            again.solution.forces, records[step].solution.forces, atol=1e-6 * records[step].solution.forces.max()
        )
