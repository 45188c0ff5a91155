"""The demonstration of a helical gear stage."""

from dataclasses import replace

import pytest
from demos.helical_gearbox import gearbox
from demos.helical_gearbox.picture import picture

from fenics_gears import load_scene, model_of, simulate
from fenics_gears.scene.data import Accuracy

SCENE = load_scene(gearbox.HERE / "gearbox.toml")


def test_sizes_are_those_of_its_page():
    """ISO 21771 and the demonstration's own words."""
    pair = model_of(SCENE).pair
    assert [pair.contact_ratio, pair.overlap_ratio] == pytest.approx([1.73, 1.33], abs=5e-3)
    assert pair.slope < 0.0


@pytest.mark.nightly
def test_crowning_takes_the_load_off_the_end():
    """The demonstration's own words, on coarse bodies."""
    coarse = replace(SCENE, accuracy=Accuracy(slices=12, layers=6, body_element_size=1.2, steps_per_mesh_cycle=10))
    results = {name: simulate(scene) for name, scene in gearbox.variants(coarse).items()}
    aligned, misaligned, crowned = (result.attrs["face_load_factor"] for result in results.values())
    assert aligned < crowned < misaligned
    rows = [gearbox.row(name, result) for name, result in results.items()]
    assert gearbox.table(rows).count("\n") == 4 and {row[5] for row in rows} == {"3577"}
    assert len(picture(results).axes) == 7
