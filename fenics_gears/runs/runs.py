"""Runs that are asked for by their scenes: what a store has is taken from there, the others are computed by a team of
processes."""

from __future__ import annotations

import contextlib
import functools
import logging
import time
from collections.abc import Callable, Collection, Iterable, Sequence
from typing import Any, Protocol

from fenics_gears.errors import GearsError
from fenics_gears.model.model import Model
from fenics_gears.model.train import TrainModel
from fenics_gears.results.dataset import RunResult
from fenics_gears.simulation.together import alike, can_be_solved_together, sets_solved_together, solved_together
from fenics_gears.simulation.warm_up import compile_kernels
from fenics_gears.system.progress import Progress

from .condensing import condense, gear_tasks
from .gear_store import operators_key, own_gear_store
from .one_run import Tick, Ticking, completed
from .run import Run
from .simulate import settled
from .spent import Spent
from .team import Alone, Together
from .train import RunOfTrain, train_completed

LOGGER = logging.getLogger(__name__)
# Runs that are computed together at most, and tasks that each process gets at least.
MOST_TOGETHER = 32
TASKS = 2
Finished = Callable[[Run, Any], None]


class Failure(str):
    """Why a run has no result, in words."""


class Store(Protocol):
    """Where runs are kept; another process gets a copy of it. What it returns of a run is what is known of it."""

    def known(self, runs: Iterable[Run]) -> dict[str, Any]:
        """What is kept of runs, by their keys."""

    def keep(self, run: Run, result: RunResult | RunOfTrain) -> Any:
        """Keep the result of a run."""

    @property
    def asked(self) -> Collection[str] | None:
        """The numbers of a run that are kept, where nothing else of it is."""

    def seconds(self, known: Any) -> Iterable[float]:
        """As of `spent.seconds_of`, by what is known of a run that was computed."""

    def keep_failure(self, run: Run, error: Exception) -> Failure:
        """Keep why a run failed; raises the error where it is none of the run."""


class Runs:
    """The runs of a store and a team.

    `known`: by key what the store has of a run, a Failure where it has none; `kept`: how many were there before;
    `spent`: on those that were computed here.
    """

    def __init__(self, store: Store, team: Alone | Together, runs: Iterable[Run] = ()):
        self._store = store
        self._team = team
        self.known = store.known(runs)
        self.kept = len(self.known)
        self.spent = Spent(team.size)

    def missing(self, runs: Iterable[Run]) -> list[Run]:
        """Those that are not known, each once, in the order in which they share most."""
        return in_order_of_sharing({run.key: run for run in runs if run.key not in self.known}.values())

    def condense(self, runs: Iterable[Run], progress: Progress) -> None:
        """Condense every gear of the runs once, a process a gear; one that fails fails again, with its reason, in the
        runs."""
        runs = list(runs)
        if runs:
            compile_kernels(tangential=True, progress=progress)
        tasks = gear_tasks(runs)
        done = 0
        if not tasks:
            return
        progress.stage("condense gears")

        def finished(index: int, error: Exception | None) -> None:
            nonlocal done
            done += 1
            if error is not None:
                LOGGER.debug("condensing the %s: %s", tasks[index].name, error)

        self._team.run(condense, tasks, finished, lambda: progress.update(done, len(tasks)))
        progress.update(done, len(tasks))

    def compute(self, missing: list[Run], tick: Tick, finished: Finished = lambda run, outcome: None) -> None:
        """Compute runs in this order; each is `known` when `finished` is called. `tick` is called often and may raise
        KeyboardInterrupt."""

        together = 1 if self._store.asked is None else most_together(len(missing), self._team.size)
        tasks = in_tasks(missing, together)

        def take(index: int, outcome: Any) -> None:
            # An exception is one that the worker could not even report, such as an MPI error.
            every = [failure_of(outcome)] * len(tasks[index]) if isinstance(outcome, Exception) else outcome
            for run, known in zip(tasks[index], every):
                self.known[run.key] = known
                self.spent.count(() if isinstance(known, Failure) else self._store.seconds(known))
                finished(run, known)

        begun = time.perf_counter()
        try:
            self._team.run(functools.partial(computed, self._store), tasks, take, tick)
        finally:
            self.spent.seconds += time.perf_counter() - begun


def most_together(missing: int, processes: int) -> int:
    """How many of so many runs whose numbers alone are kept are in a task at most."""
    return min(MOST_TOGETHER, missing // (TASKS * processes) or 1)


def solved_at_once(models: Sequence[Model | TrainModel], asked: Collection[str]) -> bool:
    """Whether runs of these models are solved together where the numbers `asked` alone are kept."""
    pairs = [model for model in models if isinstance(model, Model)]
    same = len(pairs) == len(models) and len({operators_key(model) for model in pairs}) == 1
    return same and all(can_be_solved_together(model, asked) for model in pairs)


def in_order_of_sharing(runs: Iterable[Run]) -> list[Run]:
    """The runs in their order, but those that share contact operators next to each other, and of these those with the
    same gaps."""
    groups: dict[int, dict[int, list[Run]]] = {}
    for run in runs:
        operators, cycle = run.sharing
        groups.setdefault(operators, {}).setdefault(cycle, []).append(run)
    return [run for group in groups.values() for alike in group.values() for run in alike]


def in_tasks(runs: Iterable[Run], most: int) -> list[list[Run]]:
    """Runs in their order, at most so many in a task that share contact operators and follow each other."""
    tasks: list[list[Run]] = []
    for run in runs:
        if tasks and len(tasks[-1]) < most and tasks[-1][0].sharing[0] == run.sharing[0]:
            tasks[-1].append(run)
        else:
            tasks.append([run])
    return tasks


def computed(store: Store, runs: Sequence[Run], tick: Tick | None = None) -> list[Any]:
    """Compute runs and keep them, or why they failed; return what is known of each. Raises KeyboardInterrupt on
    Ctrl-C."""
    together = {} if store.asked is None else _together(runs, store.asked)
    ticking = Ticking(tick)
    return [_kept(store, run, together.get(run.key), ticking) for run in runs]


def _kept(store: Store, run: Run, result: Any, progress: Progress) -> Any:
    """Keep a run, computed here unless its result is there already."""
    try:
        return store.keep(run, result or _computed(run.model, progress))
    except Exception as error:
        if isinstance(error.__cause__, KeyboardInterrupt):  # compiled code that a second Ctrl-C hit in the middle
            raise KeyboardInterrupt from error
        return store.keep_failure(run, error)


def _computed(model: Model | TrainModel, progress: Progress) -> RunResult | RunOfTrain:
    """The result of a run, whose `wall_time` has the choice of its settings too."""
    if not isinstance(model, Model):
        return train_completed(model, own_gear_store(), progress)
    chosen = settled(model, progress)
    result = completed(chosen.scene, own_gear_store().prepared, progress, chosen.describe)
    result.attrs["wall_time"] += result.attrs.get("time_choose", 0.0)
    return result


def _together(runs: Sequence[Run], asked: Collection[str]) -> dict[str, Any]:
    """The numbers of those runs that can be solved together, by their keys."""
    groups: list[list[tuple[str, Any]]] = []
    for run in runs:
        model = run.model
        group = next((each for each in groups if alike(each[0][1], model)), None)
        if group is not None:
            group.append((run.key, model))
        elif can_be_solved_together(model, asked):
            groups.append([(run.key, model)])
    by_key: dict[str, Any] = {}
    for group in groups:
        # What fails together fails by itself, or does not.
        with contextlib.suppress(GearsError):
            models = [model for _, model in group]
            store = own_gear_store()
            pairs = isinstance(models[0], Model)
            results = (
                solved_together(models, store.prepared, asked) if pairs else sets_solved_together(models, store.row)
            )
            by_key |= {key: result for (key, _), result in zip(group, results)}
    return by_key


def failure_of(error: Exception) -> Failure:
    """Why a run failed, in words."""
    return Failure(error if isinstance(error, GearsError) else f"{type(error).__name__}: {error}")
