"""The demonstration of the Python interface, as a script and as a notebook."""

import re
import runpy
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib import pyplot
from matplotlib.image import imread
from tests.conftest import DEMOS
from tests.paper_text import COARSE, coarse_text

SCRIPT = DEMOS / "python_interface" / "first_steps.py"


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """Every name of the script after it has run beside a coarse scene, and its folder."""
    folder = tmp_path_factory.mktemp("checkout")
    (folder / "demos").mkdir()
    (folder / "demos" / "lundvall2004.toml").write_text(coarse_text(cycles=30, accuracy=COARSE))
    with pytest.MonkeyPatch.context() as patched:
        patched.chdir(folder)
        patched.setenv("MPLBACKEND", "agg")
        patched.setattr(sys, "path", list(sys.path))
        yield runpy.run_path(str(SCRIPT)), folder
    pyplot.close("all")


def cells():
    """Cells by the format that Jupytext and VS Code share: (title, text) from each `# %%`."""
    parts = re.split(r"^# %%(.*)\n", SCRIPT.read_text(), flags=re.MULTILINE)
    assert parts[0] == ""
    return list(zip((title.strip() for title in parts[1::2]), parts[2::2]))


def test_it_opens_as_a_notebook():
    """Jupytext's documentation: a text cell is comments throughout."""
    kinds = [title for title, _ in cells()]
    assert set(kinds) == {"", "[markdown]"} and kinds.count("") >= 8 and kinds.count("[markdown]") >= 8
    for title, text in cells():
        if title == "[markdown]":
            assert all(line.startswith("#") for line in text.strip().splitlines())
        else:
            compile(text, "cell", "exec")


@pytest.mark.nightly
def test_results_are_those_that_it_speaks_of(ran):
    """The paper, Sections 5 and 6: friction raises the error at 200 Hz; resonance near 213 Hz; relief lowers it."""
    names, _ = ran
    with_friction, without = (names["micrometres"](names[run]) for run in ("result", "frictionless"))
    assert np.ptp(with_friction.values) > 1.1 * np.ptp(without.values)
    assert "friction_force" in names["result"] and "friction_force" not in names["frictionless"]
    study = names["study"]
    assert np.all(study.idxmax("mesh_frequency").isin([200, 210, 220])) and np.all(study.diff("torque") > 0.0)
    # The study's number is of extremes located between the steps, which the curve's steps miss by a little.
    assert float(study.sel(torque=437, mesh_frequency=200)) == pytest.approx(np.ptp(with_friction.values), rel=2e-3)
    assert np.ptp(names["micrometres"](names["relieved"]).values) < 0.75 * np.ptp(with_friction.values)


@pytest.mark.nightly
def test_pictures_and_the_kept_run_are_there(ran):
    """The run on disk is the one in memory, pictures are no empty pages."""
    names, folder = ran
    assert names["again"].identical(names["result"])
    pictures = sorted(path.name for path in Path(folder, "results", "python_interface").glob("*.png"))
    assert pictures == ["curves.png", "stress.png", "study_and_spectrum.png"]
    for name in pictures:
        assert np.ptp(imread(folder / "results" / "python_interface" / name)[..., :3]) > 0.5
