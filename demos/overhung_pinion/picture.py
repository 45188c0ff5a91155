"""Line load along the face at three torques, a panel for each flank, and below what scattering axes make of them."""

from __future__ import annotations

from matplotlib.figure import Figure

from fenics_gears.results.load_factors import mean_line_load
from fenics_gears.show.panels import PALETTE, styled


@styled
def picture(flanks: dict) -> Figure:
    """`flanks`: by name, as of `corrected.compared`."""
    figure = Figure(figsize=(13.0, 8.2), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.12)
    above, below = figure.subfigures(2, 1)
    figure.suptitle("An overhung helical pinion: line load along the face", x=0.012, ha="left", fontsize=14)
    panels = above.subplots(1, len(flanks), sharex=True, sharey=True)
    for panel, (name, each) in zip(panels, flanks.items()):
        for colour, (torque, result) in zip(PALETTE, each.results.items()):
            load = mean_line_load(result, "")
            panel.plot(result.face_position, load / load.mean(), color=colour, label=f"{torque:g} N m")
        panel.set_title(f"flanks: {name}\nhelix slope {each.slope:.1f} µm, crowning {each.crowning:.1f} µm")
        panel.set_xlabel("Place on the face (mm)")
    panels[0].set_ylabel("Line load over its mean")
    panels[0].set_ylim(0.0, 1.05 * max(line.get_ydata().max() for panel in panels for line in panel.get_lines()))
    panels[0].legend(title="torque on the wheel", loc="upper right")
    panel = below.subplots()
    for colour, (name, each) in zip(PALETTE[3:], flanks.items()):
        order = each.misalignments.argsort()
        words = f"{name}: nine of ten below {each.nine_of_ten:.2f}"
        panel.plot(each.misalignments[order], each.scattered[order], ".", color=colour, label=words)
    panel.set_xlabel("Misalignment of the axes by mounting (µm over the face)")
    panel.set_ylabel(r"K$_{\mathrm{H}\beta}$, mean of the torques")
    panel.set_ylim(bottom=1.0)
    panel.legend(title="flanks")
    return figure
