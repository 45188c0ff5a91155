"""The steps that a run's numbers are taken from: all after the vibration of the start has died down, in whole common
periods."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass
from math import ceil, exp, inf, isfinite, log, pi, sqrt
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from fenics_gears.effects import common_period
from fenics_gears.model.model import Model
from fenics_gears.scene.schema import MOST_CYCLES

if TYPE_CHECKING:
    from fenics_gears.dynamics.frequencies import Vibration

    from .dataset import RunResult

# The start has died down when at most this part of its slowest vibration is left. Where the run is long enough, less is
# left: at high speed the start may be twenty times as large as the settled motion.
DIED_DOWN = 0.01
QUIET = 0.001


@dataclass(frozen=True)
class Settled:
    """The steps that count, from `first` to the last of the run; `warning`: what is left of the start there, empty
    where it has died down."""

    first: int
    warning: str = ""


def settled(model: Model, steps: int) -> Settled:
    """The settled ones of so many steps, by the drivetrain's slowest vibration that contact excites; all of a
    quasi-static run.

    They are whole common periods: at least the last one, and where all cycles are alike at least those with contact
    fields, even if the start has not died down. A ramp on which it does not die down counts as a whole.
    """
    a_cycle = model.resolution.steps_per_mesh_cycle
    period = common_period(model.scene)
    rate, slowest = _slowest(model)
    calm, quiet = (_step_at(model, log(1.0 / left) / rate if rate else inf, steps) for left in (DIED_DOWN, QUIET))
    if not isfinite(period):
        return Settled(calm) if calm < steps else Settled(0, _warning(slowest, rate, 1.0, None, steps > 0))
    least = (int(period) if period > 1 else model.scene.motion.recorded_cycles) * a_cycle
    first = max(min(quiet, steps - least), 0)
    whole = (steps - first) // (int(period) * a_cycle)
    warning = ""
    if calm > first and steps:
        needed = (
            ceil(model.clock.duration(0, calm) * model.scene.motion.mesh_frequency + least / a_cycle) if rate else None
        )
        warning = _warning(slowest, rate, exp(-rate * model.clock.time(first)), needed, True)
    return Settled(steps - whole * int(period) * a_cycle if whole else first, warning)


def settling_time(model: Model) -> float:
    """Time (s) in which the start dies down to 0.1 %; infinite where nothing damps it, zero without vibrations."""
    rate, _ = _slowest(model)
    return log(1.0 / QUIET) / rate if rate else inf


def settled_steps(result: RunResult | xr.Dataset) -> slice:
    begin = result.attrs.get("settled_from")
    return slice(None) if begin is None else slice(int(np.searchsorted(np.asarray(result["time"]), begin)), None)


def of_settled(result: xr.Dataset) -> xr.Dataset:
    """A result with its settled steps only; contact fields stay as they are.

    >>> of_settled(xr.Dataset(coords={"time": [0.0, 0.1, 0.2]}, attrs={"settled_from": 0.1})).sizes["time"]
    2
    """
    steps = settled_steps(result)
    return result if not steps.start else result.isel(time=steps)


def _slowest(model: Model) -> tuple[float, Vibration | None]:
    """Rate of decay (1/s) of the vibration that dies down last, and that vibration; infinite where there is none."""
    rates = [(_rate(each, model), each) for each in model.vibrations if each.excited]
    return min(rates, key=lambda each: each[0], default=(inf, None))


def _rate(vibration: Vibration, model: Model) -> float:
    """Rate (1/s) at which a vibration decays, by its damping and by the numerical damping of backward Euler."""
    angular = 2.0 * pi * vibration.frequency
    ratio = vibration.damping_ratio
    rate = angular * (ratio if ratio <= 1.0 else ratio - sqrt(ratio**2 - 1.0))
    if not model.time_scales.averages_acceleration:
        rate += 0.5 * log(1.0 + (angular * model.time_step) ** 2) / model.time_step
    return rate


def _step_at(model: Model, time: float, steps: int) -> float:
    if time <= 0.0 or not steps:
        return 0
    if time <= model.clock.time(steps):
        return bisect_left(range(steps + 1), time, key=model.clock.time)
    return inf if not isfinite(time) else steps + ceil((time - model.clock.time(steps)) / model.time_step)


def _warning(slowest: Vibration, rate: float, left: float, needed: int | None, ran: bool) -> str:
    if not ran:
        return ""
    mode = f"its slowest vibration ({slowest.frequency:.4g} Hz, damping ratio {slowest.damping_ratio:.2g})"
    if not rate:
        return (
            f"the start does not die down: nothing damps {slowest.frequency:.4g} Hz, which it sets off, and all numbers"
            " have it in them; [damping] lets it die down"
        )
    cycles = "" if needed is None else f"; motion.mesh_cycles = {needed} leaves {DIED_DOWN:.0%}"
    if needed is not None and needed > MOST_CYCLES:
        cycles = "; no run is long enough for it to die down: raise the damping, by [damping]"
    return f"the start has not died down where the numbers begin: {100.0 * left:.3g}% of {mode} is left{cycles}"
