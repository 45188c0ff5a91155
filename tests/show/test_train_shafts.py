"""Pictures of a train whose shafts bend."""

from tests.trains import bent_two_stages

from fenics_gears.commands.cli import main


def test_shafts_are_drawn(tmp_path, capsys):
    """A user's expectation: a picture of the shafts, line loads of both meshes, the largest force of a bearing in the
    summary."""
    scene = tmp_path / "bent.toml"
    scene.write_text(bent_two_stages().text)
    out = tmp_path / "out"
    assert main(["run", str(scene), "-o", str(out)]) == 0
    assert "largest force of a bearing" in capsys.readouterr().out
    assert {"shafts.png", "line_load.png"} < {each.name for each in out.iterdir()}
