"""``[eccentricity]``: run-out of either gear (``contact.run_out``), and wobble of its teeth (``contact.wobble``)."""

from __future__ import annotations

from collections.abc import Iterator
from math import lcm
from typing import Optional

from fenics_gears.effects.effect import Effect
from fenics_gears.geometry.eccentricity_data import Eccentricity
from fenics_gears.inputs.fields import Section, quantity
from fenics_gears.inputs.problem import Problem
from fenics_gears.inputs.tree import (
    GEARS,
    NOT_IN_THE_PLANE,
    Tree,
    over_the_face,
    table,
    too_large_for_the_module,
    value_at,
)
from fenics_gears.inputs.written import as_written


def _angle(of: str, field: str):
    meaning = (
        f"{of} at the start of the first mesh cycle: angle from the line of action (pinion to wheel), in the gear's"
        " sense of rotation"
    )
    return quantity(
        "-360 deg", "360 deg", "90 deg", meaning=meaning, otherwise=f"0 deg; has no meaning without {field}"
    )


class OffsetText(Section):
    """``[eccentricity.pinion]`` and ``[eccentricity.wheel]``: a distance, or in three-dimensional scenes a wobble, or
    both."""

    distance: Optional[float] = quantity(
        "1e-6 um",
        "100 mm",
        "10 um",
        meaning="eccentricity: distance of the base circle's centre from the axis of rotation, at mid-width",
        otherwise="no eccentricity, for `wobble` alone",
        below="For a gear that runs true, leave its section out.",
    )
    phase: Optional[float] = _angle("direction of the base circle's centre", "`distance`")
    wobble: Optional[float] = quantity(
        "1e-6 um",
        "100 mm",
        "10 um",
        meaning="wobble: how far the axis of the teeth departs from the axis of rotation over the gear's face width",
        otherwise="no wobble; not allowed in a plane scene",
        below="For teeth that do not wobble, leave it out.",
    )
    wobble_phase: Optional[float] = _angle(
        "direction in which the axis of the teeth leans towards the right end", "`wobble`"
    )


class EccentricityText(Section):
    """``[eccentricity]``."""

    pinion: Optional[OffsetText] = None
    wheel: Optional[OffsetText] = None


def run_out_is_small_and_of_some_gear(tree: Tree) -> Iterator[Problem]:
    """A section names a gear, what it does not run true by, and that is small against the tooth."""
    section = table(tree, "eccentricity")
    if section is not None and not section:
        message = (
            "says of neither gear that it runs out. Add [eccentricity.pinion] or [eccentricity.wheel], or leave the"
            " section out."
        )
        yield Problem(("eccentricity",), "", message)
    for gear in GEARS:
        own = table(section or {}, gear)
        if own is not None and not {"distance", "wobble"} & set(own):
            yield Problem(
                ("eccentricity", gear, "distance"),
                None,
                'is missing. Allowed: such as "10 um"; or a wobble in a three-dimensional scene.',
            )
        for name in ("distance", "wobble"):
            path = ("eccentricity", gear, name)
            yield from too_large_for_the_module(tree, path, value_at(tree, *path))
        if own is not None and "wobble" in own and not over_the_face(tree):
            yield Problem(("eccentricity", gear, "wobble"), as_written(own["wobble"]), NOT_IN_THE_PLANE)


def gaps(eccentricity: Eccentricity, model):
    """What displaced base circles and leaning teeth add to the gaps."""
    from fenics_gears.contact.run_out import run_out

    return run_out(model.pair, eccentricity, model.resolution.steps_per_mesh_cycle)


def period(eccentricity: Eccentricity, scene) -> int:
    """Mesh cycles of whole turns of the gears that run out."""
    return lcm(*(getattr(scene.gears, name).teeth for name in GEARS if getattr(eccentricity, name) is not None))


EFFECT = Effect(
    section="eccentricity",
    description="eccentricity of the gears on their shafts (run-out), wobble of their teeth",
    absent="no run-out",
    text=EccentricityText,
    data=Eccentricity,
    terms=("gaps that vary once per revolution of the gear",),
    rules=run_out_is_small_and_of_some_gear,
    gaps=gaps,
    period=period,
)
