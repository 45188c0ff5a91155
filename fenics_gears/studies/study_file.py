"""Reads a study file into a `Study` and validates all its cases."""

import functools
import math
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import Any

from fenics_gears.errors import SceneError
from fenics_gears.inputs.problem import Mistakes, did_you_mean, line_numbers
from fenics_gears.inputs.tree import value_at
from fenics_gears.inputs.written import as_written
from fenics_gears.results.planetary import OF_SETS
from fenics_gears.runs.record import TRAIN_ERROR
from fenics_gears.runs.run import Run, run_of, scene_key
from fenics_gears.scene.data import Scene
from fenics_gears.scene.parsing import is_train, name_of, parsed, text_of
from fenics_gears.scene.read import load_scene_or_train
from fenics_gears.scene.train import TrainScene
from fenics_gears.scene.train_pair import STAGES
from fenics_gears.system.progress import Progress, SilentProgress

from . import fields
from .axis import SAMPLE, Axis, AxisError, label, unit_of, values_of
from .random_values import is_random, sampled
from .scenes import NoScene, SceneChanges, Scenes
from .study import Study

KEYS = ("title", "scene", "combine", "keep", "without", "set", "sweep")
COMBINATIONS = ("product", "zip")
KEPT = ("runs", "numbers")
# What is asked for where numbers alone are kept, of pairs and of trains.
OF_PAIRS = ("peak_to_peak_transmission_error", "max_normal_force")
MOST_CASES = 100_000
# So many are validated within a second or two.
MOST_CASES_AT_ONCE = 100
# Names of the combined dataset's own variables.
TAKEN = {"case", "failed", "failure", "meaningless", "mesh_phase", "gear", "mesh", "quantile", SAMPLE}


def load_study(path: str | Path, progress: Progress | None = None) -> Study:
    """Read a study file and its base scene and validate every case. Raises SceneError, naming every mistake at once,
    before anything is computed."""
    path = Path(path)
    text = text_of(path, "study")
    tree = parsed(text, str(path))
    if ("gears" in tree or is_train(tree)) and "sweep" not in tree:
        raise SceneError(
            f"{path}: is a scene, not a study; `gears run {path}` runs it. Nothing was computed or written."
        )
    # A swept field has one name here, whether its dots are written bare or within quotes.
    lines = {
        (name[0], ".".join(name[1:])) if len(name) > 1 else name: line for name, line in line_numbers(text).items()
    }
    return study_of(tree, path, text, str(path), lines, progress)


def study_of(
    tree: Mapping[str, Any],
    path: Path,
    text: str,
    source: str,
    lines: Mapping[tuple[str, ...], int],
    progress: Progress | None = None,
) -> Study:
    """The study of a parsed file; `path` from whose folder the base scene is named and whose stem is the study's name,
    `source` and `lines` for messages."""
    mistakes = Mistakes(source, lines)
    _check_keys(tree, mistakes)
    changes = _changes(tree, mistakes)
    mistakes.check()
    scene_file = path.parent / tree["scene"]
    base = load_scene_or_train(scene_file)
    scene_tree = parsed(base.text, str(scene_file))
    _check_present(changes, scene_tree, str(scene_file), mistakes)
    _check_stages(changes, scene_tree, str(scene_file), mistakes)
    mistakes.check()
    name = name_of(path)
    combine = changes.combine
    axes = changes.axes
    scenes = Scenes(name, scene_file.parent, changes, scene_tree)
    cases = _cases(scenes, changes, mistakes, progress or SilentProgress())
    mistakes.check()
    asked = None
    if tree.get("keep") == "numbers":
        asked = tuple(sorted(OF_SETS)) if _has_sets(base) else (TRAIN_ERROR,) if is_train(scene_tree) else OF_PAIRS
    return Study(name, tree.get("title", name), combine, axes, cases, text, base.text, scene_key(base), asked)


def _has_sets(base: Scene | TrainScene) -> bool:
    return isinstance(base, TrainScene) and any(part.shafts.carrier is not None for part in base.parts)


def _check_keys(tree: Mapping[str, Any], mistakes: Mistakes) -> None:
    for key, value in tree.items():
        if key not in KEYS:
            hint = did_you_mean(key, KEYS)
            if not hint and (key,) in fields.known_paths():
                hint = " A field of the scene belongs below [set], or below [sweep] with a list of values."
            mistakes.add((key,), as_written(value), f"is not known in a study.{hint} Known: {', '.join(KEYS)}.")
    for key in ("title", "scene", "combine", "keep"):
        if key in tree and not isinstance(tree[key], str):
            mistakes.add((key,), as_written(tree[key]), "is not a text.")
    if "scene" not in tree:
        allowed = "the file of the base scene, from this file's folder on, such as"
        mistakes.add(("scene",), None, f'is missing. Allowed: {allowed} "lundvall2004.toml".')
    if isinstance(tree.get("combine"), str) and tree["combine"] not in COMBINATIONS:
        message = f'is not known.{did_you_mean(tree["combine"], COMBINATIONS)} Allowed: "product", "zip".'
        mistakes.add(("combine",), as_written(tree["combine"]), message)
    if isinstance(tree.get("keep"), str) and tree["keep"] not in KEPT:
        hint = did_you_mean(tree["keep"], KEPT)
        message = f'is not known.{hint} Allowed: "runs", a file of each case; "numbers", without files.'
        mistakes.add(("keep",), as_written(tree["keep"]), message)
    for key in ("set", "sweep"):
        if key in tree and not isinstance(tree[key], Mapping):
            message = f"is not a section. Write a line [{key}], and below it fields of the scene."
            mistakes.add((key,), as_written(tree[key]), message)
    if not tree.get("sweep"):
        example = 'motion.mesh_frequency = ["100 Hz", "200 Hz"]'
        message = f"is missing. Add the section [sweep] with at least one field, such as {example}."
        mistakes.add(("sweep",), None, message)


def _changes(tree: Mapping[str, Any], mistakes: Mistakes) -> SceneChanges:
    without = left_out(tree, mistakes)
    fixed = dict(entries(tree, "set", mistakes))
    swept = []
    for path, written in entries(tree, "sweep", mistakes):
        try:
            values = sampled(path, written) if is_random(written) else values_of(path, written)
            swept.append((path, values, is_random(written)))
        except AxisError as error:
            mistakes.add(("sweep", ".".join(path)), _shown(written), str(error))
    axes = _axes(swept)
    _check_overlaps(without, fixed, axes, mistakes)
    combine = tree.get("combine", "product")
    _check_sizes(axes, combine, mistakes)
    return SceneChanges(without, fixed, axes, combine)


def left_out(tree: Mapping[str, Any], mistakes: Mistakes) -> tuple[fields.Path, ...]:
    """The sections and fields that a file leaves out of its scene (`without`); mistakes in them are noted."""
    names = tree.get("without", [])
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        allowed = 'sections and fields to leave out, such as ["inertia", "damping"]'
        mistakes.add(("without",), as_written(names), f"is not a list of names. Allowed: {allowed}.")
        return ()
    for name in names:
        if problem := fields.why_unknown(tuple(name.split("."))):
            mistakes.add(("without",), as_written(name), problem)
    return tuple(tuple(name.split(".")) for name in names)


def entries(
    tree: Mapping[str, Any], table: str, mistakes: Mistakes, own: Collection[str] = ()
) -> list[tuple[fields.Path, Any]]:
    """Paths and values below [set], [sweep] or another `table` less its `own` keys, however the dotted path is
    spelt."""
    paths: list[tuple[fields.Path, Any]] = []

    def walk(home: fields.Path, values: Mapping[str, Any]) -> None:
        for key, value in values.items():
            path = (*home, *key.split("."))
            if problem := fields.why_unknown(path):
                mistakes.add((table, ".".join(path)), _shown(value), problem)
            elif isinstance(value, Mapping) and value and fields.has_parts(path):
                walk(path, value)
            else:
                paths.append((path, value))

    if isinstance(tree.get(table), Mapping):
        walk((), {key: value for key, value in tree[table].items() if key not in own})
    return paths


def _shown(value: Any) -> str:
    return f"{{ {label(value)} }}" if isinstance(value, Mapping) else as_written(value)


def _axes(swept: list[tuple[fields.Path, tuple[Any, ...], bool]]) -> tuple[Axis, ...]:
    """The swept fields, random ones last."""
    last = [path[-1] for path, _, _ in swept]
    short = {name for name in last if last.count(name) == 1 and name not in TAKEN}
    return tuple(
        Axis(path, values, path[-1] if path[-1] in short else "_".join(path), unit_of(values), random)
        for path, values, random in sorted(swept, key=lambda each: each[2])
    )


def _check_overlaps(without, fixed, axes: tuple[Axis, ...], mistakes: Mistakes) -> None:
    swept = [axis.path for axis in axes]
    for path in swept:
        dotted = ".".join(path)
        for other in swept:
            if other != path and other == path[: len(other)]:
                message = f"lies in [{'.'.join(other)}], which is swept too. Sweep one of the two."
                mistakes.add(("sweep", dotted), None, message)
        # A section is named in [set] so that "present" has it.
        if fixed.get(path, {}) != {}:
            mistakes.add(("set", dotted), None, "is swept too. Leave it out of [set].")
        if swept.count(path) > 1:
            mistakes.add(("sweep", dotted), None, "is swept twice.")
    if (second := fields.second_load(swept)) is not None:
        mistakes.add(("sweep", ".".join(second[0])), None, second[1])
    for path in without:
        if path in fixed or path in swept:
            message = "is set or swept as well. Leave it out of one of the two."
            mistakes.add(("without",), f'"{".".join(path)}"', message)


def _check_sizes(axes: tuple[Axis, ...], combine: str, mistakes: Mistakes) -> None:
    lengths = {axis.dotted: len(axis.values) for axis in axes}
    if combine == "zip" and len(set(lengths.values())) > 1:
        listed = ", ".join(f"{name} has {length}" for name, length in lengths.items())
        mistakes.add(("combine",), '"zip"', f"needs as many values of each swept field: {listed}.")
    samples = {axis.dotted: len(axis.values) for axis in axes if axis.random}
    if combine == "product" and len(set(samples.values())) > 1:
        listed = ", ".join(f"{name} has {length}" for name, length in samples.items())
        mistakes.add(("sweep",), "", f"needs as many samples of each random field: {listed}.")
    cases = math.prod(len(axis.values) for axis in axes if not axis.random) * max(samples.values(), default=1)
    if combine == "product" and cases > MOST_CASES:
        mistakes.add(("sweep",), "", f"makes {cases} cases. Allowed: up to {MOST_CASES}.")


def _check_present(changes: SceneChanges, scene_tree: Mapping[str, Any], scene_file: str, mistakes: Mistakes) -> None:
    """ "present" needs a section that the scene, with what is set, has."""
    values = [(("sweep", axis.dotted), axis.path, axis.values) for axis in changes.axes]
    values += [(("set", ".".join(path)), path, (value,)) for path, value in changes.fixed.items()]
    for place, path, listed in values:
        if value_at(changes.apply(scene_tree, ()), *path) is None and any(value == fields.PRESENT for value in listed):
            message = f"means the section as {scene_file} has it, but that has none. Write its fields as a table."
            mistakes.add(place, f'"{fields.PRESENT}"', message)


def _check_stages(changes: SceneChanges, scene_tree: Mapping[str, Any], scene_file: str, mistakes: Mistakes) -> None:
    """Stages are those of the scene: another one would be a new stage without gears."""
    places = [(("sweep", axis.dotted), axis.path) for axis in changes.axes]
    places += [(("set", ".".join(path)), path) for path in changes.fixed]
    places += [(("without",), path) for path in changes.without]
    known = list(scene_tree.get(STAGES, {}))
    for place, path in places:
        if path[0] == STAGES and len(path) > 1 and path[1] not in known:
            there = f"has the stages {', '.join(known)}" if known else "has no stages"
            hint = did_you_mean(path[1], known)
            mistakes.add(place, None, f"is of a stage {path[1]}, but {scene_file} {there}.{hint}")


def _cases(scenes: Scenes, changes: SceneChanges, mistakes: Mistakes, progress: Progress) -> tuple[Run, ...]:
    cases: list[Run] = []
    by_key: dict[str, Run] = {}
    wrong: dict[tuple, list[str]] = {}
    numbers: Iterable[int] = range(len(scenes.points))
    if len(scenes.points) > MOST_CASES_AT_ONCE:
        progress.stage("validate cases")
        numbers = progress.counted(range(len(scenes.points)))
    for index in numbers:
        values = scenes.values(index)
        try:
            case = run_of(scenes.model(index), index, values, functools.partial(scenes.model, index))
        except NoScene as error:
            words = ", ".join(f"{name} = {value}" for name, value in values.items())
            for problem in error.problems:
                wrong.setdefault((problem.path, problem.written, problem.message), []).append(words)
            continue
        same = by_key.setdefault(case.key, case)
        if same is not case:
            mistakes.add(("sweep",), "", f"{same} and {case} are the same scene. Leave one of them out.")
        cases.append(case)
    for (field, written, message), where in wrong.items():
        mistakes.add(*_in_study(field, written, message, changes, where, len(scenes.points)))
    return tuple(cases)


def _in_study(field: fields.Path, written, message: str, changes: SceneChanges, where: list[str], points: int) -> tuple:
    """A mistake in the scenes of some cases as a mistake of the study file, at the line that causes it where there is
    one."""
    named = [("sweep", axis.path) for axis in changes.axes] + [("set", path) for path in changes.fixed]
    for table, path in named:
        length = min(len(path), len(field))
        if field and path[:length] == field[:length]:
            return (table, ".".join(max(path, field, key=len))), written, message
    first = f"{'only ' if points == 1 else ''}with {where[0]}"
    if len(where) > 1:
        first = f"in {len(where)} of {points} cases, first {first}"
    if not field:
        return ("sweep",), "", f"{message} ({first})"
    return field, written, f"{message} (a field of the base scene, as this study changes it; {first})"
