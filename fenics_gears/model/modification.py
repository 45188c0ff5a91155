"""Reliefs and tip edges of a scene; and thin rims: how much too stiff a rigid bore makes a gear, and how much the rim
of an internal one bends.

A thin ring under three equal radial forces P at 120 degrees moves by THREE_FORCES P R^3/(E' I) at the forces, E' =
E/(1 - nu^2) in plane strain (series of the inextensional ring, exact). Per force of a tooth pair along the line of
action, P is its sine, and the flanks feel the sine of the movement.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, sin
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.effects import from_effects
from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear_data import PAIR_STIFFNESS, Material
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import ELASTIC, Scene

if TYPE_CHECKING:
    from fenics_gears.geometry.gear import Gear

    from .model import Model


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


def check_bodies(scene: Scene, pair: GearPair) -> None:
    """Refuse a thin rim of an internal gear without a support, and tip edges that do not fit. Raises SceneError,
    GeometryError."""
    if pair.wheel.internal:
        check_support(scene, pair)
    corner(scene, pair)


def corner(scene: Scene, pair: GearPair):
    """How the scene's tips touch off the line of action, as contact sees it; None without `[corner_contact]`. Raises
    GeometryError for an edge that does not fit a tip."""
    if scene.corner_contact is None:
        return None
    from fenics_gears.contact.corner import corner_contact

    return corner_contact(pair, scene.corner_contact.edge_radii)


def removals(scene: Scene, pair: GearPair) -> tuple:
    """Material that the scene's effects remove from the drive flanks of pinion and wheel: functions of the roll angle,
    or None. Raises GeometryError where an effect asks for what the flank does not have."""
    of_effects = from_effects(scene, "removal", pair)
    parts = [tuple(part for part in of_gear if part is not None) for of_gear in zip(*of_effects)] or [(), ()]
    return tuple(Removals(of_gear) if len(of_gear) > 1 else (of_gear[0] if of_gear else None) for of_gear in parts)


# At which slopes of what is removed from a flank are taken.
PROFILE_POINTS = 201


def steepest_relief(pair: GearPair, removal: tuple) -> float:
    """Largest slope of what is removed from both flanks along them. Under a slope m the gap y^2/(2 R) + m y is least at
    y = -R m: so far from the line of action reliefs move the contact."""
    steepest = 0.0
    for gear, removed in zip(pair.gears, removal):
        if removed is not None:
            rolls = np.linspace(gear.form_roll_angle, gear.tip_roll_angle, PROFILE_POINTS)
            arcs = 0.5 * gear.base_radius * rolls**2
            steepest += float(np.abs(np.diff(removed(rolls)) / np.diff(arcs)).max())
    return steepest


@dataclass(frozen=True)
class Removals:
    """The removals of several effects from one flank."""

    parts: tuple

    def __call__(self, roll_angle) -> np.ndarray:
        """Removal (mm) at roll angles (rad, any shape)."""
        return sum(part(roll_angle) for part in self.parts)

    @classmethod
    def side_by_side(cls, removals: Sequence[Removals], counts: Sequence[int]) -> Removals | None:
        """One removal for roll angles of several flanks one after the other, so many of each; None where the effects
        that remove differ."""
        # Relief is an effect's, whose fields take 6 ms to declare.
        from fenics_gears.geometry.relief import side_by_side

        parts = [[type(part) for part in removal.parts] for removal in removals]
        if any(kinds != parts[0] for kinds in parts):
            return None
        return cls(tuple(side_by_side(of_effect, counts) for of_effect in zip(*(each.parts for each in removals))))

    @property
    def kinks(self) -> tuple[float, ...]:
        return tuple(roll for part in self.parts for roll in part.kinks)


def kinks(removal) -> tuple[float, ...]:
    """Roll angles (rad) at which a removal, None for none, leaves the flank with a kink."""
    return () if removal is None else removal.kinks


# Tooth and rim on a rigid ring give way by STIFFEST exp(-thickness/FALL) per cent less than in a solid body, thickness
# of the rim in root radii: within 4 of what is measured for 20 to 80 teeth (docs/drawing.md, thin rims).
STIFFEST = 45.0
FALL = 0.19
# Per cent from which there is a warning.
NOTABLE = 10.0


def too_stiff(gear: Gear) -> float:
    """Per cent by which tooth and rim of a gear, its bore being a rigid ring, give way less than in a solid body, apart
    from the body's turn as a whole."""
    return STIFFEST * exp(-(gear.root_radius - gear.bore_radius) / (FALL * abs(gear.root_radius)))


def rim_warnings(model: Model) -> list[str]:
    """A sentence on each gear of finite elements whose rim is thin for a rigid bore."""
    scene = model.scene
    sentences = []
    if scene.tooth_elasticity is None or scene.accuracy.model not in (None, ELASTIC):
        return []
    if model.pair.wheel.internal:
        sentences += ring_warnings(scene, model.pair)
    for name in GEARS:
        gear = getattr(model.pair, name)
        off = 0.0 if gear.internal else too_stiff(gear)
        if off < NOTABLE or getattr(scene.body_meshes, name, None) is not None:
            continue
        rim = gear.root_radius - gear.bore_radius
        sentences.append(
            f"{name}: thin rim: {rim:.4g} mm = {rim / gear.normal_module:.3g} modules between bore and root circle, and"
            f" the bore is a rigid ring: tooth and rim give way about {off:.0f}% less than in a solid body: take a"
            f" smaller gears.{name}.bore_diameter where rim and shaft are one body, or [gears.{name}.web] for a rim on"
            " a web, in a plane scene [body_meshes] for any other seat"
        )
    return sentences


THREE_FORCES = 0.0159386


def rim_over_teeth(pair: GearPair, material: Material) -> float:
    """What the rim of the wheel would give way between three planets, if it were free, over what a tooth pair does."""
    ring = pair.wheel
    thickness = ring.root_radius - ring.bore_radius
    mean = 0.5 * abs(ring.root_radius + ring.bore_radius)
    stiffness = thickness**3 / 12.0 / (1.0 - material.poissons_ratio**2)
    return THREE_FORCES * mean**3 / stiffness * sin(pair.operating_pressure_angle) ** 2 * PAIR_STIFFNESS


def _bends(scene: Scene, pair: GearPair) -> str:
    """How much the rim bends, in words; empty for one that hardly does, and for rigid teeth."""
    if not scene.resolves_contact:
        return ""
    ratio = rim_over_teeth(pair, scene.gears.materials[1])
    if ratio < 1.0:
        return ""
    rim = pair.wheel.root_radius - pair.wheel.bore_radius
    return (
        f"wheel: thin rim: free between three planets the rim of {rim:.4g} mm = {rim / pair.wheel.normal_module:.3g}"
        f" modules would give way {ratio:.2g} times as much as its teeth, along the line of action (thin ring)"
    )


def check_support(scene: Scene, pair: GearPair) -> None:
    """Refuse a thin rim whose support is not given. Raises SceneError."""
    words = _bends(scene, pair)
    if words and scene.gears.wheel.support is None and scene.wheel_points is None:
        raise SceneError(
            f"{words}. What holds it has to be said:"
            ' gears.wheel.support = "held" where the outer circle cannot move, or'
            ' [gears.wheel.support] with kind = "foundation", radial_stiffness and tangential_stiffness per area.'
            "\nNothing was computed or written."
        )


def ring_warnings(scene: Scene, pair: GearPair) -> list[str]:
    """A sentence on a thin rim that is held."""
    words = _bends(scene, pair)
    if not words or pair.wheel.foundation is not None or scene.wheel_points is not None:
        return []
    return [f"{words}; held at its outer circle it does not bend: right in a stiff housing, with a press fit alone"]
