"""What ``[tip_relief]`` and ``[root_relief]`` share: their fields, their data and their rules. No effect by itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal, Optional

from fenics_gears.scene.fields import Measured, Section, choice, either, quantity
from fenics_gears.scene.problem import Problem
from fenics_gears.scene.tree import Tree, table

LINEAR, PARABOLIC = "linear", "parabolic"


@dataclass(frozen=True)
class Relief:
    """Relief of one gear: depth at its end, mm; start as a roll angle in rad, or as a diameter in mm, neither for the usual place.

    ``shape``: "linear" or "parabolic" in the roll angle, from the start to the end.
    """

    depth: float
    start_roll_angle: float | None
    shape: str = LINEAR
    start_diameter: float | None = None


def start_field(word: str, word_meaning: str) -> Any:
    """Where a relief starts: ``word``, a roll angle or a diameter."""
    return either(
        ("1e-3 deg", "360 deg", "29.61 deg"),
        ("0.1 mm", "100 m", "80.1 mm"),
        words={word: None},
        meaning=f"where the relief starts: a roll angle, a diameter, or the {word_meaning}",
        otherwise="as of both gears; one of the two must have it",
    )


def depth_field() -> Any:
    """How much a relief removes at its end."""
    return quantity(
        "1e-6 um",
        "100 mm",
        "31 um",
        meaning="material removed at the relief's end, along the flank's normal",
        otherwise="as of both gears, else no relief",
        below="For a gear without relief, leave its depth out.",
    )


def shape_field() -> Any:
    """How a relief grows from its start to its end."""
    return choice(LINEAR, PARABOLIC, meaning="how it grows with the roll angle, from its start to its end", otherwise="as of both gears, else `linear`")


class TipReliefOfGearText(Section):
    """``[tip_relief.pinion]`` and ``[tip_relief.wheel]``; what is left out is taken from ``[tip_relief]``."""

    depth: Optional[float] = depth_field()
    start: Optional[Measured] = start_field("HPSTC", "highest point of single tooth contact")
    shape: Optional[Literal["linear", "parabolic"]] = shape_field()


class RootReliefOfGearText(Section):
    """``[root_relief.pinion]`` and ``[root_relief.wheel]``; what is left out is taken from ``[root_relief]``."""

    depth: Optional[float] = depth_field()
    start: Optional[Measured] = start_field("LPSTC", "lowest point of single tooth contact")
    shape: Optional[Literal["linear", "parabolic"]] = shape_field()


def of_gear(both: Section, own: Section | None) -> Relief | None:
    """One gear's relief: what is its own before what is both gears'; None without a depth."""
    own = own or type(both)()
    depth = both.depth if own.depth is None else own.depth
    start = own.start if "start" in own.model_fields_set else both.start
    if depth is None:
        return None
    number = {start.kind: start.number} if start is not None else {}
    return Relief(depth, number.get("an angle"), own.shape or both.shape or LINEAR, number.get("a length"))


def incomplete(tree: Tree, section: str, word: str) -> Iterator[Problem]:
    """A relief has a depth and a start."""
    both = table(tree, section)
    if both is None:
        return
    given = {(section, gear): {*both, *both[gear]} for gear in ("pinion", "wheel") if table(both, gear) is not None}
    if "depth" in both or not given:
        given[section,] = set(both)
    for path, names in given.items():
        for name, example in (("depth", '"31 um"'), ("start", f'"{word}" or "29.61 deg"')):
            if name not in names:
                yield Problem((*path, name), None, f"is missing. Allowed: such as {example}.")
