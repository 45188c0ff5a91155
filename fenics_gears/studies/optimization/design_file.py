"""Reads a design file into a `Design` and refuses, before anything is computed, what no design of it could have."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from fenics_gears.errors import SceneError
from fenics_gears.geometry.flank_tolerance import flank_tolerance, helix_tolerance
from fenics_gears.geometry.pair import gear_pair
from fenics_gears.inputs import units
from fenics_gears.inputs.names import did_you_mean
from fenics_gears.inputs.problem import line_numbers
from fenics_gears.inputs.tree import GEARS, value_at
from fenics_gears.inputs.written import as_written
from fenics_gears.scene.data import Scene
from fenics_gears.scene.read import load_scene, parsed, text_of
from fenics_gears.studies import fields
from fenics_gears.studies.axis import AxisError, factor_of, number_in, values_of
from fenics_gears.studies.optimization.conditions import samples, scattered, value_of
from fenics_gears.studies.optimization.design import MEAN, QUANTILE, WORST, Bound, Design, Goal, Loads, Scatter, Search, Tolerances, Variable
from fenics_gears.studies.optimization.goals import NAMES, lacking, unit_and_words
from fenics_gears.studies.study_file import Changes, Mistakes, entries, left_out, scene_of_tree

KEYS = ("title", "scene", "without", "set", "variables", "loads", "goals", "tolerances", "constraints", "search")
OWN_OF_LOADS, OWN_OF_TOLERANCES = ("weights", "combine"), ("samples", "quantile", "judged", "tolerance_class")
MOST = {"evaluations": 100_000, "population": 1000, "seed": 2**31 - 1, "samples": 4096, "tolerance_class": 11}


def load_design(path: str | Path) -> Design:
    """Read a design file and its scene. Raises SceneError, naming every mistake at once, before anything is computed."""
    path = Path(path)
    text = text_of(path, "design")
    tree = parsed(text, str(path))
    if "variables" not in tree and ("gears" in tree or "sweep" in tree):
        kind, command = ("a study", "study") if "sweep" in tree else ("a scene", "run")
        raise SceneError(f"{path}: is {kind}, not a design file; `gears {command} {path}` runs it. Nothing was computed or written.")
    reading = _Reading(path, text, tree)
    reading.check_keys()
    base, directory = reading.scene()
    variables, goals, search = reading.variables(), reading.goals(), reading.search()
    without, fixed = left_out(tree, reading.mistakes), dict(entries(tree, "set", reading.mistakes))
    loads, bounds = reading.loads(), reading.bounds()
    tolerances, tolerance_class = reading.tolerances()
    reading.mistakes.check()
    sections = {variable.path[0] for variable in variables}
    before = {place: value for place, value in fixed.items() if place[0] not in sections}
    trees = [Changes(without, changes, (), "product").apply(base, ()) for changes in (fixed, before)]
    title = tree.get("title", path.stem)
    design = Design(path.stem, title, *trees, directory, variables, loads, goals, tolerances, bounds, search, text)
    reading.check_ends(design)
    reading.mistakes.check()
    scene = reading.scene_of(design.scene_tree(_middle(design)))
    reading.check_numbers(design, scene)
    design = reading.with_class(design, scene, tolerance_class)
    reading.check_scatter(design)
    reading.mistakes.check()
    return design


def _middle(design: Design) -> dict[str, Any]:
    """The middle of every range, and the first of words."""
    return {each.name: each.words[0] if each.words else 0.5 * (each.low + each.high) for each in design.variables}


class _Reading:
    """A parsed design file and its mistakes so far; each method reads or checks a section."""

    def __init__(self, path: Path, text: str, tree: Mapping[str, Any]):
        self.path, self.tree = path, tree
        lines = {(name[0], ".".join(name[1:])) if len(name) > 1 else name: line for name, line in line_numbers(text).items()}
        self.mistakes = Mistakes(str(path), lines)

    def table(self, name: str) -> Mapping[str, Any]:
        """A section of the file; empty where there is none."""
        found = self.tree.get(name, {})
        return found if isinstance(found, Mapping) else {}

    def wrong(self, table: str, name: str, value: Any, message: str) -> None:
        """Note a mistake in a field of a section."""
        self.mistakes.add((table, name), None if value is None else as_written(value), message)

    def check_keys(self) -> None:
        """The file's own sections, and those that it must have."""
        for key, value in self.tree.items():
            if key not in KEYS:
                self.mistakes.add((key,), as_written(value), f"is not known in a design file.{did_you_mean(key, KEYS)} Known: {', '.join(KEYS)}.")
            elif key not in ("title", "scene", "without") and not isinstance(value, Mapping):
                self.mistakes.add((key,), as_written(value), f"is not a section. Write a line [{key}].")
        if not isinstance(self.tree.get("scene"), str | Mapping):
            message = 'is missing. Allowed: the file of the scene, such as "lundvall2004.toml", or its sections below [scene].'
            self.mistakes.add(("scene",), None, message)
        for key, example in (("variables", 'tip_relief.depth = ["5 um", "60 um"]'), ("goals", "peak_to_peak_transmission_error = 1")):
            if not self.tree.get(key):
                self.mistakes.add((key,), None, f"is missing. Add the section [{key}] with at least one line, such as {example}.")
        self.mistakes.check()

    def scene(self) -> tuple[Mapping[str, Any], Path]:
        """The parsed scene, and the folder from which it names files. A scene in a file is found right by itself."""
        named = self.tree["scene"]
        if isinstance(named, Mapping):
            return named, self.path.parent
        file = self.path.parent / named
        return parsed(load_scene(file).text, str(file)), file.parent

    def variables(self) -> tuple[Variable, ...]:
        """The fields that vary, with their ranges or words."""
        found = []
        for path, written in entries(self.tree, "variables", self.mistakes):
            name = ".".join(path)
            if fields.is_section(path):
                self.wrong("variables", name, written, "is a section. Allowed: one of its fields, with the two ends of its range.")
            elif not isinstance(written, list) or len(written) < 2:
                self.wrong("variables", name, written, 'is not a range. Allowed: its two ends, such as ["5 um", "60 um"], or for a choice its words.')
            elif not fields.is_numeric(path):
                found.append(self._choice(path, written))
            else:
                found.append(self._range(path, written))
        return tuple(each for each in found if each is not None)

    def _choice(self, path: fields.Path, written: list) -> Variable | None:
        if all(isinstance(each, str) for each in written) and len({*written}) == len(written):
            return Variable(path, words=tuple(written))
        return self.wrong("variables", ".".join(path), written, "takes no numbers between two ends. Allowed: a list of different words to choose from.")

    def _range(self, path: fields.Path, written: list) -> Variable | None:
        name = ".".join(path)
        numbers = self._numbers("variables", path, written)
        if numbers is None:
            return None
        (low, high, *more), unit = numbers
        allowed, lowest, highest = fields.allowed_at(path)
        # A depth of exactly nothing is no relief; the least depth is as good.
        low = lowest / factor_of(unit) if low == 0.0 < lowest else low
        if more or not low < high:
            return self.wrong("variables", name, written, f"goes from {as_written(written[0])} to {as_written(written[-1])}. Allowed: two ends, the lower one first.")
        if not lowest <= low * factor_of(unit) or not high * factor_of(unit) <= highest:
            return self.wrong("variables", name, written, f"goes from {as_written(written[0])} to {as_written(written[1])}. Allowed for this field: {allowed.description}.")
        return Variable(path, low, high, unit)

    def _numbers(self, table: str, path: fields.Path, written: list) -> tuple[list[float], str] | None:
        """Numbers of values of a field, in the unit of the first one, and that unit; None, with a mistake noted, where they are none of its kind."""
        allowed, *_ = fields.allowed_at(path)
        kinds = [*getattr(allowed, "ranges", {})] or [allowed.kind]
        unit = units.unit_of(written[0]) if isinstance(written[0], str) else ""
        try:
            found = [units.of_kind(each, *kinds)[1] if isinstance(each, str) and allowed.kind else None for each in written]
            numbers = [number_in(each, unit) for each in written]
        except units.QuantityError as error:
            return self.wrong(table, ".".join(path), written if len(written) > 1 else written[0], f"has an entry that {error} Allowed: {allowed.description}.")
        if len({*found}) > 1 or (found[0] is None) != (allowed.kind is None) or not all(each is not None and math.isfinite(each) for each in numbers):
            return self.wrong(table, ".".join(path), written if len(written) > 1 else written[0], f"is not of this field. Allowed: {allowed.description}.")
        return numbers, unit

    def loads(self) -> Loads:
        """The operating points."""
        table, swept = self.table("loads"), {}
        for path, written in entries(self.tree, "loads", self.mistakes, OWN_OF_LOADS):
            try:
                swept[path] = values_of(path, written)
            except AxisError as error:
                self.wrong("loads", ".".join(path), written, str(error))
        lengths = {len(values) for values in swept.values()} or {1}
        if len(lengths) > 1:
            listed = ", ".join(f"{'.'.join(path)} has {len(values)}" for path, values in swept.items())
            self.mistakes.add(("loads",), "", f"needs a value of each field for each operating point: {listed}.")
        combine, weights = table.get("combine", MEAN), table.get("weights")
        if combine not in (MEAN, WORST):
            self.wrong("loads", "combine", combine, f'is not known. Allowed: "{MEAN}", "{WORST}".')
        if weights is not None and combine == WORST:
            self.wrong("loads", "weights", weights, 'stands beside combine = "worst", where all operating points count alike. Leave one out.')
        sound = isinstance(weights, list) and len(weights) in lengths and all(_is_number(each) and each >= 0 for each in weights) and sum(weights) > 0
        if weights is not None and not sound:
            self.wrong("loads", "weights", weights, f"is not a list of {max(lengths)} numbers of 0 and above. Allowed: a weight for each operating point.")
        points = tuple(dict(zip(swept, values)) for values in zip(*swept.values())) or ({},)
        return Loads(points, tuple(map(float, weights)) if sound else (1.0,) * len(points), combine)

    def goals(self) -> tuple[Goal, ...]:
        """The numbers that are to be small."""
        found = []
        for name, weight in self.table("goals").items():
            if not (_is_number(weight) and weight > 0):
                self.wrong("goals", name, weight, "is not a weight. Allowed: a number above 0; it counts where several goals are weighed up.")
            elif self._is_result("goals", name, weight):
                found.append(Goal(name, *unit_and_words(name), float(weight)))
        return tuple(found)

    def _is_result(self, table: str, name: str, value: Any) -> bool:
        if name not in NAMES:
            self.wrong(table, name, value, f"is no number of a result that can be a goal.{did_you_mean(name, NAMES)} Known: {', '.join(NAMES)}.")
        return name in NAMES

    def bounds(self) -> tuple[Bound, ...]:
        """The constraints, in the units of results."""
        found = []
        for name, table in self.table("constraints").items():
            if not self._is_result("constraints", name, table if not isinstance(table, Mapping) else ""):
                continue
            unit, words = unit_and_words(name)
            ends: dict[str, float] = {}
            for key, value in table.items() if isinstance(table, Mapping) else ():
                number = number_in(value, "" if unit == "1" else unit) if key in ("at_least", "at_most") else None
                right = number is not None and (_is_number(value) if unit == "1" else isinstance(value, str) and units.quantity(value)[1] == units.quantity(f"1 {unit}")[1])
                ends |= {key: number} if right else {}
            if not ends or len(ends) != len(table):
                example = "1.2" if unit == "1" else f'"20 {unit}"'
                self.wrong("constraints", name, "" if isinstance(table, Mapping) else table, f"is no bound. Allowed: {{ at_most = {example} }}, and at_least likewise.")
            found.append(Bound(Goal(name, unit, words), **ends))
        return tuple(found)

    def tolerances(self) -> tuple[Tolerances, int | None]:
        """What scatters, and the flank tolerance class."""
        table, found = self.table("tolerances"), []
        for path, written in entries(self.tree, "tolerances", self.mistakes, OWN_OF_TOLERANCES):
            if fields.is_section(path) or not fields.is_numeric(path):
                self.wrong("tolerances", ".".join(path), written, "is no field of a number that could scatter.")
                continue
            numbers = self._numbers("tolerances", path, [written])
            if numbers is not None and not numbers[0][0] > 0.0:
                self.wrong("tolerances", ".".join(path), written, "is not above zero. Allowed: the limit of the scatter on either side.")
            elif numbers is not None:
                _, lowest, highest = fields.allowed_at(path)
                found.append(Scatter(path, numbers[0][0], numbers[1], lowest, highest))
        tolerance_class = self._whole("tolerances", "tolerance_class", None)
        if table and not found and tolerance_class is None:
            self.mistakes.add(("tolerances",), "", 'has nothing that scatters. Add tolerance_class, or a field with its limit, such as tip_relief.depth = "4 um".')
        number, quantile, judged = self._whole("tolerances", "samples", 16), table.get("quantile", 0.9), table.get("judged", MEAN)
        if number & (number - 1):
            self.wrong("tolerances", "samples", number, "is no power of two, as Sobol's sequence needs. Allowed: 8, 16, 32, 64, ...")
        if not (_is_number(quantile) and 0.5 <= quantile < 1.0):
            self.wrong("tolerances", "quantile", quantile, "is not allowed. Allowed: a number from 0.5 to below 1, such as 0.9.")
        if judged not in (MEAN, QUANTILE):
            self.wrong("tolerances", "judged", judged, f'is not known. Allowed: "{MEAN}", "{QUANTILE}".')
        return Tolerances(tuple(found), number if table else 1, quantile, judged), tolerance_class

    def search(self) -> Search:
        """How long is searched, and from which seed."""
        for key, value in self.table("search").items():
            if key not in ("evaluations", "population", "seed"):
                self.wrong("search", key, value, "is not known. Known: evaluations, population, seed.")
        return Search(*(self._whole("search", name, default) for name, default in (("evaluations", 200), ("population", 8), ("seed", 1))))

    def _whole(self, table: str, name: str, default: int | None) -> int | None:
        value, lowest = self.table(table).get(name, default), 0 if name == "seed" else 1 if name != "population" else 4
        if value is not default and (type(value) is not int or not lowest <= value <= MOST[name]):
            self.wrong(table, name, value, f"is not allowed. Allowed: a whole number from {lowest} to {MOST[name]}.")
            return default
        return value

    def scene_of(self, tree: Mapping[str, Any], directory: Path | None = None) -> Scene:
        """The scene of a tree that is known to be right."""
        scene, _ = scene_of_tree(self.path.stem, tree, self.scene()[1])
        return scene

    def check_ends(self, design: Design) -> None:
        """The scene before, that in the middle of all ranges, those at both ends of each range, and all operating points make scenes."""
        middle = _middle(design)
        self._try(design, design.before, ("scene",), "the scene before any change")
        if not self._try(design, design.scene_tree(middle), ("variables",), "with all variables in the middle of their ranges"):
            return
        for variable in design.variables:
            for end in variable.words or (variable.low, variable.high):
                where = f"at {variable.written(end)}, the other variables in the middle of their ranges"
                self._try(design, design.scene_tree(middle | {variable.name: end}), ("variables", variable.name), where)
        for point in design.loads.points:
            tree = design.scene_tree(middle)
            for path, value in point.items():
                tree = fields.changed(tree, path, value)
                if path[0] == "motion" and "inertia" not in tree:
                    self.wrong("loads", ".".join(path), value, "has no effect on a scene without [inertia]. Leave it out.")
            self._try(design, tree, ("loads",), f"at {', '.join(f'{path[-1]} = {value}' for path, value in point.items())}")
        repeated = {*(each.path for each in design.variables)} & {*(path for point in design.loads.points for path in point)}
        for path in repeated:
            self.wrong("variables", ".".join(path), "", "is a field of the operating points too. Leave one out.")

    def _try(self, design: Design, tree: Mapping[str, Any], place: tuple[str, ...], where: str) -> bool:
        scene, problems = scene_of_tree(design.name, tree, design.directory)
        for problem in problems:
            said = f"{'.'.join(problem.path)} {problem.message}" if problem.path and ".".join(problem.path) != place[-1] else problem.message
            self.mistakes.add(place, problem.written or "", f"{said} ({where})")
        return scene is not None

    def check_numbers(self, design: Design, scene: Scene) -> None:
        """The scene has the results that goals and constraints name."""
        for table, goals in (("goals", design.goals), ("constraints", [bound.goal for bound in design.bounds])):
            for goal in goals:
                if needs := lacking(goal.name, scene):
                    self.wrong(table, goal.name, "", f"is no result of this scene. It needs {needs}.")

    def with_class(self, design: Design, scene: Scene, tolerance_class: int | None) -> Design:
        """The design with the scatter that a flank tolerance class allows slopes and forms of the profiles, and over a face slopes of the helix."""
        from dataclasses import replace

        if tolerance_class is None:
            return design
        pair, found = gear_pair(scene.gears), list(design.tolerances.scatters)
        for name, width in zip(GEARS, pair.face_widths):
            gear = getattr(pair, name)
            limits = flank_tolerance(2.0 * gear.reference_radius, gear.normal_module, tolerance_class)
            amounts = {("profile_modifications", name, "slope"): limits.profile_slope, ("profile_modifications", name, "crowning"): limits.profile_form}
            if scene.three_dimensional:
                amounts["lead_modifications", name, "helix_slope"] = helix_tolerance(2.0 * gear.reference_radius, width, tolerance_class).slope
            found += [Scatter(path, 1e3 * amount, "um", *fields.allowed_at(path)[1:]) for path, amount in amounts.items()]
        return replace(design, tolerances=replace(design.tolerances, scatters=tuple(found)))

    def check_scatter(self, design: Design) -> None:
        """What scatters is there, and makes scenes within its limits."""
        tree = design.scene_tree(_middle(design))
        for scatter in design.tolerances.scatters:
            if scatter.name in str(self.tree.get("tolerances")) and value_of(tree, scatter.path) is None:
                self.wrong("tolerances", scatter.name, "", f"is not in the scene, so that it cannot scatter. Give it a value below [set], such as \"0 {scatter.unit}\".")
        self.mistakes.check()
        for sample in samples(design)[:2] if design.tolerances.scatters else ():
            self._try(design, scattered(tree, design.tolerances.scatters, sample), ("tolerances",), "at a sample of the tolerances")


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
