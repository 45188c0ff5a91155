"""The drivetrain's matrices."""

import re
from dataclasses import replace
from math import pi

import numpy as np
import pytest

from fenics_gears.dynamics.damping import Damping, Rayleigh
from fenics_gears.dynamics.frequencies import natural_frequencies, vibrations
from fenics_gears.dynamics.inertia import GearInertia, Inertia, LoadInertia
from fenics_gears.dynamics.shafts import Shaft, Shafts
from fenics_gears.dynamics.time_integration import Scheme
from fenics_gears.geometry.section import gear_section
from fenics_gears.model.description import describe
from fenics_gears.model.drivetrain import drivetrain, mesh_stiffness
from fenics_gears.scene.read import scene_from_text


def from_twist(coordinates):
    """Coordinates per phi1, phi2, phi3 of the paper: the last one is the twist phi3 - phi2."""
    change = np.eye(len(coordinates))
    change[coordinates.index("twist_2"), coordinates.index("rotation_2")] = -1.0
    return change


def test_effective_stiffness_is_the_papers(paper_scene, paper_pair):
    """[17] and [20]: undamped, with phi3 eliminated."""
    scene = replace(paper_scene, damping=None)
    shafts, step = drivetrain(scene, paper_pair), 5e-5
    scheme = Scheme(shafts, step)
    to_angles = np.diag(shafts.radii) @ from_twist(shafts.coordinates)
    effective = to_angles.T @ scheme.stiffness @ to_angles
    condensed = effective[:6, :6] - np.outer(effective[:6, 6], effective[6, :6]) / effective[6, 6]
    m, j = scene.inertia.mass, scene.inertia.moment_of_inertia
    kb, ks = scene.bearings.stiffness, scene.shafts.torsional_stiffness
    translation = 4 * m / step**2 + kb
    expected = [
        translation,
        translation,
        4 * j / step**2 + ks,
        translation,
        translation,
        4 * j / step**2 + 4 * j * ks / (4 * j + step**2 * ks),
    ]
    assert np.diag(condensed) == pytest.approx(expected, rel=1e-12)
    assert np.abs(condensed - np.diag(np.diag(condensed))).max() <= 1e-9 * min(expected)


def test_absent_sections_have_no_coordinates_and_no_matrices(paper_scene, paper_pair):
    """An effect that the scene does not name is not constructed."""
    bare = replace(paper_scene, shafts=None, bearings=None, inertia=None, damping=None)
    shafts = drivetrain(bare, paper_pair)
    assert shafts.coordinates == ("rotation_2",)
    assert shafts.mass is None and shafts.damping is None
    assert shafts.load == pytest.approx([437e3 / paper_pair.wheel.base_radius])
    assert shafts.free_motion == pytest.approx([1.0])
    with_bearings = drivetrain(replace(bare, bearings=paper_scene.bearings), paper_pair)
    assert with_bearings.coordinates == ("centre_x1", "centre_y1", "centre_x2", "centre_y2", "rotation_2")
    with_shafts = drivetrain(replace(bare, shafts=paper_scene.shafts), paper_pair)
    assert with_shafts.coordinates == ("rotation_1", "rotation_2", "twist_2")
    in_angles = from_twist(with_shafts.coordinates).T @ (with_shafts.load * with_shafts.radii)
    assert in_angles == pytest.approx([0.0, 0.0, 437e3], abs=1e-9)


J1, J2, J3 = 1.7, 23.0, 410.0
MESH, INPUT, OUTPUT = 2.1e5, 0.9e8, 0.4e7
UNEQUAL = Inertia(
    4.9e-3, 24.5, pinion=GearInertia(0.4e-3, J1), wheel=GearInertia(moment_of_inertia=J2), load=LoadInertia(J3)
)


@pytest.fixture
def torsional(paper_scene):
    return replace(
        paper_scene,
        bearings=None,
        damping=None,
        inertia=UNEQUAL,
        shafts=Shafts(input=Shaft(INPUT), output=Shaft(OUTPUT)),
    )


def test_a_chain_of_unequal_inertias_and_shafts(torsional, paper_pair):
    """Brute force: roots of det(K - w^2 M) in plain angles, a cubic in w^2."""
    rb1, rb2 = paper_pair.pinion.base_radius, paper_pair.wheel.base_radius
    a, b, c = INPUT + MESH * rb1**2, OUTPUT + MESH * rb2**2, MESH * rb1 * rb2
    # (a - J1 s)[(b - J2 s)(k - J3 s) - k^2] - c^2 (k - J3 s) = 0 with s = w^2 and k the output shaft's stiffness.
    s = np.polynomial.Polynomial([0.0, 1.0])
    cubic = (a - J1 * s) * ((b - J2 * s) * (OUTPUT - J3 * s) - OUTPUT**2) - c**2 * (OUTPUT - J3 * s)
    expected = np.sqrt(np.sort(cubic.roots().real)) / (2.0 * pi)
    assert natural_frequencies(drivetrain(torsional, paper_pair), MESH) == pytest.approx(expected, rel=1e-9)


def test_the_short_form_is_both_gears_own_to_the_last_bit(paper_scene, paper_pair):
    """Identity: what the sections say of both, said of each."""
    inertia, shafts, damping = paper_scene.inertia, paper_scene.shafts, paper_scene.damping
    gear = GearInertia(inertia.mass, inertia.moment_of_inertia)
    rayleigh = Rayleigh(damping.stiffness_proportional, damping.mass_proportional)
    each = replace(
        paper_scene,
        inertia=Inertia(pinion=gear, wheel=gear, load=LoadInertia(inertia.moment_of_inertia)),
        shafts=Shafts(input=Shaft(shafts.torsional_stiffness), output=Shaft(shafts.torsional_stiffness)),
        damping=Damping(pinion=rayleigh, wheel=rayleigh),
    )
    one, two = drivetrain(paper_scene, paper_pair), drivetrain(each, paper_pair)
    for name in ("stiffness", "mass", "damping", "load"):
        assert np.array_equal(getattr(one, name), getattr(two, name))


def test_rayleigh_damping_of_each_shaft(paper_scene, paper_pair):
    """Exact: alpha K + beta M of either side by its own factors."""
    own = replace(paper_scene, damping=Damping(0.4e-3, 0.5e-3, wheel=Rayleigh(mass_proportional=7.0)))
    shafts = drivetrain(own, paper_pair)
    wheel = np.arange(7) >= 3
    expected = 0.4e-3 * shafts.stiffness + np.where(wheel, 7.0, 0.5e-3)[:, None] * shafts.mass
    assert shafts.damping == pytest.approx(expected, rel=1e-14)
    assert np.array_equal(shafts.damping, shafts.damping.T) and not shafts.damping[np.ix_(wheel, ~wheel)].any()


@pytest.mark.parametrize("elastic", [True, False], ids=["elastic flanks", "rigid flanks"])
def test_every_mode_has_its_ratio(paper_scene, paper_pair, elastic):
    """Definition: with one tooth pair in mesh mode i has ratio i, all beyond the list its last."""
    scene = replace(paper_scene, inertia=UNEQUAL, damping=Damping(ratios=(0.02, 0.3, 0.07)))
    scene = scene if elastic else replace(scene, friction=None, gears=replace(scene.gears, material=None))
    shafts = drivetrain(scene, paper_pair)
    found = [mode.damping_ratio for mode in vibrations(shafts, mesh_stiffness(scene))]
    assert found == pytest.approx([0.02, 0.3] + (len(found) - 2) * [0.07], rel=1e-8)
    assert len(found) == (7 if elastic else 6)
    assert shafts.damping == pytest.approx(shafts.damping.T, rel=1e-12, abs=1e-12 * np.abs(shafts.damping).max())


def test_a_damped_mode_decays_by_its_ratio(torsional, paper_pair):
    """Exact: eigenvalues are -zeta w +- i w sqrt(1 - zeta^2)."""
    shafts = drivetrain(replace(torsional, damping=Damping(ratios=(0.05,))), paper_pair)
    normal = np.array([1.0, 1.0, 0.0])
    stiffness = shafts.stiffness + mesh_stiffness(torsional) * np.outer(normal, normal)
    inverse, size = np.linalg.inv(shafts.mass), 3
    system = np.block([[np.zeros((size, size)), np.eye(size)], [-inverse @ stiffness, -inverse @ shafts.damping]])
    values = np.linalg.eigvals(system)
    assert -values.real / np.abs(values) == pytest.approx(np.full(6, 0.05), rel=1e-8)
    natural = 2.0 * pi * natural_frequencies(shafts, mesh_stiffness(torsional))
    assert np.sort(np.abs(values))[::2] == pytest.approx(natural, rel=1e-9)


DENSITY = """
[inertia]
density = "7.85 g/cm^3"
[inertia.wheel]
mass = "1 kg"
[inertia.load]
moment_of_inertia = "0.2 kg m^2"
"""


def test_density_gives_mass_and_moment_of_inertia_of_each_gear_by_its_own_width(paper_scene, paper_pair):
    """Definition: density times width times area and polar moment."""
    text = re.sub(r"\[inertia\].*?(?=^\[)", DENSITY, paper_scene.text, flags=re.M | re.S)
    scene = scene_from_text(
        text.replace("teeth = 16", 'teeth = 16\nface_width = "18 mm"').replace(
            "teeth = 24", 'teeth = 24\nface_width = "14 mm"'
        )
    )
    pinion, wheel = gear_section(paper_pair.pinion), gear_section(paper_pair.wheel)
    said = dict(describe(scene))
    assert ("face width in common", 14.0, "mm: pinion 18 mm, wheel 14 mm") in said["Model"]
    rows = {label: value for label, value, _ in said["Inertia"]}
    assert rows["pinion mass"] == pytest.approx(7.85e-6 * 18.0 * pinion.area, rel=1e-12)
    assert rows["pinion moment of inertia"] == pytest.approx(7.85e-6 * 18.0 * pinion.polar_moment, rel=1e-12)
    assert rows["wheel mass"] == pytest.approx(1.0, rel=1e-12)
    assert rows["wheel moment of inertia"] == pytest.approx(7.85e-6 * 14.0 * wheel.polar_moment, rel=1e-12)
    assert rows["load moment of inertia"] == pytest.approx(2e5, rel=1e-12)
