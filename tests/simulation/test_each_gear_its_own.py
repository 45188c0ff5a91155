"""Material and face width of each gear its own: identities of whole runs, Hertz for two moduli, and the standard's E of two materials."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest
from tests.coarse import coarse_scene, quasi_static

from fenics_gears import simulate
from fenics_gears.contact.operator import CompliancePairing
from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.elasticity.cache import Cache
from fenics_gears.geometry.iso_6336 import pair_stiffness
from fenics_gears.geometry.pair import gear_pair
from fenics_gears.model.drivetrain import drivetrain
from fenics_gears.model.resolution import resolve
from fenics_gears.scene.data import Accuracy, Material
from fenics_gears.scene.read import scene_from_text

STEEL, BRONZE = Material(206e3, 0.3), Material(103e3, 0.35)


def of_gears(scene, pinion=None, wheel=None, **shared):
    """The scene with other values of pinion, wheel and pair."""
    gears = scene.gears
    return replace(scene, gears=replace(gears, pinion=replace(gears.pinion, **pinion or {}), wheel=replace(gears.wheel, **wheel or {}), **shared))


def test_sections_of_both_gears_say_what_the_short_form_says(paper_scene):
    """Identity: [gears.pinion.material] and [gears.wheel.material] alike are [gears.material]; a gear takes from it what it leaves out."""
    text = paper_scene.text
    own = text.replace("[gears.material]", "[gears.pinion.material]") + '\n[gears.wheel.material]\nyoungs_modulus = "206 GPa"\npoissons_ratio = 0.3\n'
    assert scene_from_text(own).gears.materials == paper_scene.gears.materials == (STEEL, STEEL)
    softer = scene_from_text(text + '\n[gears.wheel.material]\nyoungs_modulus = "103 GPa"\n').gears
    assert softer.materials == (STEEL, Material(103e3, 0.3))
    widths = text.replace('face_width = "15 mm"\n', "").replace("teeth = 16", 'teeth = 16\nface_width = "15 mm"')
    assert scene_from_text(widths.replace("teeth = 24", 'teeth = 24\nface_width = "15 mm"')).gears == paper_scene.gears
    wider = scene_from_text(text.replace("teeth = 16", 'teeth = 16\nface_width = "18 mm"')).gears
    assert (wider.face_width, wider.face_widths) == (15.0, (18.0, 15.0))
    assert gear_pair(wider).face_widths == (18.0, 15.0)


def test_each_gear_gives_way_by_its_own_width(stand_in_flanks, paper_pair):
    """Exact: the pair's compliance is the sum of both gears' over their widths."""
    from fenics_gears.contact.mesh_cycle import MeshCycle
    from fenics_gears.contact.window import ContactGrid

    def compliance(widths):
        pair = replace(paper_pair, own_face_widths=widths)
        flanks = Flanks(pair, stand_in_flanks.compliance, stand_in_flanks.removal)
        pairs = MeshCycle(flanks, ContactGrid(3.0, 21), 10, [5], tangential=False).pairs_at(0)
        return CompliancePairing(flanks).compliance(pairs)[0]

    alike = compliance((15.0, 15.0))
    assert np.array_equal(alike, compliance(None))
    assert compliance((15.0, 30.0)) + compliance((30.0, 15.0)) == pytest.approx(1.5 * alike, rel=1e-12)
    assert not np.allclose(compliance((15.0, 30.0)), compliance((30.0, 15.0)), rtol=1e-3)


@pytest.mark.parametrize("dynamic", [False, True], ids=["quasi-static", "dynamic"])
def test_a_gear_twice_as_wide_gives_way_like_one_twice_as_stiff(paper_scene, tmp_path, dynamic):
    """Exact: displacement per force goes with 1/(E b) of the gear, pressure is over the common width; two runs by different ways agree."""
    scene, cache = coarse_scene(paper_scene, 1), Cache(tmp_path)
    scene = scene if dynamic else quasi_static(scene)
    wide = simulate(of_gears(scene, pinion={"face_width": 30.0}, wheel={"face_width": 15.0}), cache=cache)
    stiff = simulate(of_gears(scene, pinion={"material": replace(STEEL, youngs_modulus=412e3)}), cache=cache)
    for name in ("transmission_error", "contact_pressure", "pair_normal_force"):
        largest = np.nanmax(np.abs(stiff[name].values))
        assert np.nanmax(np.abs(wide[name].values - stiff[name].values)) <= 1e-9 * largest
    plain = simulate(scene, cache=cache)
    assert plain.attrs["mean_transmission_error"] > 1.05 * stiff.attrs["mean_transmission_error"]


def test_half_width_of_two_moduli_and_two_widths(quasi_static_scene, paper_pair):
    """Authority: Johnson, Contact Mechanics, 1985, eq. 4.43 with 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2; a gear that is wider by a factor
    spreads the line load by that factor."""

    def half_width(**gears):
        scene = replace(of_gears(quasi_static_scene, **gears), accuracy=Accuracy())
        pair = gear_pair(scene.gears)
        return resolve(scene, pair, drivetrain(scene, pair)).half_width

    line_load = 437e3 / paper_pair.wheel.base_radius / 15.0
    length, start, end = paper_pair.line_of_action_length, paper_pair.path_start, paper_pair.path_end
    radius = min(xi * (length - xi) / length for xi in (start, end))
    softness = (1.0 - 0.3**2) / 206e3 + (1.0 - 0.35**2) / 103e3
    assert half_width(wheel={"material": BRONZE}) == pytest.approx(sqrt(4.0 * line_load * radius * softness / pi), rel=1e-12)
    assert half_width(pinion={"face_width": 30.0}, wheel={"face_width": 15.0}) == pytest.approx(half_width() * sqrt(0.75), rel=1e-12)


def test_the_standards_stiffness_of_two_materials(paper_scene):
    """Authority: ISO 6336-1, tooth stiffness of other materials: times E/E_steel with E = 2 E1 E2/(E1 + E2); over the common width."""
    steel = pair_stiffness(paper_scene.gears, 500.0)
    pair = of_gears(paper_scene, pinion={"face_width": 20.0}, wheel={"face_width": 15.0, "material": BRONZE}).gears
    assert pair_stiffness(pair, 500.0) == pytest.approx(steel * 2.0 * 103.0 / (206.0 + 103.0), rel=1e-12)
