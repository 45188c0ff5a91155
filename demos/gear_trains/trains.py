"""An idler whose third gear stands at several angles, a helical one, two stages that vibrate together at several
speeds, and two helical stages of an electric axle."""

from __future__ import annotations

from pathlib import Path

from demos.arguments import output_directory

HERE = Path(__file__).parent
# Of the third gear, deg: over somewhat more than a pitch of the idler (360/31 deg), after which all repeats.
FIRST_ANGLE = 60.0
ANGLES = 13
IDLER = "the idler"
# Of the first shaft, rpm.
SPEEDS = (300, 500, 750, 1000, 1300, 1600, 1800, 2000, 2200, 2600, 3000, 3600, 4300, 5000, 5600, 6000, 6500, 7500, 9000)


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
    """Run all trains; write their results and pictures, `idler_angle.png` and `two_stages_speed.png`."""
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
    for name in ("idler", "helical_idler", "two_stages", "electric_axle"):
        gears(["run", str(HERE / f"{name}.toml"), "-o", str(directory / name)])


if __name__ == "__main__":
    main()
