"""Both gears of a run recovered at stored times."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy.spatial import cKDTree
from tests.coarse import coarse_scene, frictionless, quasi_static

from fenics_gears import Load, SceneError, simulate
from fenics_gears.contact.compliance_product import directions
from fenics_gears.contact.flank_forces import sector_of, unmirrored
from fenics_gears.contact.operator import displacement_jacobian
from fenics_gears.contact.tooth_pair import COAST
from fenics_gears.effects.coast_flanks import CoastFlanks
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.show.drawn_scale import overlap
from fenics_gears.show.loaded_contact import loaded_contact
from fenics_gears.show.stress_grid import in_plane, upright
from fenics_gears.simulation.run_stresses import RunStresses, hub_motion
from fenics_gears.simulation.stored_forces import stored_forces, stored_index


@pytest.fixture(scope="module")
def driving(paper_scene):
    """A scene on a coarse mesh with friction and inertia, its result, and its stresses."""
    scene = coarse_scene(paper_scene, cycles=1)
    result = simulate(scene, cache=user_cache())
    with RunStresses(result, scene) as stresses:
        yield scene, result, stresses


@pytest.fixture(scope="module")
def driven(paper_scene):
    """The same driven from the wheel, on coast flanks."""
    scene = coarse_scene(paper_scene, cycles=1)
    scene = replace(quasi_static(scene), coast_flanks=CoastFlanks(), load=Load(-scene.load.wheel_torque))
    result = simulate(scene, cache=user_cache())
    with RunStresses(result, scene) as stresses:
        yield scene, result, stresses


either_way = pytest.mark.parametrize("of_run", ["driving", "driven"])


@either_way
def test_flanks_touch_where_the_pressure_is(of_run, request):
    """Signorini: the recovered displacement closes the gap at every node under pressure (N u = g), and leaves none
    negative."""
    scene, result, stresses = request.getfixturevalue(of_run)
    for index in (0, 13, 29):
        stored = stored_forces(result, stresses.model, stresses.cycle, index)
        assert any(np.any(force) for force in stored.forces)
        pair = stresses.model.pair
        radii = (pair.pinion.base_radius, pair.wheel.base_radius)
        arms = tuple(np.full(sum(len(each.offsets) for each in stored.pairs), radius) for radius in radii)
        motion = hub_motion(result, index)
        motion[:, 2] *= radii
        approach = (displacement_jacobian(stored.pairs, radii, arms, tangential=False)[:, :6] @ motion.ravel()).copy()
        start = 0
        for touching, force in zip(stored.pairs, stored.forces):
            nodes = slice(start, start + len(touching.offsets))
            start = nodes.stop
            for gear, recovery in enumerate(stresses.recoveries):
                body = recovery.recovered(stored.on_flanks(stresses.model, gear))
                side = "coast" if touching.place.flank == COAST else "flank"
                moved = body.displacement[sector_of(gear, touching) % len(body.displacement), 0][
                    recovery.sector.flank_nodes(side)
                ]
                if side == "coast":
                    moved = unmirrored(recovery.gear, moved.ravel()).reshape(-1, 2)
                # Outwards of either gear brings the flanks together.
                approach[nodes] += (
                    touching.interpolation[gear].weights
                    @ moved
                    @ directions(touching.place.contact_rolls[gear], False)[0]
                )
            opening = touching.gap - approach[nodes]
            closed = force[: len(touching.offsets)] > 0.0
            assert np.abs(opening[closed]).max(initial=0.0) < 1e-9
            assert opening[~closed].min(initial=0.0) > -1e-9


@either_way
def test_gears_stand_on_their_centres_and_touch_at_the_most_loaded_contact(of_run, request):
    """Geometry: centres, tips, and outlines that meet where the largest force is."""
    scene, result, stresses = request.getfixturevalue(of_run)
    mesh = stresses.at(13)
    assert np.linalg.norm(mesh.gears[1].centre - mesh.gears[0].centre) == pytest.approx(
        scene.gears.centre_distance, rel=1e-12
    )
    for body, gear in zip(mesh.gears, (mesh.pair.pinion, mesh.pair.wheel)):
        radius = np.linalg.norm(in_plane(body.points) - body.centre, axis=1)
        assert radius.max() == pytest.approx(gear.tip_radius, rel=1e-9) and radius.min() == pytest.approx(
            gear.bore_radius, rel=1e-3
        )
    contact, frame = loaded_contact(mesh, result), partial(upright, mesh.pair)
    assert mesh.coast == ("coast_normal_force" in result)
    outlines = [
        frame(in_plane(body.points + body.displacement))[np.unique(body.of_sectors(body.outline))]
        for body in mesh.gears
    ]
    # Nodes 0.12 mm apart on either flank, and hubs displaced by up to 0.06 mm on their bearings.
    assert all(cKDTree(outline).query(contact.point)[0] < 0.13 for outline in outlines)
    # Neither gear is inside the other by more than the sagitta of its straight elements and the averaging of the hats.
    assert overlap(mesh, 1.0) < 2e-3


def test_what_has_no_stress_is_refused(driving, paper_scene):
    """Rigid flanks; the paper's own route; a time that was not stored."""
    scene, result, _ = driving
    rigid = replace(frictionless(scene), gears=replace(scene.gears, material=None))
    with pytest.raises(SceneError, match="rigid"):
        RunStresses(result, rigid)
    remeshed = replace(
        scene, coast_flanks=None, load=paper_scene.load, accuracy=replace(scene.accuracy, condensation="every step")
    )
    with pytest.raises(SceneError, match="once"):
        RunStresses(result, remeshed)
    with pytest.raises(SceneError, match="stored mesh cycles 0 to 1"):
        stored_index(result, 1.5)
