"""The pair that is meant in a REXS model, and the components that describe it."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import copysign

from .model import Component, Relation, RexsModel
from .train import Train
from .transmission import PLANETARY, is_internal
from .values import COUNT, Value, ValueProblem, value_of, word_of

CYLINDRICAL = "cylindrical_stage"
EXTERNAL = "cylindrical_gear"
INTERNAL = "ring_gear"
CUTTER = "cutter_wheel_tool"
TOOLS = ("rack_shaped_tool", CUTTER)
# Of a section of a scene.
Fields = dict[str, Value]


@dataclass(frozen=True)
class GearParts:
    """The components of one gear of a stage: itself, its flanks by side, their modifications, its tools and their
    settings, bodies, materials, shafts, what is on its shaft, and its data in this stage. ``by_torque``: the side that
    the torque loads, where that follows from the train."""

    gear: Component
    flanks: dict[str, Component]
    modifications: dict[str, list[Component]]
    tools: list[Component]
    settings: list[Component]
    bodies: list[Component]
    materials: list[Component]
    shafts: list[Component]
    on_shafts: list[Component]
    stage_data: list[Component]
    by_torque: str | None = None

    @property
    def tool(self) -> list[Component]:
        """The tool that made the root, the first one."""
        return self.tools[:1]

    @property
    def cutters(self) -> list[Component]:
        """The shaper cutter of an internal gear."""
        return [each for each in self.tool if each.type == CUTTER]

    @property
    def material(self) -> list[Component]:
        """The material that counts, the first one."""
        return self.materials[:1]

    @property
    def loaded_sides(self) -> list[str]:
        """The side of the teeth that is loaded, both where the file does not say which."""
        said = self.said_side or self.by_torque
        return [side for side in self.flanks if said is None or side == said]

    @property
    def said_side(self) -> str | None:
        """The loaded side by the stage data."""
        said = (
            word_of(data, "loaded_tooth_flank") for data in self.stage_data if "loaded_tooth_flank" in data.attributes
        )
        return next(said, None)

    def modification(self, side: str, kind: str) -> Component | None:
        """What modifies a flank in this way. Raises ValueProblem where there are two."""
        components = [each for each in self.modifications[side] if each.type == kind]
        if len(components) > 1:
            raise ValueProblem(
                f"{self.flanks[side]}: two components {kind}, {components[0].id} and {components[1].id}; a scene has"
                " one."
            )
        return components[0] if components else None

    def of_loaded_sides(
        self, fields_of: Callable[[str], Fields], same: Callable[[Value, Value], bool], what: str
    ) -> Fields:
        """The fields of all sides that may be loaded. Raises ValueProblem where they are not the same."""
        one, *others = [fields_of(side) for side in self.loaded_sides] or [{}]
        for other in others:
            if one.keys() != other.keys() or not all(same(value, other[name]) for name, value in one.items()):
                raise ValueProblem(
                    f"{self.gear}: its left and its right flank have different {what}, and the file does not say which"
                    " one is loaded. Allowed: loaded_tooth_flank (left or right) in the gear's stage data."
                )
        return one


@dataclass(frozen=True)
class Stage:
    """A pair of gears; ``in_planetary``: it is a part of a planetary stage; ``first``: the number of its ``gear_1``;
    ``sense``: 1 where the pinion turns about its axis, -1 where it turns against it, None where that does not follow
    from its torque."""

    stage: Component
    pinion: GearParts
    wheel: GearParts
    in_planetary: bool
    first: int
    sense: float | None = None

    @property
    def named(self) -> dict[str, GearParts]:
        """The driving gear, and the one it drives."""
        return {"pinion": self.pinion, "wheel": self.wheel}


def chosen_stage(model: RexsModel, wanted: int | None) -> Stage:
    """The stage with the wanted number, or the only one. Raises ValueProblem, which lists the stages, where it is not
    clear which."""
    relations = relations_of_pairs(model)
    listed = _listed(model, relations)
    if wanted is None and len(relations) > 1:
        raise ValueProblem(
            f"has {len(relations)} pairs of cylindrical gears; a scene has one. Choose it, or all by --train:\n{listed}"
        )
    number = next(iter(relations)) if wanted is None else wanted
    if number not in relations:
        raise ValueProblem(f"has no stage of cylindrical gears with the number {number}. There are:\n{listed}")
    return stage_of(model, relations[number])


def relations_of_pairs(model: RexsModel) -> dict[int, Relation]:
    """Pairs of cylindrical gears by the number of their stage. Raises ValueProblem where there is none."""
    relations = {
        each.roles["stage"]: each
        for each in model.related("stage")
        if {"stage", "gear_1", "gear_2"} <= set(each.roles)
        and model.components[each.roles["stage"]].type == CYLINDRICAL
    }
    if not relations:
        raise ValueProblem(_no_stage(model))
    return relations


def _no_stage(model: RexsModel) -> str:
    numbers = {each.roles["stage"] for each in model.related("stage") if "stage" in each.roles}
    others = sorted({model.components[number].type for number in numbers})
    besides = f" Its stages are: {', '.join(others)}." if others else ""
    needed = 'no relation "stage" with a cylindrical_stage, a gear_1 and a gear_2'
    return f"has no pair of cylindrical gears: {needed}.{besides}"


def _listed(model: RexsModel, relations: dict[int, Relation]) -> str:
    """A line for each stage, as it is chosen."""
    return "\n".join(f"    --stage {number}    {_described(model, each)}" for number, each in relations.items())


def _described(model: RexsModel, relation: Relation) -> str:
    gears = [model.components[relation.roles[role]] for role in ("gear_1", "gear_2")]
    named = model.components[relation.roles["stage"]].name
    return f"{named + ': ' if named else ''}{' and '.join(map(_with_teeth, gears))}"


def _with_teeth(gear: Component) -> str:
    teeth = gear.attributes.get("number_of_teeth")
    count = str(teeth.value).removesuffix(".0") if teeth else "?"
    return f"{gear.type} {gear.id} ({count} teeth)"


def stage_of(model: RexsModel, relation: Relation, pinion: Component | None = None) -> Stage:
    """The pair of a stage; its pinion drives, or is the one that is given. Raises ValueProblem."""
    stage = model.components[relation.roles["stage"]]
    train = Train(model)
    parts = [_parts(model, stage, model.components[relation.roles[role]]) for role in ("gear_1", "gear_2")]
    for part in parts:
        if part.gear.type not in (EXTERNAL, INTERNAL):
            raise ValueProblem(f"{part.gear} is no cylindrical gear.")
    holders = model.partners("assembly", "assembly", part=stage)
    in_planetary = any(each.type == PLANETARY for each in holders)
    if not in_planetary:
        parts = [replace(part, by_torque=_side_by_torque(train, stage, part.gear)) for part in parts]
    said = pinion or _driving(train, stage, *parts) or _smaller(*parts)
    first = said.id == parts[0].gear.id
    ordered = parts if first else parts[::-1]
    if internal_gear(ordered[0].gear):
        raise ValueProblem(
            f"{ordered[0].gear} is an internal gear and drives {ordered[1].gear}. Allowed: an internal gear that is"
            " driven by an external one."
        )
    torque = None if in_planetary else _torque(train, stage, ordered[0].gear)
    sense = copysign(1.0, torque) if torque else None
    return Stage(stage, ordered[0], ordered[1], in_planetary, relation.roles["gear_1"], sense)


def internal_gear(gear: Component) -> bool:
    """Whether a gear is internal: a ring_gear, or one with a negative number of teeth."""
    return gear.type == INTERNAL or _teeth(gear) is not None and is_internal(gear)


def _parts(model: RexsModel, stage: Component, gear: Component) -> GearParts:
    roles = next((each.roles for each in model.related("flank", gear=gear)), {})
    flanks = {side: model.components[roles[side]] for side in ("left", "right") if side in roles}
    steps = [step for flank in flanks.values() for step in model.related("manufacturing_step", workpiece=flank)]
    tools = {step.roles["tool"]: step for step in steps if "tool" in step.roles}
    shafts = [each for each in model.partners("assembly", "assembly", part=gear) if each.type == "shaft"]
    # Up to version 1.2 a gear refers to its tools; from 1.3 on its flanks do, each with how the tool was set.
    referred = model.partners("ordered_reference", "referenced", origin=gear) + [
        model.components[number] for number in tools
    ]
    settings = {step.roles["manufacturing_settings"]: None for step in steps if "manufacturing_settings" in step.roles}
    return GearParts(
        gear,
        flanks,
        {side: model.partners("reference", "referenced", origin=flank) for side, flank in flanks.items()},
        [each for each in referred if each.type in TOOLS],
        [model.components[number] for number in settings],
        [each for each in model.partners("assembly", "part", assembly=gear) if each.type == "gear_body"],
        [each for each in model.partners("reference", "referenced", origin=gear) if each.type == "material"],
        shafts,
        [each for shaft in shafts[:1] for each in model.partners("assembly", "part", assembly=shaft)],
        model.partners("stage_gear_data", "stage_gear_data", stage=stage, gear=gear),
    )


def _teeth(gear: Component) -> float | None:
    return value_of(gear, "number_of_teeth", COUNT).number if "number_of_teeth" in gear.attributes else None


def driving_gear(model: RexsModel, relation: Relation, train: Train) -> Component | None:
    """The gear of a stage that drives, as the file says, or by the way of the power; None where neither says it."""
    stage = model.components[relation.roles["stage"]]
    gears = (model.components[relation.roles[role]] for role in ("gear_1", "gear_2"))
    return _driving(train, stage, *(_parts(model, stage, gear) for gear in gears))


def _driving(train: Train, stage: Component, first: GearParts, second: GearParts) -> Component | None:
    says = [_drives(part) for part in (first, second)]
    if says[0] != says[1]:
        return first.gear if says[0] is True or says[1] is False else second.gear
    # Programs also write that neither drives, or both.
    return train.driving(stage, first.gear, second.gear)


def _smaller(first: GearParts, second: GearParts) -> Component:
    """The gear with fewer teeth, or within an internal gear."""
    if internal_gear(first.gear) != internal_gear(second.gear):
        return second.gear if internal_gear(first.gear) else first.gear
    teeth = [_teeth(part.gear) for part in (first, second)]
    return first.gear if None in teeth or teeth[0] <= teeth[1] else second.gear


def _side_by_torque(train: Train, stage: Component, gear: Component) -> str | None:
    """The side of a gear's teeth that its torque loads, looking from its datum face with the tooth upwards; None where
    that does not follow."""
    torque = _torque(train, stage, gear) if "datum_face_orientation" in gear.attributes else None
    if not torque:
        return None
    # The mate's force turns the gear against its loads. From the end in -u, a positive turn is clockwise.
    from_below = word_of(gear, "datum_face_orientation") == "negative"
    return "left" if (torque < 0.0) == from_below else "right"


def _torque(train: Train, stage: Component, gear: Component) -> float | None:
    """Torque about a gear's axis; None where it does not follow, or is wrong, which its look-up tells."""
    try:
        return train.torque(gear, stage)
    except ValueProblem:
        return None


def _drives(part: GearParts) -> bool | None:
    data = next((each for each in part.stage_data if "is_driving_gear" in each.attributes), None)
    return None if data is None else word_of(data, "is_driving_gear").lower() == "true"
