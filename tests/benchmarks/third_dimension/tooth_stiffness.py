"""Mesh stiffness of spur and helical pairs against ISO 6336-1, method B, whose c' is 0.8 of its theoretical c'th.
Bores of 0.7 root diameters keep the twist of the body small."""

from math import cos, radians

from matplotlib.figure import Figure
from tests.benchmarks.third_dimension.pairs import LINE_LOAD, MODULE, divided, scene_of, standard_pair
from tests.benchmarks.third_dimension.table import Row, read_rows, with_picture, write_rows

from fenics_gears import gear_pair, mesh_factor, simulate, single_stiffness
from fenics_gears.show.panels import DARK, PALETTE, styled

NAME = "tooth_stiffness"
HELIX_ANGLES, WIDTH, BORE = (0.0, 10.0, 20.0, 30.0), 8.0, 0.7
LAYER_THICKNESS, SECTION_SIZE, SLICE_WIDTH = 1.5, 0.6, 0.4


def measure() -> list[Row]:
    rows = []
    for degrees in HELIX_ANGLES:
        gears = standard_pair(WIDTH * MODULE, radians(degrees), bore=BORE)
        accuracy = divided(gears, SLICE_WIDTH, LAYER_THICKNESS, SECTION_SIZE)
        result, pair = simulate(scene_of(gears, accuracy)), gear_pair(gears)
        theoretical, single = single_stiffness(gears)
        factor = mesh_factor(pair.contact_ratio)
        rows.append({
            "helix_angle": degrees, "transverse_contact_ratio": pair.contact_ratio, "overlap_ratio": pair.overlap_ratio,
            "load": LINE_LOAD,
            "mesh": result.attrs["mean_mesh_stiffness"], "of_one_pair": result.attrs["mean_mesh_stiffness"] / factor,
            "standard_single": single, "standard_mesh": single * factor,
            "theoretical_mesh": theoretical * cos(gears.helix_angle) * factor,
        })  # fmt: skip
        write_rows(NAME, rows)
    return rows


@styled
def picture(rows: list[Row]) -> Figure:
    figure = Figure(figsize=(9.0, 4.8), layout="constrained")
    axes, angles = figure.subplots(), [row["helix_angle"] for row in rows]
    mesh, theoretical = ([row[name] for row in rows] for name in ("standard_mesh", "theoretical_mesh"))
    axes.fill_between(angles, mesh, theoretical, color=PALETTE[0], alpha=0.12, linewidth=0)
    axes.plot(angles, theoretical, "--", color=PALETTE[0], label="ISO 6336-1, theoretical (c'th cos β)")
    axes.plot(angles, mesh, "-", color=PALETTE[0], label="ISO 6336-1, adjusted to measurements (c')")
    axes.plot(angles, [row["mesh"] for row in rows], "o", color=DARK, markersize=8, label="this program")
    axes.set(
        xlabel="Helix angle (°)",
        ylabel="Mean mesh stiffness (N/(mm µm))",
        title="Mesh stiffness $c_\\gamma$ in the transverse plane",
    )
    axes.set_ylim(0.0, None)
    axes.legend(loc="lower left")
    return figure


def section() -> str:
    rows = read_rows(NAME)
    lines = [
        [
            f"{row['helix_angle']:g}", f"{row['transverse_contact_ratio']:.3f}", f"{row['overlap_ratio']:.2f}",
            f"{row['standard_mesh']:.2f}",
            f"{row['theoretical_mesh']:.2f}", f"{row['mesh']:.2f}",
            f"{100 * (row['mesh'] / row['standard_mesh'] - 1):+.1f}", f"{row['of_one_pair']:.2f}",
            f"{row['standard_single']:.2f}",
        ]
        for row in rows
    ]  # fmt: skip
    headings = [
        "β, deg", "ε_α", "ε_β", "c_γ by ISO", "with c'th cos β", "c_γ here", "off ISO, %", "c_γ here/(0.75 ε_α + 0.25)",
        "c' by ISO",
    ]  # fmt: skip
    return with_picture(NAME, "Mesh stiffness over the helix angle", picture(rows), headings, lines)
