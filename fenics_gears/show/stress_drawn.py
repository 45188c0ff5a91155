"""The stress picture of a report, its words and its charts."""

import io

from fenics_gears.simulation.mesh_stresses import stresses_of_mesh
from fenics_gears.simulation.run_stresses import RunStresses

from .chart import Chart
from .run import ShownRun
from .stress_picture import charts_of, save_picture, still


def drawn(run: ShownRun, index: int) -> tuple[bytes, str, list[Chart]]:
    """PNG of both gears in mesh at a stored time, what it shows in words, and the charts that go with it."""
    found = RunStresses(run.dataset, run.scene) if run.of_train is None else stresses_of_mesh(*run.of_train)
    with found as stresses:
        mesh = stresses.at(index)
    content = io.BytesIO()
    save_picture(still(mesh, run.dataset), content)
    return content.getvalue(), *charts_of(mesh)
