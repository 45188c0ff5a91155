"""How far bodies twist on the bores at which they are held: part of the mesh stiffness that their teeth do not have.

A ring of width b(r) and shear modulus G under a torque T twists by T/(2 pi G) times the integral of dr/(b r^3): the
closed form of a disc that is sheared around its axis. Along the line of action, at the base circle of radius r_b, the
body is a spring of r_b^2 times that twist by T.
"""

from math import inf, pi

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.geometry.pair import GearPair
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.data import ISO_6336, RIGID_TEETH, Scene


def bore_twist_stiffness(scene: Scene, pair: GearPair) -> float:
    """Approximate stiffness (N/mm) along the line of action of both bodies, which twist between their roots and the
    bores where they are held. Infinite where none twists, as on shafts that bend or with given meshes."""
    if scene.tooth_elasticity is None or scene.accuracy.model in (ISO_6336, RIGID_TEETH):
        return inf
    flexibility = 0.0
    for name, material, width in zip(GEARS, scene.gears.materials, pair.face_widths):
        on_shaft = scene.shafts is not None and name in (scene.shafts.sections or {})
        given = scene.body_meshes is not None and getattr(scene.body_meshes, name) is not None
        if not (on_shaft or given):
            flexibility += _flexibility(getattr(pair, name), material, width)
    return 1.0 / flexibility if flexibility else inf


def _flexibility(gear: Gear, material: Material, width: float) -> float:
    """mm/N along the line of action."""
    shear_modulus = 0.5 * material.youngs_modulus / (1.0 + material.poissons_ratio)
    rings = [(gear.bore_radius, gear.root_radius, 1.0)]
    if gear.web is not None:
        ends = gear.bore_radius, gear.web.hub_radius, gear.web.rim_radius, gear.root_radius
        rings = list(zip(ends, ends[1:], (1.0, gear.web.share, 1.0)))
    twist = sum(0.5 * (inner**-2 - outer**-2) / share for inner, outer, share in rings)
    body = gear.base_radius**2 * abs(twist) / (2.0 * pi * shear_modulus * width)
    if gear.foundation is None:
        return body
    # A rigid ring on its springs: it turns by the tangential ones, and moves by both.
    half_circle = pi * abs(gear.bore_radius) * width
    radial, tangential = (each * material.youngs_modulus * half_circle for each in gear.foundation)
    turning = 2.0 * tangential * gear.bore_radius**2
    return body + gear.base_radius**2 / turning + 1.0 / (radial + tangential)
