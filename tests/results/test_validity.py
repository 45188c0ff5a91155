"""Results that leave the model's assumptions behind say so."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import COARSE

from fenics_gears import model_of, simulate, simulate_train
from fenics_gears.dynamics.torque_ripple import Harmonic, TorqueRipple
from fenics_gears.effects.corner_contact import EdgeRadii
from fenics_gears.effects.tip_relief import TipRelief
from fenics_gears.geometry.relief import LINEAR, PARABOLIC, Relief
from fenics_gears.results.mesh_of_train import mesh_run
from fenics_gears.results.pressure_limits import yielding
from fenics_gears.results.summary import summary_rows
from fenics_gears.scene.data import Material, Motion
from fenics_gears.scene.train import train_from_text
from fenics_gears.system.progress import SilentProgress


@pytest.fixture(scope="module")
def coarse(paper_scene):
    return replace(paper_scene, friction=None, accuracy=COARSE, motion=Motion(200.0, 6, 2))


def test_an_ordinary_run_has_nothing_to_say_but_of_its_sharp_tips(coarse):
    """The paper's damped pair; unrelieved, its tips carry on their edges."""
    result = simulate(coarse)
    # Coarse elements are said to be coarse.
    (said,) = [line for line in result.attrs["warnings"].splitlines() if "half the Hertz" not in line]
    assert said.startswith("contact reaches the sharp edge of the pinion's and the wheel's tip")
    assert result.attrs["contact_loss_count"] == 0 and "contact_loss_first" not in result.attrs


@pytest.mark.parametrize(
    ("effects", "said", "unsaid"),
    [
        ({}, ["[tip_relief] takes", "[corner_contact] with"], ["deeper", "parabolic"]),
        (
            {"tip_relief": TipRelief(Relief(0.002, None), Relief(0.002, None))},
            ["deeper or longer", "parabolic", "[corner_contact] with"],
            ["[tip_relief] takes"],
        ),
        (
            {"tip_relief": TipRelief(Relief(0.002, None), None)},
            ["[tip_relief.wheel] takes"],
            ["[tip_relief] takes", "[tip_relief.pinion]"],
        ),
        (
            {"tip_relief": TipRelief(*[Relief(0.002, shape=PARABOLIC)] * 2), "corner_contact": EdgeRadii(0.0)},
            ["deeper", "[corner_contact] with"],
            ["shape"],
        ),
    ],
)
def test_what_takes_the_load_off_a_sharp_edge_is_what_the_scene_lacks(coarse, effects, said, unsaid):
    """Advice to switch on what is on helps nobody."""
    scene = replace(coarse, motion=Motion(200.0, 1, 1), inertia=None, damping=None, **effects)
    (warning,) = [each for each in simulate(scene).attrs["warnings"].splitlines() if "sharp edge" in each]
    assert all(words in warning for words in said) and not any(words in warning for words in unsaid)


def test_stresses_above_the_yield_strength_are_named(coarse):
    """Brute force: Hertz's stresses (Johnson, Contact Mechanics, 1985, eq. 4.45) with Tresca's criterion."""
    depth = np.linspace(0.0, 3.0, 30001)
    root = np.sqrt(1.0 + depth**2)
    largest_shear = 0.5 * np.abs(-((1.0 + 2.0 * depth**2) / root - 2.0 * depth) + 1.0 / root).max()
    limit = 0.5 / largest_shear * 650.0
    scene = replace(coarse, gears=replace(coarse.gears, material=Material(206e3, 0.3, 650.0)))

    def said(pressure, root_stress=0.0):
        return yielding(scene, {"peak_contact_pressure": pressure, "largest_root_stress_wheel": root_stress})

    assert not said(0.997 * limit, 649.0) and not yielding(coarse, {"peak_contact_pressure": 1e4})
    assert [line.split(",")[0] for line in said(1.003 * limit)] == ["the peak contact pressure"] * 2
    (line,) = said(0.0, 651.0)
    assert "root stress of the wheel, 651 MPa, is above its yield strength of 650 MPa" in line


@pytest.mark.parametrize(("shape", "kinked"), [(LINEAR, True), (PARABOLIC, False)])
def test_the_kink_of_linear_relief_is_named_where_it_presses_hardest(coarse, shape, kinked):
    """Johnson, Contact Mechanics, 5.2: infinite pressure at a kink; a parabola has none. The printed number is the
    warning's."""
    relief = Relief(0.06, shape=shape)
    scene = replace(
        coarse, motion=Motion(200.0, 1, 1), inertia=None, damping=None, tip_relief=TipRelief(relief, relief)
    )
    result = simulate(scene)
    found = [
        said
        for said in result.attrs["warnings"].splitlines()
        if "near the kink where the linear tip relief of the pinion or the wheel starts" in said
    ]
    assert len(found) == kinked
    printed = {label: value for label, value, _ in summary_rows(result)}
    assert ("pressure at kinks of relief" in printed) == kinked
    if kinked:
        assert printed["pressure at kinks of relief"].split(" MPa")[0] in found[0]
        assert printed["peak contact pressure, without kinks of relief"].split(" MPa")[0] in found[0]


def test_contact_at_the_end_of_the_window_is_named(coarse):
    """A window shorter than the contact is wide."""
    short = replace(COARSE, contact_length=0.2, contact_nodes=5, flank_element_size=0.1)
    result = simulate(replace(coarse, accuracy=short))
    warnings, steps = result.attrs["warnings"], result.sizes["time"]
    assert "contact_length" in warnings and "end of the contact window" in warnings
    assert f"in {steps} of {steps} steps" in warnings


def test_contact_that_is_not_resolved_is_named(coarse):
    """Coarser than the Hertz half-width, or contact nodes closer than the elements."""
    few = simulate(replace(coarse, accuracy=replace(COARSE, contact_nodes=4)))
    assert "spacing of accuracy.contact_nodes is 1 mm, more than the Hertz half-width" in few.attrs["warnings"]
    light = replace(coarse, load=replace(coarse.load, wheel_torque=0.1), accuracy=replace(COARSE, contact_nodes=4))
    assert "contact_nodes and contact_length of the default" in "".join(model_of(light).warnings)
    many = simulate(replace(coarse, accuracy=replace(COARSE, contact_nodes=51)))
    assert "the pressure oscillates" in many.attrs["warnings"]


def test_an_incomplete_run_says_why(coarse):
    """docs/result.md."""

    class Interrupting(SilentProgress):
        def update(self, done, total, note=""):
            raise KeyboardInterrupt

    result = simulate(coarse, progress=Interrupting())
    assert (result.attrs["complete"], result.attrs["stopped"]) == (0, "interrupted")


def test_separation_beyond_the_backlash_is_named(coarse, paper_pair):
    """Claim 10: undamped at its resonance the pair loses contact globally."""
    undamped = replace(coarse, damping=None, motion=Motion(213.0, 40, 40))
    result = simulate(undamped)
    (said,) = [line for line in result.attrs["warnings"].splitlines() if "lose contact" in line]
    assert "more than the backlash" in said and "no meaning from that time on; add [coast_flanks]" in said
    # The same from the forces: where no flank touches the mesh carries nothing.
    lost = result.normal_force.values[1:] == 0.0
    assert result.attrs["contact_loss_share"] == pytest.approx(lost.mean(), rel=1e-12)
    starts = np.flatnonzero(lost & ~np.concatenate(([False], lost[:-1])))
    assert result.attrs["contact_loss_count"] == len(starts)
    assert result.attrs["contact_loss_first"] == pytest.approx(result.time.values[1 + starts[0]], rel=1e-12)
    ends = np.flatnonzero(lost & ~np.concatenate((lost[1:], [False]))) + 1
    assert result.attrs["contact_loss_longest"] == pytest.approx(
        (ends - starts).max() * float(np.diff(result.time.values[:2])[0]), rel=1e-9
    )
    assert result.attrs["contact_loss_opening"] > paper_pair.backlash
    assert f"first at {result.attrs['contact_loss_first']:.4g} s" in said


@pytest.mark.parametrize("ripple", [None, TorqueRipple((Harmonic(1.0, 20e3),))], ids=["steady", "varying load"])
def test_a_march_that_fails_at_its_start_leaves_an_empty_incomplete_result(coarse, ripple, monkeypatch):
    """A typed error that carries what was done, here nothing."""
    from fenics_gears.contact.errors import ContactNotConverged
    from fenics_gears.dynamics.stepping import Stepper

    def fail(*_):
        raise ContactNotConverged([], "for the test")

    monkeypatch.setattr(Stepper, "started", fail)
    with pytest.raises(ContactNotConverged, match="for the test") as failure:
        simulate(replace(coarse, torque_ripple=ripple))
    assert failure.value.partial.sizes["time"] == 0
    assert failure.value.partial.attrs["complete"] == 0


OVERLOADED_SET = """
title = "Overloaded set"
[stages.e]
kind = "planetary"
module = "3 mm"
pressure_angle = "20 deg"
face_width = "20 mm"
planets = 5
sun = { teeth = 20, profile_shift = 0, bore_diameter = "20 mm" }
planet = { teeth = 20, profile_shift = 0, bore_diameter = "30 mm" }
ring = { teeth = 60, profile_shift = 0, outer_diameter = "215 mm", cutter = { teeth = 23 }, support = "held" }
material = { youngs_modulus = "206 GPa", poissons_ratio = 0.3, yield_strength = "300 MPa" }
fixed = "ring"
input = "sun"
output = "carrier"
[load]
input_torque = "900 N m"
[accuracy]
steps_per_mesh_cycle = 30
flank_element_size = "0.2 mm"
"""


def test_meshes_computed_together_tell_sharp_edges_and_yielding_once():
    """An identity: five equal planets of a rigid frame carry alike, so each sentence names all five meshes, and each
    mesh as a pair has it."""
    train = train_from_text(OVERLOADED_SET)
    found = simulate_train(train)
    said = found.attrs["warnings"].splitlines()
    suns = "; ".join(f"e: sun, planet {number}" for number in range(1, 6))
    for words in ("contact reaches the sharp edge of the sun's", "above what the sun's material bears"):
        (only,) = [line for line in said if words in line]
        assert only.startswith(f"{suns}: ")
        own = [mesh_run(found, train, number).attrs["warnings"] for number in range(len(train.meshes))]
        assert sum(words in each for each in own) == 5
