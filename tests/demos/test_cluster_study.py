"""The demonstration of a study under mpirun."""

import os
import re
import shutil

import pytest
import xarray as xr
from demos.cluster_study import speed_and_load
from demos.cluster_study.gain import FREQUENCIES, gain, table
from demos.cluster_study.picture import draw
from demos.cluster_study.stopped import done, run
from tests.programs import environment

from fenics_gears.commands.cli import main

pytestmark = pytest.mark.ranks

FREQUENCIES_RUN, TORQUES_RUN = ["50 Hz", "210 Hz", "1000 Hz"], ["50 N m", "300 N m", "437 N m"]
CASES = 2 * len(FREQUENCIES_RUN) * len(TORQUES_RUN)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    if not shutil.which("mpirun"):
        pytest.skip("no mpirun")
    directory = tmp_path_factory.mktemp("cluster")
    text = speed_and_load.STUDY.read_text()
    for name, value in (
        ("scene", f'"{speed_and_load.STUDY.parents[1] / "lundvall2004.toml"}"'),
        ("accuracy.contact_nodes", '26\naccuracy.element = "P1"\naccuracy.flank_element_size = "0.12 mm"'),
        ("accuracy.steps_per_mesh_cycle", "320"),  # cases last until the signal arrives
        ("load.wheel_torque", str(TORQUES_RUN).replace("'", '"')),
        ("motion.mesh_frequency", str(FREQUENCIES_RUN).replace("'", '"')),
    ):
        text, count = re.subn(rf"^{re.escape(name)} = .*$", f"{name} = {value}", text, flags=re.MULTILINE)
        assert count == 1
    (directory / "study.toml").write_text(text)
    return directory


@pytest.fixture(scope="module")
def stopped(folder):
    """Exit code and cases of the study that was stopped after its first case, and exit code of the one that went on."""
    with pytest.MonkeyPatch.context() as patched:
        clean = environment()
        for name in set(os.environ) - set(clean):
            patched.delenv(name)
        for name, value in clean.items():
            patched.setenv(name, value)
        first = run(folder / "study.toml", folder / "out", 2, stop_after=1)
        kept = done(folder / "out")
        return first, kept, run(folder / "study.toml", folder / "out", 2)


@pytest.mark.nightly
def test_a_stopped_study_goes_on_and_ends_like_one_alone(folder, stopped):
    """Exact identity; exit code 130 (docs/promises.md)."""
    first, kept, second = stopped
    assert first == 130 and 1 <= kept < CASES
    assert second == 0 and done(folder / "out") == CASES
    assert main(["study", str(folder / "study.toml"), "--output", str(folder / "alone"), "--quiet"]) == 0
    together, alone = (
        xr.open_dataset(folder / name / "study.nc", engine="h5netcdf").load() for name in ("out", "alone")
    )
    assert together.drop_vars("wall_time").equals(alone.drop_vars("wall_time"))


@pytest.mark.nightly
def test_picture_and_table_show_it(folder, stopped):
    """Axes with units; a row for each torque."""
    pictures = speed_and_load.shown(folder / "out")
    assert {path.name for path in pictures} == {speed_and_load.PICTURE, speed_and_load.TABLE}
    found = gain(folder / "out" / "study.nc")
    maps = [axes for axes in draw(found).axes if axes.get_title(loc="left")]
    assert len(maps) == 3
    assert maps[0].get_ylabel() == "Torque on the wheel (N m)" and all(
        axes.get_xlabel() == "Mesh frequency (Hz)" for axes in maps
    )
    rows = table(found).splitlines()
    assert len(rows) == 2 + len(TORQUES_RUN) and len(FREQUENCIES) >= 4
    assert f"{found.with_relief[2, 0]:.1f} / {found.without_relief[2, 0]:.1f}" in rows[-1]
