"""The demonstration of three real pairs."""

from dataclasses import replace

import numpy as np
import pytest
from demos.real_pairs import pairs
from demos.real_pairs.picture import picture
from tests.coarse import COARSE

from fenics_gears import load_scene, simulate
from fenics_gears.model.drivetrain import lumped_gears
from fenics_gears.model.model import model_of

SCENES = [load_scene(pairs.HERE / f"{name}.toml") for name in pairs.SCENES]


def test_pairs_are_what_their_sources_say():
    """Authority: the sources that the scenes name. Contact ratio 1.64 of NASA's gears at 88.9 mm; base radii 28.34 and 71.6 mm of the third pair."""
    _, nasa, reduction = SCENES
    assert model_of(replace(nasa, gears=replace(nasa.gears, centre_distance=88.901))).pair.contact_ratio == pytest.approx(1.64, abs=5e-3)
    model = model_of(reduction).pair
    assert [model.pinion.base_radius, model.wheel.base_radius] == pytest.approx([28.34, 71.60], abs=6e-3)


def test_no_two_gears_of_unequal_teeth_have_one_inertia():
    """Authority: the demonstration's own words."""
    for scene in SCENES:
        pinion, wheel = lumped_gears(scene, model_of(scene).pair).values()
        alike = scene.gears.pinion.teeth == scene.gears.wheel.teeth
        assert (pinion == wheel) == alike
        assert model_of(scene).warnings == []


def test_at_a_crawl_a_real_pair_is_quasi_static():
    """Limit: at a hundredth of the lowest natural frequency inertia changes the transmission error's height by less than 1 % of it."""
    scene = replace(SCENES[2], accuracy=replace(COARSE, contact_length=1.0))
    slow = replace(scene, motion=replace(scene.motion, mesh_frequency=0.01 * model_of(scene).vibrations[0].frequency, mesh_cycles=2, recorded_cycles=1))
    heights = [simulate(each).attrs["peak_to_peak_transmission_error"] for each in (slow, replace(slow, inertia=None, damping=None))]
    assert heights[0] == pytest.approx(heights[1], rel=0.01)


def test_table_and_picture_have_every_pair(monkeypatch):
    """Authority: what they are made from; a row and a column for each pair, two curves of the transmission error."""
    coarse = replace(SCENES[2], accuracy=replace(COARSE, contact_length=1.0), motion=replace(SCENES[2].motion, mesh_cycles=3))
    monkeypatch.setattr("fenics_gears.load_scene", lambda path: coarse)
    found = pairs.measured(pairs.HERE)
    assert len(found.row) == len(pairs.COLUMNS) and found.row[2:4] == ("437", "8360")
    assert pairs.table([found.row]).count("\n") == 2
    axes = picture([found, found]).axes
    assert len(axes) == 4 and len(axes[0].get_lines()) == 2
    assert np.isfinite(axes[0].get_lines()[1].get_ydata()).all()
