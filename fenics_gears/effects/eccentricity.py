"""``[eccentricity]``: run-out of either gear (``contact.run_out``)."""

from __future__ import annotations

from collections.abc import Iterator
from math import lcm
from typing import Optional

from fenics_gears.effects.effect import Effect
from fenics_gears.geometry.eccentricity_data import Eccentricity
from fenics_gears.inputs.fields import Section, quantity
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.tree import GEARS, Tree, table, too_large_for_the_module, value_at


class OffsetText(Section):
    """``[eccentricity.pinion]`` and ``[eccentricity.wheel]``."""

    distance: float = quantity(
        "1e-6 um",
        "100 mm",
        "10 um",
        meaning="eccentricity: distance of the base circle's centre from the axis of rotation",
        below="For a gear that runs true, leave its section out.",
    )
    phase: Optional[float] = quantity(
        "-360 deg",
        "360 deg",
        "90 deg",
        meaning="direction of the base circle's centre at the start of the first mesh cycle: angle from the line of action (pinion to wheel), in the gear's sense of rotation",
        otherwise="0 deg",
    )


class EccentricityText(Section):
    """``[eccentricity]``."""

    pinion: Optional[OffsetText] = None
    wheel: Optional[OffsetText] = None


def run_out_is_small_and_of_some_gear(tree: Tree) -> Iterator[Problem]:
    """A section names a gear, and its run-out is small against the tooth."""
    section = table(tree, "eccentricity")
    if section is not None and not section:
        message = "says of neither gear that it runs out. Add [eccentricity.pinion] or [eccentricity.wheel], or leave the section out."
        yield Problem(("eccentricity",), "", message)
    for gear in GEARS:
        path = ("eccentricity", gear, "distance")
        yield from too_large_for_the_module(tree, path, value_at(tree, *path))


def gaps(eccentricity: Eccentricity, model):
    """What the displaced base circles add to the gaps."""
    from fenics_gears.contact.run_out import RunOut

    return RunOut(model.pair, eccentricity, model.resolution.steps_per_mesh_cycle)


def period(eccentricity: Eccentricity, scene) -> int:
    """Mesh cycles of whole turns of the gears that run out."""
    return lcm(*(getattr(scene.gears, name).teeth for name in GEARS if getattr(eccentricity, name) is not None))


EFFECT = Effect(
    section="eccentricity",
    description="eccentricity of the gears on their shafts (run-out)",
    absent="no run-out",
    text=EccentricityText,
    data=Eccentricity,
    terms=("gaps that vary once per revolution of the gear",),
    rules=run_out_is_small_and_of_some_gear,
    gaps=gaps,
    period=period,
)
