"""An idler whose third gear stands at several angles, a helical one, two stages that vibrate together at several
speeds, two paths whose shafts are clocked, two helical stages of an electric axle, and a gearbox with its oil pump."""

from __future__ import annotations

from pathlib import Path

from demos.arguments import output_directory

HERE = Path(__file__).parent
# Of the third gear, deg: over somewhat more than a pitch of the idler (360/31 deg), after which all repeats.
FIRST_ANGLE = 60.0
ANGLES = 13
IDLER = "the idler"
PUMP = "240 N m on the main output, 12 N m on the pump, whose wheel runs out by 40 µm"
# Of the first shaft, rpm.
SPEEDS = (300, 500, 750, 1000, 1300, 1600, 1800, 2000, 2200, 2600, 3000, 3600, 4300, 5000, 5600, 6000, 6500, 7500, 9000)

# Of the lower path's shaft, mrad.
CLOCKINGS = (-20.0, -13.3, -8.0, -4.0, -0.8, 0.0, 0.8, 4.0, 8.0, 13.3, 20.0)


def angles(teeth: int, count: int = ANGLES) -> list[float]:
    """Directions (deg) of the third gear over a pitch of an idler of so many teeth, both ends included."""
    return [FIRST_ANGLE + 360.0 / teeth * number / (count - 1) for number in range(count)]


def at_angle(text: str, angle: float) -> str:
    """The scene's text with its third gear in another direction."""
    return text.replace('"60 deg"', f'"{angle!r} deg"')


def over_angles(directory: Path, text: str, directions: list[float]) -> list[float]:
    """Overall transmission error, peak to peak, µrad of the last gear, for the third gear in each direction (deg)."""
    from fenics_gears import load_train, simulate_train

    found = []
    scene = directory / "idler_at_angle.toml"
    for angle in directions:
        scene.write_text(at_angle(text, angle), encoding="utf-8")
        result = simulate_train(load_train(scene))
        found.append(1e6 * result.attrs["peak_to_peak_overall_transmission_error"])
        print(f"{angle:.2f} deg: {found[-1]:.1f} µrad", flush=True)
    scene.unlink()
    return found


def chart(directions: list[float], errors: list[float]):
    """Peak-to-peak overall transmission error over the angle of the third gear."""
    over = f"over a pitch of {IDLER}"
    return _peaks(over, "Direction of the third gear from the idler (deg)", directions, errors)


def at_speed(text: str, speed: float) -> str:
    """The scene's text with its first shaft at another speed (rpm)."""
    return text.replace('"3000 rpm"', f'"{speed!r} rpm"')


def over_speeds(text: str, speeds: tuple[float, ...]) -> list[float]:
    """Overall transmission error, peak to peak, µrad of the last gear, at each speed (rpm) of the first shaft."""
    from fenics_gears import simulate_train, train_from_text

    found = []
    for speed in speeds:
        result = simulate_train(train_from_text(at_speed(text, speed)))
        found.append(1e6 * result.attrs["peak_to_peak_overall_transmission_error"])
        print(f"{speed:g} rpm: {found[-1]:.1f} µrad", flush=True)
    return found


def chart_of_speeds(speeds: tuple[float, ...], errors: list[float]):
    """Peak-to-peak overall transmission error over the speed of the first shaft."""
    return _peaks("over the speed", "Speed of the first shaft (rpm)", list(speeds), errors)


def clocked(text: str, clocking: float) -> str:
    """The scene's text with its lower shaft turned ahead by so much (mrad)."""
    return text.replace('"0.0008 rad"', f'"{clocking!r} mrad"')


def over_clockings(text: str, clockings: tuple[float, ...]) -> list[float]:
    """Mean share of the torque, in per cent, of the lower path at each clocking (mrad)."""
    from fenics_gears import simulate_train, train_from_text

    found = []
    for clocking in clockings:
        result = simulate_train(train_from_text(clocked(text, clocking)))
        found.append(100.0 * float(result["mean_path_share"].sel(mesh="lower")))
        print(f"{clocking:g} mrad: {found[-1]:.2f} %", flush=True)
    return found


def chart_of_clockings(clockings: tuple[float, ...], shares: list[float]):
    """Shares of both paths over the clocking of one."""
    import numpy as np

    from fenics_gears.charts import MARKED_LINES, PALETTE, Chart, Curve

    places = np.array(clockings)
    lower = np.array(shares)
    both = ("lower path, which is clocked", lower, PALETTE[1]), ("upper path", 100.0 - lower, PALETTE[0])
    return Chart(
        "How both paths share the torque",
        [Curve(name, places, values, colour, mode=MARKED_LINES) for name, values, colour in both],
        "Clocking of the lower shaft (mrad)",
        "Share of the torque (%)",
        y_range=(0.0, 105.0),
        height=320,
    )


def lags_of_outputs(run: Path):
    """Lags of both shafts that drive no gear, in the result of a run."""
    from fenics_gears import carried_train, load
    from fenics_gears.shown import train_errors

    found = load(run / "run.nc")
    return train_errors(carried_train(found), found)[1]


def _peaks(over: str, axis: str, places: list[float], errors: list[float]):
    import numpy as np

    from fenics_gears.charts import MARKED_LINES, Chart, Curve

    curve = Curve("peak to peak", np.array(places, dtype=float), np.array(errors), mode=MARKED_LINES)
    return Chart(
        f"Peak to peak {over}: {min(errors):.3g} to {max(errors):.3g} µrad",
        [curve],
        axis,
        "Overall transmission error (µrad)",
        y_range=(0.0, 1.1 * max(errors)),
        height=320,
    )


def main(arguments: list[str] | None = None) -> None:
    """Run all trains; write their results and pictures, `idler_angle.png`, `two_stages_speed.png`,
    `split_torque_clocking.png` and `two_outputs_lags.png`."""
    directory = output_directory("gear_trains", __doc__.splitlines()[0], arguments)
    from fenics_gears.charts import draw_charts
    from fenics_gears.commands.cli import main as gears

    directory.mkdir(parents=True, exist_ok=True)
    text = (HERE / "idler.toml").read_text(encoding="utf-8")
    directions = angles(31)
    errors = over_angles(directory, text, directions)
    subject = "Overall transmission error", [chart(directions, errors)]
    draw_charts({"idler_angle.png": subject}, directory, "gears of 24, 31 and 40 teeth in a row, 300 N m on the last")
    text = (HERE / "two_stages.toml").read_text(encoding="utf-8")
    subject = "Overall transmission error", [chart_of_speeds(SPEEDS, over_speeds(text, SPEEDS))]
    draw_charts({"two_stages_speed.png": subject}, directory, "two stages with masses and shafts that twist, 1 kN m")
    text = (HERE / "split_torque.toml").read_text(encoding="utf-8")
    subject = "Split torque", [chart_of_clockings(CLOCKINGS, over_clockings(text, CLOCKINGS))]
    draw_charts({"split_torque_clocking.png": subject}, directory, "367 N m on the pinion of 32 teeth, two paths")
    for name in ("idler", "helical_idler", "two_stages", "split_torque", "electric_axle", "two_outputs"):
        gears(["run", str(HERE / f"{name}.toml"), "-o", str(directory / name)])
    draw_charts({"two_outputs_lags.png": ("Lags", [lags_of_outputs(directory / "two_outputs")])}, directory, PUMP)


if __name__ == "__main__":
    main()
