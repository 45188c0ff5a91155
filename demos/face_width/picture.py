"""Peak-to-peak transmission error over the overlap ratio, beside what published formulas expect of stiff gear
bodies."""

from __future__ import annotations

import numpy as np
from demos.face_width.stiffness_function import contact_lines, mesh_stiffness
from matplotlib.figure import Figure

from fenics_gears.show.panels import GREY, PALETTE, styled

PHASES = np.linspace(0.0, 1.0, 401)


def expected(formula, contact_ratio: float, overlap_ratio: float) -> float:
    """Peak-to-peak transmission error over the mean one, of a pair that gives way in the mesh alone."""
    return float(np.ptp(1.0 / formula(PHASES, contact_ratio, overlap_ratio)))


@styled
def picture(found: list) -> Figure:
    """`found`: the cases, by overlap ratio."""
    figure = Figure(figsize=(9.0, 5.4), layout="constrained")
    axes = figure.subplots()
    largest = found[-1].overlap_ratio
    for whole in range(1, int(largest + 0.01) + 1):
        axes.axvline(whole, color=GREY, linewidth=1.0, linestyle=":")
    ratios = np.linspace(0.05, largest, 246)
    for formula, colour, style, label in (
        (contact_lines, PALETTE[2], ":", "as the lines of contact are long (Velex, Maatar 1996)"),
        (mesh_stiffness, PALETTE[1], "--", "by the mesh stiffness of Gu, Velex et al. 2015"),
    ):
        # Of the mean of the widest pair: bodies bend least there.
        spans = [found[-1].mean * expected(formula, found[0].contact_ratio, ratio) for ratio in ratios]
        axes.plot(ratios, spans, style, color=colour, linewidth=1.6, label=label)
    axes.plot(
        [case.overlap_ratio for case in found],
        [case.peak_to_peak for case in found],
        "-o",
        color=PALETTE[0],
        markersize=6,
        label="this program",
    )
    axes.set(
        xlim=(0.0, largest + 0.05),
        xlabel=r"Overlap ratio $\varepsilon_\beta$, by the face width",
        ylabel="Peak-to-peak transmission error (µm)",
    )
    axes.set_ylim(bottom=0.0)
    axes.set_title("Helical pair without modifications, the same load per face width")
    axes.legend(loc="upper right")
    return figure
