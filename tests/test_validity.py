"""Results that leave the model's assumptions behind say so."""

from dataclasses import replace

import pytest

from fenics_gears.scene.data import Accuracy, Motion
from fenics_gears.simulation import simulate

COARSE = Accuracy(element="P1", flank_element_size=0.12, contact_length=3.0, contact_nodes=26, steps_per_mesh_cycle=40)


@pytest.fixture(scope="module")
def coarse(paper_scene):
    return replace(paper_scene, friction=None, accuracy=COARSE, motion=Motion(200.0, 6, 2))


def test_an_ordinary_run_has_nothing_to_say(coarse):
    """The paper's damped pair stays in contact and within the window."""
    assert simulate(coarse).attrs["warnings"] == ""


def test_contact_at_the_end_of_the_window_is_named(coarse):
    """A window shorter than the contact is wide cuts pressure off."""
    short = replace(COARSE, contact_length=0.2, contact_nodes=5, flank_element_size=0.1)
    warnings = simulate(replace(coarse, accuracy=short)).attrs["warnings"]
    assert "contact_length" in warnings and "end of the contact window" in warnings
    assert "in 81 of 81 stored steps" in warnings


def test_contact_that_is_not_resolved_is_named(coarse):
    """Elements and contact nodes coarser than the Hertz half-width, or contact nodes closer than the elements' own."""
    few = simulate(replace(coarse, accuracy=replace(COARSE, contact_nodes=4)))
    assert "spacing of accuracy.contact_nodes is 1 mm, more than the Hertz half-width" in few.attrs["warnings"]
    many = simulate(replace(coarse, accuracy=replace(COARSE, contact_nodes=51)))
    assert "the pressure oscillates" in many.attrs["warnings"]


def test_large_rotations_are_named(coarse):
    """A shaft soft enough to turn by radians is outside of small rotations."""
    soft = replace(coarse, shafts=replace(coarse.shafts, torsional_stiffness=1e5), inertia=None, damping=None)
    assert "turns by" in simulate(soft).attrs["warnings"]


def test_separation_beyond_the_backlash_is_named(coarse):
    """Claim 10: undamped at its resonance the pair loses contact globally, which without coast flanks has no meaning."""
    undamped = replace(coarse, damping=None, motion=Motion(213.0, 60, 20))
    warnings = simulate(undamped).attrs["warnings"]
    assert "more than the backlash" in warnings and "no meaning" in warnings


def test_a_march_that_fails_at_its_start_leaves_an_empty_incomplete_result(coarse, monkeypatch):
    """Failure is part of the interface: a typed error that carries what was done, here nothing."""
    from fenics_gears.contact.errors import ContactNotConverged
    from fenics_gears.dynamics.march import Marcher

    def fail(self):
        raise ContactNotConverged([], "for the test")

    monkeypatch.setattr(Marcher, "start", fail)
    with pytest.raises(ContactNotConverged, match="for the test") as failure:
        simulate(coarse)
    assert failure.value.partial.sizes["time"] == 0
    assert failure.value.partial.attrs["complete"] == 0
