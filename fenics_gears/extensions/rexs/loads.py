"""Torque on the driven gear and speed of the driving one, looked up at the gears, the stage and along the train."""

from dataclasses import replace

from .attributes import Reading, every, first
from .model import Component, RexsModel
from .order import Unit, entry_of, exit_of
from .stage import GearParts, Stage
from .train import Train
from .transmission import Share
from .values import Value, ValueProblem, computed, together

RPM = 0.10471975511965977  # rad/s
ASSUMED_SPEED = 100.0
BY_TEETH = " by the ratio of teeth"


def loaded_model(model: RexsModel, case: str | None) -> RexsModel:
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


def model_with_loads(
    reading: Reading, model: RexsModel, case: str | None, given: tuple[Value | None, Value | None]
) -> RexsModel | None:
    """`loaded_model`, None where it is not clear which, which `reading` then has. A call that gives torque and speed,
    all that a load case is asked for, needs none."""
    if case is None and None not in given:
        return model
    return reading.attempt(lambda: loaded_model(model, case))


def wheel_torque(model: RexsModel, stage: Stage, ratio: float) -> Value:
    """The torque on the driven gear; ``ratio``: its number of teeth over the driving gear's. Raises ValueProblem where
    the file gives none."""
    for part, factor in ((stage.wheel, 1.0), (stage.pinion, ratio)):
        torque = first(part, "torque") or _torque_of_train(model, stage, part)
        if torque is not None:
            return _scaled(torque, factor, 1e3, "N m")
    why = (
        "neither gear's side of the train has external loads that are all known and reach it by one path (through"
        " shafts, couplings and stages)"
    )
    if stage.in_planetary:
        why = "its planets share the torque of their shafts"
    raise ValueProblem(
        f"{stage.stage}: no torque. Its gears, {stage.pinion.gear.id} and {stage.wheel.gear.id}, have none in their"
        f' stage data, and {why}. Give that of the driven gear: --wheel-torque "437 N m".'
    )


def pinion_speed(model: RexsModel, stage: Stage, ratio: float) -> Value:
    """The speed of the driving gear, against its carrier where it has one; a slow one where the file gives none."""
    for part, factor in ((stage.pinion, 1.0), (stage.wheel, ratio)):
        speeds = every(part, "speed_in_mesh") + ([] if stage.in_planetary else every(part, "speed"))
        for speed in speeds:
            if speed.number != 0.0:
                return _scaled(speed, factor, RPM, "rpm")
    return _speed_of_train(model, None if stage.in_planetary else stage.pinion.gear)


def _speed_of_train(model: RexsModel, part: Component | None) -> Value:
    stated = None if part is None else Train(model).speed(part)
    if stated is not None:
        speed, factor, stages = stated
        return _scaled(_through(speed, stages), abs(factor), RPM, "rpm")
    why = "no rotational_speed; without [inertia] it sets the scale of time only"
    return computed(ASSUMED_SPEED * RPM, RPM, "rpm", why, assumed=True)


def torque_of_output(model: RexsModel, unit: Unit, ratio: float) -> Value:
    """The torque on the last gear of a train or the output of its last set; ``ratio``: turns of the input in one of
    the output. Raises ValueProblem where the file gives none."""
    if isinstance(unit, Stage):
        return wheel_torque(model, unit, ratio)
    for part, factor in ((exit_of(unit), 1.0), (entry_of(unit), ratio)):
        torque = _brought(Train(model).shares(part, unit.stage))
        if torque is not None and factor == 1.0:
            return _scaled(torque, 1.0, 1e3, "N m")
        if torque is not None:
            origin = f"{torque.origin.removesuffix(BY_TEETH)}{BY_TEETH}"
            return computed(abs(torque.number) * factor, 1e3, "N m", origin)
    raise ValueProblem(
        f"{unit.stage}: no torque. Neither its input, {entry_of(unit)}, nor its output, {exit_of(unit)}, has external"
        ' loads that are all known and reach it by one path. Give that of its output: --wheel-torque "437 N m".'
    )


def speed_of_input(model: RexsModel, unit: Unit, ratio: float) -> Value:
    """The speed of the first gear of a train, or of the input of its first set; a slow one where none is given."""
    if isinstance(unit, Stage):
        return pinion_speed(model, unit, ratio)
    return _speed_of_train(model, entry_of(unit))


def _scaled(value: Value, factor: float, unit: float, name: str) -> Value:
    """Without sign, times a ratio of teeth."""
    if factor == 1.0 and value.number >= 0.0:
        return value
    origin = value.origin if factor == 1.0 else value.origin.removesuffix(BY_TEETH) + BY_TEETH
    return computed(abs(value.number) * factor, unit, name, origin)


def _through(value: Value, stages: tuple[int, ...]) -> Value:
    """A value with the stages that it comes through in its origin."""
    if not stages:
        return value
    named = f"stage{'s' if len(stages) > 1 else ''} {', '.join(map(str, stages))}"
    return replace(value, origin=f"{value.origin} through {named}{BY_TEETH}")


def _torque_of_train(model: RexsModel, stage: Stage, part: GearParts) -> Value | None:
    """What the loads on a gear's side of the stage bring to it, where all of it goes through this mesh; None where it
    may not."""
    return None if stage.in_planetary else _brought(Train(model).shares(part.gear, stage.stage))


def _brought(shares: list[Share] | None) -> Value | None:
    """What loads bring together; None where not all are known, or their signs are not."""
    bringing = [share for share in shares or () if share.number != 0.0]
    if not shares or len(bringing) > 1 and not all(share.signed for share in bringing):
        return None
    origins = together(_through(share.load, share.stages).origin for share in shares)
    if len(shares) == 1 and not shares[0].stages:
        return shares[0].load
    return computed(sum(share.number for share in shares), 1e3, "N m", origins)
