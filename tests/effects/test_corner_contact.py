"""`[corner_contact]`, from the scene to the operators; the method is tested in tests/contact."""

from dataclasses import replace

import pytest
from tests.coarse import COARSE, teeth_alone

from fenics_gears import GeometryError, SceneError, model_of, scene_from_text
from fenics_gears.effects.corner_contact import Edge, EdgeRadii
from fenics_gears.model.modification import corner
from fenics_gears.scene.data import Motion


@pytest.fixture(scope="module")
def scene(paper_scene):
    return replace(
        teeth_alone(paper_scene),
        friction=None,
        accuracy=replace(COARSE, contact_length=4.0, contact_nodes=35),
        motion=Motion(200.0, 1, 1),
    )


def test_each_gear_has_its_own_radius(paper_scene):
    """A gear's own radius before that of both, sharp where none is given."""
    text = paper_scene.text
    assert scene_from_text(text + "\n[corner_contact]\n").corner_contact.edge_radii == (0.0, 0.0)
    both = '\n[corner_contact]\nedge_radius = "0.1 mm"\n[corner_contact.wheel]\nedge_radius = "0.2 mm"\n'
    assert scene_from_text(text + both).corner_contact.edge_radii == pytest.approx((0.1, 0.2))


def test_edges_that_do_not_fit_are_refused(paper_scene, paper_pair):
    """A radius of more than half the tip's thickness leaves no tip."""
    with pytest.raises(GeometryError, match="corner_contact.edge_radius"):
        corner(replace(paper_scene, corner_contact=EdgeRadii(pinion=Edge(2.0))), paper_pair)
    text = paper_scene.text.replace("[accuracy]", '[corner_contact]\n[accuracy]\ncondensation = "every step"').replace(
        'condensation = "once"', ""
    )
    with pytest.raises(SceneError, match="has no contact of tips off the line of action"):
        scene_from_text(text)


def test_edges_that_leave_the_flanks_no_overlap_are_warned_of(paper_scene):
    """Exact: the path of contact is shorter by rb (v_tip - v_edge)."""
    gears = paper_scene.gears
    short = replace(
        gears, pinion=replace(gears.pinion, tip_diameter=80.4), wheel=replace(gears.wheel, tip_diameter=116.0)
    )
    sharp = replace(paper_scene, gears=short, corner_contact=EdgeRadii(0.0))
    assert not [said for said in model_of(sharp).warnings if "contact ratio" in said]
    rounded = replace(sharp, corner_contact=EdgeRadii(1.3))
    (said,) = [said for said in model_of(rounded).warnings if "contact ratio" in said]
    pair = model_of(sharp).pair
    taken = sum(
        gear.base_radius * (gear.tip_roll_angle - edge.flank_roll)
        for gear, edge in zip((pair.pinion, pair.wheel), corner(rounded, pair).edges)
    )
    assert f"{pair.contact_ratio - taken / pair.base_pitch:.3g}" in said
