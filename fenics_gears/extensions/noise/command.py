"""``gears listen RUN``: a curve of a run as an audio file; an engineer hears orders."""

from __future__ import annotations

import argparse
from pathlib import Path

from fenics_gears.commands.shared import add_run_argument, loaded_run, print_files, run_file
from fenics_gears.errors import SceneError
from fenics_gears.inputs import units

SECONDS, LONGEST = 5.0, 600.0


def add(commands, shared: argparse.ArgumentParser) -> None:
    """Add the command to the parser."""
    command = commands.add_parser("listen", parents=[shared], help="write a curve of a run as sound (WAV)")
    add_run_argument(command)
    command.add_argument(
        "--curve",
        default="normal_force",
        metavar="NAME",
        help="variable over time to hear (default: normal_force, the mesh force)",
    )
    command.add_argument(
        "--seconds",
        type=float,
        default=SECONDS,
        metavar="N",
        help=f"length of a steady run's sound (default: {SECONDS:g}); a speed ramp is heard once",
    )
    command.add_argument(
        "--full-scale",
        metavar="VALUE",
        help=(
            'value of the curve at which the file is full, such as "500 N", so that two runs can be compared by ear'
            " (default: from the loudest sample)"
        ),
    )
    command.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help="file to write (default: CURVE.wav beside run.nc)"
    )
    command.set_defaults(command=listen)


def listen(options: argparse.Namespace) -> int:
    """Write the sound of a run."""
    from fenics_gears.system.output import check_writable, write_whole

    file = run_file(options.run)
    output = options.output or file.parent / f"{options.curve}.wav"
    if output.suffix != ".wav":
        raise SceneError(f"{output}: the sound is a .wav file; give --output such a name.")
    if not 0.1 <= options.seconds <= LONGEST:
        raise SceneError(f"--seconds {options.seconds:g}: allowed are 0.1 to {LONGEST:g} seconds.")
    check_writable(output.parent, output.name)
    result = loaded_run(file)
    full_scale = _checked(result, options)
    from fenics_gears.extensions.noise.sound import save_sound, sound

    try:
        heard = sound(result, options.curve, options.seconds, full_scale)
    except ValueError as error:
        raise SceneError(
            f"--curve {options.curve}: {error} in this run, so there is nothing to hear. A quasi-static run without"
            " friction has a constant force; its transmission error is heard with --curve transmission_error."
        ) from None
    print_files([write_whole(output, lambda path: save_sound(heard, path))], options.quiet)
    if not options.quiet:
        print(f"full scale {heard.full_scale:.4g} {result[options.curve].attrs['units']}")
    return 0


def _checked(result, options: argparse.Namespace) -> float | None:
    """The full scale in the curve's unit; None where none is given. Raises SceneError for a curve that is none, a run
    that is too slow to be heard, and a wrong unit."""
    from fenics_gears.extensions.noise.sound import LOWEST_HEARD

    curves = [name for name in result.data_vars if result[name].dims == ("time",) and result[name].dtype.kind == "f"]
    if options.curve not in curves:
        raise SceneError(f"--curve {options.curve}: is no curve of this run. Allowed: {', '.join(curves)}.")
    phase, time = result["mesh_phase"].values, result["time"].values
    fastest = abs(phase[-1] - phase[0]) / (time[-1] - time[0]) if len(time) > 1 else 0.0
    if fastest < LOWEST_HEARD:
        raise SceneError(
            f"{options.run}: has a mesh frequency of {fastest:.3g} Hz, too low to hear (from {LOWEST_HEARD:g} Hz). Give"
            " the scene a motion.mesh_frequency or motion.pinion_speed."
        )
    if options.full_scale is None:
        return None
    unit = result[options.curve].attrs["units"]
    try:
        value, kind = units.quantity(options.full_scale)
        wanted = units.quantity(f"1 {unit}")[1]
    except units.QuantityError as error:
        raise SceneError(f'--full-scale "{options.full_scale}": {error}') from None
    if kind != wanted or not value > 0.0:
        raise SceneError(
            f'--full-scale "{options.full_scale}": allowed is {wanted} greater than zero, such as "1 {unit}".'
        )
    return value
