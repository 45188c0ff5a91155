"""Energy account of a march, step by step, which closes to round-off.

Average acceleration gives the drivetrain's part exactly: over a step, with the contact forces p and dx = x1 - x0,

    change of (kinetic + springs) = F dx - dx D dx/dt - dx (G0^T p0 + G1^T p1)/2.

With u = G x - C p at both ends, the contact's part splits, without remainder, into the change of the teeth's energy 1/2
p C p; the friction loss p1 slip1, as of backward Euler; the work of the prescribed rotation, by the changing geometry
(G, C, gaps, rigid slip); and the algorithm's own term at changes of contact, 1/2 sum(p0 gap1 - p1 gap0), and the same
for friction. A node that only one end of the step has is given the compliance and the lever arms of that end at the
other.

F is the mean of the loads at both ends of the step, where they vary. Backward Euler, which is used where no vibration
is sampled and for rigid flanks, has another balance: its dissipation is in the defect.

The account is in the frame of the nominal motion. The power that the nominal motion carries through the mesh, load
times nominal speed, is added to input and output alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .clock import Clock
from .contact_work import contact_work
from .drivetrain import Drivetrain
from .stepping import VaryingLoad
from .steps import Steps


@dataclass(frozen=True)
class Account:
    """Work since the first step, (steps,), N mm, and its `defect` from the change of energy."""

    rotation: np.ndarray
    load: np.ndarray
    damping: np.ndarray
    friction: np.ndarray
    changes: np.ndarray
    defect: np.ndarray


def account(
    drivetrain: Drivetrain, clock: Clock, steps: Steps, energy: np.ndarray, loads: Sequence[VaryingLoad] = ()
) -> Account:
    """The account of consecutive steps, whose elastic and kinetic `energy` (steps,) is in N mm; `loads` as the march
    had them."""
    # A step that was divided is accounted for part by part.
    passed, whole = steps.with_parts()
    contact = contact_work(passed)
    moved = np.diff(passed.states[:, 0], axis=0)
    damping = np.zeros(len(moved))
    if drivetrain.damping is not None:
        damping = quadratic(moved, drivetrain.damping) / clock.durations(passed.numbers)
    parts = {
        "rotation": _summed(contact.rotation),
        "load": _summed(np.sum(moved * mean_load(drivetrain, loads, passed.numbers), axis=1)),
        "damping": _summed(damping),
        "friction": _summed(contact.friction),
        "changes": _summed(contact.changes),
    }
    parts = {name: work[whole] for name, work in parts.items()}
    gained = parts["rotation"] + parts["load"] + parts["changes"] - parts["damping"] - parts["friction"]
    return Account(**parts, defect=energy - energy[:1] - gained if len(energy) else energy)


def quadratic(vectors: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """v M v (n,) of vectors (n, k) with a matrix (k, k)."""
    return np.sum(vectors @ matrix * vectors, axis=1)


def mean_load(drivetrain: Drivetrain, loads: Sequence[VaryingLoad], steps: Sequence[float]) -> np.ndarray:
    """Forces (n, k), N, on the centre coordinates from each of n + 1 steps to the next, the mean of both."""
    forces = np.tile(drivetrain.load, (len(steps), 1))
    for load in loads:
        # Reshaped for a march that failed at its start and has no steps.
        forces = forces + np.reshape([load(step) for step in steps], forces.shape)
    return 0.5 * (forces[:-1] + forces[1:])


def _summed(steps) -> np.ndarray:
    return np.concatenate(([0.0], np.cumsum(steps)))
