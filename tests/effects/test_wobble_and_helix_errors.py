"""Wobble and helix deviations in a scene."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import COARSE, coarse_scene, frictionless, teeth_alone
from tests.effects.examples import text_of

from fenics_gears import Load, SceneError, scene_from_text, simulate
from fenics_gears.effects import result_variables
from fenics_gears.effects.flank_errors_sections import FlankErrors, GearErrors
from fenics_gears.effects.misalignment import Misalignment
from fenics_gears.scene.data import Motion

FACE = '[misalignment]\nin_plane = "0 um"\n'
ELASTIC = text_of("tooth_elasticity")
WOBBLE = '[eccentricity.wheel]\nwobble = "10 um"\nwobble_phase = "90 deg"\n'
FIVE = '"5 um"'
HELIX = f"[flank_errors.pinion]\nhelix_slope = [{', '.join([FIVE] * 16)}]\n"
CLASS = "[flank_errors]\ntolerance_class = 6\n"


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (
            WOBBLE,
            (
                'eccentricity.wheel.wobble = "10 um"\n    is of three-dimensional scenes: allowed beside'
                " gears.helix_angle, [lead_modifications], [misalignment], bearings.places,"
                " shafts.input.sections or shafts.output.sections."
            ),
        ),
        (HELIX, "flank_errors.pinion.helix_slope = a list\n    is of three-dimensional scenes"),
        (
            FACE + '[eccentricity.wheel]\nwobble_phase = "90 deg"\n',
            'eccentricity.wheel.distance\n    is missing. Allowed: such as "10 um"; or a wobble',
        ),
        (FACE + '[eccentricity.wheel]\nwobble = "1 mm"\n', "is too large an error of manufacture"),
        (FACE + HELIX.replace("5 um", "1 mm"), "is too large an error of manufacture"),
        (FACE + HELIX.replace(', "5 um"', "", 1), "has 15 values, but the pinion has 16 teeth"),
    ],
)
def test_what_needs_a_face_or_does_not_fit_it_is_refused(lines, said):
    """House rule 7."""
    with pytest.raises(SceneError) as refused:
        scene_from_text(ELASTIC + lines)
    assert said in str(refused.value)


def test_a_class_is_for_face_widths_of_the_standard():
    """ISO 1328-1:2013: face widths from 4 mm to 1.2 m; a plane scene draws nothing along the face."""
    narrow = ELASTIC.replace('face_width = "15 mm"', 'face_width = "3 mm"')
    scene_from_text(narrow + CLASS)
    with pytest.raises(SceneError, match="face widths from 4 mm to 1200 mm"):
        scene_from_text(narrow + CLASS + FACE)


def test_a_table_with_helix_deviations_is_of_a_scene_with_a_face(tmp_path, monkeypatch):
    """House rule 7."""
    from fenics_gears.model.model import model_of

    (tmp_path / "pinion.csv").write_text(
        "tooth, helix_form (um)\n" + "".join(f"{tooth}, 3\n" for tooth in range(1, 17))
    )
    table = f'[flank_errors.pinion]\nfile = "{tmp_path}/pinion.csv"\n'
    assert model_of(scene_from_text(ELASTIC + FACE + table)).scene.flank_errors.pinion.helix_form == pytest.approx(
        (0.003,) * 16
    )
    with pytest.raises(SceneError, match="the column helix_form is of three-dimensional scenes"):
        model_of(scene_from_text(ELASTIC + table))


def test_constant_helix_slope_is_a_misalignment(paper_scene):
    """Identity: linear along the face, the mean zero."""
    scene = frictionless(teeth_alone(coarse_scene(paper_scene, cycles=1)))
    accuracy = replace(COARSE, steps_per_mesh_cycle=5, contact_nodes=14, slices=4, layers=2, body_element_size=2.5)
    scene = replace(scene, accuracy=accuracy, load=Load(0.3 * scene.load.wheel_torque), motion=Motion(200.0, 1, 1))
    errors = FlankErrors(pinion=GearErrors(helix_slope=(0.008,) * 16))
    by_errors = simulate(replace(scene, flank_errors=errors, misalignment=Misalignment()))
    by_axes = simulate(replace(scene, misalignment=Misalignment(in_plane=-0.008)))
    assert float(np.ptp(by_axes.line_load.isel(contact_time=0).values.max(axis=0))) > 50.0
    assert by_errors.line_load.values == pytest.approx(by_axes.line_load.values, abs=1e-6)
    assert by_errors.transmission_error.values == pytest.approx(by_axes.transmission_error.values, rel=1e-9)
    assert set(by_errors.data_vars) == {
        each.name for each in result_variables(replace(scene, flank_errors=errors, misalignment=Misalignment()))
    }
    assert (
        by_errors.pinion_helix_slope.values == pytest.approx(np.full(16, 0.008))
        and not by_errors.wheel_helix_form.values.any()
    )
