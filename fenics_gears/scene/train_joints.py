"""Planetary sets beside other stages: the parts of such a train, and the shafts that join the output of one to the
input of the next. Power takes one path through them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from fenics_gears.geometry.planetary import CARRIER, SUN
from fenics_gears.inputs.allowed import Allowed, Refused
from fenics_gears.inputs.fields import declared
from fenics_gears.inputs.problem import Path, Problem, did_you_mean
from fenics_gears.inputs.section import Section, read
from fenics_gears.inputs.written import as_written

from .planetary_rules import OF_THE_TRAIN, has_planets, wrong_sections
from .planetary_schema import second_in
from .train_loads import TrainLoad, TrainMotion
from .train_pair import STAGES, MistakesOfStage
from .train_shaft import TrainShaft
from .train_whole import whole_train

HOUSING = "housing"
JOINS = "joins"
SHAFTS = "shafts"
# What a shaft between parts may say.
OF_A_JOINT = ("carries", "torsional_stiffness")
# Parts are read under a load that stands for the one that follows from the whole.
STANDS_FOR_A_LOAD = {"output_torque": "1 N m"}
Tree = Mapping[str, Any]


@dataclass(frozen=True, kw_only=True)
class AllowedJoins(Allowed):
    """A list of lists of names."""

    def convert(self, value: Any) -> tuple[tuple[str, ...], ...]:
        if not isinstance(value, list) or not all(isinstance(each, list) and len(each) == 2 for each in value):
            raise Refused("is no list of pairs.")
        if not all(isinstance(name, str) for each in value for name in each):
            raise Refused("has a pair that is not of two names.")
        return tuple(map(tuple, value))


@dataclass(frozen=True, kw_only=True)
class JoinsText(Section):
    """``joins`` of a train with planetary sets beside other stages."""

    joins: tuple[tuple[str, str], ...] | None = declared(
        AllowedJoins(
            description='a list of pairs, such as [["first.sun", "second.carrier"], ["first.ring", "housing"]]',
            meaning="members of planetary sets and gears that are on one shaft, the output of one with the input of"
            " another; a member that is joined to the housing is fixed",
            otherwise="by the order of the stages",
        )
    )


@dataclass(frozen=True)
class Joint:
    """A shaft between two parts: what it carries, and its torsional `stiffness` (N mm/rad), None where it is rigid.
    `path`: where the scene has it."""

    carries: tuple[str, ...]
    stiffness: float | None = None
    path: Path = ()


@dataclass(frozen=True)
class Ends:
    """The names of what is on the first and on the last shaft of a part."""

    input: tuple[str, ...]
    output: tuple[str, ...]


@dataclass(frozen=True)
class JoinedText:
    """What a parsed train with sets beside other stages says of the whole, and the `trees` of its parts."""

    load: TrainLoad
    motion: TrainMotion
    joints: tuple[Joint, ...]
    trees: tuple[Tree, ...]

    @classmethod
    def of(cls, tree: Tree) -> JoinedText:
        """Raises MistakesOfStage."""
        problems = list(wrong_sections(tree, (*OF_THE_TRAIN, JOINS, SHAFTS)))
        whole, wrong = whole_train({name: tree[name] for name in OF_THE_TRAIN if name in tree})
        problems += wrong
        joins, wrong = read(JoinsText, {name: tree[name] for name in (JOINS,) if name in tree}, ())
        problems += wrong
        pairs = () if joins is None or joins.joins is None else joins.joins
        joints = [Joint(pair, path=(JOINS,)) for pair in pairs if HOUSING not in pair]
        joints += _of_shafts(tree.get(SHAFTS, {}), problems)
        stages, wrong = _held(tree[STAGES], [pair for pair in pairs if HOUSING in pair])
        problems += wrong
        if whole is None or problems:
            raise MistakesOfStage(problems)
        motion_of_parts = {name: each for name, each in tree.get("motion", {}).items() if name != "input_speed"}
        shared = {name: tree[name] for name in ("friction", "accuracy") if name in tree}
        shared |= {"load": STANDS_FOR_A_LOAD, "motion": motion_of_parts}
        return cls(whole.load, whole.motion, tuple(joints), tuple(shared | {STAGES: each} for each in _parts(stages)))


def _parts(stages: Tree) -> list[dict[str, Any]]:
    """Each planetary set by itself, and together the other stages that stand beside each other in the scene."""
    found: list[dict[str, Any]] = []
    alone = True
    for name, content in stages.items():
        of_set = has_planets({STAGES: {name: content}})
        if of_set or alone:
            found.append({})
        found[-1][name] = content
        alone = of_set
    return found


def _held(stages: Tree, pairs: Sequence[Sequence[str]]) -> tuple[Tree, list[Problem]]:
    """The stages with the members fixed that are joined to the housing, and what is wrong with these."""
    found = dict(stages)
    problems = []
    for pair in pairs:
        name = next((each for each in pair if each != HOUSING), "")
        stage, _, member = name.rpartition(".")
        content = found.get(stage)
        sets = [each for each in stages if has_planets({STAGES: {each: stages[each]}})]
        known = [f"{each}.{own}" for each in sets for own in (SUN, second_in(stages[each]), CARRIER)]
        if name not in known or not isinstance(content, Mapping):
            said = f"joins to the housing what is no member of a planetary set.{did_you_mean(name, known)}"
            problems.append(Problem((JOINS,), as_written(name), f"{said} Known: {', '.join(known)}."))
        elif content.get("fixed", member) != member:
            said = f"is joined to the housing, and {stage}.{content['fixed']} is fixed. Allowed: one of them."
            problems.append(Problem((JOINS,), as_written(name), said))
        else:
            found[stage] = {**content, "fixed": member}
    return found, problems


def _of_shafts(written: Any, problems: list[Problem]) -> Iterator[Joint]:
    """The shafts with sections of their own."""
    if not isinstance(written, Mapping):
        problems.append(Problem((SHAFTS,), as_written(written), "is not a section. Allowed: sections [shafts.NAME]."))
        return
    for name, content in written.items():
        path = (SHAFTS, name)
        if not isinstance(content, Mapping):
            problems.append(Problem(path, as_written(content), f"is not a section with {' and '.join(OF_A_JOINT)}."))
            continue
        for field in content:
            if field not in OF_A_JOINT:
                said = f"is not computed beside planetary sets yet. Allowed there: {' and '.join(OF_A_JOINT)}."
                problems.append(Problem((*path, field), as_written(content[field]), said))
        shaft, wrong = read(TrainShaft, {each: content[each] for each in OF_A_JOINT if each in content}, path)
        problems += wrong
        if shaft is not None:
            yield Joint(shaft.carries, shaft.torsional_stiffness, (*path, "carries"))


def in_series(whole: JoinedText, ends: Sequence[Ends]) -> tuple[list[int], list[Joint]]:
    """Numbers of the parts in the order of the power, and the shafts between them. Raises MistakesOfStage where it has
    not one path."""
    behind: dict[int, tuple[int, Joint]] = {}
    for joint in whole.joints:
        before, after = _joined(joint, ends)
        if before in behind or after in [number for number, _ in behind.values()]:
            said = "is a second shaft of what is joined already: power has one path beside planetary sets."
            raise MistakesOfStage([Problem(joint.path, _quoted(joint.carries), f"{said} {_known(ends)}")])
        behind[before] = after, joint
    for before in range(len(ends) - 1):
        after = before + 1
        driven = [number for number, _ in behind.values()]
        if len(behind) < len(ends) - 1 and before not in behind and after not in driven:
            behind[before] = after, Joint((*ends[before].output, *ends[after].input))
    driven = [number for number, _ in behind.values()]
    order = [number for number in range(len(ends)) if number not in driven]
    while order and order[-1] in behind and len(order) <= len(ends):
        order.append(behind[order[-1]][0])
    if sorted(order) != [*range(len(ends))]:
        said = f"do not join all stages on one path: power would go in a circle, or end within. {_known(ends)}"
        raise MistakesOfStage([Problem((JOINS,), "", said)])
    return order, [behind[number][1] for number in order[:-1]]


def _joined(joint: Joint, ends: Sequence[Ends]) -> tuple[int, int]:
    """The parts before and behind a shaft."""
    before = {number for number, each in enumerate(ends) if {*each.output} & {*joint.carries}}
    after = {number for number, each in enumerate(ends) if {*each.input} & {*joint.carries}}
    known = {name for each in ends for name in (*each.input, *each.output)}
    strange = [name for name in joint.carries if name not in known]
    if strange or len(before) != 1 or len(after) != 1 or before == after:
        written = _quoted(strange or joint.carries)
        said = "does not join the output of one part of the train to the input of another."
        raise MistakesOfStage([Problem(joint.path, written, f"{said} {_known(ends)}")])
    return before.pop(), after.pop()


def _known(ends: Sequence[Ends]) -> str:
    said = "; ".join(f"in {_quoted(each.input)}, out {_quoted(each.output)}" for each in ends)
    return f"Parts of this train, each a planetary set or the stages beside each other: {said}."


def _quoted(names: Sequence[str]) -> str:
    return ", ".join(f'"{each}"' for each in names)
