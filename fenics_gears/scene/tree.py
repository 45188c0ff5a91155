"""Looking into a parsed scene file where some of it may be wrong."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from fenics_gears.scene import units

Tree = Mapping[str, Any]


def table(tree: Tree, name: str) -> Tree | None:
    """The section of that name; None where there is none."""
    value = tree.get(name)
    return value if isinstance(value, Mapping) else None


def quantity_in(value: Any) -> float | None:
    """The number in N, mm, s, rad; None for what is no quantity."""
    if not isinstance(value, str):
        return None
    try:
        return units.quantity(value)[0]
    except units.QuantityError:
        return None
