"""Data of masses, shafts, bearings and damping, in N, mm, s and rad."""

from __future__ import annotations

from dataclasses import dataclass, replace

LUMPED = ("mass", "moment_of_inertia")


@dataclass(frozen=True)
class GearInertia:
    """Mass, N s^2/mm, and moment of inertia, N mm s^2, of a gear; where one is None, it is that of its body of
    `density`, N s^2/mm^4.

    `tilting_moment_of_inertia`, N mm s^2: about a diameter; None: as of a disc.
    """

    mass: float | None = None
    moment_of_inertia: float | None = None
    density: float | None = None
    tilting_moment_of_inertia: float | None = None


@dataclass(frozen=True)
class Inertia(GearInertia):
    """Inertia of both gears, of `pinion` and `wheel` where they have their own, and moment of inertia of the `load`
    (None: as of both gears)."""

    pinion: GearInertia | None = None
    wheel: GearInertia | None = None
    load: float | None = None

    def of(self, gear: str) -> GearInertia:
        """Inertia of the "pinion" or the "wheel": its own, by its own density, or that of both."""
        own = getattr(self, gear) or GearInertia()

        def given(name: str) -> float | None:
            return getattr(self if getattr(own, name) is None else own, name)

        tilting = given("tilting_moment_of_inertia")
        if own.density is not None:
            return replace(own, tilting_moment_of_inertia=tilting)
        return GearInertia(*(given(name) for name in LUMPED), self.density, tilting)

    @property
    def shaft_end(self) -> float | None:
        """Moment of inertia (N mm s^2) at the far end of the output shaft."""
        return self.moment_of_inertia if self.load is None else self.load


@dataclass(frozen=True)
class Shaft:
    """Torsional stiffness of one shaft, N mm/rad."""

    torsional_stiffness: float


@dataclass(frozen=True)
class Shafts:
    """Torsional stiffness, N mm/rad, of both shafts, and of `input` and `output` where they have their own."""

    torsional_stiffness: float | None = None
    input: Shaft | None = None
    output: Shaft | None = None

    def of(self, shaft: str) -> float:
        """Torsional stiffness (N mm/rad) of the "input" or the "output" shaft."""
        own = getattr(self, shaft)
        return self.torsional_stiffness if own is None else own.torsional_stiffness


@dataclass(frozen=True)
class Support:
    """Translational stiffness of one shaft's support, N/mm: in every direction across the axis, along and off the line
    of action, and along the
    axis; None: as of both shafts."""

    stiffness: float | None = None
    stiffness_x: float | None = None
    stiffness_y: float | None = None
    axial_stiffness: float | None = None

    def along(self, direction: str) -> float | None:
        """Stiffness in "x" or "y"; None where it is not given."""
        own = {"x": self.stiffness_x, "y": self.stiffness_y}[direction]
        return self.stiffness if own is None else own


@dataclass(frozen=True)
class BearingPlaces:
    """Places (mm) of the two bearings of the pinion's and of the wheel's shaft, along the axis from the gear's
    mid-width; a gear without does not tilt."""

    pinion: tuple[float, ...] | None = None
    wheel: tuple[float, ...] | None = None


@dataclass(frozen=True)
class Bearings(Support):
    """Support of both shafts, and of `pinion` and `wheel` where they have their own.

    `places`: of the bearings, each of which has half of the stiffness across the axis; without them gears neither tilt
        nor move axially.
    """

    pinion: Support | None = None
    wheel: Support | None = None
    places: BearingPlaces | None = None

    def of(self, gear: str, direction: str) -> float:
        """Stiffness (N/mm) of the "pinion"'s or the "wheel"'s support in "x" or "y"."""
        own = getattr(self, gear)
        stiffness = None if own is None else own.along(direction)
        return self.along(direction) if stiffness is None else stiffness

    def axial(self, gear: str) -> float | None:
        """Axial stiffness (N/mm) of the "pinion"'s or the "wheel"'s shaft; None where it is held."""
        own = getattr(getattr(self, gear), "axial_stiffness", None)
        return self.axial_stiffness if own is None else own

    def places_of(self, gear: str) -> tuple[float, ...] | None:
        """Places (2,), mm, of the bearings of the "pinion"'s or the "wheel"'s shaft; None where that gear does not
        tilt."""
        return getattr(self.places, gear, None)


RAYLEIGH, MODAL = ("stiffness_proportional", "mass_proportional"), ("ratio", "ratios")


@dataclass(frozen=True)
class Rayleigh:
    """Rayleigh damping of a shaft with its gear: alpha K + beta M, alpha in s, beta in 1/s; None: as of both shafts."""

    stiffness_proportional: float | None = None
    mass_proportional: float | None = None


@dataclass(frozen=True)
class Damping(Rayleigh):
    """Rayleigh damping of both shafts, and of `pinion` and `wheel`, each with its shaft, where they have their own; or
    `ratios` alone.

    `ratios`: of the critical damping, by mode from the lowest frequency on; the last holds for all that follow.
    """

    pinion: Rayleigh | None = None
    wheel: Rayleigh | None = None
    ratios: tuple[float, ...] = ()

    def of(self, gear: str, name: str) -> float:
        """`name` of alpha and beta, of the shaft of the "pinion" or of the "wheel"."""
        own = getattr(getattr(self, gear), name, None)
        return getattr(self, name) if own is None else own
