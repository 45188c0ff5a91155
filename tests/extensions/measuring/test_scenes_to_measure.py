"""`gears accuracy` and `gears effects` of trains, and of scenes with a target."""

import pytest
from tests.paper_text import coarse_text
from tests.trains import COARSE, gearbox_file

from fenics_gears.commands.cli import main

LOAD = f'[load]\noutput_torque = "400 N m"\n[accuracy]\n{COARSE}\n'


@pytest.mark.nightly
def test_stages_are_measured_one_by_one(tmp_path, capsys):
    """A table and a picture for each stage of two gears, and the standard error says so."""
    assert main(["effects", str(gearbox_file(tmp_path)), "-o", str(tmp_path / "out")]) == 0
    assert "Each stage of two gears by itself" in capsys.readouterr().err
    for name in ("first", "second"):
        assert (tmp_path / "out" / name / "effects.csv").is_file()


def test_rows_with_idlers_are_not_measured(tmp_path, capsys):
    """Before anything is computed, with what can be done."""
    path = tmp_path / "idler.toml"
    gear = '{ teeth = 24, profile_shift = 0, bore_diameter = "30 mm" }'
    text = '[stages.a]\nkind = "row"\nmodule = "3 mm"\npressure_angle = "20 deg"\nface_width = "30 mm"\n'
    path.write_text(f'{text}gears = [{gear}, {gear}, {gear}]\nmaterial = "steel"\n{LOAD}')
    assert main(["accuracy", str(path)]) == 2
    assert "computed together (a)" in capsys.readouterr().err


def test_settings_are_wanted_as_they_stand(tmp_path, capsys):
    """`gears accuracy` and `gears effects` turn settings themselves."""
    text = coarse_text(accuracy='[accuracy]\ntarget = "10 %"\n')
    (tmp_path / "scene.toml").write_text(text)
    for command in ("accuracy", "effects"):
        assert main([command, str(tmp_path / "scene.toml"), "--output", str(tmp_path)]) == 2
        assert "leave accuracy.target out" in capsys.readouterr().err
