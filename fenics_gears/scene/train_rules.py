"""What the scene of a train may have: its load and motion, the sections of its stages; and mistakes against them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from re import fullmatch
from typing import Any

from fenics_gears.inputs.problem import Problem, did_you_mean
from fenics_gears.inputs.written import as_written

from .planetary_schema import PLANETARY
from .train_loads import TrainLoad, TrainMotion
from .train_shafts import TrainShafts, checked_shafts
from .train_topology import coupled_stages
from .train_whole import whole_train, wrong_with_inertia

PAIR = "pair"
ROW = "row"
ENDS = ("load", "motion")
# Sections that a train may have for all of its stages, and those that a row may have of its own; and a stage of two
# gears. Others are of a pair alone so far.
SHARED = ("friction", "accuracy", "inertia", "bearings")
OVER_THE_FACE = ("lead_modifications", "misalignment")
ON_FLANKS = ("corner_contact", "coast_flanks")
OF_A_ROW = (*SHARED, "tip_relief", "root_relief", "profile_modifications", *ON_FLANKS, *OVER_THE_FACE)
RUN_OUT = "eccentricity"
# Of single gears: of a pair by `pinion` and `wheel`, of a row by their numbers.
OF_GEARS = ("flank_errors", RUN_OUT)
OF_A_STAGE = (*OF_A_ROW, "body_meshes", "wheel_points", *OF_GEARS)
OF_A_PAIR = ("shafts", "damping", "torque_ripple", "speed_ramp")
OF_A_TRAIN = ("title", "stages", "load", "motion", *SHARED, "shafts", "damping", "speed_ramp")
MOST_STAGES = 20
NAMES = r"[A-Za-z0-9_-]{1,60}"


@dataclass(frozen=True)
class TrainSections:
    """Sections of a train beside its stages."""

    load: TrainLoad
    motion: TrainMotion
    shafts: TrainShafts


def checked_train(tree: Mapping[str, Any]) -> tuple[TrainSections | None, list[Problem]]:
    """The sections of a parsed train, None where it is wrong, and all that is wrong with it."""
    problems = [
        Problem((each,), as_written(tree[each]), f"is not of a train.{did_you_mean(each, OF_A_TRAIN)} {_where(each)}")
        for each in tree
        if each not in OF_A_TRAIN
    ]
    stages = tree["stages"]
    if not isinstance(stages, Mapping) or not 0 < len(stages) <= MOST_STAGES:
        allowed = f"Allowed: 1 to {MOST_STAGES} sections [stages.NAME], each with the gears of a stage."
        return None, [*problems, Problem(("stages",), as_written(stages), f"has no stages. {allowed}")]
    coupled = coupled_stages(stages)
    for stage, content in stages.items():
        if not fullmatch(NAMES, stage):
            allowed = "Allowed: letters, digits, _ and -; a folder of results has this name."
            problems.append(Problem(("stages", stage), "", f"is no name of a stage. {allowed}"))
        problems += _of_stage(("stages", stage), content, stage in coupled)
    whole, wrong = whole_train(tree)
    problems += wrong
    shafts, wrong = checked_shafts(tree, None if problems else whole)
    problems += wrong
    if whole is None or problems:
        return None, problems
    problems += _needed(tree) if whole.inertia is None else wrong_with_inertia(whole.motion)
    return (None if problems else TrainSections(whole.load, whole.motion, shafts)), problems


def _needed(tree: Mapping[str, Any]) -> Iterator[Problem]:
    """Masses that stages have, and the train has not."""
    for stage, content in tree["stages"].items():
        if "inertia" in content:
            said = "is of one stage. Add [inertia] for all stages, such as with a density."
            yield Problem(("stages", stage, "inertia"), "", said)


def _where(name: str) -> str:
    if name in OF_A_STAGE:
        return f"Write it within a stage: [stages.NAME.{name}]."
    if name in OF_A_PAIR:
        return f"It is not yet computed in trains. Known: {', '.join(OF_A_TRAIN)}."
    return f"Known: {', '.join(OF_A_TRAIN)}; within a stage {', '.join(OF_A_STAGE)} and all fields of [gears]."


def _of_stage(path: tuple[str, ...], content: Any, coupled: bool) -> Iterator[Problem]:
    """What is wrong with a stage; `coupled`: a gear of it stands in several meshes."""
    if not isinstance(content, Mapping):
        yield Problem(path, as_written(content), "is not a section with the gears of a stage.")
        return
    kind = content.get("kind", PAIR)
    if kind not in (PAIR, ROW):
        said = f'is no kind of stage. Allowed: "{PAIR}", "{ROW}" or "{PLANETARY}".'
        yield Problem((*path, "kind"), as_written(kind), said)
    elif kind == ROW:
        yield from _of_row(path, content)
    elif "gears" in content or "directions" in content:
        wrong = "gears" if "gears" in content else "directions"
        yield Problem((*path, wrong), as_written(content[wrong]), f'is of a row. Add kind = "{ROW}", or leave it out.')
    for name in (*OF_A_PAIR, *(OF_A_STAGE if coupled else ())):
        if name in content and name not in (*OF_A_ROW, *OF_GEARS):
            what = "where a gear has several mates" if name in OF_A_STAGE else "of a stage by itself"
            allowed = f"Allowed: {', '.join((*OF_A_ROW, *OF_GEARS) if coupled else OF_A_STAGE)}."
            if name in OF_A_TRAIN:
                allowed = f"Write it for the whole train: [{name}]."
            yield Problem((*path, name), "", f"is not yet computed {what}. {allowed}")
    if coupled and "backlash" in content:
        said = "would thin the teeth of a gear differently in its meshes. Allowed: profile_shift of each gear."
        yield Problem((*path, "backlash"), as_written(content["backlash"]), said)


def _of_row(path: tuple[str, ...], content: Mapping[str, Any]) -> Iterator[Problem]:
    gears = content.get("gears")
    place = (*path, "gears")
    if not isinstance(gears, list) or len(gears) < 2 or not all(isinstance(each, Mapping | str) for each in gears):
        allowed = "Allowed: a list of at least two tables, as [{ teeth = 24 }, { teeth = 31 }, { teeth = 40 }]."
        yield Problem(place, None if gears is None else as_written(gears), f"has not the gears of a row. {allowed}")
        return
    directions = content.get("directions")
    if directions is not None and (not isinstance(directions, list) or len(directions) != len(gears) - 1):
        allowed = f"Allowed: {len(gears) - 1} angles, one for each mesh."
        yield Problem((*path, "directions"), as_written(directions), f"has not one angle for each mesh. {allowed}")
    for name in [each for each in OF_GEARS if each in content]:
        section = content[name]
        allowed = f"Allowed: sections by their numbers, 1 to {len(gears)}."
        if not isinstance(section, Mapping) or not section:
            yield Problem((*path, name), as_written(section), f"says of no gear what it has. {allowed}")
            continue
        for key, own in section.items():
            if not isinstance(own, Mapping) or key not in map(str, range(1, len(gears) + 1)):
                yield Problem((*path, name, key), as_written(own), f"is no gear of this row. {allowed}")
    for name in ("pinion", "wheel", "direction"):
        if name in content:
            yield Problem((*path, name), as_written(content[name]), "is of a pair. A row has gears and directions.")
