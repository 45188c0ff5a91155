"""Reliefs and tip edges of a scene: changes of the flanks that all teeth of a gear share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fenics_gears.effects import from_effects
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.scene.data import Scene


def check_geometry(scene: Scene) -> GearPair:
    """The pair of a scene whose gears mesh and have the flanks and tips that its effects ask for. Raises GeometryError
    where they do not.

    >>> from fenics_gears import load_scene
    >>> print(f'{check_geometry(load_scene("demos/lundvall2004.toml")).contact_ratio:.2f}')
    1.47
    """
    pair = gear_pair(scene.gears)
    removals(scene, pair)
    corner(scene, pair)
    return pair


def corner(scene: Scene, pair: GearPair):
    """How the scene's tips touch off the line of action, as contact sees it; None without `[corner_contact]`.

    Raises GeometryError for an edge that does not fit a tip.
    """
    if scene.corner_contact is None:
        return None
    # Imported here: a scene without corner contact does not load it.
    from fenics_gears.contact.corner import corner_contact

    return corner_contact(pair, scene.corner_contact.edge_radii)


def removals(scene: Scene, pair: GearPair) -> tuple:
    """Material that the scene's effects remove from the drive flanks of pinion and wheel: functions of the roll angle,
    or None.

    Raises GeometryError where an effect asks for what the flank does not have.
    """
    found = from_effects(scene, "removal", pair)
    parts = [tuple(part for part in of_gear if part is not None) for of_gear in zip(*found)] or [(), ()]
    return tuple(Removals(of_gear) if len(of_gear) > 1 else (of_gear[0] if of_gear else None) for of_gear in parts)


@dataclass(frozen=True)
class Removals:
    """The removals of several effects from one flank."""

    parts: tuple

    def __call__(self, roll_angle) -> np.ndarray:
        """Removal (mm) at roll angles (rad, any shape) by all of them together."""
        return sum(part(roll_angle) for part in self.parts)

    @property
    def kinks(self) -> tuple[float, ...]:
        """Those of all parts."""
        return tuple(roll for part in self.parts for roll in part.kinks)


def kinks(removal) -> tuple[float, ...]:
    """Roll angles (rad) at which a removal, None for no removal, leaves the flank with a kink."""
    return () if removal is None else removal.kinks
