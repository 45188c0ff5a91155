"""Mesh and time step compared with the drivetrain's vibrations, which decides on the start of a march and its method in
time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class TimeScales:
    """Mesh and time step compared with vibrations.

    `samples_vibration`: a period of the slowest vibration has two steps or more, the least that can represent it.
    `follows_statics`: the mesh is slower than the slowest vibration. `outruns_vibration`: it is faster than the
    fastest.
    `impulsive`: flanks are rigid and forces jump; with average acceleration they would change sign at every step from
    then on.
    """

    samples_vibration: bool = True
    follows_statics: bool = True
    outruns_vibration: bool = False
    impulsive: bool = False

    @property
    def averages_acceleration(self) -> bool:
        """Whether average acceleration is the method in time, else backward Euler."""
        return self.samples_vibration and not self.impulsive


FOLLOWING = TimeScales()


def time_scales(elastic_frequencies: np.ndarray, mesh_frequency: float, time_step: float) -> TimeScales:
    """The time scales of a mesh frequency (Hz) and a step (s) among a drivetrain's elastic natural frequencies (Hz),
    ascending."""
    return TimeScales(
        samples_vibration=2.0 * time_step * elastic_frequencies[0] <= 1.0,
        follows_statics=mesh_frequency < elastic_frequencies[0],
        outruns_vibration=mesh_frequency > elastic_frequencies[-1],
    )
