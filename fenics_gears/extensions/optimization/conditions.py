"""The scenes of a design: one for each operating point and each sample of what scatters."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fenics_gears.scene_text import GEARS, STAGES, factor_of, fields, number_in, value_at

from .design import Design, Scatter

FRESH = 4
FROM_ZERO = ("profile_modifications", "lead_modifications")


def samples(design: Design, fresh: bool = False) -> np.ndarray:
    """Deviations (samples, scatters) in parts of their limits, -1 to 1, by Sobol's scrambled sequence: the same for all
    designs, so that these can be compared. Without tolerances one sample of none. `fresh`: others, `FRESH` times as
    many."""
    count = len(design.tolerances.scatters)
    if not count:
        return np.zeros((1, 0))
    from scipy.stats import qmc

    sequence = qmc.Sobol(count, scramble=True, seed=design.search.seed + fresh)
    number = design.tolerances.samples * (FRESH if fresh else 1)
    return 2.0 * sequence.random_base2(number.bit_length() - 1) - 1.0


def value_of(tree: Mapping[str, Any], path: fields.Path) -> Any:
    """What a parsed scene has at a path; of one gear, where it has nothing of its own, what both gears have."""
    own = value_at(tree, *path)
    inner = within(path)
    if own is not None or len(inner) < 2 or inner[1] not in GEARS:
        return own
    return value_at(tree, *path[: len(path) - len(inner)], inner[0], *inner[2:])


def within(path: fields.Path) -> fields.Path:
    """A path in the scene of a pair, or within the stage of a train."""
    return path[2:] if path[0] == STAGES else path


def scattered(tree: Mapping[str, Any], scatters: Sequence[Scatter], deviations: np.ndarray) -> dict[str, Any]:
    """A parsed scene with deviations (scatters,), in parts of the limits; a modification that is not there deviates
    from zero, another field that is not there does not deviate."""
    changed = dict(tree)
    for scatter, deviation in zip(scatters, deviations):
        written = value_of(tree, scatter.path)
        if written is None and within(scatter.path)[0] not in FROM_ZERO:
            continue
        factor = factor_of(scatter.unit)
        nominal = 0.0 if written is None else number_in(written, scatter.unit)
        number = float(min(max(nominal + deviation * scatter.limit, scatter.lowest / factor), scatter.highest / factor))
        changed = fields.changed(changed, scatter.path, f"{number:.10g} {scatter.unit}" if scatter.unit else number)
    return changed


def trees_of(design: Design, tree: Mapping[str, Any], deviations: np.ndarray) -> list[dict[str, Any]]:
    """Parsed scenes of a design's tree: for each operating point all samples (samples, scatters)."""
    trees = []
    for point in design.loads.points:
        loaded = dict(tree)
        for path, value in point.items():
            loaded = fields.changed(loaded, path, value)
        trees += [scattered(loaded, design.tolerances.scatters, each) for each in deviations]
    return trees
