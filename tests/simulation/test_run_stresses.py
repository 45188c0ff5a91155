"""Both gears of a run recovered at stored times, and stress in the fillets over time ([output] root_stress)."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy.spatial import cKDTree
from tests.coarse import coarse_scene, frictionless, quasi_static
from tests.coarse_sector import PINION, STEEL, unmirrored
from tests.elasticity.flank_pressure import pressed
from tests.iso_tooth_root import nominal_root_stress, standard_gear

from fenics_gears import Load, SceneError, scene_from_text, simulate
from fenics_gears.contact.compliance_product import directions
from fenics_gears.contact.kinematics import COLUMNS, displacement_jacobian, lines_of
from fenics_gears.contact.tooth_pair import COAST
from fenics_gears.effects.coast_flanks import CoastFlanks
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.fillet_points import POINTS, fillet_curve, fillet_rows
from fenics_gears.elasticity.recovery import gear_recovery
from fenics_gears.elasticity.root_stress import root_stress_rows
from fenics_gears.geometry.in_mesh import upright
from fenics_gears.geometry.involute import arc_length
from fenics_gears.results.settled import settled_steps
from fenics_gears.scene.data import Output
from fenics_gears.show.drawn_scale import overlap
from fenics_gears.show.loaded_contact import loaded_contact
from fenics_gears.show.stress_grid import in_plane
from fenics_gears.simulation.dynamic_factor import quasi_static as without_inertia
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
    scene = coarse_scene(paper_scene, cycles=1)
    scene = replace(quasi_static(scene), coast_flanks=CoastFlanks(), load=Load(-scene.load.wheel_torque))
    result = simulate(scene, cache=user_cache())
    with RunStresses(result, scene) as stresses:
        yield scene, result, stresses


either_way = pytest.mark.parametrize("of_run", ["driving", "driven"])


def opening_of(stresses, stored, forces) -> tuple[np.ndarray, np.ndarray]:
    """Openings (mm) at the nodes under pressure and at all others, of both gears recovered under
    `forces(gear, stored)`."""
    pair = stresses.model.pair
    motion = hub_motion(stresses.result, stored.index)
    motion[:, 2] *= pair.base_radii
    rows = displacement_jacobian(lines_of(stored.pairs, pair.sides), tangential=False)
    approach = rows[:, COLUMNS[:, [0, 1, 5]].ravel()] @ motion.ravel()
    bodies = [recovery.recovered(forces(gear, stored)) for gear, recovery in enumerate(stresses.recoveries)]
    start = 0
    for touching in stored.pairs:
        nodes = slice(start, start + len(touching.offsets))
        start = nodes.stop
        for gear, (recovery, body) in enumerate(zip(stresses.recoveries, bodies)):
            side = "coast" if touching.place.flank == COAST else "flank"
            tooth = touching.place.teeth[gear] % len(body.displacement)
            moved = body.displacement[tooth, 0][recovery.sector.flank_nodes(side)]
            if side == "coast":
                moved = unmirrored(recovery.gear, moved.ravel()).reshape(-1, 2)
            # Outwards of either gear brings the flanks together.
            along = directions(touching.place.contact_rolls[gear], False)[0]
            approach[nodes] += touching.interpolation[gear].weights @ moved @ along
    opening = np.concatenate([each.gap for each in stored.pairs]) - approach
    closed = np.concatenate([force[: len(each.offsets)] for each, force in zip(stored.pairs, stored.forces)]) > 0.0
    return opening[closed], opening[~closed]


@either_way
def test_flanks_touch_where_the_pressure_is(of_run, request):
    """Signorini: the recovered displacement closes the gap at every node under pressure (N u = g), and leaves none
    negative."""
    scene, result, stresses = request.getfixturevalue(of_run)
    for index in (0, 13, 29):
        stored = stored_forces(result, stresses.model, stresses.cycle, index)
        assert any(np.any(force) for force in stored.forces)
        closed, others = opening_of(stresses, stored, stresses.forces)
        assert np.abs(closed).max(initial=0.0) < 1e-9
        assert others.min(initial=0.0) > -1e-9


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


FACTORS = ("dynamic_factor_by_force", "dynamic_factor_by_stress")


def wanted(scene):
    return replace(scene, output=Output(root_stress=True))


@pytest.fixture(scope="module", params=["friction and inertia", "driven from the wheel on coast flanks"])
def run(request, paper_scene):
    scene = wanted(coarse_scene(paper_scene, cycles=1))
    if request.param.startswith("driven"):
        scene = replace(quasi_static(scene), coast_flanks=CoastFlanks(), load=Load(-scene.load.wheel_torque))
    return scene, simulate(scene)


def test_rows_give_what_the_full_recovery_gives(run):
    """Exact identity (Betti): at sampled times, both gears, all loaded teeth, both fillets."""
    scene, result = run
    with RunStresses(result, scene) as stresses:
        for index in (0, 21):
            stored = stored_forces(result, stresses.model, stresses.cycle, index)
            step = round(float(result["mesh_phase"].values[index]) * stresses.cycle.steps)
            for gear, recovery in enumerate(stresses.recoveries):
                moved = recovery.recovered(stored.on_flanks(stresses.model, gear)).displacement
                rows = fillet_rows(recovery, fillet_curve(recovery.gear.of_module_one))
                for tooth in {pair.place.index for pair in stored.pairs}:
                    pair = (
                        int(stresses.cycle.pair_number(step, tooth)) + result["pair_number"].attrs["number_at_phase_0"]
                    )
                    at = moved[(1, -1)[gear] * tooth % len(moved)].ravel()
                    expected = (rows @ at * scene.gears.material.youngs_modulus / recovery.gear.module).reshape(2, -1)
                    slot = int(np.flatnonzero(result["pair_number"].values[index] == pair)[0])
                    here = result.isel(time=index, contact_time=index, gear=gear, slot=slot)
                    largest = np.nanmax(np.abs(result["root_stress"].values))
                    assert np.abs(here["root_stress"].values - expected[:, :-1].ravel()).max() < 1e-9 * largest
                    assert np.abs(here["root_stress_at_30_degrees"].values - expected[:, -1]).max() < 1e-9 * largest


def test_largest_stress_is_that_of_the_points_and_tension_is_on_the_loaded_side(run):
    """Definition; beam theory: the fillet below the loaded flank is pulled."""
    scene, result = run
    points, angles = result["root_stress"].values, result["fillet_tangent_angle"].values
    known, of_bending = np.isfinite(points).all(axis=-1), (angles >= np.radians(15.0))[:, None, :]
    assert (of_bending.mean(axis=-1) > 0.6).all() and not of_bending.all()
    bent = np.where(of_bending, points, -np.inf).max(axis=-1)
    np.testing.assert_array_equal(result["root_stress_maximum"].values[known], bent[known])
    assert np.isnan(result["root_stress_maximum"].values[~known]).all()
    loaded, other = ("coast", "drive") if "coast_normal_force" in result else ("drive", "coast")
    index, gear, slot = np.unravel_index(np.nanargmax(result["root_stress_maximum"].values), known.shape)
    tooth = result["root_stress"].isel(contact_time=index, gear=gear, slot=slot)
    assert tooth.where(tooth["fillet_side"] == loaded).max() > 0.0 > tooth.where(tooth["fillet_side"] == other).min()
    assert float(tooth.max()) == float(tooth.where(tooth["fillet_side"] == loaded).max())


def test_dynamic_factors_are_ratios_to_the_quasi_static_run(run):
    """Definition: of the same scene without inertia, which has none."""
    scene, result = run
    if scene.inertia is None:
        assert not [name for name in result.attrs if "dynamic_factor" in name]
        return
    still, counted = simulate(without_inertia(scene)), settled_steps(result)
    assert result.attrs[FACTORS[0]] == pytest.approx(
        result.attrs["largest_pair_force"] / still.attrs["largest_pair_force"], rel=1e-9
    )
    names = ["root_stress_maximum", "root_stress_at_30_degrees"]
    largest, largest_still = (
        max(np.nanmax(run[name].values[steps]) for name in names)
        for run, steps in ((result, counted), (still, slice(None)))
    )
    assert result.attrs[FACTORS[1]] == pytest.approx(largest / largest_still, rel=1e-9)


def highest_single_contact(gear) -> float:
    """Roll angle (rad) near the outer point of single tooth contact with a like gear: contact ratio 1.6."""
    return gear.tip_roll_angle - 0.6 * gear.angular_pitch


def stresses_of_a_narrow_load(gear, roll: float, element: str = "P2") -> np.ndarray:
    """MPa in the fillets (50,) under 1 N/mm over a tenth of a module around a roll angle (rad)."""
    discretisation = Discretisation(element, 0.04 * gear.module)
    with gear_recovery(gear, STEEL, discretisation) as recovery:
        middle, half = arc_length(gear.base_radius, roll), 0.05 * gear.module
        forces = pressed(
            recovery,
            lambda arc: (
                np.where(np.abs(arc - middle) < half, 1.0 + np.cos(np.pi * (arc - middle) / half), 0.0) / (2.0 * half)
            ),
        )
    rows = root_stress_rows(gear, STEEL, discretisation, reach=0)
    # The mesh resolves so narrow a load but in the mean.
    return rows.rows[0, 0] @ forces / np.linalg.norm(forces.reshape(-1, 2).sum(axis=0))


@pytest.mark.parametrize(
    "gear", [PINION, *(standard_gear(teeth) for teeth in (20, 100))], ids=lambda gear: f"z={gear.teeth}"
)
def test_stress_is_near_that_of_the_standards(gear):
    """F_t/(b m) Y_F Y_S of ISO 6336-3 method B and DIN 3990-3, whose fit to analyses and measurements scatters by 20
    to 25 %."""
    roll = highest_single_contact(gear)
    stress, nominal = stresses_of_a_narrow_load(gear, roll), nominal_root_stress(gear, roll, 1.0)
    assert stress[:POINTS].max() == pytest.approx(nominal, rel=0.2)
    assert stress[POINTS] == pytest.approx(nominal, rel=0.25)
    # The pressed side has the larger stress, since the load's own pressure adds to bending there.
    assert -stress[POINTS + 1 :].min() > stress[:POINTS].max()


@pytest.mark.parametrize(("edit", "said"), [
    (lambda text: text.replace("[gears.material]", "[friction_]"), "gears.material"),
    (lambda text: text.replace('condensation = "once"', 'condensation = "every step"'), 'Take "once"'),
    (lambda text: text.replace("[accuracy]", '[accuracy]\nmodel = "stiffness table"'), "finite elements"),
    (lambda text: text.replace("root_stress = true", 'root_stress = "yes"'), "neither true nor false"),
])  # fmt: skip
def test_scenes_it_cannot_be_had_of_are_refused(paper_scene, edit, said):
    """Before anything is computed, with the remedy."""
    with pytest.raises(SceneError, match=said):
        scene_from_text(edit(paper_scene.text + "\n[output]\nroot_stress = true\n"))
