"""Three and four planets with a held and with a floating sun, one pin beside its place."""

from __future__ import annotations

from itertools import product
from pathlib import Path

from demos.arguments import output_directory

HERE = Path(__file__).parent
FINE = 'steps_per_mesh_cycle = 60\nflank_element_size = "0.059 mm"'
QUICK = 'steps_per_mesh_cycle = 36\nflank_element_size = "0.1 mm"'
# Teeth of sun, planet and ring, by the number of planets; FVA's set has three.
TEETH = {3: (17, 22, 61), 4: (18, 20, 58)}
# um
ERRORS = (0, 20, 40)
COLUMNS = ("planets", "sun", "pin error (µm)", "K_gamma", "largest pin force (kN)", "T_EPP (µrad of the carrier)")
Case = tuple[int, bool, int]


def scene_text(planets: int, floating: bool, error: int, accuracy: str = QUICK) -> str:
    """The scene with so many planets; `error`, um: of the first pin."""
    text = (HERE / "floating_sun.toml").read_text(encoding="utf-8").replace(FINE, accuracy)
    for name, old, new in zip(("sun", "planet", "ring"), TEETH[3], TEETH[planets]):
        text = text.replace(f"{name} = {{ teeth = {old}", f"{name} = {{ teeth = {new}")
    errors = ", ".join(f'"{each} um"' for each in (error, *(planets - 1) * (0,)))
    text = text.replace('"20 um", "0 um", "0 um"', errors).replace("planets = 3", f"planets = {planets}")
    return text if floating else text.replace('floating = ["sun"]', "")


def row(case: Case, result) -> tuple[str, ...]:
    """A row of the table."""
    planets, floating, error = case
    numbers = result.attrs
    return (
        f"{planets}",
        "floating" if floating else "held",
        f"{error}",
        f"{numbers['load_sharing_factor']:.3f}",
        f"{1e-3 * numbers['largest_pin_force']:.1f}",
        f"{1e6 * numbers['peak_to_peak_overall_transmission_error']:.1f}",
    )


def main(arguments: list[str] | None = None) -> None:
    """Run all; write `table.md`, `planetary_sets.png`, `wind_turbine.md` and `wind_turbine.png`."""
    directory = output_directory("planetary_sets", __doc__.splitlines()[0], arguments)
    from demos.planetary_sets import wind_turbine
    from demos.planetary_sets.picture import picture
    from fenics_gears import simulate_train, train_from_text
    from fenics_gears.show.plots import save_figure

    directory.mkdir(parents=True, exist_ok=True)
    cases = list(product(TEETH, (False, True), ERRORS))
    scenes = {case: train_from_text(scene_text(*case), "planets") for case in cases}
    results = {case: simulate_train(scene) for case, scene in scenes.items()}
    rows = [row(case, result) for case, result in results.items()]
    _write(directory / "table.md", COLUMNS, rows)
    save_figure(picture(scenes, results), directory / "planetary_sets.png")
    rows, figure = wind_turbine.wind_turbine()
    _write(directory / "wind_turbine.md", wind_turbine.COLUMNS, rows)
    save_figure(figure, directory / "wind_turbine.png")


def _write(file: Path, columns: tuple[str, ...], rows: list[tuple[str, ...]]) -> None:
    """Write a table, and print it."""
    text = "\n".join("| " + " | ".join(cells) + " |" for cells in (columns, ["---"] * len(columns), *rows))
    file.write_text(text + "\n", encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
