"""Runs and a study on coarse meshes, made by commands."""

import pytest

from fenics_gears.commands.cli import main
from fenics_gears.show.report import rendering
from fenics_gears.system import environment

environment.prepare()

DRAWN = "Normal force of the mesh"
COARSE = """[accuracy]
element = "P1"
flank_element_size = "0.3 mm"
contact_length = "2.4 mm"
contact_nodes = 9
steps_per_mesh_cycle = 20
"""


def scene_text(paper_scene, *, without=(), more="", cycles=2):
    """The paper's scene on a coarse mesh, less some sections, with more of them before the accuracy."""
    head = paper_scene.text[: paper_scene.text.index("[accuracy]")]
    head = head.replace("mesh_cycles = 30", f"mesh_cycles = {cycles}").replace(
        "recorded_cycles = 2", "recorded_cycles = 1"
    )
    parts = head.split("\n[")
    kept = [part for part in parts if part.partition("]")[0] not in without]
    return "\n[".join(kept).rstrip("#\n ") + f"\n\n{more}\n{COARSE}"


@pytest.fixture(scope="session")
def made(tmp_path_factory):
    """Runs a scene's text and returns the run's directory."""

    def make(text, name):
        directory = tmp_path_factory.mktemp(name)
        (directory / f"{name}.toml").write_text(text, encoding="utf-8")
        assert (
            main(
                ["run", str(directory / f"{name}.toml"), "--output", str(directory / "run"), "--quiet", "--no-pictures"]
            )
            == 0
        )
        return directory / "run"

    return make


@pytest.fixture(scope="session")
def run(made, paper_scene):
    return made(scene_text(paper_scene, more="[output]\nroot_stress = true\n"), "dynamic")


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
    """Charts have an empty image, which takes less time."""
    monkeypatch.setattr(rendering, "still", lambda chart: b"<svg/>")


@pytest.fixture(scope="session")
def study(paper_scene, tmp_path_factory):
    directory = tmp_path_factory.mktemp("study")
    (directory / "pair.toml").write_text(scene_text(paper_scene), encoding="utf-8")
    sweep = '[sweep]\nmotion.mesh_frequency = ["100 Hz", "200 Hz", "300 Hz"]\nfriction = ["absent", "present"]\n'
    (directory / "study.toml").write_text('title = "Three speeds <i>"\nscene = "pair.toml"\n' + sweep, encoding="utf-8")
    assert main(["study", str(directory / "study.toml"), "--output", str(directory / "out"), "--quiet"]) == 0
    return directory / "out"
