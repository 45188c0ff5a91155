"""The carrier of a planetary set as the train in its frame has it: which gears its pins carry, how stiffly, where."""

from __future__ import annotations

from cmath import rect
from dataclasses import dataclass
from math import inf
from re import sub

from fenics_gears.geometry.planetary import RING, SUN, PlanetarySet
from fenics_gears.inputs.tree import GEARS

from .planetary_schema import VibratingMember, VibratingPlanet, VibrationText
from .schema import HUNTING_TOOTH_PERIOD


@dataclass(frozen=True)
class RunOut:
    """A `gear` by its name, how far (mm) the centre of its base circle is off its axis, and at which `phase` (rad,
    counter-clockwise in space) as the run begins."""

    gear: str
    distance: float
    phase: float


@dataclass(frozen=True)
class Carrier:
    """The carrier of the set in a `stage`. `pin_stiffness`, N/mm: None where pins do not give way; `pin_errors`: of
    each planet tangential, against its force, and radial, outwards, mm; none where pins are in their places.
    `run_outs`: of gears whose base circles are off their axes.
    `floating`: members that no bearing holds. `speed`, rad/s, and `torque`, N mm: of the input. `vibration`: lumped
    members, None where the scene has none; `in_time`: whether it runs with them, else they are for natural frequencies
    alone."""

    stage: str
    set: PlanetarySet
    pin_stiffness: float | None = None
    pin_errors: tuple[tuple[float, float], ...] = ()
    floating: tuple[str, ...] = ()
    run_outs: tuple[RunOut, ...] = ()
    speed: float | None = None
    torque: float = 0.0
    vibration: VibrationText | None = None
    in_time: bool = False

    @property
    def sun(self) -> str:
        """Name of the sun among the gears of the train."""
        return f"{self.stage}.{SUN}"

    @property
    def ring(self) -> str:
        """Name of the ring among the gears of the train."""
        return f"{self.stage}.{RING}"

    @property
    def planets(self) -> list[str]:
        """Names of the planets among the gears of the train."""
        return [f"{self.stage}.planet {number}" for number in range(1, self.set.planets + 1)]

    @property
    def gears(self) -> list[str]:
        """Names of all gears, shaft by shaft from the sun to the ring."""
        return [self.sun, *self.planets, self.ring]

    def support(self, gear: str) -> tuple[float, float] | None:
        """Stiffness (N/mm) along and off any line that holds the centre of a gear: infinite where it is held beside its
        place, None where in it."""
        if gear in self.planets:
            stiffness = self.pin_stiffness or (inf if self.pin_errors else None)
            return None if stiffness is None else (stiffness, stiffness)
        stiffness = self.held(SUN if gear == self.sun else RING)
        return None if stiffness is None else (stiffness, stiffness)

    def held(self, member: str) -> float | None:
        """Stiffness (N/mm) that holds the centre of sun or ring, 0 of one that floats; None where it stands."""
        if member in self.floating:
            return 0.0
        if not self.in_time or self.vibration is None:
            return None
        lumped: VibratingMember = getattr(self.vibration, member)
        return lumped.support_stiffness

    def lumped(self, member: str) -> VibratingPlanet:
        """Masses and springs of a lumped member."""
        found: VibratingPlanet = getattr(self.vibration, member)
        return found

    def displaced(self, gear: str) -> complex:
        """Where (mm) the centre of a gear stands beside its place, in space."""
        if not self.pin_errors or gear not in self.planets:
            return 0j
        number = self.planets.index(gear)
        tangential, radial = self.pin_errors[number]
        # The sun turns counter-clockwise, and so its teeth and the ring's push the planets.
        return (radial - 1j * tangential) * rect(1.0, self.set.angles[number])


@dataclass(frozen=True)
class OfSet:
    """A mesh of a set: the `stage`, what it calls the gears of the pair, and how often its effects are named:
    `sun_mesh` or `ring_mesh`."""

    stage: str
    gears: tuple[str, str]
    mesh: str

    def words(self, said: str) -> str:
        """What is said of the pair, in words of the set."""
        # Sets name a number of mesh cycles.
        said = said.replace(f' or "{HUNTING_TOOTH_PERIOD}"', "")
        for one, other in zip(GEARS, self.gears):
            said = sub(rf"\bgears\.{one}\b", f"stages.{self.stage}.{other}", said)
            said = sub(rf"\b{one}\b", other, said)
        return said.replace("[gears", f"[stages.{self.stage}").replace("gears.", f"stages.{self.stage}.")

    def place(self, path: tuple[str, ...]) -> tuple[str, ...]:
        """Where a scene has what the scene of the pair has at a path."""
        if path[:1] != ("gears",):
            return path if path[:1] in (("friction",), ("accuracy",), ("load",)) else (
                "stages", self.stage, self.mesh, *path
            )  # fmt: skip
        inner = path[1:]
        if inner and inner[0] in GEARS:
            inner = (self.gears[GEARS.index(inner[0])], *inner[1:])
        return ("stages", self.stage, *inner)
