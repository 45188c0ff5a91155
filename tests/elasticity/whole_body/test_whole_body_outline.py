"""Bore and flanks are found in any mesh of the gear; what is no such mesh is named."""

from dataclasses import replace

import gmsh
import numpy as np
import pytest
from tests.coarse_sector import PINION, coarse_sector_mesh
from tests.whole_gear import whole_gear_mesh

from fenics_gears import SceneError
from fenics_gears.elasticity.body_mesh_file import read_body_mesh
from fenics_gears.elasticity.gmsh_session import start
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.whole_body.outline import OUTLINE_TOLERANCE, whole_body
from fenics_gears.geometry.outline import rotation
from meshes.mesh_file import write_body_mesh
from meshes.root_crack import joined_sectors


@pytest.fixture(scope="module")
def whole():
    return whole_gear_mesh(coarse_sector_mesh("P1"), PINION.teeth)


def unnamed(mesh: BodyMesh, points: np.ndarray | None = None) -> BodyMesh:
    return BodyMesh(mesh.points if points is None else points, mesh.cells, {})


@pytest.mark.parametrize("angle", [0.0, 0.15, -0.19, 0.3, 2.0, -3.0])
def test_the_outline_is_found_at_any_angle_and_tooth_0_is_the_nearest(whole, angle):
    """Exact: the sides that the mesh was made with."""
    found = whole_body(unnamed(whole, whole.points @ rotation(angle).T), PINION).mesh
    pitch = PINION.angular_pitch
    steps = round(angle / pitch)
    assert np.abs(found.points - whole.points @ rotation(steps * pitch).T).max() < 1e-9
    assert sides(found.edges["hub"]) == sides(whole.edges["hub"])
    for tooth in range(PINION.teeth):
        assert sides(found.edges[f"flank {(tooth + steps) % PINION.teeth}"]) == sides(whole.edges[f"flank {tooth}"])


def sides(edges: np.ndarray) -> set:
    return {tuple(sorted(side)) for side in edges.tolist()}


def without_cells(mesh: BodyMesh, gone: np.ndarray) -> BodyMesh:
    used, cells = np.unique(mesh.cells[~gone], return_inverse=True)
    return BodyMesh(mesh.points[used], cells.reshape(-1, 3), {})


def cut_off(mesh: BodyMesh) -> BodyMesh:
    """A tooth that holds on to nothing."""
    centre = mesh.points[mesh.cells].mean(axis=1)
    radius, angle = np.linalg.norm(centre, axis=1), np.arctan2(centre[:, 1], centre[:, 0])
    return without_cells(mesh, (np.abs(radius - 31.5) < 1.5) & (np.abs(angle + 1.7) < 0.25))


def broken_off(mesh: BodyMesh) -> BodyMesh:
    centre = mesh.points[mesh.cells].mean(axis=1)
    radius, angle = np.linalg.norm(centre, axis=1), np.arctan2(centre[:, 1], centre[:, 0])
    return without_cells(mesh, (radius > 33.0) & (np.abs(angle + 1.7) < 0.25))


def moved(mesh: BodyMesh, part: str, shift: float) -> BodyMesh:
    """Points of a named part, its ends left out, moved outwards."""
    inner = mesh.edge_points(part)
    inner = inner[np.argsort(np.linalg.norm(mesh.points[inner], axis=1))][1:-1]
    points = mesh.points.copy()
    points[inner] = points[inner] @ rotation(shift).T
    return unnamed(mesh, points)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            cut_off,
            "2 parts that do not hold together; the smallest, of .* A tooth that a crack has cut off carries nothing",
        ),
        (broken_off, "has 15 tooth tips on its tip circle, the gear of the scene has 16 teeth"),
        (lambda mesh: unnamed(mesh, 1e-3 * mesh.points), "0.04132 mm from the origin, .* 41.32 mm. Is it in metres"),
        (lambda mesh: unnamed(mesh, mesh.points / 4.5), "Is it in modules"),
        (
            lambda mesh: unnamed(mesh, mesh.points + [1.0, 0.0]),
            "42.* mm from the origin, .* the gear's centre at the origin",
        ),
        (
            lambda mesh: moved(mesh, "flank 5", -2e-3),
            "drive flank of tooth 5, .* lie up to 67.* um off the gear's involute; allowed are 9 um",
        ),
    ],
)
def test_a_mesh_that_is_not_this_gear_is_named_for_what_it_is(whole, change, message):
    """What, where, and what is allowed."""
    with pytest.raises(SceneError, match=message):
        whole_body(change(whole), PINION)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"bore_radius": 14.0},
            "no bore of radius 14 mm .*bore_diameter is 28 mm.* innermost point of the boundary is 15 mm",
        ),
        ({"teeth": 17}, "16 tooth tips"),
        ({"profile_shift": 0.18}, r"the teeth are thicker than those of the scene \(profile_shift\)"),
        ({"pressure_angle": 0.36}, "drive flank of tooth"),
    ],
)
def test_a_mesh_of_another_gear_is_refused(whole, change, message):
    """Another bore, other teeth, thicker teeth."""
    with pytest.raises(SceneError, match=message):
        whole_body(unnamed(whole), replace(PINION, **change))


def test_a_flank_within_the_tolerance_is_taken(whole):
    """Half the tolerance off the involute; twice as far is refused."""
    tolerance = OUTLINE_TOLERANCE * PINION.module
    near = moved(whole, "flank 5", -0.5 * tolerance / PINION.base_radius)
    assert sides(whole_body(near, PINION).mesh.edges["flank 5"]) == sides(whole.edges["flank 5"])
    with pytest.raises(SceneError, match="off the gear's involute"):
        whole_body(moved(whole, "flank 5", -2.0 * tolerance / PINION.base_radius), PINION)


def test_a_crack_that_opens_on_a_flank_is_refused(whole):
    """A doubled point leaves no line of elements."""
    flank = whole.edge_points("flank 3")
    middle = flank[np.argsort(np.linalg.norm(whole.points[flank], axis=1))][len(flank) // 2]
    beyond = np.linalg.norm(whole.points[whole.cells].mean(axis=1), axis=1) > np.linalg.norm(whole.points[middle])
    cells = np.where(beyond[:, None] & (whole.cells == middle), len(whole.points), whole.cells)
    with pytest.raises(
        SceneError,
        match="flank of tooth 3, .* is not one line of elements from form circle to tip: it is broken near radius 37",
    ):
        whole_body(BodyMesh(np.vstack([whole.points, whole.points[middle]]), cells, {}), PINION)


def test_teeth_need_not_be_meshed_alike():
    """Two meshes in turn: every flank with as many elements as it has."""
    from fenics_gears.elasticity.element_sizes import ElementSizes
    from fenics_gears.elasticity.sector_mesh import sector_mesh

    # Cuts are divided by body and root sizes; flanks may differ where these are set by neither.
    sizes = ElementSizes(flank=0.8, fillet=0.4, coast=1.0, body=3.0)
    one = sector_mesh(PINION, sizes)
    rolls = np.linspace(PINION.form_roll_angle, PINION.tip_roll_angle, 8)
    other = sector_mesh(PINION, sizes, flank_rolls=rolls)
    body = whole_body(unnamed(joined_sectors([one, other] * 8)), PINION)
    counts = [len(body.mesh.edges[f"flank {tooth}"]) for tooth in range(16)]
    assert counts == [len(one.edges["flank"]), 7] * 8


def edited(whole, path, change) -> None:
    write_body_mesh(BodyMesh(whole.points, whole.cells, {}), path)
    start(gmsh)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(str(path))
    change()
    gmsh.write(str(path))
    gmsh.finalize()


def lift_one_point():
    tag = int(gmsh.model.mesh.getNodes()[0][0])
    position = gmsh.model.mesh.getNode(tag)[0]
    gmsh.model.mesh.setNode(tag, [position[0], position[1], 2.0], [])


def test_what_is_no_plane_mesh_of_straight_cells_is_refused(whole, tmp_path):
    """A point out of the plane, second-order cells, cells inside out."""
    path = tmp_path / "gear.msh"
    edited(whole, path, lift_one_point)
    with pytest.raises(SceneError, match="is not plane: its points lie between z = 0 and 2"):
        read_body_mesh(path)
    edited(whole, path, lambda: gmsh.model.mesh.setOrder(2))
    with pytest.raises(SceneError, match="Triangle 6.*in gmsh Mesh.ElementOrder = 1"):
        read_body_mesh(path)
    folded = whole.cells.copy()
    folded[:5] = folded[:5, ::-1]
    write_body_mesh(BodyMesh(whole.points, folded, {}), path)
    with pytest.raises(
        SceneError, match="5 of .* cells are inverted, the first near x = .*: the mesh folds over itself there"
    ):
        read_body_mesh(path)
    write_body_mesh(BodyMesh(whole.points, whole.cells[:, ::-1], {}), path)
    assert len(read_body_mesh(path).cells) == len(whole.cells)
