"""Pairs on which `[accuracy] target` is judged: with tip relief, neither friction nor inertia; the paper's own sharp
tips, also with friction and at 200 Hz; ten at random."""

from dataclasses import replace
from math import cos, radians, tan

import numpy as np
from scipy.optimize import brentq

from fenics_gears.effects.friction import Friction
from fenics_gears.effects.tip_relief import TipRelief
from fenics_gears.errors import GeometryError
from fenics_gears.geometry.pair import gear_pair
from fenics_gears.geometry.relief import LINEAR, Relief
from fenics_gears.inputs.allowed import Measured
from fenics_gears.scene.data import Accuracy, GearData, GearPairData, Motion, Scene

PRESSURE_ANGLE = radians(20.0)
# Centres stand this part of a module further apart than without backlash.
PLAY = 0.02
# Line load, N/mm, of those that are not the paper's; about its own.
LINE_LOAD = 300.0
# Tip relief: depth in mm, from this part of a module below the tip diameter on.
RELIEF, RELIEVED = 0.03, 0.9
SHARP = "16/24, sharp tips"
# Mesh cycles of a run with inertia, which then repeat.
SETTLING = 30
# Relief of the random pairs: as much as a rough tooth pair of so many N/(mm um) gives way.
RELIEF_STIFFNESS = 12.0


def rack_gear(
    module: float, teeth: int, shift: float, addendum: float = 1.0, dedendum: float = 1.25, rounding: float = 0.38
) -> GearData:
    """A gear cut by a rack; addendum, dedendum and rounding in modules."""
    tip, root = module * (teeth + 2.0 * (shift + addendum)), module * (teeth + 2.0 * (shift - dedendum))
    return GearData(teeth, shift, tip, root, 0.6 * root, rounding)


def rack_pair(
    module: float, teeth: tuple[int, int], shifts=(0.0, 0.0), face_width: float = 15.0, material=None, **rack
) -> GearPairData:
    """A pair at the centre distance without backlash (DIN 3960) and a little more."""
    pinion, wheel = (rack_gear(module, count, shift, **rack) for count, shift in zip(teeth, shifts))
    along = _involute(PRESSURE_ANGLE) + 2.0 * sum(shifts) / sum(teeth) * tan(PRESSURE_ANGLE)
    working = brentq(lambda angle: _involute(angle) - along, 1e-3, 1.2)
    distance = 0.5 * module * sum(teeth) * cos(PRESSURE_ANGLE) / cos(working) + PLAY * module
    return GearPairData(module, PRESSURE_ANGLE, distance, face_width, pinion, wheel, material)


def pairs(paper: Scene) -> dict[str, Scene]:
    """The scenes by name, with the paper's shafts and bearings, and defaults for all settings."""
    dynamic = replace(paper, accuracy=Accuracy(), motion=Motion(200.0, SETTLING, 1))
    plain = _quasi_static(replace(dynamic, friction=None))
    material = paper.gears.material
    high = {"addendum": 1.35, "dedendum": 1.6, "rounding": 0.2}
    gears = {
        "50/50": rack_pair(2.0, (50, 50), material=material),
        "20/80": rack_pair(3.0, (20, 80), material=material),
        "40/60, high contact ratio": rack_pair(3.0, (40, 60), material=material, **high),
        "14/30, shifts 0.6 and 0.5": rack_pair(4.0, (14, 30), (0.6, 0.5), material=material),
    }
    return {
        "16/24": replace(plain, tip_relief=_relief(plain.gears)),
        **{name: replace(_loaded(plain, data), tip_relief=_relief(data)) for name, data in gears.items()},
        SHARP: plain,
        f"{SHARP}, friction 0.1": _quasi_static(dynamic),
        f"{SHARP}, friction 0.1, 200 Hz": dynamic,
        **random_pairs(dynamic, 10),
    }


def held_out(paper: Scene, seed: int) -> dict[str, Scene]:
    """Random pairs of another seed, by which no factor was chosen."""
    return random_pairs(replace(paper, accuracy=Accuracy(), motion=Motion(200.0, SETTLING, 1)), 26, seed)


def random_pairs(dynamic: Scene, count: int, seed: int = 2026) -> dict[str, Scene]:
    """Pairs at random; those that vibrate have the paper's inertia and damping."""
    random, found = np.random.default_rng(seed), {}
    while len(found) < count:
        pinion = int(random.integers(14, 41))
        teeth = pinion, int(random.integers(pinion, 91))
        module = float(random.choice([1.5, 2.0, 3.0, 4.0, 6.0]))
        shifts = tuple(round(float(each), 2) for each in (random.uniform(0.0, 0.5), random.uniform(-0.1, 0.4)))
        line_load = round(random.uniform(20.0, 100.0) * module, -1)
        relieved, friction, vibrates = (
            bool(random.integers(2)),
            float(random.choice([0.0, 0.05, 0.1])),
            bool(random.integers(2)),
        )
        frequency = float(random.choice([100.0, 200.0, 400.0]))
        gears = rack_pair(module, teeth, shifts, 10.0 * module, dynamic.gears.material)
        try:
            scene = _loaded(dynamic, gears, line_load)
        except GeometryError:
            continue
        relief = _relief(gears, round(1e-3 * line_load / RELIEF_STIFFNESS, 4)) if relieved else None
        scene = replace(
            scene,
            tip_relief=relief,
            friction=Friction(friction) if friction else None,
            motion=Motion(frequency, SETTLING, 1),
        )
        words = [
            f"{teeth[0]}/{teeth[1]}, shifts {shifts[0]:g} and {shifts[1]:g}",
            f"{line_load:g} N/mm",
            "relief" if relieved else "sharp tips",
        ]
        words += [f"friction {friction:g}"] * bool(friction) + [f"{frequency:g} Hz"] * vibrates
        found[", ".join(words)] = scene if vibrates else _quasi_static(scene)
    return found


def _quasi_static(scene: Scene) -> Scene:
    return replace(scene, inertia=None, damping=None, motion=Motion(200.0, 1, 1))


def _loaded(scene: Scene, gears: GearPairData, line_load: float = LINE_LOAD) -> Scene:
    torque = line_load * gears.face_width * gear_pair(gears).wheel.base_radius
    return replace(scene, gears=gears, load=replace(scene.load, wheel_torque=torque))


def _relief(gears: GearPairData, depth: float = RELIEF) -> TipRelief:
    return TipRelief(
        *(
            Relief(depth, Measured(gear.tip_diameter - RELIEVED * gears.module, "a length"), shape=LINEAR)
            for gear in (gears.pinion, gears.wheel)
        )
    )


def _involute(angle: float) -> float:
    return tan(angle) - angle
