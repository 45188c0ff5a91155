"""Runs and a study on coarse meshes, made by commands."""

import pytest
from tests.paper_text import coarse_text

from fenics_gears.commands.cli import main
from fenics_gears.show.pages import rendering
from fenics_gears.system import environment

environment.prepare()

DRAWN = "Normal force of the mesh"


@pytest.fixture(scope="session")
def made(tmp_path_factory):

    def make(text, name):
        directory = tmp_path_factory.mktemp(name)
        (directory / f"{name}.toml").write_text(text)
        assert (
            main(
                ["run", str(directory / f"{name}.toml"), "--output", str(directory / "run"), "--quiet", "--no-pictures"]
            )
            == 0
        )
        return directory / "run"

    return make


@pytest.fixture(scope="session")
def run(made):
    return made(coarse_text(more="[output]\nroot_stress = true\n", recorded=1), "dynamic")


@pytest.fixture(scope="session")
def report(run, request):
    """The page of that run; by day one of its charts is drawn as an image."""
    draw, by_night = rendering.still, request.config.option.markexpr == "nightly"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rendering, "still", lambda each: draw(each) if by_night or each.caption == DRAWN else b"<svg/>")
        assert main(["report", str(run), "--quiet"]) == 0
    return run / "report.html"


@pytest.fixture
def without_stills(monkeypatch):
    monkeypatch.setattr(rendering, "still", lambda chart: b"<svg/>")


@pytest.fixture(scope="session")
def study(tmp_path_factory):
    directory = tmp_path_factory.mktemp("study")
    (directory / "pair.toml").write_text(coarse_text(recorded=1))
    sweep = '[sweep]\nmotion.mesh_frequency = ["100 Hz", "200 Hz", "300 Hz"]\nfriction = ["absent", "present"]\n'
    (directory / "study.toml").write_text('title = "Three speeds <i>"\nscene = "pair.toml"\n' + sweep)
    assert main(["study", str(directory / "study.toml"), "--output", str(directory / "out"), "--quiet"]) == 0
    return directory / "out"
