"""Mass and moment of inertia of the gears and of what the output shaft drives."""

from dataclasses import dataclass, replace

from fenics_gears.inputs.fields import quantity
from fenics_gears.inputs.section import Section, own_or_shared

LUMPED = ("mass", "moment_of_inertia")
OF_DENSITY = "from the gear's own `density`, otherwise from `[inertia]`"


def _mass(meaning: str, otherwise: str):
    return quantity("1e-9 kg to 1e9 kg", "4.9 kg", meaning=meaning, otherwise=otherwise)


def _moment_of_inertia(meaning: str, otherwise: str = ""):
    return quantity("1e-15 kg m^2 to 1e15 kg m^2", "24.5e-3 kg m^2", meaning=meaning, otherwise=otherwise)


def _density(otherwise: str):
    meaning = (
        "density of the gear; mass and moment of inertia follow from its outline, bore and face width, without the"
        " shaft"
    )
    return quantity("1e-6 g/cm^3 to 1e6 g/cm^3", "7.85 g/cm^3", meaning=meaning, otherwise=otherwise)


def _tilting(otherwise: str):
    meaning = (
        "moment of inertia about a diameter at mid-width of a gear that tilts: with the shaft, where bearings have"
        " `places`; without it, where that has `sections`"
    )
    return quantity("1e-15 kg m^2 to 1e15 kg m^2", "13e-3 kg m^2", meaning=meaning, otherwise=otherwise)


@dataclass(frozen=True)
class GearInertia(Section):
    """``[inertia.pinion]`` and ``[inertia.wheel]``; values that are left out follow from the gear's own density,
    otherwise from ``[inertia]``."""

    mass: float | None = _mass("mass of this gear, with its shaft, if that has no `sections`", OF_DENSITY)
    moment_of_inertia: float | None = _moment_of_inertia("moment of inertia of this gear", OF_DENSITY)
    density: float | None = _density("that of `[inertia]`, where the gear has no mass and moment of inertia of its own")
    tilting_moment_of_inertia: float | None = _tilting("that of `[inertia]`")


@dataclass(frozen=True)
class LoadInertia(Section):
    """``[inertia.load]``: the driven machine on the end of the output shaft; without ``[shafts]`` it turns with the
    wheel."""

    moment_of_inertia: float = _moment_of_inertia("moment of inertia of the load")


@dataclass(frozen=True)
class Inertia(GearInertia):
    """``[inertia]``: masses and moments of inertia, lumped at the gear centres. The far end of the input shaft needs
    none: its rotation is prescribed."""

    mass: float | None = _mass(
        "mass of each gear, with its shaft, if that has no `sections`", "from `density`, or each gear has its own"
    )
    moment_of_inertia: float | None = _moment_of_inertia(
        "moment of inertia of each gear, and of the load if there is no `[inertia.load]`",
        "from `density`, or each gear has its own",
    )
    density: float | None = _density("mass and moment of inertia must be given")
    tilting_moment_of_inertia: float | None = _tilting(
        "that of a disc: half of the moment of inertia, and mass times face width squared over 12"
    )
    pinion: GearInertia | None = None
    wheel: GearInertia | None = None
    load: LoadInertia | None = None

    def of(self, gear: str) -> GearInertia:
        """Inertia of the "pinion" or the "wheel": its own, by its own density, or that of both."""
        own = getattr(self, gear) or GearInertia()
        tilting = own_or_shared(own, self, "tilting_moment_of_inertia")
        if own.density is not None:
            return replace(own, tilting_moment_of_inertia=tilting)
        mass, moment = (own_or_shared(own, self, name) for name in LUMPED)
        return GearInertia(mass, moment, self.density, tilting)

    @property
    def shaft_end(self) -> float | None:
        """Moment of inertia (N mm s^2) at the far end of the output shaft."""
        return own_or_shared(self.load, self, "moment_of_inertia")
