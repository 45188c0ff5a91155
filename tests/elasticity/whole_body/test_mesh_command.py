"""`python -m meshes.cracked_gear`, and the mesh in the repository."""

from pathlib import Path

import numpy as np
import pytest

from fenics_gears import load_scene, model_of
from fenics_gears.elasticity.body_mesh_file import read_body_mesh
from fenics_gears.elasticity.whole_body.outline import whole_body
from fenics_gears.elasticity.whole_body.parts import crack_faces
from meshes.cracked_gear import main

ROOT = Path(__file__).parents[3]
SCENE = ROOT / "demos" / "lundvall2004.toml"


def cracked_tooth(mesh, gear) -> int:
    """The tooth whose sector has the crack's points; -1 without."""
    faces = crack_faces(mesh)
    if not faces:
        return -1
    x, y = mesh.points[mesh.cells[np.concatenate(faces)]].mean(axis=(0, 1))
    # Tooth 0 points downwards, its centreline half a tooth clockwise of its flank's start.
    ahead = np.arctan2(y, x) + 0.5 * np.pi + gear.tooth_half_angle_at_base
    return round(ahead / gear.angular_pitch) % gear.teeth


def test_the_repositorys_mesh_is_the_papers_pinion_with_its_ninth_tooth_cracked():
    """The demonstration: 3 mm in tooth 8."""
    pair = model_of(load_scene(SCENE)).pair
    mesh = whole_body(read_body_mesh(ROOT / "meshes" / "cracked_pinion.msh"), pair.pinion).mesh
    assert cracked_tooth(mesh, pair.pinion) == 8
    around = np.unique(mesh.cells[np.concatenate(crack_faces(mesh))])
    points, times = np.unique(np.round(mesh.points[around], 9), axis=0, return_counts=True)
    twins = points[times == 2]
    reach = np.linalg.norm(twins[:, None] - twins[None], axis=-1).max()
    # All but the last short side, from which on both faces meet in the tip.
    assert reach == pytest.approx(3.0, abs=0.1)


@pytest.mark.parametrize(
    "gear, tooth, depth, found",
    [("wheel", 23, "0.1 in", 23), pytest.param("wheel", 0, None, -1, marks=pytest.mark.nightly)],
)
def test_a_mesh_is_written_for_either_gear(gear, tooth, depth, found, tmp_path, capsys):
    """The file read back; its size is told."""
    file = tmp_path / "gear.msh"
    words = [str(SCENE), str(file), "--gear", gear, "--tooth", str(tooth), "--flank-size", "0.8 mm"]
    assert main(words + (["--depth", depth] if depth else [])) == 0
    said, body = capsys.readouterr().out, getattr(model_of(load_scene(SCENE)).pair, gear)
    mesh = whole_body(read_body_mesh(file), body).mesh
    assert f"{len(mesh.points)} points, {len(mesh.cells)} triangles, 0.8 mm along the drive flanks" in said
    assert cracked_tooth(mesh, body) == found


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--depth", "30 mm"], "crack of 30 mm at 45 degrees"),
        (["--depth", "3 mm", "--tooth", "16"], "crack in tooth 16: the gear has teeth 0 to 15"),
        (["--depth", "3 mm", "--mouth", "85 deg"], "no place where it stands at 85 degrees"),
    ],
)
def test_what_cannot_be_meshed_is_said_and_nothing_written(words, message, tmp_path, capsys):
    """Exit code 2."""
    file = tmp_path / "gear.msh"
    assert main([str(SCENE), str(file), *words]) == 2
    assert message in capsys.readouterr().err and not file.exists()


def test_other_endings_and_elements_are_refused(tmp_path, capsys):
    """gmsh would write another format by another name."""
    assert main([str(SCENE), str(tmp_path / "gear.vtk")]) == 2
    assert "must end in .msh" in capsys.readouterr().err
    text = SCENE.read_text().replace('element = "P2"', 'element = "Q2"')
    scene = tmp_path / "scene.toml"
    scene.write_text(text if "Q2" in text else text + '\n[accuracy]\nelement = "Q2"\n')
    assert load_scene(scene).accuracy.element == "Q2"
    assert main([str(scene), str(tmp_path / "gear.msh")]) == 2
    assert "the scene computes its teeth as Q2; meshes of cracked gears have triangles" in capsys.readouterr().err
