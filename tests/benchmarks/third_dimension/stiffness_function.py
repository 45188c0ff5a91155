"""Mesh stiffness over the mesh cycle against the function of Gu, Velex, Sainsot and Bruyère, at the contact ratios
of their Fig. 5; and a mean of plane slices in parallel, which elastic coupling along the face does not join."""

from dataclasses import replace
from math import radians

import numpy as np
from demos.face_width.stiffness_function import contact_lines, mesh_stiffness
from matplotlib.figure import Figure
from tests.benchmarks.third_dimension import pairs
from tests.benchmarks.third_dimension.table import Row, read_rows, with_picture, write_rows

from fenics_gears import gear_pair, simulate
from fenics_gears.geometry.gear_data import GearPairData
from fenics_gears.scene.data import Accuracy
from fenics_gears.show.panels import DARK, PALETTE, styled

NAME = "stiffness_function"
# As printed in the figure, read off it: smallest and largest over the mean.
CONTACT_RATIO, OVERLAP_RATIO, PUBLISHED = 1.667, 1.343, (0.917, 1.046)
TEETH, HELIX_ANGLE, BORES = (50, 100), radians(18.2412), (0.5, 0.85)
STEPS, SLICE_WIDTH, LAYER_THICKNESS, SECTION_SIZE = 24, 0.4, 1.3, 0.6


def measure() -> list[Row]:
    """Mesh stiffness at the steps of a cycle, N/(mm um), by the bores."""
    found = {}
    for bore in BORES:
        width = pairs.width_of_overlap(OVERLAP_RATIO, HELIX_ANGLE)
        gears = pairs.standard_pair(width, HELIX_ANGLE, bore=bore, teeth=TEETH)
        pair = gear_pair(gears)
        assert abs(pair.contact_ratio - CONTACT_RATIO) < 1e-3 and abs(pair.overlap_ratio - OVERLAP_RATIO) < 1e-3
        accuracy = pairs.divided(gears, SLICE_WIDTH, LAYER_THICKNESS, SECTION_SIZE, STEPS)
        result = simulate(pairs.scene_of(gears, accuracy))
        found[f"slices_{bore:g}"] = slices_in_parallel(gears)
        found["phase"], found[f"bore_{bore:g}"] = (
            result["mesh_phase"].values[:STEPS],
            1e-3 * result["mesh_stiffness"].values[:STEPS] / width,
        )
    rows = [dict(zip(found, map(float, values))) for values in zip(*found.values())]
    write_rows(NAME, rows)
    return rows


def slices_in_parallel(gears: GearPairData) -> np.ndarray:
    """Mesh stiffness at STEPS phases, N/(mm um), of plane slices of the transverse section that know nothing of each
    other: means of the plane route's over the overlap ratio."""
    pair, samples = gear_pair(gears), 4 * STEPS
    flat = [replace(gear, rack_tip_radius=0.2) for gear in (gears.pinion, gears.wheel)]
    spur = GearPairData(
        pair.pinion.module,
        pair.pinion.pressure_angle,
        gears.centre_distance,
        gears.face_width,
        flat[0],
        flat[1],
        gears.material,
    )
    scene = pairs.in_plane(pairs.scene_of(spur, Accuracy(steps_per_mesh_cycle=samples)))
    stiffness = simulate(scene)["mesh_stiffness"].values[:samples]
    integral = np.concatenate([[0.0], np.cumsum(np.tile(stiffness, 3))]) / samples
    places, phases, half = np.arange(len(integral)) / samples, 1.0 + np.arange(STEPS) / STEPS, 0.5 * pair.overlap_ratio
    return (
        1e-3
        / gears.face_width
        * (np.interp(phases + half, places, integral) - np.interp(phases - half, places, integral))
        / pair.overlap_ratio
    )


def _shares(rows: list[Row]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Phases, and stiffness over its mean: of the formulas, in the order of these phases, and of the program."""
    phases = np.array([row["phase"] for row in rows])
    shares = {
        "lines of contact, Velex and Maatar 1996": contact_lines,
        "mesh stiffness, Gu, Velex et al. 2015": mesh_stiffness,
    }
    # The formulas count from where a line of contact enters at one end of the face, the program from where it enters in
    # the middle.
    found = {
        name: formula(phases + 0.5 * OVERLAP_RATIO, CONTACT_RATIO, OVERLAP_RATIO) for name, formula in shares.items()
    }
    for kind, words in (("slices", "plane slices in parallel"), ("bore", "this program")):
        for bore in BORES:
            values = np.array([row[f"{kind}_{bore:g}"] for row in rows])
            found[f"{words}, bores {bore:g} of the root diameter"] = values / values.mean()
    return phases, found


@styled
def picture(rows: list[Row]) -> Figure:
    figure = Figure(figsize=(9.0, 4.8), layout="constrained")
    axes = figure.subplots()
    phases, shares = _shares(rows)
    for (name, values), style, colour in zip(
        shares.items(), (":", "--", "-.", "-.", "-", "-"), (PALETTE[2], PALETTE[1], DARK, PALETTE[0], DARK, PALETTE[0])
    ):
        axes.plot(phases, values, style, color=colour, label=name)
    axes.set(xlabel="Mesh phase (mesh cycles)", ylabel="Mesh stiffness over its mean", xlim=(0.0, 1.0))
    axes.set_title(f"Contact ratio {CONTACT_RATIO:g}, overlap ratio {OVERLAP_RATIO:g}")
    axes.set_ylim(0.83, 1.06)
    axes.legend(loc="lower right")
    return figure


def section() -> str:
    rows = read_rows(NAME)
    _, shares = _shares(rows)
    lines = [
        ["their Fig. 5", *(f"{value:.3f}" for value in PUBLISHED), f"{100.0 * (PUBLISHED[1] - PUBLISHED[0]):.1f}", ""]
    ]
    for name, values in shares.items():
        column = next(
            (
                f"{kind}_{bore:g}"
                for kind, words in (("slices", "plane"), ("bore", "this"))
                for bore in BORES
                if name.startswith(words) and f" {bore:g} " in name
            ),
            None,
        )
        mean = "" if column is None else f"{np.mean([row[column] for row in rows]):.2f}"
        lines.append([name, f"{values.min():.3f}", f"{values.max():.3f}", f"{100.0 * np.ptp(values):.1f}", mean])
    headings = ["", "smallest over the mean", "largest", "span, %", "mean, N/(mm µm)"]
    return with_picture(NAME, "Mesh stiffness over the mesh phase", picture(rows), headings, lines)
