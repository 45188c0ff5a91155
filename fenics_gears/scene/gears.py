"""From the validated sections ``[gears]`` and ``[load]`` to their data, with what a drawing leaves out derived."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from fenics_gears.effects.effect import same_names
from fenics_gears.effects.tooth_elasticity import material_of
from fenics_gears.geometry.gear_data import GearPairData
from fenics_gears.geometry.materials import MATERIALS
from fenics_gears.inputs.tree import GEARS, LOADS, table, wheel_torque
from fenics_gears.scene.data import Derived, Load, Motion
from fenics_gears.scene.drawing import completed
from fenics_gears.scene.gear_schema import Gears
from fenics_gears.scene.schema import Load as LoadText


def with_material_sections(tree: dict[str, Any]) -> dict[str, Any]:
    """A parsed file in which a material that is only named, ``material = "steel"``, is a section with that name."""
    gears = table(tree, "gears") or {}
    for home in (gears, *(table(gears, gear) for gear in GEARS)):
        if home is not None and isinstance(home.get("material"), str):
            home["material"] = {"name": home["material"]}
    return tree


def gear_pair_data(gears: Gears) -> tuple[GearPairData, list[Derived]]:
    """The pair, and what was derived. Raises GeometryError for a figure that cannot be."""
    both = (gears.pinion, gears.wheel)
    distance, drawn, derived = completed(gears)
    widths = [own.face_width or gears.face_width for own in both]
    offsets = tuple(float(own.axial_offset or 0.0) for own in both)
    # Where both ends are apart by as much, and so where there is no offset, the smaller width is the common one, to the last digit.
    apart = abs(offsets[0] - offsets[1])
    common = min(*widths, 0.5 * (widths[0] + widths[1]) - apart) if apart else min(widths)
    alike = widths[0] == widths[1] == common
    pinion, wheel = (
        replace(gear, bore_diameter=float(own.bore_diameter), face_width=None if alike else width, material=material_of(own.material, gears.material))
        for gear, own, width in zip(drawn, both, widths)
    )
    others = {"face_width": common, "pinion": pinion, "wheel": wheel, "material": material_of(gears.material), "axial_offsets": offsets}
    data = same_names(GearPairData, gears, ("backlash", "tip_shortening", "rack"), centre_distance=distance, **others)
    return data, derived + _named_materials(gears)


def _named_materials(gears: Gears) -> list[Derived]:
    texts = {"": gears.material, **{f"{name} ": getattr(gears, name).material for name in GEARS}}
    named = {words: (text.name, *MATERIALS[text.name]) for words, text in texts.items() if text is not None and text.name is not None}
    return [
        Derived(f"{words}Young's modulus", 1e-3 * material.youngs_modulus, "GPa", f"Poisson's ratio {material.poissons_ratio:g}, of {name}, unless given ({source})")
        for words, (name, material, source) in named.items()
    ]


def load_data(load: LoadText, gears: Gears, motion: Motion) -> tuple[Load, list[Derived]]:
    """The torque on the wheel, N mm, and how it was derived."""
    name = next(each for each in LOADS if getattr(load, each) is not None)
    torque = wheel_torque(name, float(getattr(load, name)), (gears.pinion.teeth, gears.wheel.teeth), motion.mesh_frequency)
    assert torque is not None, "a load by power has a speed"
    why = {"pinion_torque": "T_2 = T_1 z2/z1", "power": "T_2 = P/(2 pi n_2)"}
    return Load(torque), [] if name == "wheel_torque" else [Derived("torque on the wheel", 1e-3 * torque, "N m", why[name])]
