"""``[stages.NAME.ring.points]``: the ring of a planetary set on bolts, pins or splines."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from fenics_gears.effects.wheel_points import MOST, WheelPoints
from fenics_gears.geometry.planetary import RING
from fenics_gears.inputs.fields import quantities
from fenics_gears.inputs.problem import Path, Problem
from fenics_gears.inputs.tree import table

from .gear_schema import GearText

POINTS = "points"
# Sections of a train beside which the points of a ring are not computed yet.
NOT_BESIDE = ("friction", "inertia")


@dataclass(frozen=True, kw_only=True)
class PointsOfRing(WheelPoints):
    """``[stages.NAME.ring.points]``: bolts, pins or splines that alone hold the ring at its outer circle, which turn
    with it. Each takes the mean motion of this circle over a pitch; their other ends are rigid."""

    angles: tuple[float, ...] | None = quantities(
        "-360 deg to 360 deg",
        "0 deg",
        "95 deg",
        meaning="angles of two points or more as the run begins, counter-clockwise from the direction 0 of the set",
        otherwise="from `count`",
        shortest=2,
        longest=MOST,
    )


@dataclass(frozen=True, kw_only=True)
class RingText(GearText):
    """``[stages.NAME.ring]``: an internal gear, which may stand on points."""

    points: PointsOfRing | None = None


def wrong_points(path: Path, tree: Mapping[str, Any], content: Mapping[str, Any]) -> Iterator[Problem]:
    """What a ring on points is not computed with yet; `path` and `content` of its stage."""
    if POINTS not in (table(content, RING) or {}):
        return
    place = (*path, RING, POINTS)
    for name in NOT_BESIDE:
        if name in tree:
            yield Problem(place, "", f"is not computed with [{name}] yet. Leave one of the two out.")
    floating = content.get("floating")
    if isinstance(floating, list) and RING in floating:
        said = "hold the ring, which cannot be floating too. Leave one of the two out."
        yield Problem(place, "", said)
