"""``[eccentricity]``: run-out of either gear (``contact.run_out``), and wobble of its teeth (``contact.wobble``)."""

from dataclasses import dataclass
from math import lcm

from fenics_gears.inputs.fields import quantity
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import GEARS, Tree, table

from .effect import Effect


def _angle(of: str, field: str):
    meaning = (
        f"{of} at the start of the first mesh cycle: angle from the line of action (pinion to wheel), in the gear's"
        " sense of rotation"
    )
    otherwise = f"0 deg; has no meaning without {field}"
    return quantity("-360 deg to 360 deg", "90 deg", meaning=meaning, default="0 deg", otherwise=otherwise)


@dataclass(frozen=True)
class Offset(Section):
    """``[eccentricity.pinion]`` and ``[eccentricity.wheel]``: a distance, or in three-dimensional scenes a wobble, or
    both."""

    distance: float = quantity(
        "1e-6 um to 100 mm",
        "10 um",
        meaning="eccentricity: distance of the base circle's centre from the axis of rotation, at mid-width",
        default="0 um",
        otherwise="no eccentricity, for `wobble` alone",
        below="For a gear that runs true, leave its section out.",
        small=True,
    )
    phase: float = _angle("direction of the base circle's centre", "`distance`")
    wobble: float = quantity(
        "1e-6 um to 100 mm",
        "10 um",
        meaning=("wobble: how far the axis of the teeth departs from the axis of rotation over the gear's face width"),
        default="0 um",
        otherwise="no wobble; not allowed in a plane scene",
        below="For teeth that do not wobble, leave it out.",
        small=True,
        over_face=True,
    )
    wobble_phase: float = _angle("direction in which the axis of the teeth leans towards the right end", "`wobble`")


@dataclass(frozen=True)
class Eccentricity(Section):
    """``[eccentricity]``."""

    empty = (
        "says of neither gear that it runs out. Add [eccentricity.pinion] or [eccentricity.wheel], or leave the section"
        " out."
    )

    pinion: Offset | None = None
    wheel: Offset | None = None


def offsets_are_given(tree: Tree) -> Broken:
    for gear in GEARS:
        own = table(table(tree, "eccentricity") or {}, gear)
        if own is not None and not {"distance", "wobble"} & set(own):
            message = 'is missing. Allowed: such as "10 um"; or a wobble in a three-dimensional scene.'
            yield ("eccentricity", gear, "distance"), message


def gaps(eccentricity: Eccentricity, model):
    from fenics_gears.contact.run_out import run_out

    return run_out(model.pair, eccentricity, model.resolution.steps_per_mesh_cycle)


def period(eccentricity: Eccentricity, scene) -> int:
    return lcm(*(getattr(scene.gears, name).teeth for name in GEARS if getattr(eccentricity, name) is not None))


EFFECT = Effect(
    section="eccentricity",
    description="eccentricity of the gears on their shafts (run-out), wobble of their teeth",
    absent="no run-out",
    fields=Eccentricity,
    terms=("gaps that vary once per revolution of the gear",),
    rules=offsets_are_given,
    gaps=gaps,
    period=period,
)
