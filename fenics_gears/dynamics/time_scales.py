"""How fast the mesh and the time step are, compared with the drivetrain's vibrations: what the march starts from and steps by."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class TimeScales:
    """What the time step samples and the mesh leaves time for.

    `samples_vibration`: two steps or more in a period of the slowest vibration, below which no sampling can hold one.
    `impulsive`: flanks are rigid and forces jump; average acceleration would turn their sign at every step from then on.
    `follows_statics`: the mesh is slower than the slowest vibration. `outruns_vibration`: it is faster than the fastest.
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
    """The time scales of a mesh frequency (Hz) and a step (s) among a drivetrain's elastic natural frequencies (Hz), ascending."""
    return TimeScales(
        samples_vibration=2.0 * time_step * elastic_frequencies[0] <= 1.0,
        follows_statics=mesh_frequency < elastic_frequencies[0],
        outruns_vibration=mesh_frequency > elastic_frequencies[-1],
    )
