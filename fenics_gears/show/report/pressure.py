"""Contact pressure: its peak over time and the map of flank and time."""

from __future__ import annotations

import io

import numpy as np
import xarray as xr

from fenics_gears.results.pairs import contact_times
from fenics_gears.show.panels import PALETTE
from fenics_gears.show.plots import save_figure
from fenics_gears.show.pressure_map import contact_pressure
from fenics_gears.show.report.forces import least
from fenics_gears.show.report.page import Block, Picture, Section, Words
from fenics_gears.show.report.plotting import over_time
from fenics_gears.show.report.run import TOO_FEW, Run
from fenics_gears.show.units import in_unit

# More mesh cycles than this side by side are too narrow to be read, and slow to draw.
MAPPED_CYCLES = 6.0
SIDES = {"contact_pressure": "drive flanks", "coast_contact_pressure": "coast flanks"}


def pressure(run: Run) -> Section:
    """Largest pressure at every step, and the map of the last mesh cycles."""
    heading = "Contact pressure"
    if "contact_pressure" not in run.dataset:
        return Section(
            "pressure",
            heading,
            [
                Words(
                    "There is none: the run has stored no contact fields (`[output] contact_fields`)."
                    if run.scene is not None and run.scene.resolves_contact
                    else "There is none: this run's flanks are rigid or its mesh is one of springs, so that contact is not spread over the "
                    "flank."
                )
            ],
        )
    if not run.has_curves:
        return Section("pressure", heading, [Words(TOO_FEW, warns=True)])
    dataset = contact_times(run.dataset)
    curves = [
        (words, in_unit(dataset[name].max(["slot", "contact_node"], keep_attrs=True), "MPa"), colour)
        for (name, words), colour in zip(SIDES.items(), PALETTE)
        if name in dataset
    ]
    together = np.concatenate([each for _, each, _ in curves])
    peaks = over_time(dataset, "Largest pressure of a contact node", "Pressure (MPa)", curves, least=least(together))
    return Section("pressure", heading, [peaks, *_map(dataset)])


def _map(dataset: xr.Dataset) -> list[Block]:
    phase, note = dataset["contact_mesh_phase"].values, ""
    mapped, cycles = dataset, float(phase[-1] - phase[0])
    if cycles > MAPPED_CYCLES * (1 + 1e-9):
        mapped = dataset.isel(contact_time=phase >= phase[-1] - MAPPED_CYCLES - 1e-9)
        note = f"The last {MAPPED_CYCLES:g} of {cycles:g} stored mesh cycles."
    figure = contact_pressure(mapped)
    if figure is None:
        return []
    content = io.BytesIO()
    save_figure(figure, content)
    return [Picture("Pressure over flank and time", content.getvalue(), note)]
