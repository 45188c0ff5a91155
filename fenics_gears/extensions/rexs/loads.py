"""Torque on the driven gear and speed of the driving one, looked up at the gears, the stage and the shafts."""

from .attributes import every, first
from .model import Component, Model
from .stage import GearParts, Stage
from .values import Value, ValueProblem, computed, together, value_of, word_of

RPM = 0.10471975511965977  # rad/s
ASSUMED_SPEED = 100.0
# Of a load on a shaft.
TORQUE = "torque_around_u_axis"


def loaded_model(model: Model, case: str | None) -> Model:
    """The model in a load case, or in the only one. Raises ValueProblem, which lists the cases, where it is not clear
    which."""
    listed = ", ".join(model.load_cases)
    if case is None and len(model.load_cases) > 1:
        raise ValueProblem(
            f"has {len(model.load_cases)} load cases; a scene has one. Choose it with --load-case: {listed}."
        )
    if case is not None and case not in model.load_cases:
        raise ValueProblem(f'has no load case "{case}". It has: {listed or "none"}.')
    return model.under_load(case or listed) if model.load_cases else model


def wheel_torque(model: Model, stage: Stage, ratio: float) -> Value:
    """The torque on the driven gear; ``ratio``: its teeth over those of the driving one. Raises ValueProblem where the
    file gives none."""
    for part, factor in ((stage.wheel, 1.0), (stage.pinion, ratio)):
        torque = first(part, "torque") or _shaft_torque(model, stage, part)
        if torque is not None:
            return _scaled(torque, factor, 1e3, "N m")
    why = "no shaft with this gear alone bears external loads that are all known"
    if stage.in_planetary:
        why = "its planets share the torque of their shafts"
    raise ValueProblem(
        f"{stage.stage}: no torque. Its gears, {stage.pinion.gear.id} and {stage.wheel.gear.id}, have none in their"
        f' stage data, and {why}. Give that of the driven gear: --wheel-torque "437 N m".'
    )


def pinion_speed(stage: Stage, ratio: float) -> Value:
    """The speed of the driving gear, against its carrier where it has one; a slow one where the file gives none."""
    for part, factor in ((stage.pinion, 1.0), (stage.wheel, ratio)):
        speeds = every(part, "speed_in_mesh") + ([] if stage.in_planetary else every(part, "speed"))
        for speed in speeds:
            if speed.number != 0.0:
                return _scaled(speed, factor, RPM, "rpm")
    why = "no rotational_speed; without [inertia] it sets the scale of time only"
    return computed(ASSUMED_SPEED * RPM, RPM, "rpm", why, assumed=True)


def _scaled(value: Value, factor: float, unit: float, name: str) -> Value:
    if factor == 1.0 and value.number >= 0.0:
        return value
    origin = value.origin if factor == 1.0 else f"{value.origin} by the ratio of teeth"
    return computed(abs(value.number) * factor, unit, name, origin)


def _shaft_torque(model: Model, stage: Stage, part: GearParts) -> Value | None:
    """The sum of the external torques on a gear's shaft, where all of it goes through this mesh; None where it may
    not."""
    if stage.in_planetary or len(part.shafts) != 1 or not _is_alone(model, part):
        return None
    on_shaft = model.partners("assembly", "part", assembly=part.shafts[0])
    loads = [each for each in on_shaft if each.type == "external_load" and _is_torque(each)]
    torques = [value_of(load, TORQUE, "N m") for load in loads if TORQUE in load.attributes]
    if not torques or len(torques) < len(loads):
        return None
    if len(torques) == 1:
        return torques[0]
    total = sum(torque.number for torque in torques)
    return computed(total, 1e3, "N m", together(torque.origin for torque in torques))


def _is_torque(load: Component) -> bool:
    """Whether a load is more than a force across the shaft: it says so, or has a torque."""
    said = word_of(load, "transmits_torque").lower() if "transmits_torque" in load.attributes else ""
    return said == "true" or TORQUE in load.attributes and said != "false"


def _is_alone(model: Model, part: GearParts) -> bool:
    pairs = [{each.roles.get("gear_1"), each.roles.get("gear_2")} for each in model.related("stage")]
    in_stages = set().union(*pairs)
    on_shaft = [each for each in model.partners("assembly", "part", assembly=part.shafts[0]) if each.id in in_stages]
    return sum(part.gear.id in pair for pair in pairs) == 1 and len(on_shaft) == 1
