"""The search for the best designs, by samplers of Optuna. For one goal over ranges it is CMA-ES (covariance matrix
adaptation), else TPE (tree-structured Parzen estimators), which takes words and several goals too.

Designs are asked for and told in whole populations and in order. So the same seed tries the same designs whatever the
number of processes. A search that was stopped goes on when it is run again: its runs are on disk.
"""

import warnings
from collections.abc import Callable, Sequence

from fenics_gears import ComputationError

from .design import Design
from .evaluations import Evaluation

Values = dict[str, float | str]


def optimiser():
    """The module of Optuna, silent. Raises ComputationError where it, or the CMA-ES that it uses, cannot be loaded."""
    try:
        import cmaes  # noqa: F401
        import optuna
    except ImportError as error:
        missing = f"`gears optimize` needs Optuna and cmaes, which cannot be loaded ({error})"
        raise ComputationError(f"{missing}. Install them: pip install 'fenics_gears[optimize]'.") from error
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    return optuna


def search(
    design: Design, evaluate: Callable[[Sequence[Values]], list[Evaluation]], report: Callable[[int], None]
) -> list[Evaluation]:
    """All designs that were tried, in their order; ``report`` is told their number before each population. Raises
    ComputationError without Optuna."""
    optuna = optimiser()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that multivariate TPE is new
        study = optuna.create_study(directions=["minimize"] * len(design.goals), sampler=_sampler(optuna, design))
    tried: list[Evaluation] = []
    while len(tried) < design.search.evaluations:
        report(len(tried))
        count = min(design.search.population, design.search.evaluations - len(tried))
        trials = [study.ask(_distributions(optuna, design)) for _ in range(count)]
        values = [{each.name: each.at(trial.params[each.name]) for each in design.variables} for trial in trials]
        evaluations = evaluate(values)
        for trial, evaluation in zip(trials, evaluations):
            study.tell(trial, evaluation.told(design.goals))
        tried += evaluations
    return tried


def _distributions(optuna, design: Design) -> dict:
    """Words, and parts of ranges from 0 to 1: CMA-ES of Optuna 3 takes steps of the same size in all variables,
    whatever their units."""
    of = optuna.distributions
    return {
        each.name: of.CategoricalDistribution(each.words) if each.words else of.FloatDistribution(0.0, 1.0)
        for each in design.variables
    }


def _sampler(optuna, design: Design):
    seed = design.search.seed
    population = design.search.population
    samplers = optuna.samplers
    if len(design.goals) > 1 or len(design.variables) == 1 or any(each.words for each in design.variables):
        return samplers.TPESampler(seed=seed, multivariate=True, n_startup_trials=2 * population)
    begin = {"x0": {each.name: 0.5 for each in design.variables}, "sigma0": 1.0 / 6.0}
    return samplers.CmaEsSampler(**begin, seed=seed, popsize=population, warn_independent_sampling=False)


def front(tried: Sequence[Evaluation], names: Sequence[str]) -> list[int]:
    """Places of the designs that keep the constraints and to which no other is better in one goal and as good in all
    others (the Pareto front)."""
    allowed = [place for place, each in enumerate(tried) if each.allowed]

    def better(one: int, other: int) -> bool:
        pairs = [(tried[one].goals[name], tried[other].goals[name]) for name in names]
        return all(a <= b for a, b in pairs) and any(a < b for a, b in pairs)

    places: dict[str, int] = {}
    for place in allowed:
        # Of equal designs the first.
        if not any(better(other, place) for other in allowed):
            places.setdefault(repr(tried[place].values), place)
    return [*places.values()]
