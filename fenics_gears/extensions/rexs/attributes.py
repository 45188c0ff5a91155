"""The table of what is looked up in a REXS file: for each value of a scene, the attributes that give it, their unit,
and their component.

Where several are named, the first one present counts, unless all must agree (``every``). Another attribute, or its name
in another version of REXS, is one more line here.
"""

from collections.abc import Callable
from typing import Any, TypeVar

from .model import Component
from .stage import EXTERNAL, INTERNAL, GearParts, Stage, internal_gear
from .values import COUNT, MODULES, NUMBER, SPEED, Value, ValueProblem, place, together, value_of

LookedUp = TypeVar("LookedUp")
Place = tuple[Component, str, str]
# By what a scene asks for: component (a field of GearParts or Stage), attribute, unit or kind of value.
ATTRIBUTES: dict[str, tuple[tuple[str, str, str], ...]] = {
    "module": (("gear", "normal_module", "mm"),),
    "pressure_angle": (
        ("flanks", "normal_pressure_angle", "deg"),
        ("gear", "normal_pressure_angle", "deg"),
        ("tools", "normal_pressure_angle", "deg"),
    ),
    "centre_distance": (("stage", "center_distance", "mm"),),
    "common_face_width": (("stage", "common_face_width", "mm"),),
    "face_width": (("gear", "face_width", "mm"),),
    "helix_angle": (("gear", "helix_angle_reference_diameter", "deg"),),
    "teeth": (("gear", "number_of_teeth", COUNT),),
    "profile_shift": tuple(
        (holder, name, kind)
        for holder in ("flanks", "gear")
        for name, kind in (
            ("addendum_modification_coefficient", NUMBER),
            ("profile_shift_coefficient", NUMBER),
            ("addendum_modification", MODULES),
        )
    ),
    "sum_of_shifts": (("stage", "sum_of_addendum_modification_coefficients", NUMBER),),
    "generated_shift": tuple(
        (holder, "generated_addendum_modification_coefficient", NUMBER) for holder in ("settings", "flanks")
    ),
    "reference_diameter": (
        ("gear", "reference_circle_diameter", "mm"),
        ("gear", "reference_diameter_cylindrical_gear", "mm"),
    ),
    "tip_diameter": (("gear", "tip_diameter", "mm"),),
    "addendum": (("flanks", "addendum_coefficient_basic_profile", NUMBER),),
    "root_diameter": (("gear", "root_diameter", "mm"),),
    "tooth_depth": (("gear", "tooth_depth", "mm"),),
    "bore_diameter": (("gear", "inner_diameter", "mm"), ("bodies", "inner_diameter", "mm")),
    "outer_diameter": (("gear", "outer_diameter", "mm"), ("bodies", "outer_diameter", "mm")),
    "cutter_teeth": (("cutters", "number_of_teeth", COUNT),),
    "cutter_shift": (("cutters", "addendum_modification_coefficient", NUMBER),),
    "tool_module": (("tool", "normal_module", "mm"),),
    "tool_addendum": (
        ("tool", "addendum_coefficient_reference_profile", NUMBER),
        ("tool", "addendum_reference_profile", MODULES),
    ),
    # The two last are their names in version 2.
    "rack_tip_radius": (
        ("tool", "tip_radius_factor", NUMBER),
        ("tool", "tip_radius", MODULES),
        ("tool", "tip_corner_radius_factor_reference_profile", NUMBER),
        ("tool", "tip_corner_radius_reference_profile", MODULES),
    ),
    "youngs_modulus": (("material", "elastic_modulus", "MPa"),),
    "poissons_ratio": (("material", "poisson_ratio", NUMBER),),
    "density": (("material", "density", "g / cm^3"),),
    "torque": (("stage_data", "torque", "N m"),),
    "speed_in_mesh": (("gear", "rolling_rotational_speed", SPEED),),
    "speed": (("gear", "rotational_speed", SPEED), ("shafts", "rotational_speed", SPEED)),
    # Words; so are loaded_tooth_flank and is_driving_gear of the stage data, by which ``stage`` sorts parts.
    "tolerance_class": (
        ("gear", "tolerance_class_according_to_iso_1328_2013", ""),
        ("gear", "global_tolerance_class_iso_1328_2013", ""),
    ),
}
# Values that must be above zero.
POSITIVE = (
    "module", "centre_distance", "common_face_width", "face_width", "teeth", "tip_diameter", "root_diameter",
    "youngs_modulus", "density",
)  # fmt: skip
# Of these a program may write negative values for an internal gear (ISO 21771).
SIGNED = ("teeth", "tip_diameter", "root_diameter")
# Attributes of gears, flanks and tools for which a scene has no field.
_THICKNESS = (
    "din_3967_deviation_tolerance_series", "tooth_thickness_deviation_tolerance_series_din_3967_1978",
    "upper_backlash_allowance_referenced_to_span", "lower_backlash_allowance_referenced_to_span",
    "upper_backlash_allowance_balls_or_pins", "lower_backlash_allowance_balls_or_pins",
)  # fmt: skip
NO_PLACE = (
    *_THICKNESS, "tooth_tip_chamfer", "remaining_protuberance", "protuberance_amount", "protuberance_amount_factor",
    "single_pitch_deviation",
    "profile_form_deviation", "runout_tolerance", "topographical_deviation_amounts",
)  # fmt: skip
# Of a relief, behind its kind.
NO_PLACE_OF_RELIEFS = (
    "evaluation_reference_length", "length_of_tangential_transition_start", "length_of_tangential_transition_end",
    "diameter_where_tangential_transition_starts", "diameter_where_tangential_transition_ends",
)  # fmt: skip


class Reading:
    """What was found wrong with a model (``problems``), and what a scene made of it leaves out, in sentences."""

    def __init__(self) -> None:
        self.problems: list[str] = []
        self.left_out: list[str] = []

    def attempt(self, look_up: Callable[..., LookedUp], *arguments) -> LookedUp | None:
        """What a look-up finds; None where it raises a ValueProblem, which is kept, or where one of its arguments was
        not found."""
        if any(argument is None for argument in arguments):
            return None
        try:
            return look_up(*arguments)
        except ValueProblem as problem:
            if str(problem) not in self.problems:
                self.problems.append(str(problem))
            return None


def places(owner: GearParts | Stage, asked: str) -> list[Place]:
    """All components and attributes that may say it, with the unit, whether or not they do."""
    known = []
    for holder, name, unit in ATTRIBUTES[asked]:
        held = getattr(owner, holder)
        components = [held] if isinstance(held, Component) else held.values() if isinstance(held, dict) else held
        known += [(each, name, unit) for each in components]
    return known


def given(owner: GearParts | Stage, asked: str) -> list[Place]:
    """Those of the places that have a value."""
    return [(component, name, unit) for component, name, unit in places(owner, asked) if name in component.attributes]


def every(owner: GearParts | Stage, asked: str, module: Value | None = None) -> list[Value]:
    """The values of all places that have one; without a module, of those that need none. Raises ValueProblem."""
    return [_checked(asked, each, module) for each in given(owner, asked) if each[2] != MODULES or module is not None]


def first(owner: GearParts | Stage, asked: str) -> Value | None:
    """The value at the first of the places that has one; None where none has. Raises ValueProblem."""
    return next((_checked(asked, each) for each in given(owner, asked)), None)


def needed(owner: GearParts | Stage, asked: str) -> Value:
    """The first value. Raises ValueProblem, naming where it was looked for, where there is none."""
    value = first(owner, asked)
    if value is None:
        raise missing(*places(owner, asked))
    return value


def stated(where: Place) -> Value | None:
    """The value at a place; None where there is none. Raises ValueProblem."""
    return value_of(*where) if where[1] in where[0].attributes else None


def required(*where: Any) -> Value:
    """The value at a place. Raises ValueProblem where there is none."""
    value = stated(where)
    if value is None:
        raise missing(where)
    return value


def missing(one: Place, *others: Place) -> ValueProblem:
    """That none of the places has a value."""
    besides = together(f"{name} of component {component.id}" for component, name, _ in others)
    return ValueProblem(f"{place(*one[:2])} is missing{' (and ' + besides + ')' if besides else ''}.")


def _checked(asked: str, where: Place, module: Value | None = None) -> Value:
    value = value_of(*where, module)
    if asked in SIGNED and value.number and where[0].type in (EXTERNAL, INTERNAL) and internal_gear(where[0]):
        return value
    return positive(value, where) if asked in POSITIVE else value


def positive(value: Value, where: Place) -> Value:
    """The value; raises ValueProblem unless it is above zero."""
    if not value.number > 0.0:
        raise ValueProblem(f"{place(*where[:2])} = {value.words} is not positive.")
    return value
