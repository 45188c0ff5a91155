"""``[inertia]``: mass and moment of inertia of each gear and of what the output shaft drives; the march in time becomes
dynamic (``dynamics``)."""

from fenics_gears.dynamics.inertia import LUMPED, Inertia
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.tree import GEARS, SHAFTS, Tree, given_for, shafts_with_sections, table, value_at, with_gears

from .effect import Effect, ResultVariable


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
            message = f"is given together with {others}, which follow from it. Leave density out, or {others}."
            yield (*path, "density"), message


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
