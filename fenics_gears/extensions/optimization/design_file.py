"""Reads a design file into a `Design` and refuses, before anything is computed, what no design of it could have."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from fenics_gears import Scene, SceneError, flank_tolerance, gear_pair, helix_tolerance
from fenics_gears.scene_text import (
    GEARS,
    NoScene,
    SceneChanges,
    entries,
    fields,
    is_train,
    left_out,
    model_of_tree,
    name_of,
    parsed,
    text_of,
)

from .conditions import FROM_ZERO, samples, scattered, value_of, within
from .design import Design, Scatter
from .goals import lacking
from .sections import Sections


def load_design(path: str | Path) -> Design:
    """Read a design file and its scene. Raises SceneError, naming every mistake at once."""
    path = Path(path)
    text = text_of(path, "design")
    tree = parsed(text, str(path))
    if "variables" not in tree and ("gears" in tree or "sweep" in tree or is_train(tree)):
        kind, command = ("a study", "study") if "sweep" in tree else ("a scene", "run")
        raise SceneError(
            f"{path}: is {kind}, not a design file; `gears {command} {path}` runs it. Nothing was computed or written."
        )
    sections = Sections(path, text, tree)
    sections.check_keys()
    base, directory = sections.scene()
    parts = ("variables", "loads", "goals", "orders", "bounds", "search", "tolerances")
    parts_read: dict[str, Any] = {part: getattr(sections, part)() for part in parts}
    without = left_out(tree, sections.mistakes)
    fixed = dict(entries(tree, "set", sections.mistakes))
    sections.mistakes.check()
    varied = {_section(variable.path) for variable in parts_read["variables"]}
    before = {place: value for place, value in fixed.items() if _section(place) not in varied}
    scene_tree, before_tree = (
        SceneChanges(without, changes, (), "product").apply(base, ()) for changes in (fixed, before)
    )
    name = name_of(path)
    design = Design(name, tree.get("title", name), scene_tree, before_tree, directory, text, **parts_read)
    scene = _checked_ranges(design, sections)
    design = _with_class(design, scene, sections)
    _check_scatter(design, sections)
    return design


def _section(path: fields.Path) -> fields.Path:
    """The section of the scene, or of a stage, that a path is in."""
    return path[: len(path) - len(within(path)) + 1]


def _checked_ranges(design: Design, sections: Sections) -> Any:
    """The scene in the middle of all ranges. Raises SceneError where it is none, where ends of a range, operating
    points or what is before make none, or where it has no such results as are wanted."""
    middle = _middle(design)
    mistakes = sections.mistakes
    _try(design, sections, design.before, ("scene",), "the scene before any change")
    where = "with all variables in the middle of their ranges"
    scene = _try(design, sections, design.scene_tree(middle), ("variables",), where)
    mistakes.check()
    for variable in design.variables:
        for end in variable.words or (variable.low, variable.high):
            where = f"at {variable.written(end)}, the other variables in the middle of their ranges"
            tree = design.scene_tree(middle | {variable.name: end})
            _try(design, sections, tree, ("variables", variable.name), where)
    for point in design.loads.points:
        tree = design.scene_tree(middle)
        for path, value in point.items():
            tree = fields.changed(tree, path, value)
            if path[0] == "motion" and "inertia" not in tree:
                message = "has no effect on a scene without [inertia]. Leave it out."
                sections.wrong("loads", path, value, message)
            if path in [each.path for each in design.variables]:
                message = "is a field of the operating points too. Leave one out."
                sections.wrong("variables", path, "", message)
        where = ", ".join(f"{path[-1]} = {value}" for path, value in point.items())
        _try(design, sections, tree, ("loads",), f"at {where}")
    for table, goals in (("goals", design.goals), ("constraints", [bound.goal for bound in design.bounds])):
        for goal in goals:
            if needs := lacking(goal.name, scene):
                sections.wrong(table, goal.name, "", f"is no result of this scene. It needs {needs}.")
    mistakes.check()
    return scene


def _middle(design: Design) -> dict[str, Any]:
    return {each.name: each.words[0] if each.words else 0.5 * (each.low + each.high) for each in design.variables}


def _try(design: Design, sections: Sections, tree: Mapping[str, Any], place: tuple[str, ...], where: str) -> Any:
    """The scene of a tree; None, with its mistakes noted at a place of the design file, where it is none."""
    try:
        return model_of_tree(design.name, tree, design.directory).scene
    except NoScene as error:
        problems = error.problems
    for problem in problems:
        name = ".".join(problem.path)
        said = f"{name} {problem.message}" if name not in ("", place[-1]) else problem.message
        sections.mistakes.add(place, problem.written or "", f"{said} ({where})")
    return None


def _with_class(design: Design, scene: Any, sections: Sections) -> Design:
    """The design with the scatter that a flank tolerance class allows."""
    tolerance_class = design.tolerances.tolerance_class
    if tolerance_class is None:
        return design
    if not isinstance(scene, Scene):
        example = 'stages.first.profile_modifications.pinion.slope = "5 um"'
        message = f"is of a pair. Allowed in a train: fields of its stages, such as {example}."
        sections.wrong("tolerances", "tolerance_class", tolerance_class, message)
        sections.mistakes.check()
    pair = gear_pair(scene.gears)
    scatters = list(design.tolerances.scatters)
    for name, width in zip(GEARS, pair.face_widths):
        gear = getattr(pair, name)
        diameter = 2.0 * gear.reference_radius
        named = {each.path for each in scatters}
        limits = flank_tolerance(diameter, gear.normal_module, tolerance_class)
        amounts = {
            ("profile_modifications", name, "slope"): limits.profile_slope,
            ("profile_modifications", name, "crowning"): limits.profile_form,
        }
        if scene.three_dimensional:
            helix = helix_tolerance(diameter, width, tolerance_class)
            amounts["lead_modifications", name, "helix_slope"] = helix.slope
        for path, amount in amounts.items():
            if path not in named:
                scatters.append(Scatter(path, 1e3 * amount, "um", *fields.allowed_at(path)[1:]))
    return replace(design, tolerances=replace(design.tolerances, scatters=tuple(scatters)))


def _check_scatter(design: Design, sections: Sections) -> None:
    """Raise SceneError where something scatters that the scene does not have, or to where there is no scene."""
    tree = design.scene_tree(_middle(design))
    scatters = design.tolerances.scatters
    for scatter in scatters:
        if within(scatter.path)[0] not in FROM_ZERO and value_of(tree, scatter.path) is None:
            remedy = f'Give it a value below [set], such as "0 {scatter.unit}".'
            message = f"is not in the scene, so that it cannot scatter. {remedy}"
            sections.wrong("tolerances", scatter.name, "", message)
    sections.mistakes.check()
    for sample in samples(design)[:2] if scatters else ():
        _try(design, sections, scattered(tree, scatters, sample), ("tolerances",), "at a sample of the tolerances")
    sections.mistakes.check()
