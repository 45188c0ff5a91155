"""An optimisation: what may vary, at which operating points, within which tolerances, for which goals."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from fenics_gears.scene_text import AllowedNumber, Section, choice, declared, fields, whole_number

from .goals import WEIGHTED, weighted_orders

MEAN = "mean"
WORST = "worst"
QUANTILE = "quantile"
Tree = Mapping[str, Any]
_QUANTILE = AllowedNumber(
    description="a number from 0.5 to below 1, such as 0.9",
    otherwise="0.9",
    lowest=0.5,
    highest=1.0,
    below_highest=True,
)


@dataclass(frozen=True)
class Variable:
    """A field that the search varies: between `low` and `high` in `unit`, or among `words`."""

    path: fields.Path
    low: float = 0.0
    high: float = 0.0
    unit: str = ""
    words: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The path as it is written."""
        return ".".join(self.path)

    def written(self, value: float | str) -> Any:
        """A value as a scene has it, of five digits: more are on no drawing."""
        if self.words:
            return value
        number = float(f"{value:.5g}")
        return f"{number:.5g} {self.unit}" if self.unit else number

    def at(self, place: float | str) -> float | str:
        """The value, as it is written, at a place of its range, 0 to 1; a word as it is."""
        return place if self.words else float(f"{self.low + float(place) * (self.high - self.low):.5g}")


@dataclass(frozen=True)
class Scatter:
    """A field that scatters evenly within `limit` on either side of its value, in `unit`; never beyond what the field
    allows, `lowest` to `highest`."""

    path: fields.Path
    limit: float
    unit: str
    lowest: float
    highest: float

    @property
    def name(self) -> str:
        """The path as it is written."""
        return ".".join(self.path)


@dataclass(frozen=True)
class Goal:
    """A number of the result to be made small; `weight`: of its ratio to what it is before, in the choice of one
    design."""

    name: str
    unit: str
    words: str
    weight: float = 1.0


@dataclass(frozen=True)
class Bound:
    """A number of the result that must keep its bounds, in the result's unit, at every operating point."""

    goal: Goal
    at_least: float = -np.inf
    at_most: float = np.inf

    def violation(self, value: float) -> float:
        """How far a value is beyond the bounds, in parts of the bound; 0 within."""
        beyond, bound = max(
            (self.at_least - value, self.at_least), (value - self.at_most, self.at_most), key=lambda each: each[0]
        )
        return max(beyond, 0.0) / (abs(bound) or 1.0)


@dataclass(frozen=True)
class Loads(Section):
    """Operating points: the values of scene fields at each, their weights, and whether goals are their mean or the
    worst."""

    points: tuple[dict[fields.Path, Any], ...] = ({},)
    weights: tuple[float, ...] = (1.0,)
    combine: str = choice(MEAN, WORST, meaning="what goals are of all operating points", default=MEAN)

    def combined(self, values: np.ndarray) -> np.ndarray:
        """One value (...) of the values at all points (points, ...)."""
        return np.max(values, axis=0) if self.combine == WORST else np.average(values, axis=0, weights=self.weights)


@dataclass(frozen=True)
class Tolerances(Section):
    """What scatters, also by a class; how many samples are taken, and what designs are judged by."""

    scatters: tuple[Scatter, ...] = ()
    samples: int = whole_number(1, 4096, 32, meaning="number of samples, a power of two", default=32)
    quantile: float = declared(_QUANTILE, 0.9)
    judged: str = choice(MEAN, QUANTILE, meaning="what designs are judged by", default=MEAN)
    tolerance_class: int | None = whole_number(1, 11, 6, meaning="flank tolerance class", otherwise="none")

    def statistic(self, values: np.ndarray) -> float:
        """What designs are judged by, of the values (samples,)."""
        return float(np.quantile(values, self.quantile) if self.judged == QUANTILE else np.mean(values))


@dataclass(frozen=True)
class Search(Section):
    """How long is searched."""

    evaluations: int = whole_number(1, 100_000, 200, meaning="designs that are tried", default=200)
    population: int = whole_number(4, 1000, 8, meaning="designs that are chosen at once", default=8)
    seed: int = whole_number(0, 2**31 - 1, 1, meaning="seed of all random numbers", default=1)


@dataclass(frozen=True)
class Design:
    """A validated optimisation.

    `tree`: the parsed scene that designs are changes of. `before`: the one they are compared with. `directory`: from
    which files are found that the scene names. `text`: of the design file. `orders`: weights of harmonics, by mesh.
    """

    name: str
    title: str
    tree: Tree
    before: Tree
    directory: Path
    text: str
    variables: tuple[Variable, ...]
    loads: Loads
    goals: tuple[Goal, ...]
    tolerances: Tolerances
    bounds: tuple[Bound, ...]
    search: Search
    orders: Mapping[str, tuple[float, ...]]

    @cached_property
    def asked(self) -> tuple[str, ...]:
        """The numbers of a run that goals and constraints name."""
        return tuple(dict.fromkeys(goal.name for goal in (*self.goals, *(bound.goal for bound in self.bounds))))

    def number(self, name: str, numbers: Mapping[str, float]) -> float | None:
        """A number of a run that a goal or a constraint names; None where the run has none."""
        return weighted_orders(self.orders, numbers) if name == WEIGHTED else numbers.get(name)

    def scene_tree(self, values: Mapping[str, float | str]) -> dict[str, Any]:
        """The parsed scene with these values of the variables, by their names."""
        tree = dict(self.tree)
        for variable in self.variables:
            tree = fields.changed(tree, variable.path, variable.written(values[variable.name]))
        return tree
