"""A spur pair by the three-dimensional way over its face width: from plane stress to plane strain, both by the plane
route."""

from math import ceil

import numpy as np
from matplotlib.figure import Figure
from tests.benchmarks.third_dimension.pairs import MODULE, STEEL, in_plane, scene_of, standard_pair
from tests.benchmarks.third_dimension.table import Row, read_rows, with_picture, write_rows

from fenics_gears import Material, simulate
from fenics_gears.scene.data import Accuracy
from fenics_gears.show.panels import DARK, GREY, PALETTE, styled

NAME = "plane_limits"
WIDTHS = (0.5, 1.0, 2.0, 4.0, 8.0, 15.0, 30.0, 60.0)
STEPS, SLICES, LAYER_THICKNESS, LAYERS = 40, 15, 0.8, (4, 12)
NU = STEEL.poissons_ratio
# The elastic constants with which equations of plane strain are those of plane stress (Timoshenko and Goodier, Theory
# of Elasticity, 1970, section 20).
PLANE_STRESS = Material(STEEL.youngs_modulus * (1.0 + 2.0 * NU) / (1.0 + NU) ** 2, NU / (1.0 + NU))


def of_scene(scene) -> Row:
    """Mean transmission error, um along the line of action, and mean mesh stiffness, N/(mm um)."""
    result = simulate(scene)
    stiffness = float(result.mesh_stiffness[:-1].mean()) * 1e-3 / scene.gears.face_width
    return {
        "mean": 1e3 * result.attrs["base_radius_wheel"] * result.attrs["mean_transmission_error"],
        "stiffness": stiffness,
    }


def scene(width: float):
    """The spur pair of a face width in modules."""
    layers = int(np.clip(ceil(width / LAYER_THICKNESS), *LAYERS))
    return scene_of(standard_pair(width * MODULE), Accuracy(steps_per_mesh_cycle=STEPS, slices=SLICES, layers=layers))


def measure() -> list[Row]:
    """Plane stress (width 0), the widths, and plane strain (width infinite)."""
    flat = Accuracy(steps_per_mesh_cycle=STEPS, flank_element_size=0.0459, contact_length=1.834, contact_nodes=59)
    stress, strain = (
        of_scene(in_plane(scene_of(standard_pair(20.0, material=material), flat))) for material in (PLANE_STRESS, STEEL)
    )
    rows = [{"width": 0.0, **stress}]
    for width in WIDTHS:
        rows.append({"width": width, **of_scene(scene(width))})
        write_rows(NAME, [*rows, {"width": np.inf, **strain}])
    return [*rows, {"width": np.inf, **strain}]


@styled
def picture(rows: list[Row]) -> Figure:
    figure = Figure(figsize=(9.0, 4.8), layout="constrained")
    axes = figure.subplots()
    stress, *between, strain = rows
    for limit, name, above in ((stress, "plane stress", True), (strain, "plane strain", False)):
        axes.axhline(limit["mean"], color=GREY, linestyle="--", linewidth=1.2)
        axes.text(58.0, limit["mean"], name, color=DARK, va="bottom" if above else "top", ha="right")
    axes.plot([row["width"] for row in between], [row["mean"] for row in between], "-o", color=PALETTE[0])
    axes.set_xscale("log")
    axes.set_xticks([0.5, 1, 2, 5, 10, 20, 60], ["0.5", "1", "2", "5", "10", "20", "60"])
    axes.minorticks_off()
    margin = 0.15 * (stress["mean"] - strain["mean"])
    axes.set_ylim(strain["mean"] - margin, stress["mean"] + margin)
    axes.set_xlabel("Face width in modules, b/m")
    axes.set_ylabel("Mean transmission error (µm)")
    axes.set_title("Spur pair in three dimensions, the same load per face width")
    return figure


def section() -> str:
    rows = read_rows(NAME)
    stress, strain = rows[0], rows[-1]
    names = ["plane stress", *(f"{row['width']:g}" for row in rows[1:-1]), "plane strain"]
    part = lambda row, limit, key: f"{100 * (row[key] / limit[key] - 1):+.2f}"  # noqa: E731
    lines = [
        [
            name,
            f"{row['mean']:.3f}",
            part(row, stress, "mean"),
            part(row, strain, "mean"),
            f"{row['stiffness']:.3f}",
            part(row, strain, "stiffness"),
        ]
        for name, row in zip(names, rows)
    ]
    headings = [
        "b/m",
        "mean T_E, µm",
        "off plane stress, %",
        "off plane strain, %",
        "mean mesh stiffness, N/(mm µm)",
        "off plane strain, %",
    ]
    return with_picture(NAME, "Mean transmission error over the face width", picture(rows), headings, lines)
