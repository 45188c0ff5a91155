"""From the validated sections ``[gears]`` and ``[load]`` to their data, with what a drawing leaves out derived."""

from __future__ import annotations

from dataclasses import replace
from math import degrees
from typing import Any

from fenics_gears.effects.tooth_elasticity import CONSTANTS, material_of
from fenics_gears.geometry.drawing import NAMES, RACKS, Derived, DrawnGear, DrawnPair, Rack, completed
from fenics_gears.geometry.gear_checks import refuse
from fenics_gears.geometry.gear_data import GearPairData, Material
from fenics_gears.geometry.materials import MATERIALS
from fenics_gears.inputs.tree import GEARS, LOADS, table, wheel_torque
from fenics_gears.scene.data import Load, Motion
from fenics_gears.scene.gear_schema import Gear, Gears, RackText
from fenics_gears.scene.load import Load as LoadText

MEASURES = ("tooth_thickness", "base_tangent_length", "spanned_teeth", "dimension_over_balls", "ball_diameter")


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
    pair = DrawnPair(
        float(gears.module), float(gears.pressure_angle), float(gears.helix_angle or 0.0), _number(gears.centre_distance), _number(gears.backlash), _number(gears.tip_shortening)
    )
    distance, drawn, derived = completed(pair, tuple(_drawn(own, gears.rack, name, pair.pressure_angle) for own, name in zip(both, NAMES)))
    widths = [float(own.face_width or gears.face_width) for own in both]
    offsets = tuple(float(own.axial_offset or 0.0) for own in both)
    # Where both ends are apart by as much, and so where there is no offset, the smaller width is the common one, to the last digit.
    apart = abs(offsets[0] - offsets[1])
    common = min(*widths, 0.5 * (widths[0] + widths[1]) - apart) if apart else min(widths)
    alike = widths[0] == widths[1] == common
    pinion, wheel = (
        replace(
            gear, bore_diameter=float(own.bore_diameter), face_width=None if alike else width, material=material_of(own.material, gears.material), tip_chamfer=float(own.tip_chamfer or 0.0)
        )
        for gear, own, width in zip(drawn, both, widths)
    )
    given = {"helix_angle": float(gears.helix_angle)} if gears.helix_angle is not None else {}
    if gears.pinion_hand is not None:
        given["pinion_hand"] = gears.pinion_hand
    data = GearPairData(pair.module, pair.pressure_angle, distance, common, pinion, wheel, material_of(gears.material), axial_offsets=offsets, **given)
    return data, derived + _named_materials(gears)


def _number(value: float | None) -> float | None:
    """A number without its spelling."""
    return None if value is None else float(value)


def _drawn(own: Gear, shared: RackText | None, name: str, pressure_angle: float) -> DrawnGear:
    measures = {name: value if isinstance(value := getattr(own, name), int) else _number(value) for name in MEASURES}
    numbers = {name: _number(getattr(own, name)) for name in ("profile_shift", "tip_diameter", "root_diameter")}
    return DrawnGear(own.teeth, _rack(own, shared), **numbers, **measures, protuberance=_protuberance(own, shared, name, pressure_angle))


def _protuberance(own: Gear, shared: RackText | None, name: str, pressure_angle: float) -> tuple[float, float]:
    """Protuberance left beyond the finished flank, mm, and its angle, rad; of the gear's own rack, else of both. Raises GeometryError."""
    sections = [each for each in (own.rack, shared) if each is not None]
    amount, angle, stock = (
        next((float(getattr(each, field)) for each in sections if getattr(each, field) is not None), None) for field in ("protuberance", "protuberance_angle", "finishing_stock")
    )
    home = f"gears.{name}.rack" if own.rack is not None and own.rack.protuberance is not None else "gears.rack"
    if (stock or 0.0) > (amount or 0.0):
        refuse(
            name,
            f"{home}.finishing_stock = {stock:.4g} mm is more than {home}.protuberance = {amount or 0.0:.4g} mm: finishing would leave a step in the root; "
            "allowed is as much as the protuberance: raise protuberance or lower finishing_stock",
        )
    if angle is not None and not amount:
        refuse(name, f"{home}.protuberance_angle = {degrees(angle):.4g} deg has no meaning without {home}.protuberance: give it, or leave both out")
    if angle is not None and angle >= pressure_angle:
        refuse(name, f"{home}.protuberance_angle = {degrees(angle):.4g} deg must be less than gears.pressure_angle = {degrees(pressure_angle):.4g} deg: lower it")
    beyond = (amount or 0.0) - (stock or 0.0)
    return beyond, (0.5 * pressure_angle if angle is None else angle) if beyond else 0.0


def _rack(own: Gear, shared: RackText | None) -> Rack:
    """The gear's own figures, then those of its own profile, then those of both gears."""
    sections = [each for each in (own.rack, shared) if each is not None]

    def figure(name: str) -> float | None:
        for section in sections:
            if getattr(section, name) is not None or section.profile is not None:
                return _number(getattr(section, name))
        return None

    addendum, dedendum, radius = RACKS[next((each.profile for each in sections if each.profile is not None), "ISO 53 A")]
    written = _number(own.rack_tip_radius) if own.rack_tip_radius is not None else figure("tip_radius")
    found = figure("addendum"), figure("dedendum")
    return Rack(addendum if found[0] is None else found[0], dedendum if found[1] is None else found[1], written, radius)


def _named_materials(gears: Gears) -> list[Derived]:
    found = []
    for words, text in (("", gears.material), *((f"{name} ", getattr(gears, name).material) for name in NAMES)):
        if text is not None and text.name is not None:
            values: Material = MATERIALS[text.name][0]
            for constant, label, unit, factor in zip(CONSTANTS, ("Young's modulus", "Poisson's ratio"), ("GPa", ""), (1e-3, 1.0)):
                if getattr(text, constant) is None:
                    found.append(Derived(f"{words}{label}", factor * getattr(values, constant), unit, f"{text.name} ({MATERIALS[text.name][1]})"))
    return found


def load_data(load: LoadText, gears: Gears, motion: Motion) -> tuple[Load, list[Derived]]:
    """The torque on the wheel, N mm, and how it was derived."""
    name = next(each for each in LOADS if getattr(load, each) is not None)
    torque = wheel_torque(name, float(getattr(load, name)), (gears.pinion.teeth, gears.wheel.teeth), motion.mesh_frequency)
    assert torque is not None, "a load by power has a speed"
    why = {"pinion_torque": "T_2 = T_1 z2/z1", "power": "T_2 = P/(2 pi n_2)"}
    return Load(torque), [] if name == "wheel_torque" else [Derived("torque on the wheel", 1e-3 * torque, "N m", why[name])]
