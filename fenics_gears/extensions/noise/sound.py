"""A curve of a run as sound: its fluctuation, as pressure would follow it, at the samples of an audio file."""

from dataclasses import dataclass
from math import ceil
from pathlib import Path

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline
from scipy.io import wavfile
from scipy.signal import resample_poly

from fenics_gears import OVERALL, carried_train, cycles_of_meshes, of_settled

SAMPLE_RATE = 48_000
# Hz; lower sounds are felt rather than heard.
LOWEST_HEARD = 20.0
# Seconds of fading at both ends, against clicks.
FADE = 0.02
# The loudest sample in parts of what the file can hold.
HEADROOM = 0.9
# A fluctuation of so small a part of the curve is round-off.
ROUND_OFF = 1e-9
_FULL = 2**15 - 1


@dataclass(frozen=True)
class Sound:
    """Samples (n,) of a curve less its mean, in its own unit, at SAMPLE_RATE; `full_scale`: value at which the file is
    full."""

    samples: np.ndarray
    full_scale: float


def sound(result: xr.Dataset, name: str, seconds: float, full_scale: float | None = None) -> Sound:
    """The curve `name` of a run. A steady run's settled cycles are repeated until `seconds` are full; a ramp is heard
    once, from its first step to its last.

    Without `full_scale` the loudest sample has HEADROOM of the file. Raises ValueError where nothing fluctuates.
    """
    # The last step of a steady run is the first of the next cycle.
    speed = np.diff(_phase(result)) / np.diff(result["time"].values)
    steady = bool(np.ptp(speed) < 1e-6 * speed.max())
    heard = of_settled(result)[name] if steady else result[name]
    time = heard["time"].values
    values = heard.values - heard.values[:-1].mean()
    if not np.ptp(values) > ROUND_OFF * np.abs(heard.values).max():
        raise ValueError("does not fluctuate")
    return _faded(_samples(time - time[0], values, seconds if steady else None), full_scale)


def train_sound(result: xr.Dataset, name: str, seconds: float, full_scale: float | None = None) -> Sound:
    """The overall transmission error of a train's run: what each of its meshes adds repeats with its own mesh cycle, so
    that the whole goes on without a seam; a ramp is heard once. Raises ValueError where nothing fluctuates."""
    train = carried_train(result)
    if train.shafts.ramp is not None:
        return sound(result, name, seconds, full_scale)
    cycles = cycles_of_meshes(result, train)
    spans = [np.ptp(each.values) for each in cycles]
    if not max(spans) > ROUND_OFF * max(np.abs(each.values).max() for each in cycles):
        raise ValueError("does not fluctuate")
    samples = np.zeros(round(seconds * SAMPLE_RATE))
    for each in cycles:
        values = np.append(each.values, each.values[0]) - each.values.mean()
        samples += _samples(np.linspace(0.0, 1.0 / each.frequency, len(values)), values, seconds)
    return _faded(samples, full_scale)


def fastest_mesh(result: xr.Dataset) -> float:
    """The largest mesh frequency (Hz) of a run, 0 for one without steps."""
    train = carried_train(result) if OVERALL in result else None
    if train is not None and train.shafts.ramp is None:
        return max(each.frequency for each in cycles_of_meshes(result, train))
    phase = _phase(result)
    time = result["time"].values
    return abs(phase[-1] - phase[0]) / (time[-1] - time[0]) if len(time) > 1 else 0.0


def _phase(result: xr.Dataset) -> np.ndarray:
    """Mesh cycles (n,) of a run, of a train those of the mesh with most."""
    phase = result["mesh_phase"].values
    return phase if phase.ndim == 1 else phase[:, np.argmax(np.ptp(phase, axis=0))]


def _faded(samples: np.ndarray, full_scale: float | None) -> Sound:
    fade = np.minimum(np.arange(len(samples)) / (FADE * SAMPLE_RATE), 1.0)
    samples = samples * fade * fade[::-1]
    return Sound(samples, np.abs(samples).max() / HEADROOM if full_scale is None else full_scale)


def _samples(time: np.ndarray, values: np.ndarray, seconds: float | None) -> np.ndarray:
    """The curve (n,) at the rate of the file; repeated for so many seconds where they are given.

    It is read between steps by a cubic spline, at a multiple of the rate that has all its steps; what the file's rate
    cannot hold is filtered out.
    """
    times = max(ceil(1.0 / (np.diff(time).min() * SAMPLE_RATE) - 1e-9), 1)
    if seconds is None:
        spline = CubicSpline(time, values)
        at = np.arange(0.0, time[-1], 1.0 / (times * SAMPLE_RATE))
    else:
        spline = CubicSpline(time, np.append(values[:-1], values[0]), bc_type="periodic")
        at = np.arange(round(seconds * SAMPLE_RATE) * times) / (times * SAMPLE_RATE) % time[-1]
    return resample_poly(spline(at), 1, times) if times > 1 else spline(at)


def save_sound(sound: Sound, path: Path) -> None:
    """Write a WAV file, 16 bit, one channel; louder samples than the full scale are cut off."""
    samples = np.clip(sound.samples / sound.full_scale, -1.0, 1.0) * _FULL
    wavfile.write(path, SAMPLE_RATE, np.round(samples).astype(np.int16))
