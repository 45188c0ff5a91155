"""The demonstration of a misaligned spur pair."""

from dataclasses import replace

import pytest
from demos.misaligned_spur import misaligned
from demos.misaligned_spur.picture import picture

from fenics_gears import load_scene, simulate
from fenics_gears.geometry.misalignment import Misalignment
from fenics_gears.scene.data import Accuracy

SCENE = load_scene(misaligned.HERE / "misaligned.toml")


@pytest.mark.nightly
def test_crowning_pays_under_misalignment_alone():
    """The demonstration's own words, on coarse bodies."""
    coarse = replace(
        SCENE,
        accuracy=Accuracy(slices=8, layers=4, body_element_size=2.2, steps_per_mesh_cycle=20, flank_element_size=0.12),
    )
    factors, results = {}, {}
    for name, modifications in list(misaligned.flanks().items())[:2]:
        for amount in (0.0, 0.030):
            results[name, amount] = simulate(
                replace(coarse, misalignment=Misalignment(in_plane=amount), lead_modifications=modifications)
            )
            factors[name, amount] = float(misaligned.row(amount, name, results[name, amount])[2])
    assert (
        factors["true", 0.0] < factors["crowned 10 µm", 0.0] < factors["crowned 10 µm", 0.030] < factors["true", 0.030]
    )
    assert (
        misaligned.table([misaligned.row(amount, name, result) for (name, amount), result in results.items()]).count(
            "\n"
        )
        == 5
    )
    assert [len(axes.get_lines()) for axes in picture(results).axes] == [2, 2]
