"""Errors of a contact step that neither Newton nor any of its fallbacks could solve."""

from __future__ import annotations

import numpy as np

from fenics_gears.errors import ComputationError

from .laws import RESIDUAL_NAMES, RESIDUAL_UNITS, STATUS_NAMES

# What becomes of a load that nothing holds; the march says which it is.
MOVES_FREELY = "the load moves the drivetrain freely"


class ContactNotConverged(ComputationError):
    """No solution of a contact step was found: names the step, the methods tried, the residuals and the alternating
    sets.

    Attributes: `time` (s) and `step`, None until the march fills them in; `attempts`: list of (method, outcome,
    residual history (iterations, 5), sets (iterations, nodes)); `partial`: the dataset of the steps before, or None.
    """

    def __init__(self, attempts, reason: str, time: float | None = None, step: int | None = None):
        self.attempts, self.reason = attempts, reason
        self.time, self.step, self.partial = time, step, None
        super().__init__(reason)

    def __str__(self) -> str:
        place = "" if self.time is None else f" at step {self.step}, t = {self.time:.6g} s"
        lines = [f"contact did not converge{place}: {self.reason}"]
        for method, outcome, history, sets in self.attempts:
            lines.append(
                f"  {method}: {outcome} after {len(history)} iterations{_last_residual(history)}{_alternating(sets)}"
            )
        return "\n".join(lines)


class NoStaticEquilibrium(ContactNotConverged):
    """Nothing holds the load: it moves the drivetrain freely, and no contact force opposes it."""


class SelfLocking(ContactNotConverged):
    """Friction cancels the normal forces: however hard the teeth press, they do not balance the load."""


class MoreThanOneSolution(ContactNotConverged):
    """Friction couples the contact nodes so strongly that a step may have several solutions or none."""


def _last_residual(history: np.ndarray) -> str:
    if not len(history):
        return ""
    parts = [f"{name} {value:.2g} {unit}" for name, value, unit in zip(RESIDUAL_NAMES, history[-1], RESIDUAL_UNITS)]
    return "; last residuals: " + ", ".join(parts)


def _alternating(sets: np.ndarray) -> str:
    if len(sets) < 2:
        return ""
    changing = np.flatnonzero(np.any(sets[-min(len(sets), 6) :] != sets[-1], axis=0))
    if not len(changing):
        return ""
    shown = [
        f"node {node} ({' / '.join(STATUS_NAMES[s] for s in dict.fromkeys(sets[-6:, node].tolist()))})"
        for node in changing[:5]
    ]
    return "; sets alternate at " + ", ".join(shown) + (" ..." if len(changing) > 5 else "")
