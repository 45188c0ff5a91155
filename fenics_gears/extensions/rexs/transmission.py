"""Parts of a gearbox in a REXS file: gears, joints and loads, their axes, and what passes torque and speed on from one
part to another in a fixed ratio."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .model import Component, RexsModel
from .values import COUNT, Value, numbers_of, value_of, word_of

# Of a load on a shaft.
TORQUE = "torque_around_u_axis"
POWER = "power"
# Cosine of the angle between axes from which on they count as parallel.
PARALLEL = 0.99
# Relations of a joint and the two parts that it joins; the second is that of version 1.0.
JOINING = ("side", "coupling")
PLANETARY = "planetary_stage"
CARRIER = "planet_carrier"
CASING = "gear_casing"


@dataclass(frozen=True)
class Mesh:
    """Two gears of a stage, or the two members of a planetary set between which its power goes; ``plain``: whether
    torque and speed follow; ``turns`` of both members in one time, None of gears, where they are by their teeth."""

    stage: Component
    gears: tuple[Component, Component]
    plain: bool
    turns: tuple[float, float] | None = None

    def mate(self, gear: Component) -> Component:
        return self.gears[1] if gear.id == self.gears[0].id else self.gears[0]

    def ratio(self, gear: Component) -> float:
        """How many times the torque about ``gear`` is that about its mate; turns are as many times fewer."""
        if self.turns is not None:
            own, other = self.turns if gear.id == self.gears[1].id else self.turns[::-1]
        else:
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


def joints(model: RexsModel) -> Iterator[tuple[int, int]]:
    """Pairs of parts that turn as one: a shaft and what is on it, and what joints that are no bearings join."""
    components = model.components
    for relation in model.relations:
        roles = relation.roles
        if relation.type == "assembly" and {"assembly", "part"} <= roles.keys():
            holder = components[roles["assembly"]]
            held_gear = holder.type == CASING and is_gear(components[roles["part"]])
            if holder.type in ("shaft", CARRIER) or is_gear(holder) or held_gear:
                yield roles["assembly"], roles["part"]
        elif relation.type == "planet_carrier_shaft" and {"planetary_stage", "shaft"} <= roles.keys():
            for carrier in model.partners("assembly", "part", assembly=components[roles["planetary_stage"]]):
                if carrier.type == CARRIER:
                    yield carrier.id, roles["shaft"]
        elif relation.type in JOINING:
            parts = [number for number in roles.values() if not is_joint(components[number])]
            if len(parts) == 2 and all(turns_both(components[number]) for number in roles.values()):
                yield parts[0], parts[1]


def axis_of(part: Component) -> np.ndarray | None:
    """The unit vector of a part's axis; None where it has none."""
    if "u_axis_vector" not in part.attributes:
        return None
    vector = np.array(numbers_of(part, "u_axis_vector"))
    length = float(np.linalg.norm(vector))
    return vector / length if vector.shape == (3,) and length > 0.0 else None


def alike(one: np.ndarray | None, other: np.ndarray | None) -> float | None:
    """1 where axes point alike, -1 where they are opposite, None where they are not parallel; those that are not given
    point alike."""
    cosine = 1.0 if one is None or other is None else float(one @ other)
    return None if abs(cosine) < PARALLEL else np.sign(cosine)


def is_gear(part: Component) -> bool:
    return part.type in ("cylindrical_gear", "bevel_gear", "ring_gear")


def is_internal(gear: Component) -> bool:
    return gear.type == "ring_gear" or value_of(gear, "number_of_teeth", COUNT).number < 0


def word(part: Component, name: str) -> str:
    return word_of(part, name).lower() if name in part.attributes else ""


def is_joint(part: Component) -> bool:
    return part.type.endswith(("bearing", "coupling", "_fit", "_connection", "_geometry"))


def turns_both(part: Component) -> bool:
    """Whether a joint passes torque on; a switchable one where the file says that it is engaged."""
    if part.type == "switchable_coupling":
        return word(part, "is_engaged") == "true"
    return "bearing" not in part.type


def is_torque(load: Component) -> bool:
    """Whether a load is more than a force across the shaft: it says so, or has a torque."""
    said = word(load, "transmits_torque")
    return said == "true" or bool({TORQUE, POWER} & load.attributes.keys()) and said != "false"


def is_force(load: Component) -> bool:
    """Whether a load has forces, or torques across the shaft, that are more than nothing."""
    beside = [name for name in load.attributes if name.startswith(("force_", "torque_around_")) and name != TORQUE]
    return load.type == "external_load" and any(any(numbers_of(load, name)) for name in beside)
