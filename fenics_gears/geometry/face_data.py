"""Modifications along the face of the gears and misalignment of their axes, as a scene gives them; lengths in mm."""

from __future__ import annotations

from dataclasses import dataclass

from fenics_gears.geometry.relief_data import LINEAR

BOTH, LEFT, RIGHT = "both", "left", "right"


@dataclass(frozen=True)
class EndRelief:
    """Relief towards the ends of a gear's face: `depth` at the end, `length` along the axis; `sides`: "both", "left"
    (-z) or "right" (+z); `shape`:
    "linear" or "parabolic" in the distance from its start."""

    depth: float
    length: float
    sides: str = BOTH
    shape: str = LINEAR


@dataclass(frozen=True)
class LeadModification:
    """Modification of one gear over its own face width: crowning, helix slope (positive: removed towards the right end,
    +z) and end relief."""

    crowning: float = 0.0
    helix_slope: float = 0.0
    end_relief: EndRelief | None = None


@dataclass(frozen=True)
class LeadModifications:
    """Lead modifications of the pair; a gear without has None."""

    pinion: LeadModification | None = None
    wheel: LeadModification | None = None


@dataclass(frozen=True)
class Misalignment:
    """How far the wheel's axis departs from parallel over the common face width, `in_plane` of action and
    `out_of_plane` of it.

    `in_plane`: positive where the right end (+z) moves away from the pinion along the line of action, +x;
        `out_of_plane`: where it moves across it, +y.
    """

    in_plane: float = 0.0
    out_of_plane: float = 0.0
