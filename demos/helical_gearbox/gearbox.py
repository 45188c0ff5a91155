"""A helical gear stage of a car: contact pattern and transmission error with and without misalignment and crowning."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from demos.arguments import output_directory

HERE = Path(__file__).parent
COLUMNS = (
    "flanks and axes",
    "T_EPP (µm)",
    "K_Hβ",
    "largest line load / even line load",
    "largest pressure off the edges (MPa)",
    "axial force (N)",
    "tilt of the wheel (µrad)",
)


def variants(scene) -> dict:
    """The scene as it is, and without its crowning, and without misalignment too."""
    uncrowned = replace(scene, lead_modifications=None)
    return {"aligned": replace(uncrowned, misalignment=None), "misaligned": uncrowned, "misaligned, crowned": scene}


def row(name: str, result) -> tuple[str, ...]:
    """A row of the table."""
    import numpy as np

    error = 1e3 * result.attrs["base_radius_wheel"] * result.attrs["peak_to_peak_transmission_error"]
    tilt = np.hypot(result.tilt_x.sel(gear="wheel"), result.tilt_y.sel(gear="wheel")).max()
    return (
        name, f"{error:.2f}", f"{result.attrs['face_load_factor']:.2f}",
        f"{result.attrs['largest_line_load_factor']:.2f}", f"{result.attrs['peak_contact_pressure']:.0f}",
        f"{float(abs(result.reaction_z).max()):.0f}", f"{1e6 * float(tilt):.0f}",
    )  # fmt: skip


def table(rows: list[tuple[str, ...]]) -> str:
    """The rows as a table in Markdown."""
    return "\n".join("| " + " | ".join(cells) + " |" for cells in (COLUMNS, ["---"] * len(COLUMNS), *rows))


def main(arguments: list[str] | None = None) -> None:
    """Run all variants; write `table.md` and `helical_gearbox.png`."""
    directory = output_directory("helical_gearbox", __doc__.splitlines()[0], arguments)
    from demos.helical_gearbox.picture import picture
    from fenics_gears import load_scene, simulate
    from fenics_gears.show.plots import save_figure

    directory.mkdir(parents=True, exist_ok=True)
    results, rows = {}, []
    for name, scene in variants(load_scene(HERE / "gearbox.toml")).items():
        results[name] = simulate(scene)
        rows.append(row(name, results[name]))
        print(rows[-1], flush=True)
    text = table(rows)
    (directory / "table.md").write_text(text + "\n", encoding="utf-8")
    save_figure(picture(results), directory / "helical_gearbox.png")
    print(text)


if __name__ == "__main__":
    main()
