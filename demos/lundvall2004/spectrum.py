"""Two periodic curves compared: how alike, how far behind each other, and by their first harmonics."""

from __future__ import annotations

import numpy as np
import xarray as xr

from demos.lundvall2004.measured import WITH, WITHOUT, Measured, one_cycle, peak_to_peak

MICRO = 1e6
LOW_ENDS, HIGH_ENDS = 400.5, 4000.5  # Hz: the last frequencies of the studies ..._low and ..._high


def lag(late: np.ndarray, early: np.ndarray) -> tuple[float, float]:
    """Correlation of two curves over one cycle (n,), the second shifted so that it is largest; the shift in cycles,
    positive when `late` is behind."""
    late, early = late - late.mean(), early - early.mean()
    products = np.fft.irfft(np.fft.rfft(late) * np.conj(np.fft.rfft(early)), len(late))
    shift = int(products.argmax())
    likeness = products[shift] / np.sqrt((late @ late) * (early @ early))
    return float(likeness), (shift if shift <= len(late) // 2 else shift - len(late)) / len(late)


def why_friction_lowers(measured: Measured, reading: str, figure: str, curve: xr.Dataset) -> str:
    """Why Fig. 6 or 10 has friction lower the transmission error where it does most, from the harmonics of the curve
    there."""
    frequency = curve.mesh_frequency.values
    lowest = float(frequency[(peak_to_peak(curve, WITH) - peak_to_peak(curve, WITHOUT)).argmin()])
    plain, added = harmonics(measured, reading, figure, lowest)
    strongest = int(np.abs(added).argmax()) + 1
    if strongest > 1:
        before, after = abs(plain[strongest - 1]) * MICRO, abs(plain[strongest - 1] + added[strongest - 1]) * MICRO
        return (
            f"at {lowest:.0f} Hz harmonic {strongest} of the mesh, {strongest * lowest / 1e3:.1f} kHz, excites a"
            f" torsional mode, whose amplitude friction lowers from {before:.0f} to {after:.0f} urad; it changes all"
            f" other harmonics by {np.abs(np.delete(added, strongest - 1)).max() * MICRO:.0f} urad at most"
        )
    said = []
    for near in (200.0, lowest):
        plain, added = harmonics(measured, reading, figure, near)
        angle = np.degrees(np.angle(added[0] / plain[0]))
        said.append(
            f"At {near:.0f} Hz it is {abs(added[0]) * MICRO:.0f} urad at {angle:.0f} deg to the frictionless"
            f" {abs(plain[0]) * MICRO:.0f} urad"
        )
    return (
        "the phase of the contribution of friction to the first harmonic changes with frequency until it opposes the"
        f" frictionless part. {'. '.join(said)}"
    )


def harmonics(measured: Measured, reading: str, figure: str, frequency: float) -> tuple[np.ndarray, np.ndarray]:
    """Complex amplitudes (rad) of the transmission error's harmonics at a swept mesh frequency (Hz): without friction,
    and what friction adds."""
    band = "low" if frequency <= LOW_ENDS else "high" if frequency <= HIGH_ENDS else "beyond"
    study = measured.study(f"{reading}figure{figure}_{band}").sel(mesh_frequency=frequency, method="nearest")
    with_friction, plain = (np.fft.rfft(one_cycle(study, "transmission_error", f)) for f in (WITH, WITHOUT))
    scale = 2.0 / len(one_cycle(study, "transmission_error", WITH))
    return scale * plain[1:], scale * (with_friction - plain)[1:]
