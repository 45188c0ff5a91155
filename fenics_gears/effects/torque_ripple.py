"""``[torque_ripple]``: load torque that varies with the rotation of the wheel's shaft (``dynamics.torque_ripple``)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite, lcm, pi
from typing import Any

from pydantic import Field
from pydantic_core import PydanticCustomError

from fenics_gears.dynamics.torque_ripple_data import Harmonic, TorqueRipple
from fenics_gears.effects.effect import Effect, ResultVariable
from fenics_gears.inputs import units
from fenics_gears.inputs.fields import Allowed, Section, out_of_range, refused
from fenics_gears.inputs.names import did_you_mean
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.spelling import quantity_text
from fenics_gears.inputs.tree import Tree, dotted, load_in, quantity_in, table
from fenics_gears.inputs.written import as_written

HIGHEST_ORDER = 1e6
MOST_HARMONICS = 1000
# Orders are taken as whole parts of this; finer ones repeat in no run.
FINEST_PART_OF_ORDER = 1000
# Bounds of amplitude and phase, and what they are written like.
QUANTITIES = {"amplitude": ("1e-12 N m", "1e12 N m", "20 N m"), "phase": ("-360 deg", "360 deg", "30 deg")}
_KINDS = {name: (units.quantity(example)[1], units.unit_of(example)) for name, (_, _, example) in QUANTITIES.items()}


@dataclass(frozen=True)
class AllowedHarmonics(Allowed):
    """A list of tables with order, amplitude and phase."""

    def convert(self, value: Any) -> tuple[Harmonic, ...]:
        """The harmonics in N mm and rad. Raises PydanticCustomError, which names the first that is wrong."""
        if not isinstance(value, list):
            raise refused("is not a list.")
        if not 0 < len(value) <= MOST_HARMONICS:
            raise refused(
                f"has {len(value)} entries."
                if value
                else "is empty. For a steady torque, leave the section [torque_ripple] out."
            )
        return tuple(_harmonic(place, entry) for place, entry in enumerate(value, 1))


def _harmonic(place: int, entry: Any) -> Harmonic:
    """One harmonic; raises PydanticCustomError that names its `place` in the list."""
    if not isinstance(entry, Mapping):
        raise refused(
            f"has the entry {as_written(entry)} at place {place}, which is no table of order, amplitude and phase."
        )
    for name in entry:
        if name not in ("order", *QUANTITIES):
            raise refused(
                f'has "{name}" at place {place}, which no harmonic has.{did_you_mean(name, ("order", *QUANTITIES))}'
            )
    for name in ("order", "amplitude"):
        if name not in entry:
            raise refused(f"has no {name} at place {place}.")
    values = {"order": _order(place, entry["order"])}
    for name in QUANTITIES:
        if name in entry:
            values[name] = _quantity(place, name, entry[name])
    return Harmonic(**values)


def _order(place: int, value: Any) -> float:
    number = value if isinstance(value, (int, float)) and not isinstance(value, bool) else None
    if number is None or not isfinite(number) or not 0 < number <= HIGHEST_ORDER:
        raise refused(
            f"has order = {as_written(value)} at place {place}, which is not a number above 0 and up to"
            f" {HIGHEST_ORDER:g}."
        )
    return float(number)


def _quantity(place: int, name: str, value: Any) -> float:
    lowest, highest, example = QUANTITIES[name]
    (low, kind), (high, _) = units.quantity(lowest), units.quantity(highest)
    try:
        converted = Allowed("", kind, units.unit_of(example)).convert(value)
        reason = out_of_range(converted, low, high)
    except PydanticCustomError as error:
        reason = error.context["reason"]
    if reason:
        raise refused(
            f"has {name} = {as_written(value)} at place {place}, which {reason} From {lowest} to {highest} are allowed."
        )
    return converted


_HARMONICS = AllowedHarmonics(
    f"a list of harmonics, each with an order above 0 up to {HIGHEST_ORDER:g}, an amplitude and, if any, "
    'a phase, such as [{ order = 1, amplitude = "20 N m", phase = "30 deg" }]',
    meaning="harmonics added to `load.wheel_torque`: amplitude * cos(order * rotation of the wheel's shaft + phase)",
)


class TorqueRippleText(Section):
    """``[torque_ripple]``."""

    harmonics: tuple = Field(..., json_schema_extra={"allowed": _HARMONICS})


def write(ripple: TorqueRipple) -> dict:
    """The section, with a table for each harmonic."""

    def harmonic(each: Harmonic) -> dict:
        written = {
            name: quantity_text(getattr(each, name), *_KINDS[name])
            for name in QUANTITIES
            if name != "phase" or each.phase
        }
        return {"order": float(each.order), **written}

    return {"harmonics": [harmonic(each) for each in ripple.harmonics]}


def torque_keeps_its_sign(tree: Tree) -> Iterator[Problem]:
    """A torque that changes its sign needs the coast flanks."""
    ripple, mean = table(tree, "torque_ripple"), load_in(tree)
    written = ripple.get("harmonics") if ripple else None
    if mean is None or "coast_flanks" in tree or not isinstance(written, list):
        return
    torque, of_wheel = mean[1], "" if mean[0][-1] == "wheel_torque" else " is on the wheel"
    amplitudes = [quantity_in(each.get("amplitude")) for each in written if isinstance(each, Mapping)]
    total = sum(amplitude for amplitude in amplitudes if amplitude is not None)
    if isfinite(total) and total > abs(torque):
        message = (
            f"has amplitudes of {total * 1e-3:.6g} N m together, more than {dotted(mean[0])}{of_wheel}: the torque can"
            f" change its sign and drive the pair from the wheel. Allowed: up to {abs(torque) * 1e-3:.6g} N m, or any"
            " with the section [coast_flanks]."
        )
        yield Problem(("torque_ripple", "harmonics"), as_written(written), message)


def load(ripple: TorqueRipple, model):
    """The varying part of the torque on the centre coordinates."""
    from fenics_gears.dynamics.torque_ripple import varying_load

    return varying_load(ripple, model.drivetrain, shaft_step(model.scene, model.resolution.steps_per_mesh_cycle))


def results(ripple: TorqueRipple, scene, cycle, steps) -> dict:
    """The torque on the wheel's shaft (time,), N mm."""
    from fenics_gears.dynamics.torque_ripple import torque

    angle = shaft_step(scene, cycle.steps)
    return {"wheel_couple": (("time",), scene.load.wheel_torque + torque(ripple, angle * steps))}


def period(ripple: TorqueRipple, scene) -> int:
    """Mesh cycles after which the torque repeats: the least common multiple of z2 / order over all harmonics."""
    teeth = scene.gears.wheel.teeth
    return lcm(
        *((teeth / Fraction(each.order).limit_denominator(FINEST_PART_OF_ORDER)).numerator for each in ripple.harmonics)
    )


def shaft_step(scene, steps_per_mesh_cycle: int) -> float:
    """Angle (rad) that the wheel's shaft turns in a step."""
    return 2.0 * pi / (scene.gears.wheel.teeth * steps_per_mesh_cycle)


EFFECT = Effect(
    section="torque_ripple",
    description="load torque that varies with the rotation of the wheel's shaft, as a sum of harmonics",
    absent="constant load torque",
    text=TorqueRippleText,
    data=TorqueRipple,
    terms=("varying load torque",),
    variables=(
        ResultVariable(
            "wheel_couple", "N mm", "load torque on the wheel's shaft, positive where it resists the rotation"
        ),
    ),
    rules=torque_keeps_its_sign,
    load=load,
    write=write,
    results=results,
    period=period,
)
