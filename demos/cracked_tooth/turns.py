"""A tooth cracked to several depths: the picture docs/pictures/cracked_tooth.png and the table of README.md.

    python -m demos.cracked_tooth.turns [directory]

meshes the pinion with each crack, runs a turn of it, and writes meshes and picture into a directory,
results/cracked_tooth unless given.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg

from demos.cracked_tooth.depths import HERE, ITS_CYCLE, Turn, turns
from demos.cracked_tooth.picture import draw, name
from fenics_gears import load_scene
from fenics_gears.elasticity.element_sizes import element_sizes
from fenics_gears.elasticity.elements import element_named
from fenics_gears.model.model import model_of
from fenics_gears.show.panels import DOTS_PER_INCH
from meshes.root_crack import RootCrack, cracked_sector_mesh

# The crack whose mesh is shown.
SHOWN = RootCrack(3.0)
# Where the cracked tooth carries alone, and where it shares with the tooth before it.
ALONE, SHARED = ITS_CYCLE + 0.75, ITS_CYCLE + 0.25


def table(found: Sequence[Turn], teeth: int) -> list[str]:
    """Rows of a table in Markdown: what a crack of some depth changes."""
    whole = found[0]
    alone, shared = (int(np.argmin(np.abs(whole.phase - at))) for at in (ALONE, SHARED))
    rows = [
        (
            "| | largest deflection (µm) | peak to peak (µm) | least stiffness (N/µm) | compliance of the pair alone |"
            " share in double contact | order 1 (µm) | mesh order ± 1 (µm) |"
        ),
        "|---|---|---|---|---|---|---|---|",
    ]
    for turn in found:
        lines = turn.orders(teeth)
        first, below, above = (
            lines.amplitudes[int(np.argmin(np.abs(lines.orders - order)))] for order in (1, teeth - 1, teeth + 1)
        )
        softer = turn.error[alone] / whole.error[alone] - 1.0
        rows.append(
            f"| {name(turn)} | {np.abs(turn.error).max():.1f} | {np.ptp(turn.error):.1f} | {turn.stiffness.min():.0f} |"
            f" {softer:+.1%} | {turn.force_of(ITS_CYCLE)[shared] / turn.load:.1%} | {first:.2f} | {below:.2f},"
            f" {above:.2f} |"
        )
    return rows


def main(directory: Path) -> Path:
    """Run all depths, print the table, draw the picture into a directory, and return its file."""
    directory.mkdir(parents=True, exist_ok=True)
    found = turns(directory)
    model = model_of(load_scene(HERE / "cracked_tooth.toml"))
    gear, resolution = model.pair.pinion, model.resolution
    print("\n".join(table(found, gear.teeth)))
    sizes = element_sizes(gear, element_named(resolution.element), resolution.flank_element_size)
    figure = draw(found, gear, cracked_sector_mesh(gear, sizes, SHOWN), SHOWN)
    FigureCanvasAgg(figure)
    file = directory / "cracked_tooth.png"
    figure.savefig(file, dpi=DOTS_PER_INCH, metadata={"Software": None})
    return file


if __name__ == "__main__":
    print(main(Path(sys.argv[1] if len(sys.argv) > 1 else "results/cracked_tooth")))
