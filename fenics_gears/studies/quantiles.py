"""Quantiles over the samples of a study with random fields."""

from collections.abc import Mapping
from itertools import product

import numpy as np
import xarray as xr

from fenics_gears.results.layout import OVERALL, in_microradians
from fenics_gears.results.planetary import LARGEST_OF_SETS
from fenics_gears.runs.record import NUMBERS, OF_TRAINS, RunRecord

from .axis import SAMPLE, label
from .study import Study

QUANTILE = "quantile"
QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
OF = "quantiles_of_"
# Of them those that people read first.
SHOWN = (0.05, 0.5, 0.95)
PARTS = f"quantiles {' / '.join(f'{100 * part:.0f}' for part in SHOWN)} %"
# Of these the summary has a table.
TABLED = ("load_sharing_factor", f"peak_to_peak_{OVERALL}", "peak_to_peak_transmission_error")
MOST_ROWS = 20
NOT_COUNTED = ("failed", "meaningless", "wall_time", "newton_iterations")


def quantiles_of(dataset: xr.Dataset) -> dict[str, xr.DataArray]:
    """By the name of a variable the quantiles of each number over all samples that have it, linear between them; none
    where nothing is random."""
    found = {}
    for name, values in dataset.data_vars.items():
        if SAMPLE not in values.dims or values.dtype.kind != "f" or name in NOT_COUNTED or "mesh_phase" in values.dims:
            continue
        kept = [dimension for dimension in values.dims if dimension != SAMPLE]
        counted = np.apply_along_axis(sorted_quantiles, -1, values.transpose(*kept, SAMPLE).values)
        labels = {"units": values.attrs["units"], "long_name": f"quantiles over samples: {values.attrs['long_name']}"}
        found[f"{OF}{name}"] = xr.DataArray(counted, dims=(*kept, QUANTILE), attrs=labels, coords=_coordinate())
    return found


def _coordinate() -> dict[str, tuple]:
    return {QUANTILE: (QUANTILE, list(QUANTILES), {"units": "1", "long_name": "part of the samples that is below"})}


def sorted_quantiles(values: np.ndarray) -> np.ndarray:
    """QUANTILES of values (n,), those that are not numbers left out; not numbers where none is left.

    >>> sorted_quantiles(np.array([3.0, 1.0, np.nan, 2.0])).tolist()
    [1.1, 1.5, 2.0, 2.5, 2.9]
    """
    known = values[np.isfinite(values)]
    return np.quantile(known, QUANTILES) if len(known) else np.full(len(QUANTILES), np.nan)


def quantile_rows(study: Study, records: Mapping[int, RunRecord]) -> list[tuple[str, str, str]]:
    """Quantiles of K_gamma and transmission error for each setting of what is not random, in rows for people."""
    if SAMPLE not in study.dimensions:
        return []
    fixed = [axis for axis in study.axes if not axis.random]
    rows = []
    for name in TABLED:
        if not any(name in record.numbers for record in records.values()):
            continue
        units, words = (NUMBERS | OF_TRAINS | LARGEST_OF_SETS)[name]
        printed, unit = (
            (in_microradians, "urad") if units == "rad" else ("{:.4g}".format, "" if units == "1" else units)
        )
        for group, point in enumerate(product(*(axis.values for axis in fixed))):
            cases = range(group * study.samples, (group + 1) * study.samples)
            values = np.array([records[case].numbers.get(name, np.nan) for case in cases if case in records])
            found = dict(zip(QUANTILES, sorted_quantiles(values)))
            setting = ", ".join(f"{axis.name} {label(value)}" for axis, value in zip(fixed, point))
            said = " / ".join(printed(found[part]) for part in SHOWN)
            rows.append((", ".join(filter(None, (words, setting, PARTS))), said, unit))
    more = len(rows) - MOST_ROWS
    return [*rows[:MOST_ROWS], *([("further quantiles", f"{more}, in study.nc", "")] if more > 0 else [])]
