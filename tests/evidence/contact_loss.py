"""Contact loss of two equal gears over speed, up and down through resonance (Blankenship and Kahraman; Parker,
Vijayakar and Imajo), beside a mass on a spring that only presses, whose period is known in closed form."""

from dataclasses import dataclass, replace
from math import acos, pi, sqrt
from pathlib import Path

import numpy as np
from demos.speed_ramp.sweeps import Sweep, sweep
from matplotlib.figure import Figure
from scipy.optimize import brentq
from tests.evidence.claim import EXACT, Claim, Numbers, Part, within

from fenics_gears import Scene, gear_pair, load_scene, lumped_gears, simulate
from fenics_gears.effects.speed_ramp import SpeedRamp
from fenics_gears.runs.gear_store import GearStore
from fenics_gears.scene.data import Motion
from fenics_gears.show.panels import DARK, PALETTE, styled

SCENE = Path(__file__).with_name("pair_50_50.toml")
PICTURE = Path(__file__).parents[2] / "docs" / "pictures" / "contact_loss.png"


@dataclass(frozen=True)
class Oscillator:
    mass: float
    stiffness: float
    load: float

    @property
    def natural_frequency(self) -> float:
        return sqrt(self.stiffness / self.mass) / (2.0 * pi)

    def period_and_swing(self, amplitude: float) -> tuple[float, float]:
        """Period (s) and peak-to-peak (mm) of a free vibration with an amplitude (mm) in contact: half an
        oscillation and more, then a flight."""
        pressed, rate = self.load / self.stiffness, sqrt(self.stiffness / self.mass)
        if amplitude <= pressed:
            return 2.0 * pi / rate, 2.0 * amplitude
        leaving = rate * sqrt(amplitude**2 - pressed**2)
        flight = 2.0 * leaving * self.mass / self.load
        touching = 2.0 * (pi - acos(pressed / amplitude)) / rate
        return touching + flight, pressed + amplitude + 0.125 * flight**2 * self.load / self.mass

    def frequency(self, swing: float) -> float:
        """Hz, of the free vibration with a peak-to-peak value (mm)."""
        amplitude = brentq(lambda each: self.period_and_swing(each)[1] - swing, 0.0, swing)
        return 1.0 / self.period_and_swing(amplitude)[0]


def oscillator(scene: Scene) -> Oscillator:
    """Both gears turn against each other, on the mean tangent stiffness at rest."""
    still = replace(scene, inertia=None, damping=None, shafts=None, coast_flanks=None, speed_ramp=None,
                    motion=Motion(1.0, 1, 1))  # fmt: skip
    stiffness = float(simulate(still).mesh_stiffness_tangent.mean())
    pair, gears = gear_pair(scene.gears), lumped_gears(scene, gear_pair(scene.gears))
    radii = (pair.pinion.base_radius, pair.wheel.base_radius)
    inverse = sum(radius**2 / each.moment_of_inertia for radius, each in zip(radii, gears.values()))
    return Oscillator(1.0 / inverse, stiffness, scene.load.wheel_torque / pair.wheel.base_radius)


def backwards(scene: Scene) -> Scene:
    first, ramp = scene.motion.mesh_frequency, scene.speed_ramp
    return replace(
        scene,
        motion=replace(scene.motion, mesh_frequency=ramp.end_frequency),
        speed_ramp=SpeedRamp(first, ramp.hold_cycles),
    )


def sweeps(scene: Scene) -> dict[str, Sweep]:
    """Up and down; amplitudes in mm on the wheel's base circle, without the held cycles."""
    radius, store, held = gear_pair(scene.gears).wheel.base_radius, GearStore(), scene.speed_ramp.hold_cycles
    found = {"up": sweep(scene, store), "down": sweep(backwards(scene), store)}
    return {name: Sweep(each.frequency[held:], radius * each.amplitude[held:]) for name, each in found.items()}


@styled
def picture(passed: dict[str, Sweep], free: Oscillator) -> Figure:
    figure = Figure(figsize=(9.0, 4.8), layout="constrained")
    axes = figure.subplots()
    for (name, each), colour in zip(passed.items(), PALETTE):
        axes.plot(each.frequency, 1e3 * each.amplitude, "-", color=colour, label=f"speed going {name}")
    largest = max(each.amplitude.max() for each in passed.values())
    curve = [free.period_and_swing(part * largest) for part in np.linspace(0.01, 1.0, 200)]
    shown = [(1.0 / period, 1e3 * swing) for period, swing in curve if swing <= largest]
    axes.plot(*zip(*shown), "--", color=DARK, label="free oscillator, closed form")
    axes.set(xlabel="Mesh frequency (Hz)", ylabel="Transmission error, peak to peak (µm)", ylim=(0.0, None),
             title="50/50, module 3 mm: contact loss through resonance")  # fmt: skip
    axes.legend(loc="upper left")
    return figure


def measured(_: str) -> Numbers:
    """The frequency at which the vibration is largest on the way down, beside the oscillator's with as much."""
    scene = load_scene(SCENE)
    passed, free = sweeps(scene), oscillator(scene)
    picture(passed, free).savefig(PICTURE)
    down = passed["down"]
    most = int(down.amplitude.argmax())
    return {"softening": (free.frequency(float(down.amplitude[most])), float(down.frequency[most]))}


PART = Part(
    "contact_loss", EXACT, "experiments.md#contact-loss-over-speed",
    {"softening": Claim("mesh frequency at resonance, teeth separating, 50 and 50 teeth",
                        "free vibration of a mass on a spring that only presses", "Hz", within(0.03),
                        "the mesh stiffness varies; the speed falls while the vibration grows")},
    measured, minutes=1.5,
)  # fmt: skip
