"""Planetary sets of a REXS file: which gear is sun, planet and ring, and what they turn by (Willis)."""

from __future__ import annotations

from dataclasses import dataclass

from .model import Component, Relation, RexsModel
from .transmission import CARRIER, is_internal
from .values import COUNT, ValueProblem, numbered, value_of

ALLOWED = "Allowed: one sun, one ring, and planets of one gear that mesh with both."


@dataclass(frozen=True)
class PlanetarySet:
    """A planetary stage, its members, its planets, and of each its meshes with the sun and with the ring."""

    stage: Component
    members: dict[str, Component]
    planets: tuple[Component, ...]
    sun_meshes: tuple[Relation, ...]
    ring_meshes: tuple[Relation, ...]

    def turns(self, held: str) -> dict[str, float]:
        """Turns of all members in one time, where one is held: z_s (n_s - n_c) = -z_r (n_r - n_c)."""
        sun, ring = (abs(value_of(self.members[name], "number_of_teeth", COUNT).number) for name in ("sun", "ring"))
        by_carrier = {"sun": float(ring), "ring": -float(sun), "carrier": 0.0}
        return {name: turn - by_carrier[held] for name, turn in by_carrier.items()}


def found_set(model: RexsModel, stage: Component) -> PlanetarySet:
    """The set of a planetary stage. Raises ValueProblem where a scene has no set like it."""
    parts = model.partners("assembly", "part", assembly=stage)
    inner = {each.id for each in parts if each.type == "cylindrical_stage"}
    meshes = [
        each
        for each in model.related("stage")
        if each.roles.get("stage") in inner and {"gear_1", "gear_2"} <= each.roles.keys()
    ]
    gears = {number: model.components[number] for each in meshes for number in _pair(each)}
    rings = [number for number, gear in gears.items() if _counted(gear) and is_internal(gear)]
    if len(rings) != 1:
        raise ValueProblem(f"{stage} has {len(rings)} internal gears. {ALLOWED}")
    of_ring = [each for each in meshes if rings[0] in _pair(each)]
    planets = [_mate(each, rings[0]) for each in of_ring]
    others = [each for each in meshes if rings[0] not in _pair(each)]
    suns = list(dict.fromkeys(number for each in others for number in _pair(each) if number not in planets))
    if len(suns) != 1 or any({*_pair(each)} - {*suns, *planets} or suns[0] not in _pair(each) for each in others):
        said = f"besides its ring, {numbered(rings)}, and the gears in it, {numbered(planets)}"
        raise ValueProblem(f"{stage} has {len(suns)} gears {said}, or meshes between planets. {ALLOWED}")
    of_sun = {_mate(each, suns[0]): each for each in others}
    if sorted(of_sun) != sorted(planets) or len({*planets}) < len(planets):
        raise ValueProblem(
            f"{stage}: not each of its planets, {numbered(planets)}, meshes once with its sun. {ALLOWED}"
        )
    carriers = [each for each in parts if each.type == CARRIER]
    carriers += model.partners("planet_carrier_shaft", "shaft", planetary_stage=stage)
    if not carriers:
        raise ValueProblem(f"{stage} has no {CARRIER} and no planet_carrier_shaft. Allowed: one of them.")
    members = {"sun": gears[suns[0]], "ring": gears[rings[0]], "carrier": carriers[0]}
    found = tuple(gears[number] for number in planets)
    return PlanetarySet(stage, members, found, tuple(of_sun[number] for number in planets), tuple(of_ring))


def is_set(model: RexsModel, stage: Component) -> bool:
    """Whether a planetary stage is a set like those of a scene; what it lacks is told where it is imported."""
    try:
        found_set(model, stage)
    except ValueProblem:
        return False
    return True


def _counted(gear: Component) -> bool:
    return gear.type == "ring_gear" or "number_of_teeth" in gear.attributes


def _pair(mesh: Relation) -> tuple[int, int]:
    return mesh.roles["gear_1"], mesh.roles["gear_2"]


def _mate(mesh: Relation, gear: int) -> int:
    one, other = _pair(mesh)
    return other if one == gear else one
