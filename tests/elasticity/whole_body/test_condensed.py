"""A gear meshed as a whole and condensed by its teeth, by meshes as a user makes them in gmsh too."""

import gmsh
import numpy as np
import pytest
from tests.coarse_sector import COARSE, PINION, STEEL, coarse_condensed_sector, coarse_sector_mesh, relative
from tests.whole_gear import whole_gear_compliance, whole_gear_mesh

from fenics_gears import ComputationError
from fenics_gears.elasticity.body_mesh_file import read_body_mesh
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.elasticity.gmsh_session import start
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.ring import ring_compliance
from fenics_gears.elasticity.whole_body.condensed import whole_body_compliance
from fenics_gears.elasticity.whole_body.outline import whole_body
from fenics_gears.geometry.outline import rotation, tooth_outline
from meshes.root_crack import RootCrack, cracked_gear_mesh


def standing_anywhere(mesh: BodyMesh) -> BodyMesh:
    """The same gear, turned by no whole number of pitches, its edges not named."""
    return BodyMesh(mesh.points @ rotation(0.123).T, mesh.cells, {})


@pytest.mark.parametrize("name", ["P2", "Q1 incompatible"])
def test_a_whole_gear_of_equal_teeth_is_a_ring_of_sectors(name):
    """Exact identity: the same mesh, whose flanks had to be found."""
    body = whole_body(standing_anywhere(whole_gear_mesh(coarse_sector_mesh(name), PINION.teeth)), PINION)
    found = whole_body_compliance(body.mesh, PINION, STEEL, element=name, tooth_offsets=2)
    ring = ring_compliance(coarse_condensed_sector(name), PINION.teeth, 2) / STEEL.youngs_modulus
    for tooth in (0, 7, 15):
        for offset in range(-2, 3):
            expected = ring[offset] if offset >= 0 else ring[-offset].T
            assert relative(found.between(tooth + offset, tooth) - expected, expected) < 1e-9
    with pytest.raises(ComputationError, match="teeth 3 and 0 are further apart than the 2 pitches"):
        found.between(3, 16)


def test_a_cracked_gear_equals_brute_force():
    """Exact identity: the whole gear condensed at once."""
    body = whole_body(cracked_gear_mesh(PINION, COARSE, {8: RootCrack(3.0)}), PINION)
    found = whole_body_compliance(body.mesh, PINION, STEEL, element="P1", tooth_offsets=2)
    for loaded in (7, 8):
        brute = whole_gear_compliance(body.mesh, PINION, STEEL, element="P1", loaded_tooth=loaded, tooth_offsets=2)
        for offset in range(3):
            assert relative(found.between(loaded + offset, loaded) - brute.blocks[offset], brute.blocks[offset]) < 1e-9
    # The crack makes its tooth softer, and by reciprocity every block is another's transpose.
    assert np.trace(found.between(8, 8)) > 1.2 * np.trace(found.between(0, 0))
    assert np.array_equal(found.between(7, 8), found.between(8, 7).T)


@pytest.mark.nightly
def test_the_cache_knows_a_body_by_its_mesh(tmp_path):
    """The same in another material; a point moved by a hair is another body."""
    mesh = whole_body(whole_gear_mesh(coarse_sector_mesh("P1"), PINION.teeth), PINION).mesh
    options = {"element": "P1", "tooth_offsets": 1, "cache": Cache(tmp_path)}
    first = whole_body_compliance(mesh, PINION, STEEL, **options)
    again = whole_body_compliance(mesh, PINION, STEEL, **options)
    assert again.timings["from_cache"] and not first.timings["from_cache"]
    assert np.array_equal(first.between(3, 2), again.between(3, 2)) and np.array_equal(
        first.rolls_of(2), again.rolls_of(2)
    )
    points = mesh.points.copy()
    points[np.argmin(np.abs(np.linalg.norm(points, axis=1) - 25.0))] += 1e-6
    assert not whole_body_compliance(BodyMesh(points, mesh.cells, mesh.edges), PINION, STEEL, **options).timings[
        "from_cache"
    ]


def gear_in_gmsh(path) -> None:
    """The pinion's outline turned by no whole number of pitches."""
    outline, turned = tooth_outline(PINION, 12), rotation(0.4)
    flank = outline.involute(np.linspace(PINION.form_roll_angle, PINION.tip_roll_angle, 16))
    drive = np.vstack([outline.fillet[:-1], flank])
    tooth = np.vstack([outline.coast(drive), drive[::-1]]) @ turned.T
    start(gmsh)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        geo, corners = gmsh.model.geo, []
        for number in range(PINION.teeth):
            for x, y in tooth @ rotation(number * PINION.angular_pitch).T:
                corners.append(geo.addPoint(x, y, 0.0, 0.7))
        lines = [geo.addLine(a, b) for a, b in zip(corners, corners[1:] + corners[:1])]
        geo.addPlaneSurface([geo.addCurveLoop(lines), bore(geo)])
        geo.synchronize()
        for line in lines:
            gmsh.model.mesh.setTransfiniteCurve(line, 2)
        gmsh.model.mesh.generate(2)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()


def written_as(version: float, binary: bool, source, path) -> None:
    start(gmsh)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(source))
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", int(binary))
        gmsh.write(str(path))
    finally:
        gmsh.finalize()


def bore(geo) -> int:
    middle, radius = geo.addPoint(0.0, 0.0, 0.0), PINION.bore_radius
    points = [geo.addPoint(x * radius, y * radius, 0.0, 3.0) for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1))]
    return geo.addCurveLoop([geo.addCircleArc(a, middle, b) for a, b in zip(points, points[1:] + points[:1])])


def bending(rolls: np.ndarray, block: np.ndarray) -> float:
    """Work of a smooth load of 1 N/mm about the middle of a flank."""
    weight = np.exp(-(((rolls - 0.45) / 0.12) ** 2)) * np.gradient(rolls**2)
    load = (weight[:, None] * np.column_stack([np.cos(rolls), -np.sin(rolls)]) / weight.sum()).ravel()
    return float(load @ block @ load)


@pytest.fixture(scope="module")
def solid_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("gmsh") / "gear.msh"
    gear_in_gmsh(path)
    return path


def test_a_solid_gear_meshed_as_a_whole_has_the_compliance_of_a_ring(solid_file):
    """The ring of sectors: all 16 unlike meshes of teeth within 0.2 %, the error of straight sides along fillets."""
    solid = whole_body_compliance(whole_body(read_body_mesh(solid_file), PINION).mesh, PINION, STEEL, tooth_offsets=1)
    ring = flank_compliance(PINION, STEEL, Discretisation("P2", 0.3), Reach(1))
    own, beside = (bending(ring.roll_angle, ring.block(ahead)) for ahead in (0, 1))
    for tooth in range(PINION.teeth):
        assert bending(solid.rolls_of(tooth), solid.between(tooth, tooth)) == pytest.approx(own, rel=2e-3)
        assert bending(solid.rolls_of(tooth), solid.between(tooth + 1, tooth)) == pytest.approx(beside, rel=1e-2)


def test_another_format_of_gmsh_is_read(solid_file, tmp_path):
    """Exact, but for the digits that are written."""
    written_as(2.2, True, solid_file, tmp_path / "gear.msh")
    found, expected = (read_body_mesh(path) for path in (tmp_path / "gear.msh", solid_file))
    assert np.array_equal(found.cells, expected.cells) and np.abs(found.points - expected.points).max() < 1e-12
