"""Contact patterns on the pinion side by side, and the line load of a tooth pair below."""

from __future__ import annotations

import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from fenics_gears.show.contact_pattern import contact_patterns
from fenics_gears.show.panels import PALETTE, styled
from fenics_gears.show.run import ShownRun


@styled
def picture(results: dict) -> Figure:
    """One column for each result: the largest pressure at each point of the pinion's flank, and below it the largest
    line load of a pair over the face."""
    figure = Figure(figsize=(13.0, 7.0), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.1)
    axes = figure.subplots(2, len(results), sharex=True, sharey="row", squeeze=False, height_ratios=[2.0, 1.3])
    figure.suptitle(
        "A helical gear stage of a car: contact pattern on the pinion, and line load of a tooth pair",
        x=0.012,
        ha="left",
        fontsize=14,
    )
    fields = {name: contact_patterns(ShownRun(result))[0].field for name, result in results.items()}
    limit = max(1.1 * result.attrs["peak_contact_pressure"] for result in results.values())
    for column, (name, result) in enumerate(results.items()):
        above, below = axes[:, column]
        field = fields[name]
        drawn = above.pcolormesh(
            field.x,
            field.y,
            np.ma.masked_invalid(field.values),
            cmap=LinearSegmentedColormap.from_list("pressure", list(field.colours)),
            vmin=0.0,
            vmax=limit,
        )
        above.set_title(name)
        above.grid(False)
        load = result.line_load.values
        below.plot(result.face_position, load.max(axis=(0, 1)), color=PALETTE[0], label="largest of one pair")
        below.plot(result.face_position, load.sum(axis=1).mean(axis=0), color=PALETTE[1], label="mean of all together")
        below.set_xlabel("Place on the face (mm)")
    # Of all columns: they share the scale.
    axes[1, 0].autoscale(axis="y")
    axes[1, 0].set_ylim(bottom=0.0)
    axes[0, 0].set_ylabel("Diameter on the pinion (mm)")
    axes[1, 0].set_ylabel("Line load (N/mm)")
    axes[1, 0].legend(loc="lower left")
    figure.colorbar(drawn, ax=axes[0, :], label="Contact pressure (MPa)", extend="max")
    return figure
