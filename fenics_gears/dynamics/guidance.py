"""Warnings about a time step and a mesh frequency beside the drivetrain's vibrations."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from math import ceil

from .clock import TimeScales
from .frequencies import PERIOD_ERROR, STEPS_OF_A_RESOLVED_PERIOD, Vibration

# Effects on the transmission error below this part of its peak-to-peak value give no warning.
NOTABLE = 0.01


def resolved_frequency(time_step: float) -> float:
    """Highest frequency (Hz) whose period average acceleration has within PERIOD_ERROR."""
    return 1.0 / (STEPS_OF_A_RESOLVED_PERIOD * time_step)


def steps_to_resolve(frequency: float, mesh_frequency: float) -> int:
    """Steps per mesh cycle that resolve a frequency (both Hz)."""
    return ceil(STEPS_OF_A_RESOLVED_PERIOD * frequency / mesh_frequency)


def effect_of_the_step(vibration: Vibration, mesh_frequency: float, time_step: float) -> float:
    """Estimate of the part of the peak-to-peak transmission error that a mode's wrong period changes.

    The mesh's harmonics fall as the square of their number; the one that meets the mode is amplified by the resonance,
    which the wrong frequency shifts by a part of its width. Within a factor of three of the error measured on the
    paper's pair up to the tenth harmonic, of five to seven at the twentieth, where little is left of either.
    """
    harmonic = max(vibration.frequency / mesh_frequency, 1.0)
    amplification = vibration.amplification
    shifted = min(1.0, 2.0 * amplification * vibration.period_error(time_step))
    return shifted * min(1.0, amplification / harmonic**2)


def effect_of_inertia(slowest: Vibration, mesh_frequency: float) -> float:
    """Estimate of the part of its peak-to-peak value by which inertia and damping change the quasi-static transmission
    error.

    r^2 by inertia and 2 zeta r by damping, with r the mesh frequency over the lowest natural frequency; without damping
    r, by the vibrations that remain when load passes from pair to pair.
    """
    ratio = mesh_frequency / slowest.frequency
    return ratio**2 + 2.0 * slowest.damping_ratio * ratio if slowest.damping_ratio > 0.0 else max(ratio, ratio**2)


def judged_frequency(elastic: Sequence[Vibration], mesh_frequencies: tuple[float, float]) -> float:
    """The mesh frequency (Hz) to judge a run by: its lowest, whose steps are the longest, or its highest where inertia
    matters only there."""
    slowest = next((vibration for vibration in elastic if vibration.excited), elastic[0])
    lowest, highest = mesh_frequencies
    return lowest if effect_of_inertia(slowest, lowest) >= NOTABLE else highest


def time_step_warnings(
    elastic: Sequence[Vibration],
    mesh_frequency: float,
    steps_per_mesh_cycle: int,
    time_scales: TimeScales,
    longest_step: float = 0.0,
) -> list[str]:
    """Warnings about vibrations that the step does not resolve, and about inertia that does not matter; `elastic`:
    modes by frequency.

    `longest_step`, s: of a run whose speed changes; its method in time follows from it (`time_scales`).
    """
    time_step = 1.0 / (mesh_frequency * steps_per_mesh_cycle)
    excited = [vibration for vibration in elastic if vibration.excited] or list(elastic)
    slowest, inertia = excited[0], effect_of_inertia(excited[0], mesh_frequency)
    if inertia < NOTABLE:
        said = [
            f"inertia hardly matters: the mesh frequency of {mesh_frequency:.4g} Hz is"
            f" {slowest.frequency / mesh_frequency:.3g} times below the lowest natural frequency of about"
            f" {slowest.frequency:.4g} Hz, and the transmission error differs from the quasi-static one by about"
            f" {inertia:.1g} of its peak-to-peak value; leave out [inertia] and [damping] to solve without them, at any"
            " number of steps"
        ]
        return said if time_scales.samples_vibration else [f"{said[0]}. {_not_sampled(slowest, time_step)}"]
    if not time_scales.samples_vibration and longest_step > time_step:
        sampled = 2.0 * slowest.frequency / steps_per_mesh_cycle
        return [
            "vibrations are not resolved anywhere in the speed ramp, whose slow end has steps too long for them."
            f" {_not_sampled(slowest, longest_step)}: keep both ends of [speed_ramp] above {sampled:.3g} Hz, or raise"
            f" accuracy.steps_per_mesh_cycle ({steps_per_mesh_cycle})"
        ]
    if not time_scales.samples_vibration:
        return [
            "vibrations are not resolved, and the result is about the quasi-static one though inertia matters."
            f" {_not_sampled(slowest, time_step)}: " + _remedy(excited[-1], mesh_frequency, steps_per_mesh_cycle)
        ]
    missed = [
        vibration
        for vibration in excited
        if vibration.period_error(time_step) > PERIOD_ERROR
        and effect_of_the_step(vibration, mesh_frequency, time_step) > NOTABLE
    ]
    if not missed:
        return []
    return [
        f"the time step does not resolve natural frequencies that the mesh excites, about {_listed(missed, time_step)};"
        f" periods are right within {PERIOD_ERROR:.0%} up to {resolved_frequency(time_step):.4g} Hz:"
        f" {_remedy(missed[-1], mesh_frequency, steps_per_mesh_cycle)}"
    ]


def _listed(vibrations: Sequence[Vibration], time_step: float) -> str:
    """Each frequency once, with the number of vibrations that have it."""
    counts = Counter(
        f"{each.frequency:.4g} Hz ({each.steps_per_period(time_step):.3g} steps per"
        f" period{each.motion and f'; {each.motion}'})"
        for each in vibrations
    )
    return ", ".join(words if count == 1 else f"{count} vibrations at {words}" for words, count in counts.items())


def _not_sampled(slowest: Vibration, time_step: float) -> str:
    return (
        f"A step of {time_step:.3g} s is {slowest.frequency * time_step:.3g} periods of the lowest natural frequency of"
        f" about {slowest.frequency:.4g} Hz (periods are right within {PERIOD_ERROR:.0%} up to"
        f" {resolved_frequency(time_step):.4g} Hz), so that backward Euler replaces average acceleration and all"
        " vibrations are damped out"
    )


def _remedy(vibration: Vibration, mesh_frequency: float, steps: int) -> str:
    needed = steps_to_resolve(vibration.frequency, mesh_frequency)
    return (
        f"accuracy.steps_per_mesh_cycle = {needed} instead of {steps} resolves them up to {vibration.frequency:.4g} Hz"
    )
