"""Friction whose coefficient follows from a formula."""

import pytest
from tests.effects.examples import text_of

from fenics_gears import SceneError, model_of, scene_from_text
from fenics_gears.commands.work.scenes import checked_model
from fenics_gears.geometry.friction_formulas import schlenk

ELASTIC = text_of("tooth_elasticity")
SPEED = '[motion]\nmesh_frequency = "400 Hz"\n'
OIL = 'viscosity = "13 mPa s"\nroughness = "0.4 um"\n'


def with_friction(lines, motion=SPEED):
    """The paper's elastic teeth with a friction section."""
    head, _, rest = ELASTIC.partition("[motion]")
    rest = rest[rest.index("\n[") :] if "\n[" in rest else ""
    return scene_from_text(f"{head}{motion}{rest}\n[friction]\n{lines}")


def test_the_model_has_the_formula_s_coefficient():
    """Identity: of the scene's nominal force and speed."""
    model = model_of(with_friction(f'formula = "Schlenk"\n{OIL}'))
    force = model.scene.load.wheel_torque / model.pair.wheel.base_radius
    assert model.friction_coefficient == pytest.approx(
        schlenk(model.pair, force, 400.0 * 60.0 / 16, 13.0, 0.4), rel=1e-12
    )
    assert model.equations_of_motion.friction == model.friction_coefficient
    assert model_of(with_friction("coefficient = 0.07\n")).friction_coefficient == 0.07


FAST_AND_LIGHT = """
[gears]
module = "1 mm"
pressure_angle = "20 deg"
face_width = "7 mm"
material = "grey cast iron"
[gears.pinion]
teeth = 20
profile_shift = 0.1334
bore_diameter = "10 mm"
[gears.wheel]
teeth = 55
profile_shift = 0.0598
bore_diameter = "20 mm"
[load]
wheel_torque = "0.001 N m"
[motion]
mesh_frequency = "4000 Hz"
[friction]
formula = "Benedict and Kelley"
viscosity = "100 mPa s"
roughness = "0.8 um"
"""


def test_a_formula_outside_its_range_is_refused_by_name(tmp_path):
    """Benedict and Kelley's logarithm is negative where a full film carries; ISO/TR 13989-2 for Schlenk's slowest
    gears."""
    (tmp_path / "light.toml").write_text(FAST_AND_LIGHT)
    with pytest.raises(
        SceneError, match=r'light.toml:20: friction.formula = "Benedict and Kelley": .* than 1. Here that is 0\.'
    ):
        checked_model(tmp_path / "light.toml")
    (tmp_path / "slow.toml").write_text(FAST_AND_LIGHT.replace("Benedict and Kelley", "Schlenk").replace("4000", "100"))
    with pytest.raises(SceneError, match=r'slow.toml:20: .* = "Schlenk": .* from 1 to 50 m/s .* this pair has 0.3'):
        checked_model(tmp_path / "slow.toml")


@pytest.mark.parametrize(
    ("lines", "motion", "said"),
    [
        ("", SPEED, "friction.coefficient\n    is missing"),
        (f'coefficient = 0.1\nformula = "Schlenk"\n{OIL}', SPEED, "is given together with coefficient"),
        ('formula = "Schlenk"\nviscosity = "13 mPa s"\n', SPEED, "friction.roughness\n    is missing"),
        ('coefficient = 0.1\nroughness = "1 um"\n', SPEED, "is for a formula"),
        (f'formula = "Benedict and Kelley"\n{OIL}', "", "needs a speed"),
        (f'formula = "Coulomb"\n{OIL}', SPEED, '"Schlenk", "Benedict and Kelley"'),
        ('formula = "Schlenk"\nviscosity = "13 MPa"\nroughness = "1 um"\n', SPEED, "friction.viscosity"),
    ],
)
def test_what_is_missing_or_too_much_is_refused(lines, motion, said):
    """What, where, what is allowed."""
    with pytest.raises(SceneError) as refused:
        with_friction(lines, motion)
    assert said in str(refused.value)
