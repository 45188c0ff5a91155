"""Stresses of teeth over the face."""

import numpy as np
import pytest
from scipy.spatial import cKDTree
from tests.over_face import helical_run, ring_run

from fenics_gears.contact.tooth_pair import DRIVE
from fenics_gears.geometry.in_mesh import standing
from fenics_gears.geometry.outline import rotation
from fenics_gears.show.flank_pressure import STAND_OFF, pressed_tiles
from fenics_gears.show.run import scene_of
from fenics_gears.show.stress_grid import save_vtu
from fenics_gears.show.stress_picture import colour_limit
from fenics_gears.simulation.run_stresses import RunStresses
from fenics_gears.simulation.stored_forces import stored_forces

STEP = 5


@pytest.fixture(scope="module", params=[helical_run, ring_run])
def run(request):
    return request.param()


@pytest.fixture(scope="module")
def stresses(run):
    with RunStresses(run, scene_of(run)) as found:
        yield found


@pytest.fixture(scope="module")
def mesh(stresses):
    return stresses.at(STEP)


def test_forces_on_the_teeth_are_those_of_the_mesh(stresses):
    """Statics: forces on nodes add up to the run's along the contact normal, and to its torque."""
    model = stresses.model
    pair, stored = model.pair, stored_forces(stresses.result, model, stresses.cycle, STEP)
    force = float(stresses.result["normal_force"].values[STEP])
    normal = pair.cosine * np.array([1.0, 0.0, -pair.slope])
    for gear, (data, sense) in enumerate(((pair.pinion, -1.0), (pair.wheel, 1.0))):
        recovery = stresses.recoveries[gear]
        on_teeth = stored.on_flanks(model, gear, recovery.heights)
        angles, twist = standing(pair, gear, stored.phase)[1], -sense * pair.slope / data.base_radius
        total, torque = np.zeros(3), 0.0
        flank = recovery.sector.flank_nodes("flank")[
            : len(recovery.sector.flank_nodes("flank")) // len(recovery.heights)
        ]
        for tooth, own in on_teeth.items():
            at_heights = own[DRIVE].reshape(len(recovery.heights), -1, 3)
            for height, at_height in zip(recovery.heights + model.face.middles[gear], at_heights):
                total += rotation(angles[tooth % data.tooth_count] + twist * height, 3) @ at_height.sum(axis=0)
                x, y = recovery.points[flank].T
                torque += (x * at_height[:, 1] - y * at_height[:, 0]).sum()
        # A slice's force has one direction in frames that turn with the layers' nodes: of second order in the turn over
        # 10 mm of face.
        assert total == pytest.approx(sense * force * normal, abs=3e-4 * force)
        # Lever arms are of the coarse flank's nodes, straight between vertices.
        assert abs(torque) == pytest.approx(abs(data.base_radius) * pair.cosine * force, rel=2e-3)


def test_roots_of_the_loaded_teeth_carry(mesh):
    """Bending: the largest tension is at a loaded tooth."""
    for gear in mesh.gears:
        tension = gear.principal[..., gear.in_root].max(axis=(1, 2))
        assert 1 <= tension.argmax() <= len(tension) - 2
        assert tension[[0, -1]].max() < 0.5 * tension.max()
    assert 0.0 < max(gear.von_mises[..., gear.in_root].max() for gear in mesh.gears) <= colour_limit([mesh])


def test_pressure_is_painted_where_the_flanks_touch(run, mesh):
    """Newton's third law: tiles of both gears lie on each other, pressures add up to the mesh's force."""
    tiles = [pressed_tiles(mesh, run, gear, 0.0) for gear in (0, 1)]
    off = STAND_OFF * mesh.pair.pinion.module
    pinion, wheel = (each.corners.mean(axis=1) for each in tiles)
    # Each stands off its flank into the other; from there flanks of other curvature part over the contact's width.
    assert np.linalg.norm(pinion - wheel, axis=1) == pytest.approx(2.0 * off, abs=0.7 * off)
    first, second = tiles[0].corners[:, 1] - tiles[0].corners[:, 0], tiles[0].corners[:, 3] - tiles[0].corners[:, 0]
    area = np.linalg.norm(np.cross(first, second), axis=1)
    assert area @ tiles[0].pressure == pytest.approx(float(run["normal_force"].values[STEP]), rel=0.02)
    for gear, each in zip(mesh.gears, tiles):
        carries = gear.points[:, :, gear.on_flank].reshape(-1, 3)
        assert cKDTree(carries).query(each.corners.reshape(-1, 3))[0].max() < 0.1 * mesh.pair.face_width


def test_file_for_paraview(mesh, tmp_path):
    """VTK reads wedges of positive volume, and the picture's stress."""
    pyvista = pytest.importorskip("pyvista")
    save_vtu(mesh, tmp_path / "teeth.vtu")
    grid = pyvista.read(tmp_path / "teeth.vtu")
    # VTK 9.3's own volumes of these wedges are a sixth of what they are.
    corners = np.asarray(grid.points)[grid.cells.reshape(grid.n_cells, -1)[:, 1:7]]
    volumes = 0.5 * np.einsum(
        "ij,ij->i",
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
        (corners[:, 3:] - corners[:, :3]).mean(axis=1),
    )
    assert volumes.min() > 0.0
    triangles = [gear.points[0, 0][gear.section.subcells][..., :2] for gear in mesh.gears]
    areas = [0.5 * np.abs(np.cross(each[:, 1] - each[:, 0], each[:, 2] - each[:, 0])).sum() for each in triangles]
    expected = sum(area * len(gear.sectors) * np.ptp(gear.points[..., 2]) for area, gear in zip(areas, mesh.gears))
    assert volumes.sum() == pytest.approx(expected, rel=1e-2)
    assert grid["von_mises_stress"].max() == pytest.approx(max(gear.von_mises.max() for gear in mesh.gears))
