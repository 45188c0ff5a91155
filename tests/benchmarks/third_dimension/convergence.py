"""Error over processor seconds from nothing, of two helical pairs by 0.4.0, whose bodies had thin layers all through
the gear, and by this checkout: `python -m tests.benchmarks.third_dimension.convergence CHECKOUT_OF_0.4.0`."""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from matplotlib.figure import Figure
from tests.benchmarks.third_dimension.defaults import (
    MEAN,
    ORDER,
    ORDER_OF_MEAN_BY_SLICES,
    PAIRS,
    ROOT,
    SPAN,
    STEPS,
    alone,
    numbers_of,
    pair,
)
from tests.benchmarks.third_dimension.defaults import NAME as DEFAULTS
from tests.benchmarks.third_dimension.table import PICTURES, Row, read_rows, with_picture, write_rows

from fenics_gears.scene.write import text_of
from fenics_gears.show.panels import GREY, PALETTE, styled

NAME = "convergence"
# By number of the pair: slices and layers.
OLD = {0: ((16, 8), (24, 12), (36, 12)), 9: ((10, 5), (14, 7), (20, 10), (28, 14), (42, 21))}
NEW = {0: ((10, 4), (19, 8), (38, 8)), 9: ((8, 4), (12, 5), (18, 5), (24, 7))}

SECONDS = (10, 20, 50, 100)


def measure(old: Path | None = None) -> list[Row]:
    """What the file does not have yet, by this checkout and, where it is given, by the old one."""
    rows = read_rows(NAME) if (PICTURES / f"{NAME}.csv").exists() else []
    done = {(row["pair"], row["old"], row["slices"], row["layers"]) for row in rows}
    of_both = [(old, True, OLD)] if old else []
    for checkout, is_old, sizes in (*of_both, (ROOT, False, NEW)):
        for number, slices, layers in [(place, *each) for place in sizes for each in sizes[place]]:
            if (number, is_old, slices, layers) in done:
                continue
            text = text_of(pair(*PAIRS[number]))
            text += f"\n[accuracy]\nslices = {slices}\nlayers = {layers}\nsteps_per_mesh_cycle = {STEPS}\n"
            with TemporaryDirectory() as cache:
                found = numbers_of(text, checkout=checkout, cache=Path(cache))
            rows.append({"pair": number, "old": is_old, "slices": slices, "layers": layers, **found})
            print(rows[-1], flush=True)
            write_rows(NAME, rows)
    return rows


def limits(number: int) -> Row:
    """Of a pair: from its two finest numbers of slices among the runs of the defaults, by the order of each number."""
    refined = (row for row in read_rows(DEFAULTS) if row["pair"] == number and alone(row, "slices"))
    finer, finest = sorted(refined, key=lambda row: row["slices"])[-2:]
    left = finer["slices"] / finest["slices"]
    parts = {MEAN: left**ORDER_OF_MEAN_BY_SLICES, SPAN: left**ORDER}
    return {name: (finest[name] - part * finer[name]) / (1.0 - part) for name, part in parts.items()}


def _slices(row: Row) -> float:
    return row["slices"]


def errors(row: Row, limit: Row) -> tuple[float, float]:
    """Of mean and peak-to-peak transmission error, in % of the mean."""
    mean, span = (100.0 * abs(row[name] - limit[name]) / limit[MEAN] for name in (MEAN, SPAN))
    return mean, span


@styled
def picture(rows: list[Row]) -> Figure:
    figure = Figure(figsize=(10.0, 7.2), layout="constrained")
    panels = figure.subplots(2, 2, sharex=True, sharey="row")
    for column, number in enumerate(OLD):
        module, width, helix, teeth, mate, _ = PAIRS[number]
        limit = limits(number)
        panels[0, column].set_title(f"{teeth}/{mate} teeth, module {module:g} mm, {helix:g}°, face {width:g} mm")
        for old, words, colour, marker in (
            (True, "0.4.0: bodies with thin layers", PALETTE[1], "s"),
            (False, "now: what layers leave out is added", PALETTE[0], "o"),
        ):
            own = sorted((row for row in rows if row["pair"] == number and bool(row["old"]) == old), key=_slices)
            seconds = [row["seconds"] for row in own]
            found = np.reshape([errors(row, limit) for row in own], (-1, 2))
            for line, axes in enumerate(panels[:, column]):
                axes.loglog(seconds, np.maximum(found[:, line], 1e-3), f"-{marker}", color=colour, label=words)
                for row, x, y in zip(own, seconds, found[:, line]):
                    words_of = f"{row['slices']:g}/{row['layers']:g}"
                    axes.annotate(
                        words_of, (x, max(y, 1e-3)), (4, 4), textcoords="offset points", fontsize=8, color=colour
                    )
    for line, (words, goal) in enumerate((("mean T_E", 0.3), ("T_EPP", 0.2))):
        panels[line, 0].set_ylabel(f"Error of {words} (% of mean T_E)")
        for axes in panels[line]:
            axes.axhline(goal, color=GREY, linewidth=1.0, linestyle="--")
            axes.text(0.99, goal, "goal", color=GREY, va="bottom", ha="right", transform=axes.get_yaxis_transform())
            axes.grid(True, which="major", alpha=0.3)
            axes.yaxis.set_major_formatter("{x:g}")
    for axes in panels[1]:
        axes.set_xticks(SECONDS, [f"{each}" for each in SECONDS])
        axes.minorticks_off()
        axes.set_xlabel("Processor seconds from nothing, one thread")
    panels[0, 0].legend(loc="lower left", title="slices/layers at the points")
    return figure


def section() -> str:
    rows = read_rows(NAME)
    lines = []
    for row in rows:
        _, width, helix, teeth, mate, _ = PAIRS[int(row["pair"])]
        off = (f"{each:.2f}" for each in errors(row, limits(int(row["pair"]))))
        lines.append([
            f"{teeth}/{mate}, {width:g} mm, {helix:g} deg", "0.4.0" if row["old"] else "now",
            f"{row['slices']:g} on {row['layers']:g}", f"{row[MEAN]:.3f}", f"{row[SPAN]:.3f}", *off,
            f"{row['seconds']:.0f}", f"{row['memory']:.1f}",
        ])  # fmt: skip
    headings = [
        "pair", "program", "slices on layers", "mean T_E, µm", "T_EPP, µm", "off the limit, % of the mean: mean T_E",
        "T_EPP", "processor, s", "memory, GB",
    ]  # fmt: skip
    return with_picture(NAME, "Error over seconds of two helical pairs", picture(rows), headings, lines)


if __name__ == "__main__":
    measure(Path(sys.argv[1]))
