"""The files of a run's pictures."""

import matplotlib
import numpy as np
import pytest
from matplotlib.image import imread
from tests.show.synthetic import BARE, made_up_run

from fenics_gears import ComputationError
from fenics_gears.show.plots import PICTURES, draw_run, run_figures

# Of a run shorter than a turn of the pinion, as the made-up one is; orders are drawn in test_spectrum.py.
OF_A_SHORT_RUN = set(PICTURES) - {"order_spectrum.png"}


@pytest.mark.parametrize("absent", [(), BARE])
def test_every_picture_is_written_whole_and_nothing_else(tmp_path, absent):
    """150 dots per inch over 10 inches, more than its ground."""
    files = draw_run(made_up_run().drop_vars(absent), tmp_path / "new")
    assert {file.name for file in files} == OF_A_SHORT_RUN == {file.name for file in (tmp_path / "new").iterdir()}
    for file in files:
        picture = imread(file)
        assert picture.shape[1] == 1500
        assert 0.005 < np.mean(picture[..., :3].min(axis=2) < 0.9) < 0.5


def test_a_failure_leaves_the_pictures_of_before_alone(tmp_path):
    """hard_cases.md, 27: never a half-written result under its final name."""
    before = {file: file.read_bytes() for file in draw_run(made_up_run(), tmp_path)}
    run = made_up_run()
    run["contact_pressure"].attrs["units"] = "mm"
    run["transmission_error"] = run["transmission_error"].copy(data=run["transmission_error"].values * 2)
    with pytest.raises(ComputationError, match="contact_pressure"):
        draw_run(run, tmp_path)
    assert {file: file.read_bytes() for file in tmp_path.iterdir()} == before


def test_an_incomplete_run_says_so_in_every_picture():
    """The attribute `complete`; cut after half of its 20 steps."""
    whole, cut = made_up_run(), made_up_run(complete=0).isel(time=slice(0, 11))
    for figure in run_figures(cut).values():
        assert "INCOMPLETE RUN: stopped at mesh cycle 29.00" in figure._suptitle.get_text()
    for figure in run_figures(whole).values():
        assert "INCOMPLETE" not in figure._suptitle.get_text()


def test_the_heading_names_scene_and_conditions(paper_scene):
    """The paper's scene: 437 N m, 200 Hz, friction 0.1."""
    for figure in run_figures(made_up_run(scene=paper_scene.text, title=paper_scene.title)).values():
        heading = figure._suptitle.get_text()
        assert paper_scene.title in heading
        assert "437 N m on the wheel, 200 Hz mesh frequency, friction coefficient 0.1" in heading
    ripple = '\n[torque_ripple]\nharmonics = [{ order = 1, amplitude = "20 N m" }]\n'
    for figure in run_figures(made_up_run(scene=paper_scene.text + ripple)).values():
        assert "friction coefficient 0.1, torque ripple" in figure._suptitle.get_text()


def test_a_users_matplotlib_settings_neither_matter_nor_change(tmp_path):
    """Byte for byte."""
    plain = [file.read_bytes() for file in draw_run(made_up_run(), tmp_path / "plain")]
    with matplotlib.rc_context(
        {"font.size": 40.0, "axes.facecolor": "black", "savefig.transparent": True, "lines.linewidth": 9.0}
    ):
        files = draw_run(made_up_run(), tmp_path / "own")
        assert matplotlib.rcParams["font.size"] == 40.0
    assert [file.read_bytes() for file in files] == plain
