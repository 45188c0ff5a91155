"""What a drawing says of the gears' bodies, webs and materials; and the load on them."""

from fenics_gears.effects.tooth_elasticity import material_of
from fenics_gears.geometry.gear_data import MATERIALS, Web
from fenics_gears.inputs.tree import GEARS, LOADS, wheel_torque

from .gear_schema import Gears, GearText
from .schema import Derived, Load, LoadText, Motion


def web_of(own: GearText, face_width: float) -> Web | None:
    if own.web is None:
        return None
    return Web(
        0.5 * (own.web.hub_diameter or own.bore_diameter),
        0.5 * own.web.rim_inner_diameter,
        own.web.width / face_width,
        offset=(own.web.axial_offset or 0.0) / face_width,
    )


def named_materials(gears: Gears) -> list[Derived]:
    texts = {"": (gears.material,), **{f"{name} ": (getattr(gears, name).material, gears.material) for name in GEARS}}
    named = {
        words: (each[0].name, material_of(*each))
        for words, each in texts.items()
        if each[0] is not None and each[0].name is not None
    }
    return [
        Derived(
            f"{words}Young's modulus",
            1e-3 * material.youngs_modulus,
            "GPa",
            f"Poisson's ratio {material.poissons_ratio:g}, {name} ({MATERIALS[name][1]})",
        )
        for words, (name, material) in named.items()
    ]


def load_data(load: LoadText, gears: Gears, motion: Motion) -> tuple[Load, list[Derived]]:
    """The torque on the wheel, N mm, and how it was derived."""
    name = next(each for each in LOADS if getattr(load, each) is not None)
    torque = wheel_torque(
        name, float(getattr(load, name)), (gears.pinion.teeth, gears.wheel.teeth), motion.mesh_frequency
    )
    assert torque is not None, "a load by power has a speed"
    why = {"pinion_torque": "T_2 = T_1 z2/z1", "power": "T_2 = P/(2 pi n_2)"}
    derived = [Derived("torque on the wheel", 1e-3 * torque, "N m", why[name])] if name in why else []
    return Load(torque, name), derived
