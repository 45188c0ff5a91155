"""The rating's formulas against numbers that other programs print."""

from dataclasses import replace
from math import hypot, radians, sqrt

import pytest
from tests.geometry.test_published_pairs import cited

from fenics_gears import gear_pair
from fenics_gears.extensions.rating.finish import Finish
from fenics_gears.extensions.rating.flank import elasticity_factor, flank_stress, single_pair_factors, zone_factor
from fenics_gears.extensions.rating.load_factors import (
    LoadFactors,
    contact_ratio_factor,
    load_factors,
    mesh_misalignment,
)
from fenics_gears.extensions.rating.operation import Operation, solid_reduced_mass
from fenics_gears.extensions.rating.root import form_at_outer_point, helix_angle_factor, root_stresses
from fenics_gears.scene.data import GearData, GearPairData, Material

STEEL = Material(206e3, 0.3)


def operation(data, pinion_torque, speed, tip_relief=0.0):
    pair = gear_pair(data)
    return Operation(pair, (STEEL, STEEL), pinion_torque, speed, tip_relief, solid_reduced_mass(pair), data)


@pytest.fixture
def example():
    return operation(cited("iso_tr_6336_30"), 9e6, 360.0, 70.0)


def test_the_standard_s_example(example):
    """KISSsoft's numbers, as a public implementation (class KSISO_6336, example_01) prints them."""
    assert example.tangential_force == pytest.approx(127352.0, abs=0.5)
    assert (zone_factor(example), elasticity_factor(example)) == pytest.approx((2.39533, 189.81170), abs=5e-6)
    assert contact_ratio_factor(example) == pytest.approx(0.803, abs=5e-4) and single_pair_factors(example) == (
        1.0,
        1.0,
    )
    finish = Finish(viscosity_grade=320.0, flank_roughness=6.0, tolerance_class=5)
    example = replace(example, finish=finish)
    flank = flank_stress(example, LoadFactors(1.003, 1.16, 1.128, 1.0, 1.0))
    assert flank.nominal == pytest.approx(1206.58207, abs=5e-4)
    # K_v is printed to three digits.
    assert flank.stress == pytest.approx((1301.35343, 1301.35343), rel=3e-4)
    assert flank.limit / finish.flank_limit == pytest.approx(1.04739 * 0.96911 * 0.96599, rel=2e-5)
    assert load_factors(example).dynamic == pytest.approx(1.003, abs=2e-3)


FZG_C = (
    GearPairData(
        4.5,
        radians(20.0),
        91.501,
        14.0,
        GearData(16, 0.1817, 82.636, 62.386, 30.0, 0.375),
        GearData(24, 0.1715, 118.544, 98.294, 30.0, 0.375),
        STEEL,
    ),
    {"Z_H": 2.342, "Z_eps": 0.920, "Y_F": (1.689, 1.583), "Y_S": (1.851, 1.917), "Y_beta": 1.0},
)
H501 = (
    cited("fzg_h501"),
    {"Z_H": 2.335, "Z_eps": 0.871, "Y_F": (1.479, 1.490), "Y_S": (2.047, 2.036), "Y_beta": 0.932},
)


@pytest.mark.parametrize(("data", "printed"), [FZG_C, H501])
def test_factors_of_another_program(data, printed):
    """GEARpie's reports of the FZG gears C14 and H501 (DIN 3990), to the printed digits."""
    found = operation(data, 200e3, 1500.0)
    assert (zone_factor(found), contact_ratio_factor(found), helix_angle_factor(found)) == pytest.approx(
        (printed["Z_H"], printed["Z_eps"], printed["Y_beta"]), abs=1.1e-3
    )
    for number, gear in enumerate((found.pair.pinion, found.pair.wheel)):
        tooth = form_at_outer_point(gear, found.pair.contact_ratio)
        assert (tooth.form, tooth.stress_correction) == pytest.approx(
            (printed["Y_F"][number], printed["Y_S"][number]), abs=1.1e-3
        )


def test_root_stress_of_another_program():
    """GEARpie's report of the FZG gear C14 at 200 N m, of F_t at the pitch circle, 5464.5 N in place of 5555.6."""
    found = operation(FZG_C[0], 200e3, 1500.0)
    roots = root_stresses(found, LoadFactors(1.0, 1.0, 1.0, 1.0, 1.0))
    assert [each.nominal * 5464.5 / found.tangential_force for each in roots] == pytest.approx(
        [271.19, 263.17], rel=1e-3
    )
    assert all(each.stress == each.nominal for each in roots)


def test_face_load_factor_counts_the_scene_s_misalignment():
    """ISO 6336-1:2006 section 7.6, by hand: flanks run in by 15 %, at most 6 um; F_betay c_gamma_beta b / (2 F_m) is
    added to 1, or from 1 on is twice its root. Without misalignment by the helix slopes of ISO 1328-1."""
    data, _ = H501
    found = replace(operation(data, 200e3, 1000.0), misalignment=-20.0)
    factors = load_factors(found)
    stiffness, line_load = 0.85 * found.mesh_stiffness, factors.dynamic * found.tangential_force / 23.0
    assert factors.face == pytest.approx(1.0 + 0.5 * 17.0 * stiffness / line_load)
    large = load_factors(replace(found, misalignment=60.0))
    assert large.face == pytest.approx(2.0 * sqrt(0.5 * 54.0 * stiffness / line_load))
    slopes = [
        sqrt(2.0) * (0.05 * sqrt(2.0 * gear.reference_radius) + 0.35 * sqrt(23.0) + 4.0)
        for gear in (found.pair.pinion, found.pair.wheel)
    ]
    assert mesh_misalignment(replace(found, misalignment=None)) == pytest.approx(hypot(*slopes))


def test_dynamic_factor_is_continuous_and_highest_in_resonance():
    """ISO 6336-1:2006 section 6.5: one below, a plateau to 1.15 of the resonance, a line to 1.5, constant above."""
    found = operation(H501[0], 100e3, 1.0)
    resonance = 30e3 / 3.14159265 / 20 * (found.mesh_stiffness / found.reduced_mass) ** 0.5

    def factor(ratio):
        return load_factors(replace(found, pinion_speed=ratio * resonance)).dynamic

    assert factor(1e-6) == pytest.approx(1.0, abs=1e-5)
    assert factor(1.0) == factor(1.1) and factor(1.6) == factor(3.0)
    assert factor(1.325) == pytest.approx(0.5 * (factor(1.0) + factor(2.0)), rel=1e-6)
    assert factor(0.4) < factor(0.8) < factor(1.0)
