"""``[load]``: the torque, as such or by power and speed."""

from __future__ import annotations

from typing import Optional

from fenics_gears.inputs.fields import Section, quantity


class Load(Section):
    """``[load]``: the mean torque on the end of the output shaft, by exactly one of these fields; the gears pass it on without losses."""

    wheel_torque: Optional[float] = quantity(
        "-1e12 N m",
        "1e12 N m",
        "437 N m",
        meaning="torque that resists the wheel's rotation; where it is negative, the wheel drives, which needs `[coast_flanks]`",
        otherwise="from `pinion_torque` or `power`",
    )
    pinion_torque: Optional[float] = quantity(
        "-1e12 N m", "1e12 N m", "291 N m", meaning="torque that drives the pinion; the wheel has it times z2/z1", otherwise="`wheel_torque` or `power` is given"
    )
    power: Optional[float] = quantity(
        "-1e9 kW", "1e9 kW", "20 kW", meaning="power that goes through the pair at the speed of `[motion]`, which is then required", otherwise="`wheel_torque` or `pinion_torque` is given"
    )
