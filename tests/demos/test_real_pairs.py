"""The demonstration of three real pairs."""

import numpy as np
import pytest
from demos.real_pairs import pairs

from fenics_gears import load_scene, lumped_gears, model_of

SCENES = [load_scene(pairs.HERE / f"{name}.toml") for name in pairs.SCENES]


def test_pairs_are_what_their_sources_say():
    """GEARpie's report on FZG type C; solid discs on the reference circles of the two others' programs."""
    fzg, *discs = SCENES
    pair = model_of(fzg).pair
    assert [pair.pinion.base_radius, pair.wheel.base_radius, pair.base_pitch] == pytest.approx(
        [33.829, 50.743, 13.285], abs=1e-3
    )
    assert pair.line_of_action_length == pytest.approx(34.93, abs=6e-3)
    for scene, density in zip(discs, (7.84e-6, 7.85e-6)):  # kg/mm^3
        pair = model_of(scene).pair
        for name, lumped in lumped_gears(scene, pair).items():
            gear = getattr(scene.gears, name)
            radius = 0.5 * scene.gears.module * gear.teeth
            mass = density * np.pi * radius**2 * scene.gears.face_width
            assert 1e3 * lumped.mass == pytest.approx(mass, rel=1e-3)
            assert 1e3 * lumped.moment_of_inertia == pytest.approx(0.5 * mass * radius**2, rel=5e-3)
