"""The paper's gallery: its studies load and say what the figures need; a fast part of its claims (model.md, section
6)."""

import re
from pathlib import Path

import numpy as np
import pytest
from demos.lundvall2004 import claims
from demos.lundvall2004.gallery import run_one
from demos.lundvall2004.measured import BASE_SCENE, PRINTED, READ, WITH, WITHOUT, Measured, study_files

from fenics_gears.studies.study_file import load_study

STUDIES = study_files()


@pytest.fixture(scope="module")
def loaded():
    """Every study of the folder, each case's scene and geometry found right by the loader."""
    return {name: load_study(path) for name, path in STUDIES.items()}


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """Results of the small studies, and of Fig. 9 at five depths, none included."""
    directory = tmp_path_factory.mktemp("gallery")
    depths = '"1e-6 um", "20 um", "28 um", "31 um", "36 um"'
    files = {name: STUDIES[name] for name in ("figure02", "figure04", "figure05", "figure08", f"{PRINTED}figure05")}
    files |= {
        name: _reduced(STUDIES[name], "tip_relief.depth", depths, directory)
        for name in ("figure09_static", "figure09_dynamic")
    }
    files["undamped"] = _reduced(STUDIES["undamped"], "motion.mesh_frequency", '"215 Hz"', directory)
    for name, file in files.items():
        code, words, _ = run_one(file, directory / name)
        assert code == 0, words
    return Measured(directory)


def _reduced(file: Path, field: str, values: str, directory: Path) -> Path:
    """The study with fewer values of a swept field."""
    text = re.sub(rf"{re.escape(field)} = \[[^]]*\]", f"{field} = [{values}]", file.read_text())
    text = re.sub(r'scene = "[^"]*"', f'scene = "{BASE_SCENE}"', text)
    (directory / file.name).write_text(text)
    return directory / file.name


def _swept(study, name):
    return next(axis.coordinate() for axis in study.axes if axis.name == name)


@pytest.mark.nightly
@pytest.mark.parametrize("reading", [READ, PRINTED])
@pytest.mark.parametrize("figure", ["06", "10"])
def test_frequency_sweeps_are_dense_and_run_long_enough(loaded, reading, figure):
    """At least 60 frequencies, rising; each run lasts until the drivetrain's slowest motion has decayed to 0.1 %
    (damped eigenvalues)."""
    slowest = {READ: 317.0, PRINTED: 2500.0}[reading]  # 1/s, with one tooth pair in mesh
    frequencies = []
    for band in ("low", "high"):
        study = loaded[f"{reading}figure{figure}_{band}"]
        frequencies += list(_swept(study, "mesh_frequency"))
        for case in study.cases:
            motion = case.scene.motion
            settling = (motion.mesh_cycles - motion.recorded_cycles) / motion.mesh_frequency
            assert np.exp(-slowest * settling) < 1e-3
            assert (case.scene.tip_relief is not None) == (figure == "10")
    assert len(frequencies) >= 60 and np.all(np.diff(frequencies) > 0)
    assert frequencies[0] <= 10.0 and frequencies[-1] >= 4000.0


@pytest.mark.nightly
def test_claim_5_shape_is_kept_at_200_hz_and_the_frictionless_curve_lags(measured):
    """Fig. 5; holds with J as we read it and not as printed (model.md, section 5)."""
    static = measured.study("figure02")
    assert claims.claim_5(static, measured.study("figure05")).verdict == claims.HELD
    assert claims.claim_5(static, measured.study(f"{PRINTED}figure05")).verdict != claims.HELD


@pytest.mark.nightly
def test_claim_7_friction_of_the_modified_pair_passes_smoothly(measured):
    """Fig. 8: within 0.02 cycles R_y1 changes by less than 15 % of mu T2/rb2; the unmodified pair's by more than twice
    as much."""
    unmodified, modified = (measured.run(name, friction=WITH) for name in ("figure04", "figure08"))
    assert claims.claim_7(unmodified, modified).verdict == claims.HELD
    assert claims.sudden_change(unmodified) > 2.0 * claims.sudden_change(modified)


@pytest.mark.nightly
def test_claim_8_the_best_depth_is_near_30_um(measured):
    """Fig. 9: of 0, 20, 28, 31 and 36 um the best lies within 30 +- 5 um, static and at 200 Hz."""
    static, dynamic = measured.study("figure09_static"), measured.study("figure09_dynamic")
    for curve, friction in ((static, WITHOUT), (dynamic, WITHOUT), (dynamic, WITH)):
        assert 25.0 <= claims.best_depth(curve, friction) <= 31.0


@pytest.mark.nightly
def test_claim_9_relief_gains_less_with_friction(measured):
    """Figs. 9, 10: the share of T_EPP that 31 um take away is smaller with friction, static and at 200 Hz."""
    for name in ("figure09_static", "figure09_dynamic"):
        error = measured.study(name).peak_to_peak_transmission_error
        gain = 1.0 - error.sel(depth=31.0) / error.isel(depth=0)
        assert 0.0 < gain.sel(friction=WITH) < gain.sel(friction=WITHOUT)


@pytest.mark.nightly
def test_claim_10_contact_is_lost_without_damping(measured):
    """Section 5: near the first torsional mode the teeth separate by more than the backlash, and the program says
    so."""
    for text in measured.study("undamped").warnings.values.ravel():
        assert "coast flanks would touch" in text
    run = measured.run("undamped", mesh_frequency=215.0, friction=WITHOUT)
    assert np.any(run.closed_nodes.values == 0)
