"""The one list of effects; a scene switches an effect on by naming its section. The scene's sections, the output of
``gears check``, the result's variables and the documentation's table follow from it.

Of an effect whose section is absent none of its unknowns, terms or result variables exist, and its module is not
imported.
"""

import functools
from collections.abc import Collection
from dataclasses import replace
from importlib import import_module
from math import inf, lcm
from typing import Any

from .effect import OF_GEARS, OF_NODES, OF_PAIRS, OF_POINTS, OF_SLICES, OF_TIME, Effect, ResultVariable, variables

# Effects by their sections, which are their modules' names: those at the top of a scene, and all.
AT_THE_TOP = (
    "body_meshes", "shafts", "bearings", "inertia", "damping", "friction", "tip_relief", "root_relief",
    "lead_modifications", "misalignment", "flank_errors", "eccentricity", "coast_flanks", "corner_contact",
    "torque_ripple", "speed_ramp", "profile_modifications", "wheel_points",
)  # fmt: skip
SECTIONS = ("tooth_elasticity", *AT_THE_TOP)
# What opens the flanks along a face.
ALONG_THE_FACE = ("lead_modifications", "misalignment")

# What every run has, whatever its effects.
COMMON_VARIABLES: tuple[ResultVariable, ...] = (
    *variables(
        OF_TIME,
        transmission_error=("rad", "transmission error"),
        normal_force=("N", "contact force of the mesh along the line of action"),
        newton_iterations=("1", "Newton iterations of the step"),
        closed_nodes=("1", "number of closed contact nodes"),
        energy=("N mm", "elastic and kinetic energy"),
        work_input=("N mm", "work done on the input shaft by the drive; negative where the wheel drives"),
        work_output=("N mm", "work done on the load by the output shaft; negative where the wheel drives"),
        work_contact_changes=("N mm", "energy added by the time stepping where nodes come into contact or separate"),
        energy_defect=("N mm", "defect of the energy balance"),
    ),
    *variables(OF_PAIRS, pair_normal_force=("N", "contact force of the tooth pair along the line of action")),
    *variables(
        OF_GEARS,
        rotation=("rad", "rotation of the hub relative to its nominal rotation"),
        reaction_x=("N", "force of the gear on its shaft along the line of action"),
        reaction_y=("N", "force of the gear on its shaft off the line of action"),
        reaction_couple=("N mm", "torque of the gear on its shaft, positive in the pinion's sense of rotation"),
    ),
    *variables(
        OF_POINTS,
        path_point_position=("mm", "distance of the point from T1 along the line of action"),
        sliding_speed=(
            "mm/s",
            "sliding speed of the pinion's flank over the wheel's, positive towards the pinion's tip",
        ),
        load_share=("1", "share of a tooth pair in the mesh force at the point of the path of contact"),
    ),
    *variables(
        (*OF_POINTS, "gear"),
        path_point_diameter=("mm", "diameter at the point of the path of contact"),
        specific_sliding=(
            "1",
            "specific sliding: sliding speed divided by the speed of the contact point along the gear's own flank;"
            " negative in the dedendum",
        ),
    ),
)

# Further variables of runs whose flanks are resolved over the face. Moments are about the gears' mid-widths.
FACE_VARIABLES: tuple[ResultVariable, ...] = (
    *variables(
        OF_SLICES,
        line_load=("N/mm", "contact force of the tooth pair along the contact normal, per length of the face"),
    ),
    *variables(
        OF_GEARS,
        reaction_z=("N", "axial force of the gear on its shaft"),
        reaction_moment_x=("N mm", "moment of the gear on its shaft about the line of action, at mid-width"),
        reaction_moment_y=("N mm", "moment of the gear on its shaft off the line of action, at mid-width"),
    ),
)

# What only contact that is spread over nodes has.
OVER_CONTACT_NODES = tuple(
    f"{side}contact_{name}" for side in ("", "coast_") for name in ("pressure", "traction", "offset", "roll_angle")
) + (
    "largest_contact_pressure",
    "largest_contact_pressure_pair",
    "largest_contact_pressure_roll_angle",
    "largest_edge_pressure",
    "largest_kink_pressure",
)

# What is of whole shafts, which in a train are not a pair's alone.
OF_SHAFTS = tuple(f"bearing_{load}" for load in ("force_x", "force_y", "force_z", "moment_x", "moment_y")) + (
    "shaft_deflection_x",
    "shaft_deflection_y",
    "shaft_end_rotation",
)


@functools.cache
def effect_named(section: str) -> Effect:
    """The effect of that section; raises KeyError for a name that is not in the list."""
    if section not in SECTIONS:
        raise KeyError(section)
    return import_module(f"{__name__}.{section}").EFFECT


def every_effect() -> tuple[Effect, ...]:
    """All effects that a scene may have, in their order."""
    return tuple(map(effect_named, SECTIONS))


def effects_on(scene) -> tuple[Effect, ...]:
    """The effects that a scene (``scene.data.Scene``) switches on, in the order of the list."""
    return tuple(effect_named(each) for each in SECTIONS if getattr(scene, each, None) is not None)


def from_effects(scene, hook: str, *arguments) -> list[Any]:
    """What the scene's effects answer: their hooks of that name, called with the effect's own data and the
    arguments."""
    hooks = ((each, getattr(each, hook)) for each in effects_on(scene))
    return [call(getattr(scene, each.section), *arguments) for each, call in hooks if call is not None]


def check_files(scene, pair) -> None:
    from_effects(scene, "check", scene, pair)


def result_variables(scene) -> tuple[ResultVariable, ...]:
    on = effects_on(scene)
    over_face = scene.three_dimensional

    def is_there(variable: ResultVariable, data) -> bool:
        fields = variable.field.split(" or ") if variable.field else ()
        return (
            (not variable.needs or getattr(scene, variable.needs) is not None)
            and (not fields or any(getattr(data, name) is not None for name in fields))
            and (over_face or not variable.over_face)
        )

    declared = list(COMMON_VARIABLES)
    declared += [each for effect in on for each in effect.variables if is_there(each, getattr(scene, effect.section))]
    if over_face:
        along_face = (*OF_SLICES, "contact_node")
        declared = [replace(each, dims=along_face) if each.dims == OF_NODES else each for each in declared]
        declared += FACE_VARIABLES
    left_out = () if scene.resolves_contact else OVER_CONTACT_NODES
    left_out += () if scene.motion.speed_given else ("sliding_speed",)
    left_out += OF_SHAFTS if scene.shafts is not None and scene.shafts.in_train else ()
    # Two effects may have a variable in common.
    return tuple(dict.fromkeys(each for each in declared if each.name not in left_out))


def common_period(scene) -> float:
    """Mesh cycles after which all that the scene's effects do repeats; infinite where one never does."""
    periods = from_effects(scene, "period", scene)
    return inf if inf in periods else lcm(*periods)


def gear_differs(scene, gear: str) -> bool:
    """Whether the pinion or the wheel runs out, or its teeth are not all alike."""
    if scene.eccentricity is not None and getattr(scene.eccentricity, gear) is not None:
        return True
    if scene.flank_errors is None:
        return False
    from .flank_errors import teeth_differ

    return teeth_differ(scene.flank_errors, scene, gear)


def without(scene, *sections: str):
    """The scene less some effects; what needs them is left in and may then not be valid."""
    changed = replace(scene, **{name: None for name in sections if name in AT_THE_TOP})
    if "tooth_elasticity" not in sections:
        return changed
    return replace(changed, gears=scene.gears.changed(lambda gear: replace(gear, material=None), material=None))


def missing_needs(sections: Collection[str]) -> list[tuple[Effect, str]]:
    """Pairs of an effect among the named sections and a section that it needs and that is not among them."""
    return [(each, need) for each in _among(sections) for need in each.needs if need not in sections]


def conflicts(sections: Collection[str]) -> list[tuple[Effect, str]]:
    """Pairs of an effect among the named sections and another one of them that it excludes."""
    return [(each, other) for each in _among(sections) for other in each.excludes if other in sections]


def _among(sections: Collection[str]) -> tuple[Effect, ...]:
    return tuple(effect_named(each) for each in SECTIONS if each in sections)
