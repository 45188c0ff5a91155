"""Five gear pairs on which `[accuracy] target` is judged: the paper's, equal, slow, of high contact ratio, of large profile shift.

All with tip relief, as such gears are made; the paper's own tips, whose sharp edges press, are the sixth.
"""

from dataclasses import replace
from math import cos, radians, tan

from scipy.optimize import brentq

from fenics_gears.effects.relief import LINEAR, Relief
from fenics_gears.effects.tip_relief import TipRelief
from fenics_gears.geometry.pair import gear_pair
from fenics_gears.scene.data import Accuracy, GearData, GearPairData, Motion, Scene

PRESSURE_ANGLE = radians(20.0)
# Centres stand this part of a module further apart than without backlash.
PLAY = 0.02
# Line load, N/mm, of those that are not the paper's; about its own.
LINE_LOAD = 300.0
# Tip relief: depth in mm, from this part of a module below the tip diameter on.
RELIEF, RELIEVED = 0.03, 0.9
SHARP = "16/24, sharp tips"


def rack_gear(module: float, teeth: int, shift: float, addendum: float = 1.0, dedendum: float = 1.25, rounding: float = 0.38) -> GearData:
    """A gear cut by a rack; addendum, dedendum and rounding in modules."""
    tip, root = module * (teeth + 2.0 * (shift + addendum)), module * (teeth + 2.0 * (shift - dedendum))
    return GearData(teeth, shift, tip, root, 0.6 * root, rounding)


def rack_pair(module: float, teeth: tuple[int, int], shifts=(0.0, 0.0), face_width: float = 15.0, material=None, **rack) -> GearPairData:
    """A pair at the centre distance without backlash and a little more (DIN 3960: involute of the working pressure angle)."""
    pinion, wheel = (rack_gear(module, count, shift, **rack) for count, shift in zip(teeth, shifts))
    along = _involute(PRESSURE_ANGLE) + 2.0 * sum(shifts) / sum(teeth) * tan(PRESSURE_ANGLE)
    working = brentq(lambda angle: _involute(angle) - along, 1e-3, 1.2)
    distance = 0.5 * module * sum(teeth) * cos(PRESSURE_ANGLE) / cos(working) + PLAY * module
    return GearPairData(module, PRESSURE_ANGLE, distance, face_width, pinion, wheel, material)


def pairs(paper: Scene) -> dict[str, Scene]:
    """The scenes by name, quasi-static and without friction, with the paper's shafts and bearings, and defaults for all settings."""
    plain = replace(paper, inertia=None, damping=None, friction=None, accuracy=Accuracy(), motion=Motion(200.0, 1, 1))
    material = paper.gears.material
    high = {"addendum": 1.35, "dedendum": 1.6, "rounding": 0.2}
    gears = {
        "50/50": rack_pair(2.0, (50, 50), material=material),
        "20/80": rack_pair(3.0, (20, 80), material=material),
        "40/60, high contact ratio": rack_pair(3.0, (40, 60), material=material, **high),
        "14/30, shifts 0.6 and 0.5": rack_pair(4.0, (14, 30), (0.6, 0.5), material=material),
    }
    relieved = replace(plain, tip_relief=_relief(plain.gears))
    return {"16/24": relieved, **{name: _loaded(plain, data) for name, data in gears.items()}, SHARP: plain}


def _loaded(plain: Scene, gears: GearPairData) -> Scene:
    torque = LINE_LOAD * gears.face_width * gear_pair(gears).wheel.base_radius
    return replace(plain, gears=gears, load=replace(plain.load, wheel_torque=torque), tip_relief=_relief(gears))


def _relief(gears: GearPairData) -> TipRelief:
    return TipRelief(*(Relief(RELIEF, None, LINEAR, gear.tip_diameter - RELIEVED * gears.module) for gear in (gears.pinion, gears.wheel)))


def _involute(angle: float) -> float:
    return tan(angle) - angle
