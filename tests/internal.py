"""A planet in its ring: 22 and -61 teeth of 4 mm, as in the planetary stage of FVA's REXS file."""

from math import radians

from fenics_gears import Gear
from fenics_gears.geometry.gear_data import Cutter
from fenics_gears.geometry.pair import GearPair

MODULE = 4.0
ANGLE = radians(20.0)
PLANET = Gear(22, MODULE, ANGLE, 0.0, 48.0, 39.0, 20.0, 0.38 * MODULE)
COARSE = """
[accuracy]
element = "P1"
flank_element_size = "0.2 mm"
contact_length = "3 mm"
contact_nodes = 20
steps_per_mesh_cycle = 20
"""


def moving(cycles: int, more_of_bearings: str = "") -> str:
    """Sections of a pair with inertia and friction on bearings, over so many mesh cycles."""
    return f"""
[friction]
coefficient = 0.08
[motion]
pinion_speed = "1500 rpm"
mesh_cycles = {cycles}
[inertia]
pinion = {{ density = "7800 kg/m^3" }}
wheel = {{ density = "7800 kg/m^3" }}
[damping]
ratio = 0.05
[bearings]
stiffness = "500 kN/mm"
{more_of_bearings}
"""


def ring(cutter: int | None = 23, outer: float = 140.0, tip: float = 119.0, teeth: int = 61, **more) -> Gear:
    """Radii without sign, mm; `cutter`: its teeth, None for plain fillets."""
    root = 0.5 * teeth * MODULE + 1.25 * MODULE
    own = Cutter(cutter) if cutter else None
    return Gear(-teeth, MODULE, ANGLE, 0.0, -tip, -root, -outer, 0.2 * MODULE, cutter=own, **more)


def planet_in_ring(distance: float = 78.0, **of_ring) -> GearPair:
    return GearPair(PLANET, ring(**of_ring), -distance, 50.0)


def internal_scene(
    *, wheel: str = "", gears: str = "", load: str = 'pinion_torque = "500 N m"', more: str = COARSE
) -> str:
    """A scene of them; `wheel`: more fields of the ring, in an inline table."""
    support = "" if "support" in wheel else ', support = "held"'
    return f"""
[gears]
module = "4 mm"
pressure_angle = "20 deg"
face_width = "50 mm"
material = "steel"
{gears}
pinion = {{ teeth = 22, profile_shift = 0, bore_diameter = "40 mm" }}
wheel = {{ teeth = -61, profile_shift = 0, outer_diameter = "280 mm", cutter = {{ teeth = 23 }}{support}{wheel} }}
[load]
{load}
{more}"""
