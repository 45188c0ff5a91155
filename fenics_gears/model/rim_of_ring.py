"""How much the rim of an internal gear bends, and whether it may count as held by default.

A thin ring under three equal radial forces P at 120 degrees moves by THREE_FORCES P R^3/(E' I) at the forces, E' =
E/(1 - nu^2) in plane strain (series of the inextensional ring, exact). Per force of a tooth pair along the line of
action, P is its sine, and the flanks feel the sine of the movement.
"""

from math import sin

from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear_data import PAIR_STIFFNESS, Material
from fenics_gears.geometry.pair import GearPair
from fenics_gears.scene.data import Scene

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
    if words and scene.gears.wheel.support is None:
        raise SceneError(
            f"{words}. What holds it has to be said:"
            ' gears.wheel.support = "held" where the outer circle cannot move, or'
            ' [gears.wheel.support] with kind = "foundation", radial_stiffness and tangential_stiffness per area.'
            "\nNothing was computed or written."
        )


def ring_warnings(scene: Scene, pair: GearPair) -> list[str]:
    """A sentence on a thin rim that is held."""
    words = _bends(scene, pair)
    if not words or pair.wheel.foundation is not None:
        return []
    return [f"{words}; held at its outer circle it does not bend: right in a stiff housing, with a press fit alone"]
