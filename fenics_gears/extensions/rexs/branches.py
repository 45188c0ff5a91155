"""Trains of a REXS file whose power has several paths or several ends: gears with several mates, shafts and loads."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from .attributes import Reading
from .gears import Sections
from .model import Component, RexsModel
from .stage import Stage
from .train import Train
from .values import Value, ValueProblem, agreed, computed, numbered, together


class Branches:
    """The stages of such a train, in the order of the power."""

    def __init__(self, model: RexsModel, stages: Sequence[Stage], name_of: Callable[[Stage], str]) -> None:
        self.stages = stages
        self.name_of = name_of
        self.train = Train(model)
        self.names: dict[int, str] = {}
        self.gears: dict[int, Component] = {}
        for stage in stages:
            for role, part in stage.named.items():
                self.names.setdefault(part.gear.id, f"{name_of(stage)}.{role}")
                self.gears[part.gear.id] = part.gear

    def sections(self, reading: Reading, meshes: Sequence[Sections]) -> list[Sections]:
        """The sections of each stage from those of its mesh as a pair: a gear is declared once, and named where it has
        further mates."""
        declared: dict[int, dict[str, Value | None]] = {}
        for stage, mesh in zip(self.stages, meshes):
            for role, part in stage.named.items():
                if self._is_declared(stage, role):
                    declared[part.gear.id] = mesh[f"gears.{role}"]
        return [self._of_stage(reading, stage, mesh, declared) for stage, mesh in zip(self.stages, meshes)]

    def _of_stage(
        self, reading: Reading, stage: Stage, mesh: Sections, declared: dict[int, dict[str, Value | None]]
    ) -> Sections:
        pair = dict(mesh["gears"])
        width = pair.pop("face_width", None)
        material = mesh.get("gears.material")
        coupled = self._coupled(stage)
        if coupled:
            self._check_coupled(reading, stage, pair)
        found: Sections = {"gears": pair}
        for role, part in stage.named.items():
            home = f"gears.{role}"
            fields = {**mesh[home], **({} if width is None else {"face_width": width})}
            if coupled and fields.pop("axial_offset", None) is not None:
                reading.left_out.append(f"axial offset of {part.gear}, which has several mates")
            if not self._is_declared(stage, role):
                both = [declared[part.gear.id]["profile_shift"], fields["profile_shift"]]
                reading.attempt(agreed, both, f"{part.gear} has two profile shifts by its mates")
                written = f'"{self.names[part.gear.id]}"'
                pair[role] = Value(0.0, written, f"component {part.gear.id}, which meshes there too")
                continue
            found[home] = fields
            inner = {name: own for name, own in mesh.items() if name.startswith(f"{home}.")}
            found |= inner if material is None else {**inner, f"{home}.material": material}
        return found | {name: own for name, own in mesh.items() if not name.startswith("gears")}

    def _is_declared(self, stage: Stage, role: str) -> bool:
        return self.names[stage.named[role].gear.id] == f"{self.name_of(stage)}.{role}"

    def _coupled(self, stage: Stage) -> bool:
        """Whether a gear of a stage has several mates."""
        own = {part.gear.id for part in stage.named.values()}
        others = [part.gear.id for each in self.stages if each is not stage for part in each.named.values()]
        return bool(own & {*others})

    def _check_coupled(self, reading: Reading, stage: Stage, pair: dict[str, Value | None]) -> None:
        """What stages with a gear in common have: a direction, and one hand, that of the first one's pinion."""
        if "direction" not in pair:
            reading.problems.append(
                f"{stage.stage}: one of its gears has several mates, and the file does not say in which directions they"
                " stand. Allowed: support_vector of the gears or their shafts, or rotating_angle_around_neg_u_axis of"
                " the stage."
            )
        if "pinion_hand" not in pair:
            return
        gear = stage.pinion.gear.id
        driving = next((each for each in self.stages if each.wheel.gear.id == gear), None)
        turned = False
        while driving is not None:
            turned = not turned
            driving = next((each for each in self.stages if each.wheel.gear.id == driving.pinion.gear.id), None)
        if turned:
            hand = pair["pinion_hand"]
            other = {'"right"': '"left"', '"left"': '"right"'}[hand.written]
            pair["pinion_hand"] = replace(hand, written=other, origin=f"{hand.origin}, that of the first pinion")

    def shafts(self) -> Sections:
        """Sections of the shafts with several gears."""
        found: Sections = {}
        for gears in self._places().values():
            if len(gears) > 1:
                shaft = next((each.shafts[0].id for each in self._parts() if each.gear.id in gears and each.shafts), 0)
                names = ", ".join(f'"{self.names[each]}"' for each in gears)
                found[f"shafts.shaft_{shaft}"] = {"carries": Value(0.0, f"[{names}]", numbered(gears))}
        return found

    def loads(self, torque: Value | None) -> dict[str, Value]:
        """Fields of the section [load]; `torque`: of the last gear, in place of the file's. Raises ValueProblem."""
        places = self._places()
        place = self.train.place
        first = place(self.stages[0].pinion.gear)
        driving = {place(each.pinion.gear) for each in self.stages}
        outputs = [number for number in places if number not in driving]
        known, loaded = self._known(places, first)
        lacking = [each for each in places if each not in (first, *known) and each in (*outputs, *loaded)]
        if torque is not None:
            last = [each for each in outputs if each in lacking] or outputs
            known[last[-1]] = torque
            lacking = [each for each in lacking if each != last[-1]]
        between = [each for each in lacking if each not in outputs]
        if between or len(lacking) > 1 or lacking and first not in known:
            shafts = " and of ".join(numbered(places[number]) for number in lacking)
            raise ValueProblem(
                f"has no torque on the shafts of {shafts}. Of the loads of the drive, {numbered(places[first])}, and of"
                " the shafts that drive no gear all but one must be known, and all between. Allowed:"
                " torque_around_u_axis of an external_load on them, or --wheel-torque of the last gear."
            )
        further = [number for number in known if number not in (first, *lacking)]
        single = outputs[0] if len(outputs) == 1 and not lacking else None
        found = {"output_torque": known[single]} if single is not None else {}
        if lacking:
            found["input_torque"] = known[first]
        others = [number for number in further if number != single]
        if others:
            entries = "".join(
                f'    {{ on = "{self.names[places[number][0]]}", torque = {known[number].written} }},\n'
                for number in others
            )
            found["torques"] = Value(0.0, f"[\n{entries}]", together(known[number].origin for number in others))
        return found

    def _known(self, places: dict[int, list[int]], first: int) -> tuple[dict[int, Value], list[int]]:
        """Torques by the places that they are on, and all places that have loads. Raises ValueProblem for a second
        drive."""
        known: dict[int, Value] = {}
        loaded: list[int] = []
        for number, gears in places.items():
            loads = self.train.loads(self.gears[gears[0]])
            if any(each is not None and (each.power or 0.0) > 0.0 for each in loads) and number != first:
                both = f"{numbered(places[first])} and of {numbered(gears)}"
                raise ValueProblem(f"has loads that drive the shafts of {both}. Allowed: one driven shaft.")
            loaded += [number] if loads else []
            if loads and None not in loads:
                total = abs(sum(each.number for each in loads if each is not None))
                known[number] = computed(total, 1e3, "N m", together(each.load.origin for each in loads if each))
        return known, loaded

    def _parts(self):
        return [part for stage in self.stages for part in stage.named.values()]

    def _places(self) -> dict[int, list[int]]:
        """Numbers of the gears by where they turn as one, in the order of the power."""
        found: dict[int, list[int]] = {}
        for part in self._parts():
            here = found.setdefault(self.train.place(part.gear), [])
            if part.gear.id not in here:
                here.append(part.gear.id)
        return found
