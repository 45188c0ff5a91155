"""The pictures of a study."""

from dataclasses import replace
from pathlib import Path

from fenics_gears.studies.combine import load_combined

from .cases import Cases
from .drawing import picture
from .plots import heading, save_figures
from .study_charts import result_charts


def draw_study(file: Path) -> list[Path]:
    """Draw the numbers of a study's cases over its parameters, as PNG in the folder of its file, and return the
    files."""
    cases = Cases(load_combined(file), file)
    title = str(cases.dataset.attrs.get("title", "")) or file.parent.name
    figures = {
        f"{name}.png": picture(heading("Study", title, chart.caption, chart.note), [replace(chart, caption="")])
        for name, chart in result_charts(cases).items()
    }
    return save_figures(figures, file.parent)
