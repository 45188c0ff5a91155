"""Standard teeth with any helix, in steel, with nothing but teeth and gear bodies to give way."""

from dataclasses import replace
from math import atan, ceil, cos, pi, radians, sin, tan

from fenics_gears.geometry.gear_data import GearData, GearPairData, Material
from fenics_gears.geometry.misalignment import Misalignment
from fenics_gears.scene.data import Accuracy, Load, Motion, Scene

MODULE, PRESSURE_ANGLE, TEETH = 3.0, radians(20.0), (20, 30)
STEEL = Material(206e3, 0.3)
LINE_LOAD = 200.0
ALIGNED = Misalignment()


def width_of_overlap(overlap: float, helix_angle: float) -> float:
    """Face width (mm) of an overlap ratio; helix_angle in rad."""
    return overlap * pi * MODULE / sin(helix_angle)


def standard_gear(teeth: int, helix_angle: float, bore: float) -> GearData:
    """No profile shift, addendum 1 and dedendum 1.25 normal modules; bore in parts of the root diameter."""
    reference = teeth * MODULE / cos(helix_angle)
    root = reference - 2.5 * MODULE
    return GearData(teeth, 0.0, reference + 2.0 * MODULE, root, bore * root, rack_tip_radius=0.25)


def standard_pair(
    face_width: float,
    helix_angle: float = 0.0,
    material: Material = STEEL,
    bore: float = 0.5,
    teeth: tuple[int, int] = TEETH,
) -> GearPairData:
    """20 and 30 teeth unless given, module 3 mm; face_width mm, helix_angle rad."""
    centre_distance = 0.5 * sum(teeth) * MODULE / cos(helix_angle)
    pinion, wheel = (standard_gear(number, helix_angle, bore) for number in teeth)
    return GearPairData(MODULE, PRESSURE_ANGLE, centre_distance, face_width, pinion, wheel, material, helix_angle)


def scene_of(gears: GearPairData, accuracy: Accuracy, line_load: float = LINE_LOAD) -> Scene:
    """Quasi-static, without friction, on rigid shafts, over the face; line_load N/mm along the line of action."""
    transverse = atan(tan(PRESSURE_ANGLE) / cos(gears.helix_angle))
    base_radius = 0.5 * gears.wheel.teeth * gears.module / cos(gears.helix_angle) * cos(transverse)
    load = Load(line_load * gears.face_width * base_radius)
    return Scene("third dimension", gears, load, Motion(1.0, 1, 1, speed_given=False), accuracy, misalignment=ALIGNED)


def divided(
    gears: GearPairData, slice_width: float, layer_thickness: float, section: float, steps: int = 20
) -> Accuracy:
    """Slices, layers and section elements of sizes in modules."""
    width = gears.face_width / gears.module
    return Accuracy(
        steps_per_mesh_cycle=steps, slices=ceil(width / slice_width), layers=ceil(width / layer_thickness),
        body_element_size=section * gears.module,
    )  # fmt: skip


def in_plane(scene: Scene) -> Scene:
    accuracy = replace(scene.accuracy, slices=None, layers=None, body_element_size=None)
    return replace(scene, misalignment=None, lead_modifications=None, accuracy=accuracy)
