"""Line load over the face for several misalignments, one panel for each shape of the flanks."""

from __future__ import annotations

from matplotlib.figure import Figure

from fenics_gears.show.panels import PALETTE, styled


@styled
def picture(results: dict) -> Figure:
    """`results`: by shape of the flanks and misalignment (mm). Line load of the tooth pair that carries most, at the
    step at which one pair is alone."""
    shapes = list(dict.fromkeys(shape for shape, _ in results))
    figure = Figure(figsize=(13.0, 4.6), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.12)
    axes = figure.subplots(1, len(shapes), sharex=True, sharey=True, squeeze=False)[0]
    figure.suptitle(
        "A spur pair on axes that are not parallel: line load of a tooth pair that carries alone",
        x=0.012,
        ha="left",
        fontsize=14,
    )
    for panel, shape in zip(axes, shapes):
        found = {misalignment: result for (name, misalignment), result in results.items() if name == shape}
        for colour, (misalignment, result) in zip(PALETTE, found.items()):
            forces = (result.line_load * result.face_slice_width).sum("face_position").values
            alone = forces.max(axis=1).argmax()
            panel.plot(
                result.face_position,
                result.line_load.values[alone, forces[alone].argmax()],
                color=colour,
                label=f"{1e3 * misalignment:g} µm",
            )
        panel.set_title(f"flanks: {shape}")
        panel.set_xlabel("Place on the face (mm)")
        panel.set_ylim(bottom=0.0)
    axes[0].set_ylabel("Line load (N/mm)")
    axes[0].legend(title="misalignment over the face", loc="upper right")
    return figure
