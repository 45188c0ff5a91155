"""When the drive flanks lost contact during a march, how long and how far."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from fenics_gears.dynamics.clock import Clock


@dataclass(frozen=True)
class ContactLoss:
    """One loss: the steps without contact from `first` to `last`, and the widest `opening` (mm) between the drive
    flanks."""

    first: int
    last: int
    opening: float

    @property
    def steps(self) -> int:
        """Steps without contact; from the last step before to the first after it is one more."""
        return self.last - self.first + 1

    def duration(self, clock: Clock) -> float:
        """Time that those steps stand for, s."""
        return clock.duration(self.first - 1, self.last)


def contact_losses(separations: Sequence[tuple[int, float]]) -> list[ContactLoss]:
    """The losses among (step, smallest opening in mm) of all steps without contact: steps that follow each other are
    one."""
    losses = []
    for _, run in groupby(enumerate(separations), lambda each: each[1][0] - each[0]):
        steps = [separation for _, separation in run]
        losses.append(ContactLoss(steps[0][0], steps[-1][0], max(opening for _, opening in steps)))
    return losses


def loss_attributes(separations: Sequence[tuple[int, float]], first: int, last: int, clock: Clock) -> dict[str, float]:
    """Attributes of a result on lost contact between two steps: how often; time of the first and length of the longest
    loss (s), share of the time, widest opening (mm).

    The last four only where contact was lost.
    """
    losses = contact_losses(separations)
    if not losses:
        return {"contact_loss_count": 0}
    durations = [loss.duration(clock) for loss in losses]
    return {
        "contact_loss_count": len(losses),
        "contact_loss_first": clock.time(losses[0].first),
        "contact_loss_longest": max(durations),
        "contact_loss_share": sum(durations) / clock.duration(first, last),
        "contact_loss_opening": max(loss.opening for loss in losses),
    }
