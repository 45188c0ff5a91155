"""gears picture."""

import numpy as np
import pytest
from matplotlib.image import imread
from tests.coarse import coarse_scene
from tests.paper_text import COARSE, coarse_text
from tests.programs import python

from fenics_gears import results, scene_from_text
from fenics_gears.commands.cli import main
from fenics_gears.system import environment

environment.prepare()


@pytest.fixture(scope="module")
def run(paper_scene, tmp_path_factory):
    from fenics_gears.runs.simulate import simulate

    directory = tmp_path_factory.mktemp("run")
    scene = scene_from_text(coarse_text(cycles=1, recorded=1, accuracy=COARSE))
    assert scene.accuracy == coarse_scene(paper_scene).accuracy
    results.save(simulate(scene), directory / "run.nc")
    return directory


@pytest.fixture(scope="module")
def picture(run):
    assert main(["picture", str(run), "--at", "0.25", "--quiet"]) == 0
    return imread(run / "stress.png")[..., :3]


def part(picture, place):
    """Pixels of a panel: left, bottom, width, height in parts of the figure."""
    height, width = picture.shape[:2]
    left, bottom, wide, high = place
    return picture[
        round(height * (1 - bottom - high)) : round(height * (1 - bottom)),
        round(width * left) : round(width * (left + wide)),
    ]


def strongly_coloured(pixels):
    """Hues of the upper half of the scale."""
    return pixels[..., 0] - pixels[..., 2] > 0.35


def test_picture_is_whole_and_colours_are_where_the_stress_is(picture):
    """Two tooth pairs touch at a quarter of the mesh cycle, on the line of action; bores, rims and far tips are
    pale."""
    assert picture.shape == (900, 1600, 3)
    enlarged = part(picture, (0.735, 0.36, 0.19, 0.49))
    coloured = np.argwhere(strongly_coloured(enlarged)) / enlarged.shape[:2]
    assert len(coloured) > 500 and np.abs(np.median(coloured, axis=0) - 0.5).max() < 0.15
    teeth = strongly_coloured(part(picture, (0.325, 0.06, 0.40, 0.79)))
    rows, columns = np.nonzero(teeth)
    assert 20 < len(rows) < 0.02 * teeth.size
    # Along the line of action, which falls to the right by the operating pressure angle.
    slope = np.polyfit(columns, rows, 1)[0]
    assert np.degrees(np.arctan(slope)) == pytest.approx(22.44, abs=4.0)
    whole = part(picture, (0.015, 0.06, 0.30, 0.79))
    assert (
        not strongly_coloured(whole)[: whole.shape[0] // 4].any()
        and not strongly_coloured(whole)[whole.shape[0] * 2 // 3 :].any()
    )


@pytest.fixture
def parted(run, tmp_path):
    dataset = results.load(run / "run.nc")
    forces = [name for name in dataset if "force" in name or "pressure" in name or "traction" in name]
    results.save(
        dataset.assign({name: dataset[name].copy(data=0.0 * dataset[name].values) for name in forces}),
        tmp_path / "run.nc",
    )


@pytest.mark.nightly
def test_teeth_that_have_parted_are_drawn_without_stress(parted, tmp_path):
    """No forces: bodies in the colour of zero."""
    assert main(["picture", str(tmp_path), "--at", "0.25", "--quiet"]) == 0
    found = imread(tmp_path / "stress.png")[..., :3]
    assert not strongly_coloured(part(found, (0.015, 0.06, 0.90, 0.79))).any()


@pytest.mark.nightly
def test_teeth_that_have_parted_move(parted, tmp_path, monkeypatch):
    """Also for ParaView."""
    from fenics_gears.show import stress_animation

    monkeypatch.setattr(stress_animation, "FRAMES_PER_CYCLE", 2)
    assert main(["picture", str(tmp_path), "--animate", "--pvd", str(tmp_path / "turn.pvd"), "--quiet"]) == 0
    assert (tmp_path / "stress.gif").is_file() and len(list(tmp_path.glob("turn_*.vtu"))) == 2


def test_animation_goes_through_the_cycle_once(run, tmp_path, monkeypatch):
    """Frames of one size, which differ; the last is not the first again."""
    image = pytest.importorskip("PIL.Image")
    from fenics_gears.show import stress_animation

    monkeypatch.setattr(stress_animation, "FRAMES_PER_CYCLE", 3)
    monkeypatch.setattr(stress_animation, "SAMPLED", 1)
    assert main(["picture", str(run), "--animate", "--output", str(tmp_path / "turn.gif"), "--quiet"]) == 0
    with image.open(tmp_path / "turn.gif") as moving:
        assert (moving.n_frames, moving.size) == (3, (960, 540))
        frames = []
        for number in range(3):
            moving.seek(number)
            frames.append(np.asarray(moving.convert("RGB"), dtype=int))
    assert min(np.abs(frames[a] - frames[b]).max() for a, b in ((0, 1), (1, 2), (0, 2))) > 100
    # The colours of stress survive the palette: what is red in the first frame.
    assert np.count_nonzero(strongly_coloured(frames[0] / 255.0)) > 500
    assert stress_animation.frame_steps(results.load(run / "run.nc")) == [0, 13, 27]


@pytest.mark.parametrize(("options", "said"), [
    (["--at", "1.5"], "stored mesh cycles 0 to 1"),
    (["--at", "nan"], "stored mesh cycles 0 to 1"),
    (["--output", "stress.jpg"], ".png"),
    (["--animate", "--output", "turn.png"], ".gif or a .mp4"),
    (["--vtu", "gears.vtk"], ".vtu"),
])  # fmt: skip
def test_calls_that_make_no_sense_are_refused(run, tmp_path, monkeypatch, capsys, options, said):
    """Exit code 2, the remedy said, nothing written."""
    monkeypatch.chdir(tmp_path)
    before = sorted(run.iterdir())
    assert main(["picture", str(run), *options]) == 2
    assert said in capsys.readouterr().err
    assert not list(tmp_path.iterdir()) and sorted(run.iterdir()) == before


def test_command_line_does_not_load_vtk():
    """What a command takes is told without what it draws with."""
    code = (
        "import sys, fenics_gears, fenics_gears.commands.cli; from fenics_gears.commands import picture;"
        " print('pyvista' in sys.modules, 'vtkmodules' in sys.modules)"
    )
    assert python("-c", code).stdout.split() == ["False", "False"]
