"""The sections of a design file, read one by one; mistakes are noted by their names."""

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from fenics_gears import HARMONIC_NAMES, units
from fenics_gears.scene_text import (
    AxisError,
    Mistakes,
    Section,
    as_written,
    did_you_mean,
    entries,
    factor_of,
    fields,
    is_train,
    limits_of,
    line_numbers,
    load_scene_or_train,
    names_in,
    number_in,
    parsed,
    read,
    value_at,
    values_of,
    what_is_allowed,
)

from .design import WORST, Bound, Goal, Loads, Scatter, Search, Tolerances, Variable
from .goals import MESH, NAMES, WEIGHTED, unit_and_words

KEYS = (
    "title", "scene", "without", "set", "variables", "loads", "goals", "orders", "tolerances", "constraints", "search",
)  # fmt: skip
# Harmonics of each mesh of a train that a run has.
MOST_ORDERS = 10
EXAMPLES = {"variables": 'tip_relief.depth = ["5 um", "60 um"]', "goals": "peak_to_peak_transmission_error = 1"}


class Sections:
    """A parsed design file and its mistakes so far; each method reads a section."""

    def __init__(self, path: Path, text: str, tree: Mapping[str, Any]):
        self.path = path
        self.tree = tree
        lines = {
            (name[0], ".".join(name[1:])) if len(name) > 1 else name: line for name, line in line_numbers(text).items()
        }
        self.mistakes = Mistakes(str(path), lines)

    def table(self, name: str) -> Mapping[str, Any]:
        return self.tree.get(name, {})

    def wrong(self, table: str, field: str | fields.Path, value: Any, message: str) -> None:
        """Note a mistake in a field of a section; `value`: "" to leave it out."""
        name = field if isinstance(field, str) else ".".join(field)
        self.mistakes.add((table, name), as_written(value) if value != "" else "", message)

    def check_keys(self) -> None:
        """Raise SceneError where the file has other sections than it may have, or lacks one that it must have."""
        for key, value in self.tree.items():
            if key not in KEYS:
                known = f"{did_you_mean(key, KEYS)} Known: {', '.join(KEYS)}."
                self.mistakes.add((key,), as_written(value), f"is not known in a design file.{known}")
            elif key not in ("title", "scene", "without") and not isinstance(value, Mapping):
                self.mistakes.add((key,), as_written(value), f"is not a section. Write a line [{key}].")
        if not isinstance(self.tree.get("title", ""), str):
            self.mistakes.add(("title",), as_written(self.tree["title"]), "is not a text.")
        if not isinstance(self.tree.get("scene"), str | Mapping):
            message = 'is missing. Allowed: the file of the scene, such as "lundvall2004.toml", or its sections below'
            self.mistakes.add(("scene",), None, f"{message} [scene].")
        for key, example in EXAMPLES.items():
            if not self.tree.get(key):
                message = f"is missing. Add the section [{key}] with at least one line, such as {example}."
                self.mistakes.add((key,), None, message)
        self.mistakes.check()

    def scene(self) -> tuple[Mapping[str, Any], Path]:
        """The parsed scene, and the folder from which it names files. A scene in a file is found right by itself."""
        named = self.tree["scene"]
        if isinstance(named, Mapping):
            return named, self.path.parent
        file = self.path.parent / named
        return parsed(load_scene_or_train(file).text, str(file)), file.parent

    def variables(self) -> tuple[Variable, ...]:
        """The fields that vary, with their ranges or words."""
        variables = []
        for path, written in entries(self.tree, "variables", self.mistakes):
            if mistake := _not_variable(path, written):
                self.wrong("variables", path, written, mistake)
            elif fields.is_numeric(path):
                variables += self._range(path, written)
            else:
                variables.append(Variable(path, words=tuple(written)))
        return tuple(variables)

    def _range(self, path: fields.Path, written: list) -> list[Variable]:
        numbers, unit = self._numbers("variables", path, written)
        if not numbers:
            return []
        allowed, lowest, highest = fields.allowed_at(path)
        ends = f"goes from {as_written(written[0])} to {as_written(written[-1])}."
        low = numbers[0]
        high = numbers[-1]
        if len(numbers) > 2 or not low < high:
            ends = ends if len(numbers) == 2 else f"has {len(numbers)} values."
            self.wrong("variables", path, written, f"{ends} Allowed: two ends, the lower one first.")
        elif not lowest <= low * factor_of(unit) * (1 + 1e-12) or not high * factor_of(unit) <= highest:
            self.wrong("variables", path, written, f"{ends} Allowed for this field: {allowed.description}.")
        else:
            return [Variable(path, low, high, unit)]
        return []

    def _numbers(self, table: str, path: fields.Path, written: list) -> tuple[list[float], str]:
        """Numbers of a field's values, in the unit of the first one, and that unit; none, with a mistake noted, where
        they are none of its kind."""
        allowed, *_ = fields.allowed_at(path)
        kinds = [*getattr(allowed, "ranges", {})] or [allowed.kind]
        shown = written if len(written) > 1 else written[0]
        unit = units.unit_of(written[0]) if isinstance(written[0], str) else ""
        try:
            quantities = [
                units.of_kind(each, *kinds)[1] if isinstance(each, str) and allowed.kind else None for each in written
            ]
        except units.QuantityError as error:
            self.wrong(table, path, shown, f"has an entry that {error} Allowed: {allowed.description}.")
            return [], ""
        numbers = [number_in(each, unit) for each in written]
        finite = all(each is not None and math.isfinite(each) for each in numbers)
        if len({*quantities}) > 1 or (quantities[0] is None) != (allowed.kind is None) or not finite:
            self.wrong(table, path, shown, f"is not of this field. Allowed: {allowed.description}.")
            return [], ""
        return numbers, unit

    def loads(self) -> Loads:
        """The operating points."""
        table = self.table("loads")
        swept = {}
        for path, written in entries(self.tree, "loads", self.mistakes, ("weights", *names_in(Loads))):
            try:
                swept[path] = values_of(path, written)
            except AxisError as error:
                self.wrong("loads", path, written, str(error))
        lengths = {len(values) for values in swept.values()} or {1}
        if len(lengths) > 1:
            listed = ", ".join(f"{'.'.join(path)} has {len(values)}" for path, values in swept.items())
            self.mistakes.add(("loads",), "", f"needs a value of each field for each operating point: {listed}.")
        if (second := fields.second_load(swept)) is not None:
            self.wrong("loads", second[0], "", second[1])
        weights = table.get("weights")
        points = tuple(dict(zip(swept, each)) for each in zip(*swept.values())) or ({},)
        loads = replace(self._own("loads", Loads), points=points, weights=(1.0,) * len(points))
        if weights is None:
            return loads
        if loads.combine == WORST:
            message = 'is given together with combine = "worst", where all operating points count alike. Leave one out.'
            self.wrong("loads", "weights", weights, message)
        numbers = isinstance(weights, list) and all(is_number(each) and each >= 0 for each in weights)
        if not (numbers and len(weights) in lengths and sum(weights) > 0):
            kind = f"is not a list of {max(lengths)} numbers of 0 and above"
            message = f"{kind}. Allowed: a weight for each operating point."
            self.wrong("loads", "weights", weights, message)
            return loads
        return replace(loads, weights=tuple(map(float, weights)))

    def goals(self) -> tuple[Goal, ...]:
        """The numbers that are to be small."""
        goals = []
        for name, weight in self.table("goals").items():
            if not (is_number(weight) and weight > 0):
                message = "is not a weight. Allowed: a number above 0; it counts where several goals are weighed up."
                self.wrong("goals", name, weight, message)
            elif self._is_result("goals", name, weight):
                goals.append(Goal(name, *self._unit_and_words(name), float(weight)))
        return tuple(goals)

    def _unit_and_words(self, name: str) -> tuple[str, str]:
        return unit_and_words(name, name == WEIGHTED and is_train(self.scene()[0]))

    def orders(self) -> dict[str, tuple[float, ...]]:
        """Weights of the first harmonics, by the stage whose meshes make them, or of a pair's mesh."""
        table = self.table("orders")
        asked = {name for each in ("goals", "constraints") for name in self.table(each)}
        if (WEIGHTED in asked) != bool(table):
            example = f"{MESH} = [1, 0.5]"
            said = f"belong to the goal {WEIGHTED}, which is not there." if table else f"is missing, which {WEIGHTED}"
            said += "" if table else f" needs: weights of harmonics, of a stage by its name, of a pair as {example}."
            self.mistakes.add(("orders",), "" if table else None, said)
        stages = value_at(self.scene()[0], "stages") or {} if table else {}
        known = [*stages] or [MESH]
        for name, weights in table.items():
            most = MOST_ORDERS if stages else len(HARMONIC_NAMES)
            numbers = isinstance(weights, list) and all(is_number(each) and each >= 0 for each in weights)
            if name not in known:
                self.wrong(
                    "orders", name, weights, f"is no mesh.{did_you_mean(name, known)} Known: {', '.join(known)}."
                )
            elif not numbers or not 0 < len(weights) <= most or not sum(weights) > 0:
                message = f"is no list of weights. Allowed: 1 to {most} numbers of 0 and above, of the first harmonics."
                self.wrong("orders", name, weights, message)
        return {name: tuple(weights) for name, weights in table.items() if isinstance(weights, list)}

    def _is_result(self, table: str, name: str, value: Any) -> bool:
        if name not in NAMES:
            known = f"{did_you_mean(name, NAMES)} Known: {', '.join(NAMES)}."
            self.wrong(table, name, value, f"is no number of a result that can be a goal.{known}")
        return name in NAMES

    def bounds(self) -> tuple[Bound, ...]:
        """The constraints, in the units of results."""
        bounds = []
        for name, written in self.table("constraints").items():
            if not self._is_result("constraints", name, written):
                continue
            unit, words = self._unit_and_words(name)
            limits = limits_of(written, unit)
            if limits is None:
                self.wrong("constraints", name, written, what_is_allowed(unit))
            else:
                bounds.append(Bound(Goal(name, unit, words), **{each.end: each.value for each in limits}))
        return tuple(bounds)

    def tolerances(self) -> Tolerances:
        """What scatters, but for the flank tolerance class."""
        table = self.table("tolerances")
        scatters = []
        own = self._own("tolerances", Tolerances)
        for path, written in entries(self.tree, "tolerances", self.mistakes, names_in(Tolerances)):
            if fields.is_section(path) or not fields.is_numeric(path):
                self.wrong("tolerances", path, written, "is no field of a number that could scatter.")
                continue
            numbers, unit = self._numbers("tolerances", path, [written])
            if numbers and not numbers[0] > 0.0:
                message = "is not above zero. Allowed: the limit of the scatter on either side."
                self.wrong("tolerances", path, written, message)
            elif numbers:
                scatters.append(Scatter(path, numbers[0], unit, *fields.allowed_at(path)[1:]))
        if table and not scatters and "tolerance_class" not in table:
            message = "has nothing that scatters. Add tolerance_class, or a field with its limit, such as"
            self.mistakes.add(("tolerances",), "", f'{message} tip_relief.depth = "4 um".')
        if own.samples & (own.samples - 1):
            message = "is no power of two, as Sobol's sequence needs. Allowed: 8, 16, 32, 64, ..."
            self.wrong("tolerances", "samples", own.samples, message)
        return replace(own, scatters=tuple(scatters), samples=own.samples if table else 1)

    def search(self) -> Search:
        """How long is searched, and from which seed."""
        known = names_in(Search)
        for key, value in self.table("search").items():
            if key not in known:
                hint = f"{did_you_mean(key, known)} Known: {', '.join(known)}."
                self.wrong("search", key, value, f"is not known.{hint}")
        return self._own("search", Search)

    def _own(self, table: str, section: type[Section]) -> Any:
        """A section's own fields, without paths; its defaults, with mistakes noted, where it is wrong."""
        own = {name: value for name, value in self.table(table).items() if name in names_in(section)}
        part, problems = read(section, own, (table,))
        for problem in problems:
            self.mistakes.add(problem.path, problem.written, problem.message)
        return part or section()


def _not_variable(path: fields.Path, written: Any) -> str:
    """Why a field does not vary as it is written; empty where it does, but for the ends of a range."""
    if fields.is_section(path):
        return "is a section. Allowed: one of its fields, with the two ends of its range."
    if not isinstance(written, list) or len(written) < 2:
        return 'is not a range. Allowed: its two ends, such as ["5 um", "60 um"], or for a choice its words.'
    words = all(isinstance(each, str) for each in written) and len({*written}) == len(written)
    if not (words or fields.is_numeric(path)):
        return "takes no numbers between two ends. Allowed: a list of different words to choose from."
    return ""


def is_number(value: Any) -> bool:
    """Whether a value is a finite number without unit."""
    number = None if isinstance(value, str) else number_in(value, "")
    return number is not None and math.isfinite(number)
