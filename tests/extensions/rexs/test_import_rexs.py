"""`gears import`."""

import shutil

import pytest
from tests.conftest import DEMOS
from tests.extensions.rexs import paper_model as rexs

from fenics_gears import load_scene
from fenics_gears.commands.cli import main


@pytest.fixture
def here(tmp_path, monkeypatch):
    shutil.copy(DEMOS / "lundvall2004.rexs", tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_scene_is_written_beside_nothing_else_and_can_be_checked(here, paper_scene, capsys):
    """Every field says where it is from, and `gears check` takes the scene."""
    assert main(["import", "lundvall2004.rexs"]) == 0
    assert sorted(path.name for path in here.iterdir()) == ["lundvall2004.rexs", "lundvall2004.toml"]
    said = capsys.readouterr().out
    assert "component 5 (cylindrical_gear 'pinion') drives component 6 (cylindrical_gear 'wheel')" in said
    assert "Next: gears check lundvall2004.toml" in said and "motion.mesh_cycles = 1" in said
    assert load_scene("lundvall2004.toml").gears == paper_scene.gears
    fields = [
        line for line in (here / "lundvall2004.toml").read_text().splitlines() if " = " in line and line[0] not in "#t["
    ]
    assert len(fields) > 15 and all("  # " in line for line in fields)
    assert main(["check", "lundvall2004.toml"]) == 0


def test_options(here, capsys):
    """Another name, another load; --quiet tells nothing."""
    load = ["--wheel-torque", "500 N m", "--pinion-speed", "3000 rpm"]
    assert main(["import", "lundvall2004.rexs", "-o", "new/pair.toml", *load, "--quiet"]) == 0
    scene = load_scene("new/pair.toml")
    assert (
        scene.load.wheel_torque == 500e3
        and scene.motion.mesh_frequency == pytest.approx(800.0)
        and capsys.readouterr().out == ""
    )


def test_a_scene_is_never_overwritten(here, capsys):
    """It may hold the user's work."""
    (here / "lundvall2004.toml").write_text("mine")
    assert main(["import", "lundvall2004.rexs"]) == 2
    assert (here / "lundvall2004.toml").read_text() == "mine" and "exists already" in capsys.readouterr().err


@pytest.mark.parametrize(
    "change, words",
    [
        ((rexs.PINION, "number_of_teeth", 2), ["gears.pinion.teeth = 2", "The pinion is component 5"]),
        (
            (rexs.PINION, "root_diameter", 50.0, "mm"),
            ["file.rexs as a scene: pinion: ", "root_diameter", "The pinion is component 5"],
        ),
        ((rexs.STAGE, "center_distance", 70.0, "mm"), ["file.rexs as a scene: pair: ", "Nothing was written."]),
        ((rexs.PINION, "normal_module", 4.5, "kg"), ["normal_module = 4.5 kg is a mass"]),
    ],
)
def test_gears_that_cannot_be_are_refused_and_nothing_is_written(here, capsys, change, words):
    """The scene's own checks, and whose gear is meant."""
    (here / "file.rexs").write_bytes(rexs.as_xml(rexs.with_value(rexs.paper_model(), *change)))
    assert main(["import", "file.rexs"]) == 2
    said = capsys.readouterr().err
    assert all(each in said for each in words) and not (here / "file.toml").exists()


def test_names_are_checked_before_anything_is_read(here, capsys):
    """A scene is a .toml file; an archive's two endings are no part of its name."""
    assert main(["import", "none.rexs", "-o", "pair.txt"]) == 2
    assert "a scene is a .toml file" in capsys.readouterr().err
    (here / "pair.rexs.zip").write_bytes(rexs.as_zip(("model.rexs", (here / "lundvall2004.rexs").read_bytes())))
    assert main(["import", "pair.rexs.zip", "-q"]) == 0 and (here / "pair.toml").exists()
