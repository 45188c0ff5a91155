"""The demonstration of an overhung pinion, on coarse teeth."""

import re

import pytest
from demos.overhung_pinion import corrected
from demos.overhung_pinion.picture import picture

ACCURACY = """[accuracy]
steps_per_mesh_cycle = 10
slices = 8
layers = 4
contact_nodes = 11
contact_length = "2.4 mm"
flank_element_size = "0.3 mm"
"""


@pytest.mark.nightly
def test_the_proposal_is_for_one_torque_and_the_search_for_all(tmp_path, monkeypatch):
    """The README's own words."""
    monkeypatch.setattr("fenics_gears.extensions.optimization.optimize.VALUES", 2)
    monkeypatch.setattr("fenics_gears.extensions.optimization.optimize.TORQUES", (1.0,))
    scene, design = ((corrected.HERE / name).read_text() for name in ("input_shaft.toml", "design.toml"))
    (tmp_path / "input_shaft.toml").write_text(scene[: scene.index("[accuracy]")] + ACCURACY)
    design = re.sub("evaluations = .*", "evaluations = 16", re.sub("samples = .*", "samples = 4", design))
    (tmp_path / "design.toml").write_text(design)
    flanks, inclination = corrected.compared(tmp_path / "input_shaft.toml", tmp_path / "design.toml", tmp_path)
    assert 15.0 < inclination < 30.0
    true, proposed, best = flanks.values()
    assert proposed.factors[-1] < 1.1 and true.factors[-1] > 1.5
    assert proposed.factors[0] > 1.5
    assert best.nine_of_ten < 0.85 * min(true.nine_of_ten, proposed.nine_of_ten)
    assert proposed.errors[-1] < true.errors[-1]
    assert corrected.table(flanks).count("\n") == 4
    assert [len(axes.get_lines()) for axes in picture(flanks).axes] == [3, 3, 3, 3]
