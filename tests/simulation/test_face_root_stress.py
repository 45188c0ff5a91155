"""[output] root_stress over the face."""

import numpy as np
import pytest
from tests.over_face import root_stress_run

from fenics_gears import gear_pair
from fenics_gears.elasticity.face.fine_fillet import fine_over_swept
from fenics_gears.elasticity.fillet_points import POINTS_OVER_FACE, fillet_curve, fillet_weights, section_angle
from fenics_gears.elasticity.slice_averages import slice_averages
from fenics_gears.model.face_resolution import face_discretisation
from fenics_gears.results.root_stress_variables import OF_BENDING
from fenics_gears.simulation.run_stresses import RunStresses
from fenics_gears.simulation.stored_forces import stored_forces

STEP = 5


either = pytest.mark.parametrize("coast", [pytest.param(False, marks=pytest.mark.nightly), True])


@either
def test_rows_give_what_the_recovered_sectors_have(coast):
    """Exact identity (Betti): in every slice, on both gears and all teeth in reach, times the fine section's
    factors."""
    scene, result = root_stress_run(coast)
    largest = np.nanmax(np.abs(result["root_stress"].values))
    with RunStresses(result, scene) as stresses:
        face, stored = stresses.model.face, stored_forces(result, stresses.model, stresses.cycle, STEP)
        step = round(float(result["mesh_phase"].values[STEP]) * stresses.cycle.steps)
        for gear, recovery in enumerate(stresses.recoveries):
            data = (stresses.model.pair.pinion, stresses.model.pair.wheel)[gear]
            forces = stored.on_flanks(stresses.model, gear, recovery.heights)
            averages = slice_averages(recovery.heights, 2, face.positions - face.middles[gear], face.widths)
            teeth = sorted({pair.place.index for pair in stored.pairs})
            assert len(teeth) > 1
            sizes = face_discretisation(stresses.model, gear).in_modules_of(data).sizes
            factors = fine_over_swept(
                data.of_module_one,
                sizes,
                scene.gears.material_of(("pinion", "wheel")[gear]).poissons_ratio,
                fillet_curve(data.of_module_one, POINTS_OVER_FACE),
            )
            factors = factors.reshape(2, -1)
            for tooth in teeth:
                found = recovery.recovered(forces, [(1, -1)[gear] * tooth]).stress[0]
                expected = _at_fillets(recovery, data, np.einsum("sh,hnij->snij", averages, found)) * factors
                number = int(stresses.cycle.pair_number(step, tooth)) + result["pair_number"].attrs["number_at_phase_0"]
                slot = int(np.flatnonzero(result["pair_number"].values[STEP] == number)[0])
                here = result.isel(time=STEP, contact_time=STEP, gear=gear, slot=slot)
                assert (
                    np.abs(
                        here["root_stress"].values - expected[:, :, :-1].transpose(1, 2, 0).reshape(-1, face.slices)
                    ).max()
                    < 1e-9 * largest
                )
                assert np.abs(here["root_stress_over_face"].values - expected[:, :, -1].T).max() < 1e-9 * largest


def _at_fillets(recovery, data, stress):
    """Stress (S, 2, p) of both fillets from that (S, n, 3, 3) at the section's nodes."""
    curve, body = fillet_curve(data.of_module_one, POINTS_OVER_FACE), recovery.sector
    found = []
    for side in (0, 1):
        nodes, weights, tangents = fillet_weights(curve, body.section, body.held, side)
        at_points = np.einsum("pk,skij->spij", weights, stress[:, nodes])
        x, y = (weights @ body.section.points[nodes]).T
        # The surface's normal is across the tangent of the section and the trace; the profile's direction across that
        # and the trace.
        trace = np.column_stack([-body.sweep.twist * y, body.sweep.twist * x, np.ones(len(x))])
        normal = np.cross(np.pad(tangents, ((0, 0), (0, 1))), trace)
        across = np.cross(trace, normal)
        across /= np.linalg.norm(across, axis=1)[:, None]
        found.append(np.einsum("pi,spij,pj->sp", across, at_points, across))
    return np.stack(found, axis=1)


@either
def test_largest_values_are_those_over_the_face(coast):
    """Definition: the largest of points and slices; a slot without a pair in reach has none."""
    scene, result = root_stress_run(coast)
    of_bending = OF_BENDING * section_angle(gear_pair(scene.gears).pinion)
    along, over_face = (
        result["root_stress"]
        .where(result["fillet_tangent_angle"] >= of_bending)
        .max(("fillet_point", "face_position")),
        result["root_stress_over_face"].max("face_position"),
    )
    np.testing.assert_array_equal(result["root_stress_maximum"].values, along.values)
    np.testing.assert_array_equal(result["root_stress_at_30_degrees"].values, over_face.values)
    assert (np.isnan(along.values).all(axis=1) == (result["pair_number"].values == 0)).all()
    assert result.attrs["largest_root_stress_pinion"] > 0.0
