"""``[inertia]``: mass and moment of inertia of each gear and of what the output shaft drives; the march in time becomes
dynamic (``dynamics``)."""

from dataclasses import dataclass, replace

from fenics_gears.inputs.fields import quantity
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import GEARS, SHAFTS, Tree, given_for, shafts_with_sections, table, value_at, with_gears

from .effect import Effect, ResultVariable, own_or_shared

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


def inertia_is_complete(tree: Tree) -> Broken:
    """Either gear has mass and moment of inertia, in one way; the far end of an output shaft has a moment of
    inertia."""
    both = table(tree, "inertia")
    if both is None:
        return
    if "motor" in both:
        message = (
            "has no effect: the far end of [shafts.input] turns as prescribed. Leave it out; what turns with the pinion"
            " belongs to [inertia.pinion]."
        )
        yield ("inertia", "motor"), message
    yield from _density_stands_alone(tree)
    yield from _what_tilts_has_places(tree)
    missing = {name: [gear for gear in GEARS if not given_for(both, gear) & {name, "density"}] for name in LUMPED}
    for name, gears in missing.items():
        if gears:
            path = ("inertia", name) if len(gears) == 2 else ("inertia", *gears, name)
            place = "" if len(gears) == 2 else ", here or in [inertia] for both gears"
            allowed = f'such as "{_EXAMPLES[name]}"{place}; or density = "7.85 g/cm^3", from which it is computed'
            yield path, f"is missing. Allowed: {allowed}."
    twisted = {"torsional_stiffness", "output"} & set(table(tree, "shafts") or {})
    if twisted and not missing["moment_of_inertia"] and not {"moment_of_inertia", "load"} & set(both):
        message = (
            "is missing: the far end of the output shaft turns by itself and needs a moment of inertia of its own,"
            ' which no gear\'s tells. Allowed: such as "24.5e-3 kg m^2", or leave [shafts] out.'
        )
        yield ("inertia", "load", "moment_of_inertia"), message


_EXAMPLES = {"mass": "4.9 kg", "moment_of_inertia": "24.5e-3 kg m^2"}


def _density_stands_alone(tree: Tree) -> Broken:
    for path, section in with_gears(tree, "inertia").items():
        beside = [name for name in LUMPED if name in section]
        if "density" in section and beside:
            others = " and ".join(beside)
            yield (*path, "density"), f"stands beside {others}, which follow from it. Leave density out, or {others}."


def _what_tilts_has_places(tree: Tree) -> Broken:
    tilting = [gear for gear in GEARS if value_at(tree, "bearings", "places", gear) is not None]
    tilting += [GEARS[SHAFTS.index(shaft)] for shaft in shafts_with_sections(tree)]
    for path, section in with_gears(tree, "inertia").items():
        gears = path[1:] or GEARS
        if "tilting_moment_of_inertia" in section and not any(gear in tilting for gear in gears):
            names = " or ".join(f"bearings.places.{gear}" for gear in gears)
            message = (
                "has no effect: gears tilt where their bearings have places, or shafts sections, only. Leave it out, or"
                f" give {names}."
            )
            yield (*path, "tilting_moment_of_inertia"), message


EFFECT = Effect(
    section="inertia",
    description="mass and moment of inertia of gears and load",
    absent="quasi-static equilibrium in each step",
    fields=Inertia,
    terms=("inertia forces",),
    variables=(ResultVariable("energy_kinetic", "N mm", "kinetic energy"),),
    rules=inertia_is_complete,
)
