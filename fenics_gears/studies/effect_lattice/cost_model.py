"""The ratio of the times of two scenes' steps that their numbers of unknowns lead one to expect.

An iteration of `contact.newton` sets up and solves one dense system of N = closed nodes + centre coordinates (a slipping node's
tangential force is inserted, only a sticking one's is an unknown) and multiplies out the displacement of all m contact rows:

    W = 2/3 N^3 + 2 N^2  (elimination, substitution)  +  N^2 + 2 c^2 with friction  (assembly)  +  2 m (l + k)  (displacement)

with c closed nodes, l loaded rows (c, or 2 c with friction) and k centre coordinates. With friction a step multiplies out once the
displacement that the material points had before, H = m (m + k). The arithmetic of a step of i iterations is i W + H.

Beside its arithmetic a step takes a time of its own whatever its size, which dominates in small systems. It is longer with equations of
motion, with friction, and with each effect that varies from step to step (gaps, loads, the clock):

    t = own + own of inertia + own of friction + varying effects x own of one + (i W + H) / rate

fitted to the other subsets of the same run.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class StepWork:
    """Average size of a scene's steps: centre coordinates, contact rows, closed nodes, Newton iterations a step.

    `varying`: how many effects change gaps, loads or the length of a step as it goes.
    """

    coordinates: int
    contact_rows: float
    closed_nodes: float
    iterations: float
    inertia: bool
    friction: bool
    varying: int = 0

    @property
    def operations(self) -> float:
        """Floating-point operations of a step."""
        size, closed, rows = self.closed_nodes + self.coordinates, self.closed_nodes, self.contact_rows
        solving = 2.0 / 3.0 * size**3 + 2.0 * size**2
        assembling = size**2 + (2.0 * closed**2 if self.friction else 0.0)
        loaded = 2.0 * closed if self.friction else closed
        history = rows * (rows + self.coordinates) if self.friction else 0.0
        return self.iterations * (solving + assembling + 2.0 * rows * (loaded + self.coordinates)) + history

    @property
    def terms(self) -> tuple[float, ...]:
        """The factors of the constants of the time model."""
        return 1.0, float(self.inertia), float(self.friction), float(self.varying), self.operations


@dataclass(frozen=True)
class Expectation:
    """Ratio of the times of two steps.

    `arithmetic`: of their operations alone. `fitted`: with the own time of a step, None where too few subsets were run to fit it;
    `small` and `large`: the two fitted times, s.
    """

    arithmetic: float
    fitted: float | None = None
    small: float | None = None
    large: float | None = None


def expected_ratio(small: StepWork, large: StepWork, others: Sequence[tuple[StepWork, float]]) -> Expectation:
    """Time of a `large` step by that of a `small` one; `others`: work and seconds of the steps that the constants are fitted to."""
    arithmetic = large.operations / small.operations
    terms = np.array([work.terms for work, _ in others]).reshape(len(others), len(small.terms))
    asked = np.array([small.terms, large.terms])
    # Terms that neither of the two has need no constant. Constants that the others do not determine are not fitted.
    used = np.flatnonzero(asked.any(axis=0))
    if len(others) <= len(used) or np.linalg.matrix_rank(terms[:, used] / np.abs(terms[:, used]).max(axis=0).clip(1e-300)) < len(used):
        return Expectation(arithmetic)
    seconds = np.array([time for _, time in others])
    # Relative errors count: each row is divided by its time.
    constants = np.linalg.lstsq(terms[:, used] / seconds[:, None], np.ones(len(others)), rcond=None)[0]
    times = asked[:, used] @ constants
    if constants[-1] <= 0.0 or times.min() <= 0.0:
        return Expectation(arithmetic)
    return Expectation(arithmetic, float(times[1] / times[0]), float(times[0]), float(times[1]))
