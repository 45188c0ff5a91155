"""Random fields of studies: what their samples are, how they are combined, and their quantiles."""

from pathlib import Path

import numpy as np
import pytest
from scipy.stats import kstest
from tests.planets import planetary_text
from tests.studies.conftest import write_study

from fenics_gears import simulate_train
from fenics_gears.commands.cli import main
from fenics_gears.errors import SceneError
from fenics_gears.model import train_parts
from fenics_gears.model.model import model_of
from fenics_gears.model.train import _KNOWN_OF_SETS, train_model_of
from fenics_gears.runs.gear_store import GearStore
from fenics_gears.runs.train import train_completed
from fenics_gears.scene.planetary import _scene_read
from fenics_gears.simulation import train as train_simulation
from fenics_gears.studies.combine import load_combined
from fenics_gears.studies.quantiles import QUANTILES
from fenics_gears.studies.random_values import sampled
from fenics_gears.studies.study_file import load_study
from fenics_gears.system.progress import SilentProgress

PINS = ("stages", "set", "carrier", "pin_errors")
NORMAL = {"distribution": "normal", "mean": "1 um", "deviation": "10 um", "count": 2000, "seed": 7, "entries": 3}
TORQUE = 'load.wheel_torque = { distribution = "uniform", start = "90 N m", stop = "110 N m", count = 3, seed = 1 }\n'
SHIFT = 'gears.pinion.profile_shift = { distribution = "normal", mean = 0.1, deviation = 0.01, count = 3, seed = 1 }\n'


def numbers(values) -> np.ndarray:
    return np.array([[float(entry.removesuffix(" um")) for entry in value] for value in values])


def test_samples_have_their_distribution():
    """Kolmogorov and Smirnov's test against the distribution itself; entries are not correlated beyond chance."""
    found = numbers(sampled(PINS, NORMAL))
    assert found.shape == (2000, 3)
    assert kstest(found.ravel(), "norm", (1.0, 10.0)).pvalue > 0.01
    assert np.abs(np.corrcoef(found.T) - np.eye(3)).max() < 4.0 / np.sqrt(2000)
    uniform = {"distribution": "uniform", "start": "-5 um", "stop": "0.01 mm", "count": 2000, "seed": 7, "entries": 1}
    assert kstest(numbers(sampled(PINS, uniform)).ravel(), "uniform", (-5.0, 15.0)).pvalue > 0.01


def test_pitches_of_each_gear_close():
    """They sum to zero around each gear, and else are as they were drawn: so many times less one the variance."""
    path = ("stages", "set", "pitch_errors", "planets")
    found = numbers(sampled(path, NORMAL | {"entries": [3, 22]})).reshape(-1, 3, 22)
    assert np.abs(found.sum(axis=-1)).max() < 1e-8
    assert (found**2).mean() == pytest.approx(100.0 * 21 / 22, rel=0.01)


def test_samples_are_those_of_their_seed():
    """The same again with the same seed, others with another one or of another field."""
    first = numbers(sampled(PINS, NORMAL))
    assert np.array_equal(first, numbers(sampled(PINS, NORMAL)))
    others = (numbers(sampled(PINS, NORMAL | {"seed": 8})), numbers(sampled((*PINS[:-1], "radial_pin_errors"), NORMAL)))
    for other in others:
        assert abs(np.corrcoef(first.ravel(), other.ravel())[0, 1]) < 4.0 / np.sqrt(6000)
    # More samples begin with the same ones.
    assert np.array_equal(first[:5], numbers(sampled(PINS, NORMAL | {"count": 5})))


def test_random_fields_vary_together_for_each_value_of_others(folder):
    """One dimension for all samples, inside the product of the other fields."""
    text = f'[sweep]\n{TORQUE}motion.mesh_frequency = ["100 Hz", "200 Hz"]\n{SHIFT}'
    study = load_study(write_study(folder, text))
    assert study.dimensions == ("mesh_frequency", "sample") and study.shape == (2, 3)
    said = [
        (case.scene.motion.mesh_frequency, case.scene.load.wheel_torque, case.scene.gears.pinion.profile_shift)
        for case in study.cases
    ]
    assert [each[0] for each in said] == [100.0] * 3 + [200.0] * 3
    assert [each[1:] for each in said[:3]] == [each[1:] for each in said[3:]]
    assert len({each[1:] for each in said}) == 3


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"distribution": "gauss"}, 'distribution "gauss".*Allowed: "normal"'),
        ({"deviation": "0 um"}, "deviation .*above zero"),
        ({"deviation": "1 N"}, "mixes"),
        ({"seed": None}, "has no seed"),
        ({"seed": -1}, "seed = -1.* whole number from 0"),
        ({"count": 1}, "count = 1.* from 2"),
        ({"entries": None}, "has no entries"),
        ({"sigma": "1 um"}, '"sigma", which a normal distribution has not'),
    ],
)
def test_mistakes_in_a_distribution(folder, change, said):
    """Each with what is allowed."""
    (folder / "set.toml").write_text(planetary_text())
    table = {name: value for name, value in (NORMAL | change).items() if value is not None}
    written = ", ".join(
        f'{name} = "{value}"' if isinstance(value, str) else f"{name} = {value}" for name, value in table.items()
    )
    study = folder / "study.toml"
    study.write_text(f'scene = "set.toml"\n[sweep]\n{".".join(PINS)} = {{ {written} }}\n')
    with pytest.raises(SceneError, match=f"(?s)sweep.*{said}"):
        load_study(study)


def test_numbers_of_samples_that_differ(folder):
    """Samples that vary together are as many of each field."""
    text = f"[sweep]\n{TORQUE}{SHIFT.replace('count = 3', 'count = 4')}"
    with pytest.raises(SceneError, match="as many samples of each random field"):
        load_study(write_study(folder, text))


def test_quantiles_of_a_set(folder, monkeypatch, capsys):
    """numpy's quantiles of the cases that the dataset has; K_gamma in table and picture. The same errors share more
    evenly under more torque."""
    monkeypatch.chdir(folder)
    more = 'carrier = { pin_stiffness = "3e5 N/mm" }'
    text = planetary_text(teeth=(20, 16, 52), planets="planets = 4", more=more, accuracy=SETTLED)
    Path("set.toml").write_text(text)
    pins = '{ distribution = "normal", mean = "0 um", deviation = "10 um", count = 3, seed = 1, entries = 4 }'
    Path("study.toml").write_text(f'scene = "set.toml"\n[sweep]\n{".".join(PINS)} = {pins}\n{TORQUES}')
    assert main(["study", "study.toml"]) == 0
    found = load_combined(folder / "results" / "study" / "study.nc")
    sharing = found["load_sharing_factor"]
    assert sharing.dims == ("input_torque", "sample") and (sharing > 1.0).all()
    np.testing.assert_allclose(
        found["quantiles_of_load_sharing_factor"].T, np.quantile(sharing, QUANTILES, axis=1), rtol=1e-14
    )
    assert (sharing[1] < sharing[0]).all()
    assert (folder / "results" / "study" / "load_sharing_factor.png").is_file()
    assert "quantiles 5 / 50 / 95 %" in capsys.readouterr().out


SETTLED = 'steps_per_mesh_cycle = 4\nflank_element_size = "0.5 mm"\ncontact_length = "3 mm"'
TORQUES = 'load.input_torque = ["500 N m", "600 N m"]\n'


def test_cases_that_differ_in_errors_share_the_pairs_of_their_set(folder, monkeypatch):
    """Count: the two pairs of all cases are read and modelled once, beside those of the base scene; a model by itself
    is the same."""
    Path("set.toml").write_text(planetary_text((20, 16, 52), "planets = 3", accuracy=SETTLED))
    pitches = '{ distribution = "normal", mean = "0 um", deviation = "3 um", entries = [3, 16], count = 101, seed = 1 }'
    Path("study.toml").write_text(
        f'scene = "set.toml"\n[sweep]\nstages.set.pitch_errors.planets = {pitches}\n'
        'stages.set.eccentricity.sun.distance = { distribution = "uniform", start = "1 um", stop = "9 um", count = 101,'
        " seed = 1 }\n"
    )
    _scene_read.cache_clear()
    _KNOWN_OF_SETS.clear()
    modelled = []
    monkeypatch.setattr(train_parts, "model_of", lambda scene: modelled.append(scene) or model_of(scene))
    progress = SilentProgress()
    stages: list[str] = []
    monkeypatch.setattr(progress, "stage", stages.append)
    study = load_study("study.toml", progress)
    assert stages == ["validate cases"]
    assert _scene_read.cache_info().misses == 4
    assert len(modelled) == 6
    last = study.cases[-1].model
    _KNOWN_OF_SETS.clear()
    alone = train_model_of(last.scene)
    for one, other in zip(last.models, alone.models):
        assert one.scene == other.scene and one.resolution == other.resolution


@pytest.mark.parametrize(
    ("field", "sections"),
    [
        pytest.param(PINS, "", marks=pytest.mark.nightly),
        (PINS, "[friction]\ncoefficient = 0.05"),
        (("stages", "set", "eccentricity", "planets", "distance"), ""),
    ],
)
def test_cases_whose_gaps_differ_share_their_contact_equations(folder, monkeypatch, field, sections):
    """Exact identity with runs by themselves, with and without friction; operators are built once."""
    monkeypatch.chdir(folder)
    made = []
    built = train_simulation.row_cycle
    monkeypatch.setattr(train_simulation, "row_cycle", lambda *given: made.append(1) or built(*given))
    more = 'carrier = { pin_stiffness = "3e5 N/mm" }\nfloating = ["sun"]'
    text = planetary_text((20, 16, 52), "planets = 3", more=more, accuracy=SETTLED, sections=sections)
    Path("set.toml").write_text(text)
    own = '{ distribution = "uniform", start = "0 um", stop = "9 um", count = 3, seed = 1, entries = 3 }'
    Path("study.toml").write_text(f'scene = "set.toml"\n[sweep]\n{".".join(field)} = {own}\n')
    cases = load_study("study.toml").cases
    store = GearStore()
    found = [train_completed(case.model, store).dataset for case in cases]
    assert len(made) == 1
    for case, one in zip(cases, found):
        alone = simulate_train(case.model.scene)
        for name in ("overall_transmission_error", "pin_force", "normal_force"):
            assert np.array_equal(one[name], alone[name])
