"""The gear train around a mesh: which parts turn as one, which meshes join them, and the torque, speed and direction
of power that a gear has through it.

Nothing is lost on the way: M2 = M1 z2/z1, n2 = n1 z1/z2. A torque is known only where it follows from the given loads.
It does not where a path divides and comes together again, ends without a load or goes through a planetary stage.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .model import Component, RexsModel
from .values import COUNT, SPEED, Value, numbers_of, value_of, word_of

# Relations of a joint and the two parts that it joins; the second is that of version 1.0.
JOINING = ("side", "coupling")
# Stages whose ratio is that of the teeth; one in a planetary stage turns about an axis that turns itself.
PLAIN_STAGES = ("cylindrical_stage", "bevel_stage")
# Parts that hold what they are joined to, or share its torque in ways that are not followed.
NOT_FOLLOWED = ("gear_casing", "planet_carrier", "side_plate")
# Of a load on a shaft.
TORQUE = "torque_around_u_axis"
# Cosine of the angle between axes from which on they count as parallel.
PARALLEL = 0.99


@dataclass(frozen=True)
class _Mesh:
    """Two gears of a stage; ``plain``: whether torque and speed follow by the teeth."""

    stage: Component
    gears: tuple[Component, Component]
    plain: bool

    def mate(self, gear: Component) -> Component:
        return self.gears[1] if gear.id == self.gears[0].id else self.gears[0]

    def ratio(self, gear: Component) -> float:
        """How many times the torque about ``gear`` is that about its mate; turns are as many times fewer."""
        own, other = (value_of(each, "number_of_teeth", COUNT).number for each in (gear, self.mate(gear)))
        return abs(own / other)


@dataclass(frozen=True)
class Share:
    """The part of one load in a gear: the torque (N mm) about the gear's axis, whose sign is known or not; the power
    that the load puts into the train; its origin; and the stages on the way. The power follows from the speed of the
    load's own shaft, None where the file does not give it: signs of shafts that turn the other way are often not
    meant."""

    number: float
    signed: bool
    power: float | None
    load: Value
    stages: tuple[int, ...] = ()


class Train:
    """The train of a model."""

    def __init__(self, model: RexsModel) -> None:
        self.model = model

    def shares(self, gear: Component, stage: Component) -> list[Share] | None:
        """What the loads on a gear's side of a stage bring to it; None where that does not follow."""
        return self._shares(gear, stage, set())

    def turn_as_one(self, one: Component, other: Component) -> bool:
        """Whether two gears are on one shaft, or on shafts that are coupled."""
        return other.id in {each.id for each in self._turning(one)}

    def power(self, gear: Component, stage: Component) -> float | None:
        """Power, by its sign, that comes to a stage from this gear's side; None where that does not follow."""
        shares = self.shares(gear, stage)
        if not shares or any(share.power is None for share in shares):
            return None
        return sum(share.power for share in shares if share.power is not None)

    def speed(self, gear: Component) -> tuple[Value, float, tuple[int, ...]] | None:
        """The nearest speed that is given in the train, how many times as fast the gear turns, without sign, and the
        stages between; None where none is given."""
        waiting: list[tuple[Component, float, tuple[int, ...]]]
        waiting = [(gear, 1.0, ())]
        seen = set()
        while waiting:
            part, factor, stages = waiting.pop(0)
            turning = self._turning(part)
            if part.id in seen:
                continue
            seen |= {each.id for each in turning}
            if (own := self._own_speed(turning)) is not None:
                return own[0], factor, stages
            for own_gear, mesh in self._meshes_of(turning):
                if mesh.plain:
                    beyond = (*stages, mesh.stage.id)
                    waiting.append((mesh.mate(own_gear), factor / mesh.ratio(own_gear), beyond))
        return None

    def torque(self, gear: Component, stage: Component) -> float | None:
        """Torque (N mm) about a gear's own axis, with its sign, that comes to a stage from this gear's side. It follows
        from the loads there or from the loads beyond the mate; None where it does not."""
        mesh = next((each for each in self._meshes if each.stage.id == stage.id), None)
        if mesh is None or not mesh.plain:
            return None
        for side, factor in ((gear, 1.0), (mesh.mate(gear), self._sense(mesh))):
            shares = self.shares(side, stage)
            sign = self._sign(gear, self._axis_of(self._turning(gear)))
            if shares and factor and sign and all(share.signed and share.power is not None for share in shares):
                # The mate's loads and those that hold them from here turn gears whose axes point alike in one sense.
                total = sum(share.number for share in shares) * factor * sign
                return total if side is gear else total * mesh.ratio(gear)
        return None

    def _shares(self, gear: Component, stage: Component, seen: set[int]) -> list[Share] | None:
        turning = self._turning(gear)
        numbers = {each.id for each in turning}
        if numbers & seen or any(each.type in NOT_FOLLOWED for each in turning) or self._in_planetary(numbers):
            return None
        seen |= numbers
        loads = [each for each in turning if each.type == "external_load" and _is_torque(each)]
        beyond = [(own, mesh) for own, mesh in self._meshes_of(turning) if mesh.stage.id != stage.id]
        if not (loads or beyond) or any(TORQUE not in load.attributes for load in loads):
            return None
        shares = [self._own_share(load, turning) for load in loads]
        for own, mesh in beyond:
            through = self._shares(mesh.mate(own), mesh.stage, seen) if mesh.plain else None
            if through is None:
                return None
            shares += [self._passed_on(share, own, mesh) for share in through]
        return shares

    def _own_share(self, load: Component, turning: tuple[Component, ...]) -> Share:
        torque = value_of(load, TORQUE, "N m")
        sign = self._sign(load, self._axis_of(turning))
        number = torque.number * (sign or 1.0)
        speed = self._own_speed(turning)
        power = None if sign is None or speed is None or speed[1] is None else number * speed[0].number * speed[1]
        return Share(number, sign is not None, power, torque)

    def _passed_on(self, share: Share, own: Component, mesh: _Mesh) -> Share:
        sense = self._sense(mesh)
        return replace(
            share,
            number=-share.number * mesh.ratio(own) * (sense or 1.0),
            signed=share.signed and sense is not None,
            stages=(mesh.stage.id, *share.stages),
        )

    def _own_speed(self, turning: tuple[Component, ...]) -> tuple[Value, float | None] | None:
        """The speed that is given for what turns as one, and its sign about that axis; None without one."""
        for part in turning:
            if "rotational_speed" in part.attributes and (value := value_of(part, "rotational_speed", SPEED)).number:
                return value, self._sign(part, self._axis_of(turning))
        return None

    def _turning(self, part: Component) -> tuple[Component, ...]:
        """All that turns as one with a part, the part first."""
        turning = {part.id}
        waiting = [part.id]
        while waiting:
            new = [each for each in self._joined.get(waiting.pop(), ()) if each not in turning]
            turning.update(new)
            waiting += new
        return tuple(self.model.components[each] for each in (part.id, *sorted(turning - {part.id})))

    @cached_property
    def _joined(self) -> dict[int, list[int]]:
        joined: dict[int, list[int]] = {}
        for one, other in self._joints():
            joined.setdefault(one, []).append(other)
            joined.setdefault(other, []).append(one)
        return joined

    def _joints(self) -> Iterator[tuple[int, int]]:
        """Pairs of parts that turn as one: a shaft and what is on it, and what joints that are no bearings join."""
        components = self.model.components
        for relation in self.model.relations:
            roles = relation.roles
            if relation.type == "assembly" and {"assembly", "part"} <= roles.keys():
                if components[roles["assembly"]].type == "shaft" or _is_gear(components[roles["assembly"]]):
                    yield roles["assembly"], roles["part"]
            elif relation.type in JOINING:
                parts = [number for number in roles.values() if not _is_joint(components[number])]
                if len(parts) == 2 and all(_turns_both(components[number]) for number in roles.values()):
                    yield parts[0], parts[1]

    @cached_property
    def _meshes(self) -> list[_Mesh]:
        components = self.model.components
        meshes = []
        for relation in self.model.related("stage"):
            if {"stage", "gear_1", "gear_2"} <= relation.roles.keys():
                stage, *gears = (components[relation.roles[role]] for role in ("stage", "gear_1", "gear_2"))
                holders = self.model.partners("assembly", "assembly", part=stage)
                counted = all("number_of_teeth" in gear.attributes for gear in gears)
                plain = counted and stage.type in PLAIN_STAGES
                plain = plain and not any(holder.type == "planetary_stage" for holder in holders)
                meshes.append(_Mesh(stage, (gears[0], gears[1]), plain))
        return meshes

    def _meshes_of(self, turning: tuple[Component, ...]) -> list[tuple[Component, _Mesh]]:
        """The meshes of all gears that turn as one, each with its own gear."""
        numbers = {each.id for each in turning}
        return [(gear, mesh) for mesh in self._meshes for gear in mesh.gears if gear.id in numbers]

    def _in_planetary(self, numbers: set[int]) -> bool:
        """Whether one of the parts is a member of a planetary stage."""
        components = self.model.components
        return any(
            numbers & set(relation.roles.values())
            and any(components[each].type == "planetary_stage" for each in relation.roles.values())
            for relation in self.model.relations
        )

    def _sense(self, mesh: _Mesh) -> float | None:
        """1 where torques of both gears about their axes have one sign, -1 where they have two, None where that is not
        known. One sign have external gears whose axes point alike, and bevel gears whose axes both point to where they
        cross."""
        one, other = (self._axis_of(self._turning(gear)) for gear in mesh.gears)
        if mesh.stage.type == "cylindrical_stage":
            alike = _alike(one, other)
            return None if alike is None else -alike if any(map(_is_internal, mesh.gears)) else alike
        senses = [self._sign(gear, axis) for gear, axis in zip(mesh.gears, (one, other))]
        tips = [_word(gear, "bevel_cone_orientation") for gear in mesh.gears]
        if None in senses or not set(tips) <= {"positive", "negative"}:
            return None
        return float(np.prod(senses)) * (1.0 if tips[0] == tips[1] else -1.0)

    def _axis_of(self, turning: tuple[Component, ...]) -> np.ndarray | None:
        """The axis of what turns as one: that of its first shaft that has one."""
        ordered = sorted(turning, key=lambda each: (each.type != "shaft", each.id))
        return next((axis for each in ordered if (axis := axis_of(each)) is not None), None)

    def _sign(self, part: Component, axis: np.ndarray | None) -> float | None:
        return _alike(axis_of(part), axis)


def axis_of(part: Component) -> np.ndarray | None:
    """The unit vector of a part's axis; None where it has none."""
    if "u_axis_vector" not in part.attributes:
        return None
    vector = np.array(numbers_of(part, "u_axis_vector"))
    length = float(np.linalg.norm(vector))
    return vector / length if vector.shape == (3,) and length > 0.0 else None


def _alike(one: np.ndarray | None, other: np.ndarray | None) -> float | None:
    """1 where axes point alike, -1 where they are opposite, None where they are not parallel; those that are not given
    point alike."""
    cosine = 1.0 if one is None or other is None else float(one @ other)
    return None if abs(cosine) < PARALLEL else np.sign(cosine)


def _is_gear(part: Component) -> bool:
    return part.type in ("cylindrical_gear", "bevel_gear", "ring_gear")


def _is_internal(gear: Component) -> bool:
    return gear.type == "ring_gear" or value_of(gear, "number_of_teeth", COUNT).number < 0


def _word(part: Component, name: str) -> str:
    return word_of(part, name).lower() if name in part.attributes else ""


def _is_joint(part: Component) -> bool:
    return part.type.endswith(("bearing", "coupling", "_fit", "_connection", "_geometry"))


def _turns_both(part: Component) -> bool:
    """Whether a joint passes torque on; a switchable one where the file says that it is engaged."""
    if part.type == "switchable_coupling":
        return _word(part, "is_engaged") == "true"
    return "bearing" not in part.type


def _is_torque(load: Component) -> bool:
    """Whether a load is more than a force across the shaft: it says so, or has a torque."""
    said = _word(load, "transmits_torque")
    return said == "true" or TORQUE in load.attributes and said != "false"


def is_force(load: Component) -> bool:
    """Whether a load has forces, or torques across the shaft, that are more than nothing."""
    beside = [name for name in load.attributes if name.startswith(("force_", "torque_around_")) and name != TORQUE]
    return load.type == "external_load" and any(any(numbers_of(load, name)) for name in beside)
