"""Two periodic curves compared: how alike, how far behind each other, and by their first harmonics."""

from __future__ import annotations

import numpy as np
import xarray as xr

from demos.lundvall2004.measured import WITH, WITHOUT, Measured, one_cycle, peak_to_peak

MICRO = 1e6


def lag(late: np.ndarray, early: np.ndarray) -> tuple[float, float]:
    """Correlation of two curves over one cycle (n,), the second shifted so that it is largest; the shift in cycles, positive when `late` is behind."""
    late, early = late - late.mean(), early - early.mean()
    products = np.fft.irfft(np.fft.rfft(late) * np.conj(np.fft.rfft(early)), len(late))
    shift = int(products.argmax())
    likeness = products[shift] / np.sqrt((late @ late) * (early @ early))
    return float(likeness), (shift if shift <= len(late) // 2 else shift - len(late)) / len(late)


def first_harmonic(curve: np.ndarray) -> complex:
    """Complex amplitude of a curve over one cycle (n,), at the frequency of the cycle."""
    return complex(2.0 * np.fft.rfft(curve)[1] / len(curve))


def why_friction_lowers(measured: Measured, reading: str, curve: xr.Dataset) -> str:
    """The first harmonics of the modified pair's transmission error: what friction adds, against what is there without it."""
    frequency = curve.mesh_frequency.values
    lowest = float(frequency[(peak_to_peak(curve, WITH) - peak_to_peak(curve, WITHOUT)).argmin()])
    said = []
    for near in (200.0, lowest):
        study = measured.study(f"{reading}figure10_{'low' if near < 410.0 else 'high'}").sel(mesh_frequency=near, method="nearest")
        plain = first_harmonic(one_cycle(study, "transmission_error", WITHOUT))
        added = first_harmonic(one_cycle(study, "transmission_error", WITH)) - plain
        said.append(
            f"at {float(study.mesh_frequency):.0f} Hz {abs(added) * MICRO:.0f} urad at {np.degrees(np.angle(added / plain)):.0f} deg to the frictionless {abs(plain) * MICRO:.0f} urad"
        )
    return f"what friction adds to the first harmonic turns with frequency until it opposes the rest: {'; '.join(said)}"
