"""The scene that a result carries is the one that was run."""

import shutil
from dataclasses import replace
from pathlib import Path

import pytest
import xarray as xr
from tests.effects.examples import MESHES, scene_of

from fenics_gears import Load, Material, SceneError, carried_scene, load_scene
from fenics_gears.effects.body_meshes import BodyMeshes, MeshFile
from fenics_gears.results.carried_scene import scene_attributes
from fenics_gears.show.run import scene_of as scene_for_pictures

MEASURED = Path(__file__).parents[2] / "demos" / "flank_errors"


@pytest.fixture
def measured(tmp_path):
    shutil.copytree(MEASURED, tmp_path / "there")
    return load_scene(tmp_path / "there" / "measured.toml")


def result_of(scene) -> xr.Dataset:
    return xr.Dataset(attrs=scene_attributes(scene))


def test_a_changed_scene_is_carried_as_it_was_run(paper_scene):
    """Identity."""
    changed = replace(paper_scene, load=Load(0.5 * paper_scene.load.wheel_torque))
    result = result_of(changed)
    assert set(result.attrs) == {"scene", "scene_name"}
    assert carried_scene(result) == scene_for_pictures(result) == changed


def test_tables_are_found_again_from_elsewhere(measured, tmp_path, monkeypatch, caplog):
    """Identity."""
    result = result_of(replace(measured, load=Load(1e5)))
    monkeypatch.chdir(tmp_path)
    assert carried_scene(result) == replace(measured, load=Load(1e5)) and not caplog.records


def test_tables_that_have_changed_are_named(measured, caplog):
    """The hash of what was read: another number, and no file."""
    result, table = result_of(measured), Path(measured.folder) / "pinion.csv"
    lines = table.read_text().splitlines()
    cells = lines[-1].split(",")
    table.write_text("\n".join([*lines[:-1], ",".join([*cells[:-1], "0.7"])]))
    carried_scene(result)
    table.unlink()
    carried_scene(result)
    said = [record.getMessage() for record in caplog.records]
    assert len(said) == 2 and all(
        words.startswith("pinion.csv, which the scene names, is not what it was") and measured.folder in words
        for words in said
    )


def test_a_body_mesh_that_was_overwritten_is_named(tmp_path, caplog):
    """The hash of the file."""
    scene, own = scene_of("tooth_elasticity", "body_meshes"), tmp_path / "own.msh"
    shutil.copy(MESHES / "cracked_pinion.msh", own)
    scene = replace(scene, body_meshes=BodyMeshes(MeshFile(str(own), scene.body_meshes.pinion.digest), None))
    result = result_of(scene)
    assert carried_scene(result) == scene and not caplog.records
    own.write_bytes(b"another")
    carried_scene(result)
    assert str(own) in caplog.records[0].getMessage()
    # A scene whose mesh is gone before it is written down is given by no file.
    with pytest.raises(SceneError, match="No scene file gives this scene.*body_meshes"):
        carried_scene(result_of(replace(scene)))


def test_a_scene_that_no_file_gives_is_none_of_another_one(paper_scene):
    """Readers are refused in words, pictures go without a scene."""
    result = result_of(replace(paper_scene, gears=replace(paper_scene.gears, material=Material(206e3, -1.5))))
    with pytest.raises(SceneError, match=r"No scene file gives this scene, .*gears.*poissons_ratio = -1.5"):
        carried_scene(result)
    assert scene_for_pictures(result) is None
