"""Peak-to-peak transmission error of helical pairs over the overlap ratio: least where it is a whole number, since
the length of the contact lines then is the same at every position."""

from math import ceil, degrees, radians

import numpy as np
from matplotlib.figure import Figure
from tests.benchmarks.third_dimension.pairs import MODULE, in_plane, scene_of, standard_pair, width_of_overlap
from tests.benchmarks.third_dimension.table import Row, read_rows, with_picture, write_rows

from fenics_gears import simulate
from fenics_gears.scene.data import Accuracy
from fenics_gears.show.panels import DARK, GREY, PALETTE, styled

NAME = "overlap"
HELIX_ANGLE = radians(20.0)
OVERLAPS = (0.2, 0.4, 0.5, 0.6, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 1.75, 2.0, 2.2)
STEPS, SLICE_WIDTH, LAYER_THICKNESS, SECTION_SIZE = 40, 0.25, 1.5, 0.6


def scene(
    overlap: float,
    slice_width: float = SLICE_WIDTH,
    layer_thickness: float = LAYER_THICKNESS,
    section: float = SECTION_SIZE,
    steps: int = STEPS,
):
    """The pair with an overlap ratio; widths of slices, layers and section elements in modules."""
    width = width_of_overlap(overlap, HELIX_ANGLE)
    accuracy = Accuracy(
        steps_per_mesh_cycle=steps, slices=max(ceil(width / (slice_width * MODULE)), 5),
        layers=max(ceil(width / (layer_thickness * MODULE)), 3),
        body_element_size=section * MODULE,
    )  # fmt: skip
    return scene_of(standard_pair(width, HELIX_ANGLE), accuracy)


def of_result(result, base_radius: float) -> Row:
    """Transmission error along the line of action, um."""
    mean, span = (
        1e3 * base_radius * result.attrs[name]
        for name in ("mean_transmission_error", "peak_to_peak_transmission_error")
    )
    return {"mean": mean, "peak_to_peak": span} | {
        f"harmonic_{n}": result.attrs[f"transmission_error_harmonic_{n}"] for n in (1, 2, 3)
    }


def measure() -> list[Row]:
    """Of the spur pair (overlap ratio 0) by the plane route, and of helical ones."""
    spur = simulate(in_plane(scene_of(standard_pair(20.0), Accuracy(steps_per_mesh_cycle=STEPS))))
    rows: list[Row] = [{"overlap": 0.0, **of_result(spur, spur.attrs["base_radius_wheel"])}]
    for overlap in OVERLAPS:
        result = simulate(scene(overlap))
        rows.append({"overlap": overlap, **of_result(result, result.attrs["base_radius_wheel"])})
        write_rows(NAME, sorted(rows, key=lambda row: row["overlap"]))
    return rows


@styled
def picture(rows: list[Row]) -> Figure:
    """Peak-to-peak transmission error over the overlap ratio, a tenth of the spur pair's beside it."""
    figure = Figure(figsize=(9.0, 5.2), layout="constrained")
    axes = figure.subplots()
    overlaps, spans = (np.array([row[name] for row in rows]) for name in ("overlap", "peak_to_peak"))
    for whole in range(1, int(overlaps.max()) + 1):
        axes.axvline(whole, color=GREY, linewidth=1.0, linestyle=":")
    axes.axhline(0.1 * spans[0], color=PALETTE[1], linewidth=1.2, linestyle="--")
    axes.text(0.0, 0.1 * spans[0], "a tenth of the spur pair", color=PALETTE[1], va="bottom")
    axes.plot(overlaps[1:], spans[1:], "-o", color=PALETTE[0], markersize=6)
    axes.plot(0.0, spans[0], "s", color=DARK, markersize=8)
    axes.text(0.04, spans[0], "spur pair", color=DARK, va="center")
    axes.set_ylim(0.0, None)
    axes.set_xlim(-0.04, None)
    axes.set_xlabel(r"Overlap ratio $\varepsilon_\beta$, by the face width")
    axes.set_ylabel("Peak-to-peak transmission error (µm, line of action)")
    axes.set_title(
        f"Unmodified pair, helix angle {degrees(HELIX_ANGLE):.0f}°, no friction, the same load per face width"
    )
    return figure


def section() -> str:
    rows = read_rows(NAME)
    spur = rows[0]["peak_to_peak"]
    wanted = [row for row in rows if row["overlap"] in (0.0, 0.5, 1.0, 1.5, 2.0)]
    lines = [
        [
            f"{row['overlap']:g}",
            f"{row['mean']:.2f}",
            f"{row['peak_to_peak']:.3f}",
            f"{100 * row['peak_to_peak'] / spur:.1f}",
        ]
        for row in wanted
    ]
    headings = ["overlap ratio", "mean T_E, µm", "T_EPP, µm", "of the spur pair's, %"]
    return with_picture(NAME, "Transmission error over the overlap ratio", picture(rows), headings, lines)
