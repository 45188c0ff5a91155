"""Line load of a misaligned spur pair against a uniform foundation and ISO 6336-1, 7.5 (method C). With springs c
the largest line load is ``1 + c b f/(2 F)`` times the mean one while the whole face touches, ``2 sqrt(c b f/(2 F))``
times beyond."""

from dataclasses import replace
from math import sqrt

import numpy as np
from matplotlib.figure import Figure
from tests.benchmarks.third_dimension.pairs import LINE_LOAD, MODULE, scene_of, standard_pair
from tests.benchmarks.third_dimension.table import Row, read_rows, with_picture, write_rows

from fenics_gears import gear_pair, mesh_factor, simulate, single_stiffness
from fenics_gears.geometry.misalignment import Misalignment
from fenics_gears.scene.data import Accuracy
from fenics_gears.show.panels import DARK, GREY, PALETTE, styled

NAME, LINES = "misaligned", "misaligned_lines"
WIDTH, MISALIGNMENTS = 8.0, (0.0, 5.0, 10.0, 20.0, 40.0, 80.0)
ACCURACY = Accuracy(steps_per_mesh_cycle=20, slices=40, layers=10)
METHOD_C = 0.85


def face_load_factor(share: float) -> float:
    """Largest line load over the mean one; share: c b f/(2 F)."""
    return 1.0 + share if share <= 1.0 else 2.0 * sqrt(share)


def foundation(z: np.ndarray, width: float, stiffness: float, misalignment: float, mean: float) -> np.ndarray:
    """Line load (k,), N/mm, of the foundation at places z (k,) from mid-width; stiffness N/mm^2, misalignment mm over
    the width, opening towards +z."""
    share = 0.5 * stiffness * misalignment / mean
    if share <= 1.0:
        return mean * (1.0 - 2.0 * share * z / width)
    touching = width / sqrt(share)
    return np.maximum(2.0 * mean * width / touching * (1.0 - (z + 0.5 * width) / touching), 0.0)


def tilting_stiffness(z: np.ndarray, load: np.ndarray, width: float, misalignment: float) -> float:
    """Stiffness (N/mm^2) of the foundation of the same moment under a misalignment (mm over the width): c f b^2/12."""
    return -12.0 * float(np.mean(load * z)) / (misalignment * width)


def single_pair_step(result) -> int:
    """The step nearest to the middle of those in which one pair of teeth carries."""
    alone = np.flatnonzero(result.loaded_pairs.values == 1)
    return int(alone[len(alone) // 2])


def measure() -> list[Row]:
    gears, rows, lines = standard_pair(WIDTH * MODULE), [], []
    pair = gear_pair(gears)
    mesh = METHOD_C * mesh_factor(pair.contact_ratio) * single_stiffness(gears)[1]
    for amount in MISALIGNMENTS:
        scene = replace(scene_of(gears, ACCURACY), misalignment=Misalignment(in_plane=1e-3 * amount))
        result = simulate(scene)
        step = single_pair_step(result)
        load = result.line_load.values.sum(axis=1)
        if amount == 0.0:
            single = [
                float(result[name][step]) * 1e-3 / gears.face_width
                for name in ("mesh_stiffness", "mesh_stiffness_tangent")
            ]
        peaks = load.max(axis=1) / load.mean(axis=1)
        shares = [0.5 * c * amount / LINE_LOAD for c in (*single, mesh)]
        names = ("secant_foundation", "tangent_foundation", "iso_6336")
        rows.append({
            "misalignment": amount, "stiffness": single[0], "tangent": single[1], "single_pair": peaks[step],
            "cycle_mean": peaks[:-1].mean(),
            **dict(zip(names, map(face_load_factor, shares))),
        })  # fmt: skip
        lines += [
            {"misalignment": amount, "z": z, "line_load": w} for z, w in zip(result.face_position.values, load[step])
        ]
        write_rows(NAME, rows)
        write_rows(LINES, lines)
    return rows


@styled
def picture(rows: list[Row], lines: list[Row]) -> Figure:
    """Line load over the face, elastic teeth against the foundation; and the face load factor."""
    figure = Figure(figsize=(12.5, 5.2), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    width, stiffness = WIDTH * MODULE, rows[0]["stiffness"]
    shown = (0.0, 10.0, 40.0)
    for colour, amount in zip(PALETTE, shown):
        own = [line for line in lines if line["misalignment"] == amount]
        z = np.array([line["z"] for line in own])
        left.plot(z, [line["line_load"] for line in own], color=colour, label=f"{amount:g} µm")
        fine = np.linspace(-0.5 * width, 0.5 * width, 400)
        left.plot(
            fine, foundation(fine, width, 1e3 * stiffness, 1e-3 * amount, LINE_LOAD), "--", color=colour, linewidth=1.2
        )
    left.set(
        xlabel="Place on the face (mm from mid-width)",
        ylabel="Line load (N/mm)",
        title="One pair in contact; dashed: uniform foundation",
    )
    left.legend(title="misalignment")
    left.set_ylim(0.0, None)
    amounts = [row["misalignment"] for row in rows]
    right.plot(amounts, [row["single_pair"] for row in rows], "-o", color=DARK, label="elastic teeth, one pair")
    right.plot(
        amounts,
        [row["secant_foundation"] for row in rows],
        "--",
        color=PALETTE[0],
        label="foundation of the same stiffness",
    )
    right.plot(amounts, [row["iso_6336"] for row in rows], ":", color=PALETTE[1], label="ISO 6336-1, method C")
    right.set(
        xlabel="Misalignment in the plane of action (µm)",
        ylabel="Largest line load over the mean",
        title="Face load factor",
    )
    right.axhline(2.0, color=GREY, linewidth=0.8)
    right.legend()
    return figure


def section() -> str:
    rows = read_rows(NAME)
    figure = picture(rows, read_rows(LINES))
    least, width = rows[1]["misalignment"], WIDTH * MODULE
    z, load = np.array([(line["z"], line["line_load"]) for line in read_rows(LINES) if line["misalignment"] == least]).T
    tilting = tilting_stiffness(z, load, width, 1e-3 * least)
    for row in rows:
        row["tilting"] = face_load_factor(0.5e-3 * tilting * row["misalignment"] / LINE_LOAD)
    names = ("single_pair", "cycle_mean", "secant_foundation", "tilting", "iso_6336")
    lines = [[f"{row['misalignment']:g}", *(f"{row[name]:.3f}" for name in names)] for row in rows]
    stiffness = (f"foundation of {1e-3 * c:.1f} N/(mm µm)" for c in (1e3 * rows[0]["stiffness"], tilting))
    headings = ["misalignment, µm", "K_Hβ, one pair", "mean of the mesh cycle", *stiffness, "ISO 6336-1, method C"]
    return with_picture(NAME, "Line load of a misaligned pair", figure, headings, lines)
