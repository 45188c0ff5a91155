"""``[bearings]``."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import COARSE, coarse_scene, frictionless, quasi_static
from tests.paper_text import PAPER as DEMO

from fenics_gears import SceneError, scene_from_text, simulate
from fenics_gears.dynamics.bearings import BearingPlaces, Bearings, Support

ISOTROPIC = 'stiffness = "0.155e6 N/mm"'


# Four stiffnesses (N/mm) that no mistake of axis or gear leaves alone.
ALL_DIFFERENT = Bearings(0.2e6, stiffness_y=0.3e6, pinion=Support(stiffness_x=0.1e6), wheel=Support(stiffness_y=0.5e6))
EXPECTED = {("pinion", "x"): 0.1e6, ("pinion", "y"): 0.3e6, ("wheel", "x"): 0.2e6, ("wheel", "y"): 0.5e6}


def with_bearings(lines):
    assert ISOTROPIC in DEMO
    return scene_from_text(DEMO.replace(ISOTROPIC, lines))


def test_a_gears_own_stiffness_stands_before_that_of_both():
    """A direction's stiffness stands before that of every direction."""
    text = (
        'stiffness = "0.2e6 N/mm"\nstiffness_y = "0.3e6 N/mm"\n[bearings.pinion]\nstiffness_x = "0.1e6 N/mm"\n'
        '[bearings.wheel]\nstiffness_y = "0.5e6 N/mm"'
    )
    bearings = with_bearings(text).bearings
    assert bearings == ALL_DIFFERENT
    assert {key: bearings.of(*key) for key in EXPECTED} == EXPECTED


def test_places_are_read_from_mid_width():
    """In mm; the axial stiffness of a shaft before that of both."""
    text = (
        f'{ISOTROPIC}\naxial_stiffness = "1 N/mm"\nplaces = {{ pinion = ["-40 mm", "6 cm"]'
        ' }\n[bearings.pinion]\naxial_stiffness = "2 N/mm"'
    )
    bearings = with_bearings(text).bearings
    assert bearings.places_of("pinion") == (-40.0, 60.0) and bearings.places_of("wheel") is None
    assert bearings.axial("pinion") == 2.0 and bearings.axial("wheel") == 1.0
    assert with_bearings(ISOTROPIC).bearings.places is None


@pytest.mark.parametrize(("lines", "said"), [
    ("", "bearings.stiffness\n    is missing"),
    ('stiffness_x = "1 N/mm"', "bearings.stiffness_y\n    is missing"),
    ('[bearings.pinion]\nstiffness = "1 N/mm"\n[bearings.wheel]\nstiffness_y = "1 N/mm"',
     "bearings.wheel.stiffness_x\n    is missing"),
    (f'{ISOTROPIC}\nplaces = {{ wheel = ["40 mm", "40.1 mm"] }}',
     "bearings.places.wheel = a list\n    has both bearings on one spot"),
    (f'{ISOTROPIC}\nplaces = {{ wheel = ["40 mm"] }}',
     "has 1 entry. Allowed: a list of 2 quantities, each a length from -10 m to 10 m"),
    (f"{ISOTROPIC}\nplaces = {{}}", "[bearings.places]\n    is empty."),
    (f'{ISOTROPIC}\naxial_stiffness = "1 N/mm"',
     ('bearings.axial_stiffness = "1 N/mm"\n    has no effect: a shaft whose bearings have no places is held'
     " axially.")),
    (f'{ISOTROPIC}\nplaces = {{ wheel = ["-40 mm", "40 mm"] }}\n[bearings.pinion]\naxial_stiffness = "1 N/mm"',
     "Leave it out, or give bearings.places.pinion."),
])  # fmt: skip
def test_what_is_missing_or_cannot_be_is_named(lines, said):
    """House rule 7."""
    with pytest.raises(SceneError) as refused:
        with_bearings(lines)
    assert said in str(refused.value)


PLACED = replace(ALL_DIFFERENT, axial_stiffness=0.07e6, places=BearingPlaces((-40.0, 60.0), (-30.0, 75.0)))


@pytest.fixture(scope="module")
def placed_run(paper_scene):
    """A quasi-static run of a coarse helical pair without friction on bearings along the shafts."""
    scene = frictionless(quasi_static(coarse_scene(paper_scene, cycles=1)))
    gears = replace(scene.gears, module=4.35, helix_angle=np.deg2rad(15.0))
    accuracy = replace(COARSE, steps_per_mesh_cycle=6, contact_nodes=14, slices=3, layers=2, body_element_size=2.5)
    scene = replace(scene, gears=gears, accuracy=accuracy, bearings=PLACED)
    return scene, simulate(scene)


def test_what_the_bearings_carry_is_in_the_result(placed_run):
    """Exact: springs times displacements are the reactions, half of their work the energy."""
    scene, result = placed_run
    energy = 0.0
    for gear in ("pinion", "wheel"):
        centre_x, centre_y, axial, tilt_x, tilt_y = (
            result[name].sel(gear=gear).values
            for name in ("centre_x", "centre_y", "axial_position", "tilt_x", "tilt_y")
        )
        force, moment = {"x": 0.0, "y": 0.0}, {"x": 0.0, "y": 0.0}
        for place in PLACED.places_of(gear):
            for direction, moved in (("x", centre_x + place * tilt_y), ("y", centre_y - place * tilt_x)):
                carried = 0.5 * PLACED.of(gear, direction) * moved
                force[direction] = force[direction] + carried
                other, sense = {"x": ("y", 1.0), "y": ("x", -1.0)}[direction]
                moment[other] = moment[other] + sense * place * carried
                energy = energy + 0.5 * carried * moved
        energy = energy + 0.5 * PLACED.axial(gear) * axial**2
        size = np.abs(force["x"]).max()
        for direction in "xy":
            assert result[f"reaction_{direction}"].sel(gear=gear).values == pytest.approx(
                force[direction], abs=1e-9 * size
            )
            assert result[f"reaction_moment_{direction}"].sel(gear=gear).values == pytest.approx(
                moment[direction], abs=1e-7 * size
            )
        assert result["reaction_z"].sel(gear=gear).values == pytest.approx(PLACED.axial(gear) * axial, abs=1e-9 * size)
    assert result["energy_bearings"].values == pytest.approx(energy, rel=1e-10)
