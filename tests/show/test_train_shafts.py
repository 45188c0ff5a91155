"""Pictures and report of a train whose shafts bend."""

from tests.trains import bent_two_stages

from fenics_gears.commands.cli import main


def test_shafts_are_drawn_and_their_bearings_listed(tmp_path, capsys):
    """A user's expectation: a picture of the shafts, line loads of both meshes, a table of all bearings in the report,
    the largest force of a bearing in the summary."""
    scene = tmp_path / "bent.toml"
    scene.write_text(bent_two_stages().text)
    out = tmp_path / "out"
    assert main(["run", str(scene), "-o", str(out)]) == 0
    assert "largest force of a bearing" in capsys.readouterr().out
    assert {"shafts.png", "line_load.png"} < {each.name for each in out.iterdir()}
    assert main(["report", str(out), "-q"]) == 0
    page = (out / "report.html").read_text()
    assert "Shaft middle: first.wheel at 35 mm, second.pinion at 100 mm" in page
    assert "middle 1" in page
    assert "middle 2" in page
    capsys.readouterr()
