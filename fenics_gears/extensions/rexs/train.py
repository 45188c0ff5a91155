"""The gear train around a mesh: which parts turn as one, which meshes join them, and the torque, speed and direction
of power that a gear has through it.

Nothing is lost on the way: M2 = M1 z2/z1, n2 = n1 z1/z2; through a planetary set whose third member is held, by Willis.
A torque is known only where it follows from the given loads. It does not where a path divides and comes together again,
ends without a load or goes through other planetary stages.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np

from .model import Component, RexsModel
from .planetary_sets import PlanetarySet, found_set, is_set
from .transmission import (
    CASING,
    PLANETARY,
    POWER,
    TORQUE,
    Mesh,
    Share,
    alike,
    axis_of,
    is_internal,
    is_torque,
    joints,
    word,
)
from .values import SPEED, Value, ValueProblem, computed, value_of

# Stages whose ratio is that of the teeth; one in a planetary stage turns about an axis that turns itself.
PLAIN_STAGES = ("cylindrical_stage", "bevel_stage")


class Train:
    """The train of a model."""

    def __init__(self, model: RexsModel) -> None:
        self.model = model

    def shares(self, gear: Component, stage: Component) -> list[Share] | None:
        """What the loads on a gear's side of a stage bring to it; None where that does not follow."""
        return self._shares(gear, stage, set())

    def power(self, gear: Component, stage: Component) -> float | None:
        """Power, by its sign, that comes to a stage from this gear's side; None where that does not follow."""
        shares = self.shares(gear, stage)
        if not shares or any(share.power is None for share in shares):
            return None
        return sum(share.power for share in shares if share.power is not None)

    def driving(self, stage: Component, one: Component, other: Component) -> Component | None:
        """The one of both through which power comes to a stage; None where that does not follow."""
        try:
            coming = [self.power(each, stage) for each in (one, other)]
        except ValueProblem:
            # It is told where the torque is looked up.
            return None
        if not (coming[0] or coming[1]):
            return None
        return one if (coming[0] > 0.0 if coming[0] else coming[1] < 0.0) else other

    def bearings(self, part: Component) -> list[Component]:
        """The bearings of all that turns as one with a part."""
        numbers = {each.id for each in self._turning(part)}
        joints = [
            self.model.components[each.roles["assembly"]]
            for each in self.model.related("side")
            if "assembly" in each.roles and numbers & {*each.roles.values()}
        ]
        return [each for each in joints if "bearing" in each.type]

    def place(self, part: Component) -> int:
        """A number that all that turns as one with a part has, and nothing else."""
        return min(each.id for each in self._turning(part))

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
        if numbers & seen or any(each.type == CASING for each in turning) or self._in_planetary(numbers):
            return None
        seen |= numbers
        own_shares = self._own_shares(turning)
        beyond = [(own, mesh) for own, mesh in self._meshes_of(turning) if mesh.stage.id != stage.id]
        if not (own_shares or beyond) or None in own_shares:
            return None
        shares = [each for each in own_shares if each is not None]
        for own, mesh in beyond:
            through = self._shares(mesh.mate(own), mesh.stage, seen) if mesh.plain else None
            if through is None:
                return None
            shares += [self._passed_on(share, own, mesh) for share in through]
        return shares

    def loads(self, part: Component) -> list[Share | None]:
        """What loads bring to a part without a stage on the way; None of each whose torque is not known."""
        return self._own_shares(self._turning(part))

    def _own_shares(self, turning: tuple[Component, ...]) -> list[Share | None]:
        return [self._own_share(load, turning) for load in turning if load.type == "external_load" and is_torque(load)]

    def _own_share(self, load: Component, turning: tuple[Component, ...]) -> Share | None:
        """The torque of a load, or that of its power at the speed of its shaft."""
        speed = self._own_speed(turning)
        if TORQUE in load.attributes:
            torque = value_of(load, TORQUE, "N m")
            sign = self._sign(load, self._axis_of(turning))
            number = torque.number * (sign or 1.0)
            power = None if sign is None or speed is None or speed[1] is None else number * speed[0].number * speed[1]
            return Share(number, sign is not None, power, torque)
        if POWER not in load.attributes or speed is None:
            return None
        power = value_of(load, POWER, "kW")
        number = power.number / speed[0].number
        torque = computed(abs(number), 1e3, "N m", f"{power.origin} over {speed[0].origin}")
        return Share(number * (speed[1] or 1.0), speed[1] is not None, power.number, torque)

    def _passed_on(self, share: Share, own: Component, mesh: Mesh) -> Share:
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
        for one, other in joints(self.model):
            joined.setdefault(one, []).append(other)
            joined.setdefault(other, []).append(one)
        return joined

    @cached_property
    def _meshes(self) -> list[Mesh]:
        components = self.model.components
        meshes = [each for each in map(self._mesh_of_set, self._sets) if each is not None]
        followed = {each.stage.id for each in meshes}
        for relation in self.model.related("stage"):
            if {"stage", "gear_1", "gear_2"} <= relation.roles.keys():
                stage, *gears = (components[relation.roles[role]] for role in ("stage", "gear_1", "gear_2"))
                holders = self.model.partners("assembly", "assembly", part=stage)
                if followed & {each.id for each in holders}:
                    continue
                counted = all("number_of_teeth" in gear.attributes for gear in gears)
                plain = counted and stage.type in PLAIN_STAGES
                plain = plain and not any(holder.type == PLANETARY for holder in holders)
                meshes.append(Mesh(stage, (gears[0], gears[1]), plain))
        return meshes

    @cached_property
    def _sets(self) -> list[PlanetarySet]:
        """The planetary sets like those of a scene."""
        return [
            found_set(self.model, each)
            for each in self.model.components.values()
            if each.type == PLANETARY and is_set(self.model, each)
        ]

    def held(self, own: PlanetarySet) -> list[str]:
        """Names of the members of a set that are joined to the casing; or of the one that nothing else is joined to."""
        turning = {name: self._turning(member) for name, member in own.members.items()}
        found = [name for name, parts in turning.items() if any(each.type == CASING for each in parts)]
        alone = [
            name for name, parts in turning.items() if not self._own_shares(parts) and not self._onwards(own, parts)
        ]
        return found or (alone if len(alone) == 1 else [])

    def _onwards(self, own: PlanetarySet, turning: tuple[Component, ...]) -> bool:
        """Whether a mesh that is none of a set, or a member of another set, turns as one with these."""
        numbers = {each.id for each in turning}
        inner = {each.roles["stage"] for each in (*own.sun_meshes, *own.ring_meshes)}
        meshes = [each.roles for each in self.model.related("stage") if numbers & {*each.roles.values()}]
        others = [member.id for each in self._sets if each.stage.id != own.stage.id for member in each.members.values()]
        return bool(numbers & {*others}) or any(roles.get("stage") not in inner for roles in meshes)

    def _mesh_of_set(self, own: PlanetarySet) -> Mesh | None:
        """The way of the power through a set, None where not one of its members is held."""
        held = self.held(own)
        if len(held) != 1:
            return None
        turns = own.turns(held[0])
        ends = [name for name in own.members if name != held[0]]
        members = own.members[ends[0]], own.members[ends[1]]
        return Mesh(own.stage, members, True, (turns[ends[0]], turns[ends[1]]))

    def _meshes_of(self, turning: tuple[Component, ...]) -> list[tuple[Component, Mesh]]:
        """The meshes of all gears that turn as one, each with its own gear."""
        numbers = {each.id for each in turning}
        return [(gear, mesh) for mesh in self._meshes for gear in mesh.gears if gear.id in numbers]

    def _in_planetary(self, numbers: set[int]) -> bool:
        """Whether one of the parts is a member of a planetary stage through which torque is not followed."""
        components = self.model.components
        followed = {mesh.stage.id for mesh in self._meshes if mesh.turns is not None}
        return any(
            numbers & set(relation.roles.values())
            and any(components[each].type == PLANETARY and each not in followed for each in relation.roles.values())
            for relation in self.model.relations
        )

    def _sense(self, mesh: Mesh) -> float | None:
        """1 where torques of both gears about their axes have one sign, -1 where they have two, None where that is not
        known. One sign have external gears whose axes point alike, and bevel gears whose axes both point to where they
        cross."""
        one, other = (self._axis_of(self._turning(gear)) for gear in mesh.gears)
        if mesh.stage.type == "cylindrical_stage" or mesh.turns is not None:
            same = alike(one, other)
            together = mesh.turns[0] * mesh.turns[1] > 0.0 if mesh.turns else any(map(is_internal, mesh.gears))
            return None if same is None else -same if together else same
        senses = [self._sign(gear, axis) for gear, axis in zip(mesh.gears, (one, other))]
        tips = [word(gear, "bevel_cone_orientation") for gear in mesh.gears]
        if None in senses or not set(tips) <= {"positive", "negative"}:
            return None
        return float(np.prod(senses)) * (1.0 if tips[0] == tips[1] else -1.0)

    def _axis_of(self, turning: tuple[Component, ...]) -> np.ndarray | None:
        """The axis of what turns as one: that of its first shaft that has one."""
        ordered = sorted(turning, key=lambda each: (each.type != "shaft", each.id))
        return next((axis for each in ordered if (axis := axis_of(each)) is not None), None)

    def _sign(self, part: Component, axis: np.ndarray | None) -> float | None:
        return alike(axis_of(part), axis)
