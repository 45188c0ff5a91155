"""``gears plot RUN``: draw the pictures of a run again, or its noise figures."""

from __future__ import annotations

import argparse
from pathlib import Path

from fenics_gears.commands.shared import add_run_argument, loaded_run, plots, print_files, run_file
from fenics_gears.show import FACE_PICTURE_FILES, PICTURE_FILES

NOISE_FILES = "noise.png", "noise.nc"
AUTOMATIC, WINDOWS = "auto", ("auto", "none", "hann", "flat-top")


def add(commands, shared: argparse.ArgumentParser) -> None:
    """Add the command to the parser."""
    command = commands.add_parser(
        "plot", parents=[shared], help="draw the pictures of a run again, or its noise figures"
    )
    add_run_argument(command)
    command.add_argument(
        "-o", "--output", type=Path, metavar="DIR", help="folder to write into (default: beside run.nc)"
    )
    command.add_argument(
        "--spectrum", nargs="?", choices=WINDOWS, const=AUTOMATIC, metavar="WINDOW",
        help="draw and write levels in dB over mesh orders with the energy of their sidebands, of a speed ramp over "
            "the speed: noise.png, noise.nc and tables; "
        "WINDOW is none, hann or flat-top (default: none for whole mesh cycles, flat-top for a ramp)",
    )  # fmt: skip
    command.set_defaults(command=plot)


def plot(options: argparse.Namespace) -> int:
    """Draw a run's pictures."""
    from fenics_gears.system.output import check_writable

    file = run_file(options.run)
    directory = options.output or file.parent
    check_writable(directory, *((*PICTURE_FILES, *FACE_PICTURE_FILES) if options.spectrum is None else NOISE_FILES))
    dataset = loaded_run(file)
    files = (
        plots().draw_run(dataset, directory, shared=True)
        if options.spectrum is None
        else _noise(dataset, directory, options.spectrum)
    )
    print_files(files, options.quiet)
    return 0


def _noise(dataset, directory: Path, window: str) -> list[Path]:
    """The files of a run's noise figures."""
    from fenics_gears.extensions.noise.charts import noise_charts
    from fenics_gears.extensions.noise.figures import noise_figures
    from fenics_gears.results.curves_table import save_tables
    from fenics_gears.show.drawing import picture

    found, drawing = noise_figures(dataset, None if window == AUTOMATIC else window), plots()
    words = drawing.heading("Noise figures", str(dataset.attrs.get("title", "")), f"Window: {found.attrs['window']}")
    return [
        *save_tables(found, directory, "noise"),
        *drawing.save_figures({"noise.png": picture(words, noise_charts(found))}, directory),
    ]
