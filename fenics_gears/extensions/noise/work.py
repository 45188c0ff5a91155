"""What ``gears listen`` and ``gears plot --spectrum`` do."""

import argparse
from pathlib import Path

from fenics_gears import SceneError, save_tables
from fenics_gears.charts import draw_charts
from fenics_gears.command_line import (
    check_writable,
    file_to_write,
    loaded_run,
    number_of_option,
    print_files,
    run_file,
    write_whole,
)

from .charts import noise_charts
from .command import AUTOMATIC
from .figures import noise_figures
from .sound import LOWEST_HEARD, OVERALL, fastest_mesh, save_sound, sound, train_sound
from .train_figures import train_charts, train_figures

LONGEST = 600.0
FORCE = "normal_force"
NOISE_FILES = "noise.png", "noise.nc"


def listen(options: argparse.Namespace) -> int:
    """Write the sound of a run."""
    file = run_file(options.run)
    if not 0.1 <= options.seconds <= LONGEST:
        raise SceneError(f"--seconds {options.seconds:g}: allowed are 0.1 to {LONGEST:g} seconds.")
    # Before the run is read: a place that cannot be written comes first.
    output = file_to_write(options, file.parent / f"{options.curve or FORCE}.wav", "the sound")
    result = loaded_run(file, trains=True)
    of_train = OVERALL in result
    if of_train and options.curve is None:
        options.curve = OVERALL
        output = file_to_write(options, file.parent / f"{OVERALL}.wav", "the sound")
    options.curve = options.curve or FORCE
    full_scale = _checked(result, options)
    try:
        heard = (train_sound if of_train else sound)(result, options.curve, options.seconds, full_scale)
    except ValueError as error:
        why = f"{error} in this run. Without inertia and friction the force is constant"
        raise SceneError(f"--curve {options.curve}: {why}: take --curve transmission_error.") from None
    print_files([write_whole(output, lambda path: save_sound(heard, path))], options.quiet)
    if not options.quiet:
        print(f"full scale {heard.full_scale:.4g} {result[options.curve].attrs['units']}")
    return 0


def _checked(result, options: argparse.Namespace) -> float | None:
    """The full scale in the curve's unit; None where none is given. Raises SceneError for a curve that is none, a run
    that is too slow to be heard, and a wrong unit."""
    curves = [name for name in result.data_vars if result[name].dims == ("time",) and result[name].dtype.kind == "f"]
    if options.curve not in curves:
        raise SceneError(f"--curve {options.curve}: is no curve of this run. Allowed: {', '.join(curves)}.")
    fastest = fastest_mesh(result)
    if fastest < LOWEST_HEARD:
        low = f"has a mesh frequency of {fastest:.3g} Hz, too low to hear (from {LOWEST_HEARD:g} Hz)"
        speeds = "motion.input_speed" if OVERALL in result else "motion.mesh_frequency or motion.pinion_speed"
        raise SceneError(f"{options.run}: {low}. Give the scene a higher {speeds}.")
    unit = result[options.curve].attrs["units"]
    return None if options.full_scale is None else number_of_option("--full-scale", options.full_scale, unit)


def plot_spectrum(options: argparse.Namespace) -> int:
    """Write a run's noise figures."""
    file = run_file(options.run)
    directory = options.output or file.parent
    check_writable(directory, *NOISE_FILES)
    result = loaded_run(file, trains=True)
    if OVERALL in result and options.spectrum not in (AUTOMATIC, "none"):
        raise SceneError(
            f"--spectrum {options.spectrum}: orders of a train are of whole cycles of each mesh, without a window."
            " Allowed: --spectrum alone."
        )
    print_files(_noise(result, directory, options.spectrum), options.quiet)
    return 0


def _noise(dataset, directory: Path, window: str) -> list[Path]:
    of_train = OVERALL in dataset
    figures = train_figures(dataset) if of_train else noise_figures(dataset, None if window == AUTOMATIC else window)
    charts = train_charts(figures) if of_train else noise_charts(figures)
    picture = {"noise.png": ("Noise figures", charts)}
    title = str(dataset.attrs.get("title", ""))
    more = f"Window: {figures.attrs['window']}"
    return [*save_tables(figures, directory, "noise"), *draw_charts(picture, directory, title, more)]
