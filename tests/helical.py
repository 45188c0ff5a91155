"""Helical pairs of any proportions, on bodies without finite elements unless a test asks for real ones."""

from math import cos, radians

from tests.stand_in import stand_in_body, stand_in_compliance

from fenics_gears import Scene, scene_from_text
from fenics_gears.elasticity.compliance import Bodies, Body
from fenics_gears.model.model import Model

MODULE = 3.0
COARSE = "slices = 5\ncontact_nodes = 13\nsteps_per_mesh_cycle = 16"
BEARINGS = """
[bearings]
stiffness = "0.2e6 N/mm"
axial_stiffness = "0.1e6 N/mm"
places = { pinion = ["-40 mm", "60 mm"], wheel = ["-45 mm", "50 mm"] }
"""
FRICTION = "\n[friction]\ncoefficient = 0.05\n"
SHAFTS = '\n[shafts]\ntorsional_stiffness = "1e8 N mm/rad"\n'
INERTIA = '\n[inertia]\nmass = "2 kg"\nmoment_of_inertia = "2000 kg mm^2"\n'
CROWNED = '\n[lead_modifications.pinion]\ncrowning = "5 um"\n'


def helical_scene(
    more: str = "",
    *,
    teeth: tuple[int, int] = (18, 35),
    helix: float = 15.0,
    hand: str = "right",
    width: float = 24.0,
    torque: float = 200e3,
    frequency: float = 200.0,
    cycles: int = 1,
    accuracy: str = COARSE,
    poissons_ratio: float = 0.3,
    elasticities: tuple[float, float] = (206e3, 206e3),
    offset: float = 0.0,
    backlash: float = 0.1,
    module: float = MODULE,
) -> Scene:
    """Standard proportions with a little backlash: helix (deg), width, backlash and axial offset of the wheel (mm),
    torque (N mm)."""
    # As NumPy 2 does not write them.
    offset, width, torque = float(offset), float(width), float(torque)
    stretch = 1.0 / cos(radians(helix))
    diameters = [module * count * stretch for count in teeth]
    gears = "".join(
        f'[gears.{name}]\nteeth = {count}\nprofile_shift = 0.0\ntip_diameter = "{diameter + 2.0 * module!r}'
        f' mm"\nroot_diameter = "{diameter - 2.5 * module!r} mm"\nbore_diameter = "{0.4 * diameter!r}'
        f' mm"\n{beside}[gears.{name}.material]\nyoungs_modulus = "{elasticity!r} N/mm^2"\npoissons_ratio ='
        f" {poissons_ratio!r}\n"
        for name, count, diameter, elasticity, beside in zip(
            ("pinion", "wheel"), teeth, diameters, elasticities, ("", f'axial_offset = "{offset!r} mm"\n')
        )
    )
    lean = f'helix_angle = "{helix!r} deg"\npinion_hand = "{hand}"\n' if helix else ""
    return scene_from_text(
        f'[gears]\nmodule = "{module!r} mm"\npressure_angle = "20 deg"\n{lean}centre_distance ='
        f' "{0.5 * sum(diameters) + backlash!r} mm"\nface_width = "{width!r} mm"\n{gears}'
        f'[load]\nwheel_torque = "{torque!r} N mm"\n[motion]\nmesh_frequency = "{frequency!r} Hz"\nmesh_cycles ='
        f" {cycles}\nrecorded_cycles = {cycles}\n"
        f"{accuracy and '[accuracy]'}\n{accuracy}\n{more}"
    )


def wide_pair(more: str = "") -> Scene:
    """30 mm wide under 300 N m; accuracy is the program's own or in the sections `more`."""
    return helical_scene(more, width=30.0, torque=300e3, accuracy="")


def on_stand_in_bodies(model: Model, reach: float | None = 0.2) -> Bodies:
    """Of both flanks where the scene has coast flanks."""
    offsets, coast = model.touching.reach.farthest, model.scene.coast_flanks is not None
    gears = (model.pair.pinion, model.pair.wheel)
    pinion, wheel = (
        Body(
            stand_in_compliance(gear, offsets=offsets, coast_flank=coast),
            stand_in_body(gear, width, elements=12, offsets=offsets, coast_flank=coast, reach=reach),
        )
        for gear, width in zip(gears, model.pair.face_widths)
    )
    return pinion, wheel
