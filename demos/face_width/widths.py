"""Transmission error of a helical pair over its face width: a study, its picture and its table. Called by `run`."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from pathlib import Path

from demos.arguments import output_directory

STUDY = Path(__file__).parent / "study.toml"
PICTURE, TABLE = "face_width.png", "face_width.md"


@dataclass(frozen=True)
class Width:
    """A case of the study: overlap ratio, face width (mm), and mean and peak-to-peak transmission error (um on the
    wheel's base circle)."""

    overlap_ratio: float
    contact_ratio: float
    face_width: float
    mean: float
    peak_to_peak: float


def main(arguments: list[str] | None = None) -> int:
    """Run the study on the cores there are, draw; returns the exit code of `gears study`."""
    directory = output_directory("face_width", __doc__.splitlines()[0].removesuffix(" Called by `run`."), arguments)
    from fenics_gears.commands.cli import main as gears

    processes = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    code = gears(["study", str(STUDY), "--output", str(directory), "--processes", str(processes)])
    if code == 0:
        shown(directory)
    return code


def cases(directory: Path) -> list[Width]:
    """The runs of a study in a directory, by width."""
    import xarray as xr

    from fenics_gears.model.model import model_of
    from fenics_gears.scene.read import scene_from_text

    found = []
    for file in sorted((directory / "cases").glob("*.nc")):
        with xr.open_dataset(file, engine="h5netcdf") as run:
            pair, attributes = model_of(scene_from_text(run.attrs["scene"])).pair, run.attrs
            error = [
                1e3 * pair.wheel.base_radius * attributes[f"{name}_transmission_error"]
                for name in ("mean", "peak_to_peak")
            ]
        found.append(Width(pair.overlap_ratio, pair.contact_ratio, pair.face_width, *error))
    return sorted(found, key=lambda case: case.overlap_ratio)


def table(found: list[Width]) -> str:
    """Markdown: a row for each width."""
    rows = ["| overlap ratio | face width (mm) | mean T_E (µm) | T_EPP (µm) |", "|---|---|---|---|"]
    rows += [
        f"| {case.overlap_ratio:.2f} | {case.face_width:.1f} | {case.mean:.2f} | {case.peak_to_peak:.2f} |"
        for case in found
    ]
    return "\n".join(rows) + "\n"


def shown(directory: Path) -> None:
    """Draw the study that lies in a directory and write its table, both into it."""
    from demos.face_width.picture import picture
    from fenics_gears.show.plots import save_figure

    found = cases(directory)
    save_figure(picture(found), directory / PICTURE)
    (directory / TABLE).write_text(table(found), encoding="utf-8")
    print(table(found))


if __name__ == "__main__":
    sys.exit(main())
