"""gears listen: the curve's own frequencies at their own loudness."""

import numpy as np
import pytest
import xarray as xr
from scipy.io import wavfile
from scipy.signal import hilbert
from tests.planets import in_time
from tests.trains import two_stages

from fenics_gears import results, simulate_train
from fenics_gears.commands.cli import main
from fenics_gears.extensions.noise.sound import HEADROOM, SAMPLE_RATE, sound

MESH = 400.0


def run(values, time, phase=None, **attributes):
    return xr.Dataset(
        {
            "normal_force": ("time", values, {"units": "N", "long_name": "mesh force"}),
            "transmission_error": ("time", 1e-7 * values, {"units": "rad", "long_name": "transmission error"}),
        },
        {
            "time": ("time", time, {"units": "s"}),
            "mesh_phase": ("time", MESH * time if phase is None else phase, {"units": "1"}),
        },
        {"complete": 1, "scene": "title = 'synthetic'", **attributes},
    )


def steady(*tones, cycles=3, steps=300):
    time = np.arange(cycles * steps + 1) / (steps * MESH)
    return run(
        5000.0 + sum(amplitude * np.cos(2.0 * np.pi * frequency * time + 0.3) for frequency, amplitude in tones), time
    )


def lines(samples):
    """Amplitudes by frequency in Hz over a second in the middle."""
    middle = samples[SAMPLE_RATE // 2 : SAMPLE_RATE // 2 + SAMPLE_RATE]
    return 2.0 * np.abs(np.fft.rfft(middle)) / len(middle)


def test_tones_are_heard_at_their_frequency_and_amplitude():
    """Exact: two harmonics of the mesh and nothing else; the filter's passband is even within 0.2 %."""
    amplitudes = lines(sound(steady((MESH, 100.0), (12 * MESH, 10.0)), "normal_force", 2.0).samples)
    assert amplitudes[400] == pytest.approx(100.0, rel=2e-3) and amplitudes[4800] == pytest.approx(10.0, rel=2e-3)
    amplitudes[[400, 4800]] = 0.0
    assert amplitudes.max() < 0.01


def test_what_the_file_cannot_hold_is_filtered_out():
    """Exact: a tone of 30 kHz would be heard at 18 kHz; it is 54 dB down."""
    amplitudes = lines(sound(steady((5 * MESH, 10.0), (75 * MESH, 10.0), steps=3000), "normal_force", 2.0).samples)
    assert amplitudes[2000] == pytest.approx(10.0, rel=2e-3) and amplitudes[18000] < 0.02


def test_a_ramp_is_heard_as_it_runs():
    """Exact: a mesh frequency from 200 to 1000 Hz in 2 s; the frequency is the phase's derivative."""
    phase = np.arange(0.0, 1200.0 + 1e-9, 1.0 / 80.0)
    time = (-200.0 + np.sqrt(200.0**2 + 2.0 * 400.0 * phase)) / 400.0
    heard = sound(run(3000.0 + 50.0 * np.sin(2.0 * np.pi * phase), time, phase), "normal_force", 0.5).samples
    assert len(heard) == pytest.approx(2.0 * SAMPLE_RATE, abs=2)
    instant = np.gradient(np.unwrap(np.angle(hilbert(heard)))) * SAMPLE_RATE / (2.0 * np.pi)
    at = np.arange(len(heard)) / SAMPLE_RATE
    inside = (at > 0.2) & (at < 1.8)
    assert instant[inside] == pytest.approx(200.0 + 400.0 * at[inside], rel=0.02)


@pytest.mark.parametrize("set_or_train", [True, False])
def test_the_ramp_of_a_train_is_heard_once(tmp_path, set_or_train):
    """Definition: as long as its run, and what a pair's curve of the same values is."""
    ramp = '[speed_ramp]\nend_speed = "90000 rpm"\n'
    if set_or_train:
        scene = in_time(60000, 12, sections=f"[damping]\nratio = 0.05\n{ramp}")
    else:
        ends = f'[inertia]\ndensity = "7.85 g/cm^3"\n[motion]\ninput_speed = "60000 rpm"\nmesh_cycles = 12\n{ramp}'
        scene = two_stages(more=ends)
    found = simulate_train(scene)
    results.save(found, tmp_path / "run.nc")
    assert main(["listen", str(tmp_path), "-q"]) == 0
    _, samples = wavfile.read(tmp_path / "overall_transmission_error.wav")
    assert len(samples) == pytest.approx(found["time"].values[-1] * SAMPLE_RATE, abs=2)
    values = found["overall_transmission_error"].values
    alone = sound(run(values, found["time"].values, found["mesh_phase"].values[:, 0]), "normal_force", 5.0)
    heard = samples / np.abs(samples).max()
    np.testing.assert_allclose(heard, alone.samples / np.abs(alone.samples).max(), atol=1e-3)


def test_the_file_plays_at_the_scale_that_is_said(tmp_path, capsys):
    """Definition: 16 bits at 48 kHz; the loudest sample has 0.9 of the file, or what the full scale makes it."""
    results.save(steady((MESH, 100.0)), tmp_path / "run.nc")
    assert main(["listen", str(tmp_path), "--seconds", "1"]) == 0
    assert "full scale 111.1 N" in capsys.readouterr().out
    rate, samples = wavfile.read(tmp_path / "normal_force.wav")
    assert (rate, len(samples), samples.dtype) == (SAMPLE_RATE, SAMPLE_RATE, np.int16)
    assert samples.max() == pytest.approx(HEADROOM * (2**15 - 1), abs=1)
    assert main(["listen", str(tmp_path), "--full-scale", "0.4 kN", "-o", str(tmp_path / "quiet.wav"), "-q"]) == 0
    assert wavfile.read(tmp_path / "quiet.wav")[1].max() == pytest.approx(0.25 * (2**15 - 1), abs=3)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (
            ["--curve", "loudness"],
            "--curve loudness: is no curve of this run. Allowed: normal_force, transmission_error.",
        ),
        (["--full-scale", "3 mm"], "allowed is a force greater than zero"),
        (["--full-scale", "3 parrots"], "parrots"),
        (["--seconds", "0"], "allowed are 0.1 to 600 seconds"),
        (["-o", "sound.mp3"], "the sound is a .wav file"),
    ],
)
def test_wrong_calls_write_nothing(tmp_path, capsys, options, said):
    """Exit code 2, what is allowed, and no file."""
    results.save(steady((MESH, 100.0)), tmp_path / "run.nc")
    assert main(["listen", str(tmp_path), *options]) == 2
    assert said in capsys.readouterr().err and [each.name for each in tmp_path.iterdir()] == ["run.nc"]
