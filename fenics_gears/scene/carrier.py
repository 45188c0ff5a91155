"""The carrier of a planetary set as the train in its frame has it: which gears its pins carry, how stiffly, where."""

from __future__ import annotations

from cmath import rect
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf
from re import sub

import numpy as np

from fenics_gears.dynamics.shafts import HousingFile
from fenics_gears.geometry.planetary import CARRIER, SUN, PlanetarySet
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
    each planet tangential, against its force, and radial, outwards, mm; none where pins are in their places. `file`:
    stiffness of the carrier between its pins, None where it is rigid; `bearing_stiffness`, N/mm: None where its centre
    is held.
    `run_outs`: of gears whose base circles are off their axes. `pitches`: by the name of a gear the deviations of its
    pitches, mm, in the order in which its teeth mesh.
    `floating`: members that no bearing holds. `speed`, rad/s, and `torque`, N mm: of the input. `vibration`: lumped
    members, None where the scene has none; `in_time`: whether it runs with them, else they are for natural frequencies
    alone."""

    stage: str
    set: PlanetarySet
    pin_stiffness: float | None = None
    pin_errors: tuple[tuple[float, float], ...] = ()
    floating: tuple[str, ...] = ()
    run_outs: tuple[RunOut, ...] = ()
    pitches: tuple[tuple[str, tuple[float, ...]], ...] = ()
    speed: float | None = None
    torque: float = 0.0
    vibration: VibrationText | None = None
    file: HousingFile | None = None
    bearing_stiffness: float | None = None
    in_time: bool = False

    @property
    def moving(self) -> tuple[str, ...]:
        """Members whose centres move: what is floating or on springs, a carrier too."""
        own = tuple(each for each in self.set.members if each != CARRIER and self.held(each) is not None)
        return own if self.bearing_stiffness is None else (*own, CARRIER)

    @property
    def sun(self) -> str:
        """Name of the sun among the gears of the train."""
        return f"{self.stage}.{SUN}"

    @property
    def ring(self) -> str:
        """Name of the ring, or the second sun, among the gears of the train."""
        return f"{self.stage}.{self.set.second}"

    @property
    def planets(self) -> list[str]:
        """Names of the planets among the gears of the train."""
        return [f"{self.stage}.planet {number}" for number in range(1, self.set.planets + 1)]

    @property
    def steps(self) -> list[str]:
        """Names of the gears that mesh with the ring: the planets themselves unless they are stepped."""
        if not self.set.stepped:
            return self.planets
        return [f"{self.stage}.step {number}" for number in range(1, self.set.planets + 1)]

    @property
    def shafts(self) -> tuple[tuple[str, ...], ...]:
        """Names of the gears on each shaft, from the sun to the ring."""
        planets = (tuple(dict.fromkeys(both)) for both in zip(self.planets, self.steps))
        return ((self.sun,), *planets, (self.ring,))

    def meshes(self, kind: int) -> slice:
        """Which of the meshes are with the sun (0), or with the ring (1): in turns, but all of either one after the
        other where planets are stepped, and no gear couples them."""
        count = self.set.planets
        return slice(kind * count, (kind + 1) * count) if self.set.stepped else slice(kind, None, 2)

    def centred(self, gears: Sequence[str]) -> dict[int, int]:
        """Of the second gears of stepped planets, by their numbers among all `gears`, the first one."""
        known = [(gears.index(one), gears.index(other)) for one, other in zip(self.steps, self.planets)]
        return {one: other for one, other in known if one != other}

    def planet_of(self, gear: str) -> int | None:
        """Number from 0 of the planet that has a gear; None of sun and ring."""
        return next((names.index(gear) for names in (self.planets, self.steps) if gear in names), None)

    def support(self, gear: str) -> tuple[float, float] | None:
        """Stiffness (N/mm) along and off any line that holds the centre of a gear: infinite where it is held beside its
        place, None where in it; that of planets which are held `together` is there."""
        if self.planet_of(gear) is not None:
            if self.together is not None:
                return 0.0, 0.0
            stiffness = self.pin_stiffness or (inf if self.pin_errors else None)
            return None if stiffness is None else (stiffness, stiffness)
        stiffness = self.held(SUN if gear == self.sun else self.set.second)
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

    @cached_property
    def together(self) -> np.ndarray | None:
        """Stiffness (2 n, 2 n), N/mm, that holds the centres of the planets in the direction 0 of the set and 90
        degrees counter-clockwise of it, planet after planet: of pins, carrier and its bearings in series. None where
        pins alone give way, each by itself."""
        if self.file is None and self.bearing_stiffness is None:
            return None
        on_hub = self._on_hub
        if self.bearing_stiffness is None:
            return on_hub
        return on_hub - on_hub @ self._rigid @ self.centre_by_planets

    @property
    def centre_by_planets(self) -> np.ndarray:
        """Displacement (2, 2 n) of a carrier on bearings by those of the planets: forces on it balance."""
        pushed = self._rigid.T @ self._on_hub
        return np.linalg.solve(pushed @ self._rigid + (self.bearing_stiffness or 0.0) * np.eye(2), pushed)

    @property
    def _on_hub(self) -> np.ndarray:
        """Stiffness (2 n, 2 n) of pins and carrier in series, its hub held."""
        pin = self.pin_stiffness
        one = np.eye(2 * self.set.planets)
        if self.file is None or self.file.stiffness is None:
            return one * (pin or 0.0)
        own = np.array(self.file.stiffness)
        found = own if pin is None else np.linalg.solve(own / pin + one, own)
        return 0.5 * (found + found.T)

    @property
    def _rigid(self) -> np.ndarray:
        """Displacements (2 n, 2) of the pins as the carrier moves aside."""
        return np.tile(np.eye(2), (self.set.planets, 1))

    def displaced(self, gear: str) -> complex:
        """Where (mm) the centre of a gear stands beside its place, in space."""
        number = self.planet_of(gear)
        if not self.pin_errors or number is None:
            return 0j
        tangential, radial = self.pin_errors[number]
        # The sun turns counter-clockwise, and so its teeth and the ring's push the planets.
        return (radial - 1j * tangential) * rect(1.0, self.set.angles[number])


@dataclass(frozen=True)
class OfSet:
    """A mesh of a set: the `stage`, what it calls the gears of the pair, and how often its effects are named:
    `sun_mesh` or `ring_mesh`; and fields of gears that are its own (`cut`). `own_accuracy`: whether `[accuracy]` is of
    the stage, not of the whole train."""

    stage: str
    gears: tuple[str, str]
    mesh: str
    cut: tuple[str, ...] = ()
    own_accuracy: bool = False

    def words(self, said: str) -> str:
        """What is said of the pair, in words of the set."""
        # Sets name a number of mesh cycles.
        said = said.replace(f' or "{HUNTING_TOOTH_PERIOD}"', "")
        said = said.replace("[wheel_points]", f"[stages.{self.stage}.ring.points]")
        for one, other in zip(GEARS, self.gears):
            said = sub(rf"\bgears\.{one}\b", f"stages.{self.stage}.{other}", said)
            said = sub(rf"\b{one}\b", other, said)
        return said.replace("[gears", f"[stages.{self.stage}").replace("gears.", f"stages.{self.stage}.")

    def place(self, path: tuple[str, ...]) -> tuple[str, ...]:
        """Where a scene has what the scene of the pair has at a path."""
        if path[:1] == ("accuracy",) and self.own_accuracy:
            return ("stages", self.stage, *path)
        if path[:1] == ("wheel_points",):
            return ("stages", self.stage, "ring", "points", *path[1:])
        if path[:1] != ("gears",):
            return path if path[:1] in (("friction",), ("accuracy",), ("load",)) else (
                "stages", self.stage, self.mesh, *path
            )  # fmt: skip
        inner = path[1:]
        if inner and inner[0] in GEARS:
            inner = (self.gears[GEARS.index(inner[0])], *inner[1:])
        own = (self.mesh,) if inner[:1] and inner[0] in self.cut else ()
        return ("stages", self.stage, *own, *inner)
