"""The charts of a run whose flanks are resolved over the face."""

from collections.abc import Callable

from .bent_shafts import bent_shafts
from .chart import Chart
from .contact_pattern import contact_patterns
from .line_load import line_loads
from .run import ShownRun


def charts_over_face(run: ShownRun) -> dict[str, Callable[[ShownRun], list[Chart]]]:
    """What draws them, by subject."""
    charts: dict[str, Callable[[ShownRun], list[Chart]]] = {
        "Contact pattern": contact_patterns,
        "Line load along the face": line_loads,
    }
    if "bearing" in run.dataset.dims:
        charts["Shafts under load"] = bent_shafts
    return charts
