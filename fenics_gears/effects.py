"""The one list of effects a scene can switch on by naming their section.

An effect whose section is absent is not constructed: none of its unknowns, terms or result variables exist.
The schema takes its optional sections from here, ``gears check`` prints the list, and the result takes its variables from it.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass


@dataclass(frozen=True)
class ResultVariable:
    """One variable of the result: its name, its units and its long name for labels."""

    name: str
    units: str
    long_name: str


@dataclass(frozen=True)
class Effect:
    """One effect: the section that switches it on, what it adds, and the sections it needs or excludes.

    ``needs`` and ``excludes`` are section names; ``absent`` says what the model is without the effect.
    """

    section: str
    description: str
    absent: str
    unknowns: tuple[str, ...] = ()
    terms: tuple[str, ...] = ()
    variables: tuple[ResultVariable, ...] = ()
    needs: tuple[str, ...] = ()
    excludes: tuple[str, ...] = ()


EFFECTS: tuple[Effect, ...] = (
    Effect(
        section="shafts",
        description="elastic torsion of the input and the output shaft",
        absent="pinion hub turned as prescribed, couple straight on the wheel",
        unknowns=("rotation of the pinion", "rotation of the output shaft's end"),
        terms=("torsional springs",),
        variables=(
            ResultVariable("shaft_end_rotation", "rad", "rotation of the output shaft's end"),
            ResultVariable("energy_shafts", "N mm", "elastic energy of the shafts"),
        ),
    ),
    Effect(
        section="bearings",
        description="elastic support of the gear centres",
        absent="centres fixed",
        unknowns=("two displacements of each centre",),
        terms=("translational springs",),
        variables=(
            ResultVariable("centre_x", "mm", "displacement of the centre along the line of action"),
            ResultVariable("centre_y", "mm", "displacement of the centre off the line of action"),
            ResultVariable("energy_bearings", "N mm", "elastic energy of the bearings"),
        ),
    ),
    Effect(
        section="inertia",
        description="mass and moment of inertia of gears and shafts",
        absent="quasi-static",
        terms=("inertia forces, average acceleration in time",),
        variables=(
            ResultVariable("energy_kinetic", "N mm", "kinetic energy"),
        ),
    ),
    Effect(
        section="damping",
        description="Rayleigh damping of each shaft",
        absent="undamped",
        terms=("damping forces, stiffness- and mass-proportional",),
        variables=(ResultVariable("work_damping", "N mm", "work that damping takes"),),
        needs=("inertia",),
    ),
    Effect(
        section="friction",
        description="Coulomb friction between the flanks",
        absent="frictionless, no tangential unknowns",
        unknowns=("tangential force of each closed contact node",),
        terms=("friction law with stick and slip",),
        variables=(
            ResultVariable("friction_force", "N", "friction force of the mesh"),
            ResultVariable("pair_friction_force", "N", "friction force of the tooth pair"),
            ResultVariable("contact_traction", "MPa", "friction traction on the flank"),
            ResultVariable("work_friction", "N mm", "work that friction takes"),
        ),
    ),
    Effect(
        section="tip_relief",
        description="material removed towards the tips, linear in the roll angle",
        absent="true involutes",
        terms=("initial gaps",),
    ),
    Effect(
        section="coast_flanks",
        description="contact on the unloaded flanks, with the backlash of the geometry",
        absent="drive flanks only",
        unknowns=("normal force of each closed contact node on the coast flanks",),
        terms=("contact along the coast flanks' own line of action",),
        variables=(
            ResultVariable("coast_normal_force", "N", "contact force of the coast flanks along their line of action"),
            ResultVariable("pair_coast_normal_force", "N", "contact force of the coast flank of the pair's pinion tooth"),
            ResultVariable("coast_contact_pressure", "MPa", "contact pressure on the coast flanks"),
            ResultVariable("coast_contact_roll_angle", "rad", "roll angle of the contact node on the pinion's coast flank"),
            ResultVariable("drive_flank_opening", "mm", "smallest distance of the drive flanks"),
            ResultVariable("coast_flank_opening", "mm", "smallest distance of the coast flanks"),
        ),
    ),
)

# What every run has, whatever its effects.
COMMON_VARIABLES: tuple[ResultVariable, ...] = (
    ResultVariable("transmission_error", "rad", "transmission error"),
    ResultVariable("rotation", "rad", "rotation of the hub from its nominal motion"),
    ResultVariable("normal_force", "N", "contact force of the mesh along the line of action"),
    ResultVariable("pair_normal_force", "N", "contact force of the tooth pair along the line of action"),
    ResultVariable("contact_pressure", "MPa", "contact pressure"),
    ResultVariable("contact_offset", "mm", "offset of the contact node from the line of action, towards the pinion"),
    ResultVariable("contact_roll_angle", "rad", "roll angle of the contact node on the pinion's flank"),
    ResultVariable("reaction_x", "N", "force of the gear on its shaft along the line of action"),
    ResultVariable("reaction_y", "N", "force of the gear on its shaft off the line of action"),
    ResultVariable("reaction_couple", "N mm", "couple of the gear on its shaft"),
    ResultVariable("newton_iterations", "1", "Newton iterations of the step"),
    ResultVariable("closed_nodes", "1", "contact nodes that are closed"),
    ResultVariable("energy", "N mm", "elastic and kinetic energy"),
    ResultVariable("energy_teeth", "N mm", "elastic energy of the gears"),
    ResultVariable("work_input", "N mm", "work of the drive"),
    ResultVariable("work_output", "N mm", "work done on the load"),
    ResultVariable("work_contact_changes", "N mm", "work of the time stepping at changes of contact"),
    ResultVariable("energy_defect", "N mm", "energy that the account does not explain"),
)


def effect(section: str) -> Effect:
    """The effect of that section; raises KeyError for a name that is not in the list."""
    return {each.section: each for each in EFFECTS}[section]


def effects_on(scene) -> tuple[Effect, ...]:
    """The effects that a scene (``scene.data.Scene``) switches on, in the order of the list."""
    return tuple(each for each in EFFECTS if getattr(scene, each.section) is not None)


def result_variables(scene) -> tuple[ResultVariable, ...]:
    """Every variable that the result of a scene has."""
    return COMMON_VARIABLES + tuple(variable for each in effects_on(scene) for variable in each.variables)


def missing_needs(sections: Collection[str]) -> list[tuple[Effect, str]]:
    """Pairs of an effect among the named sections and a section that it needs and that is not among them."""
    return [(each, need) for each in EFFECTS if each.section in sections for need in each.needs if need not in sections]


def conflicts(sections: Collection[str]) -> list[tuple[Effect, str]]:
    """Pairs of an effect among the named sections and a section beside it that it excludes."""
    return [(each, other) for each in EFFECTS if each.section in sections for other in each.excludes if other in sections]
