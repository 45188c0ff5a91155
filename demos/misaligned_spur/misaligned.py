"""The paper's spur pair on axes that are not parallel: line load without modification, with crowning and with end
relief."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from demos.arguments import output_directory

HERE = Path(__file__).parent
MISALIGNMENTS = (0.0, 0.010, 0.020, 0.030)
COLUMNS = ("misalignment (µm)", "flanks", "K_Hβ", "largest line load / even line load", "T_EPP (µm)")


def flanks() -> dict:
    """Lead modifications of the pinion, by their names."""
    from fenics_gears.geometry.lead_modification import EndRelief, LeadModification, LeadModifications

    return {
        "true": None,
        "crowned 10 µm": LeadModifications(pinion=LeadModification(crowning=0.010)),
        "end relief 10 µm over 4 mm": LeadModifications(pinion=LeadModification(end_relief=EndRelief(0.010, 4.0))),
    }


def row(misalignment: float, name: str, result) -> tuple[str, ...]:
    """A row of the table."""
    error = 1e3 * result.attrs["base_radius_wheel"] * result.attrs["peak_to_peak_transmission_error"]
    return (
        f"{1e3 * misalignment:g}",
        name,
        f"{result.attrs['face_load_factor']:.2f}",
        f"{result.attrs['largest_line_load_factor']:.2f}",
        f"{error:.1f}",
    )


def table(rows: list[tuple[str, ...]]) -> str:
    """The rows as a table in Markdown."""
    return "\n".join("| " + " | ".join(cells) + " |" for cells in (COLUMNS, ["---"] * len(COLUMNS), *rows))


def main(arguments: list[str] | None = None) -> None:
    """Run all; write `table.md` and `misaligned_spur.png`."""
    directory = output_directory("misaligned_spur", __doc__.splitlines()[0], arguments)
    from demos.misaligned_spur.picture import picture
    from fenics_gears import load_scene, simulate
    from fenics_gears.geometry.misalignment import Misalignment
    from fenics_gears.show.plots import save_figure

    directory.mkdir(parents=True, exist_ok=True)
    scene, results, rows = load_scene(HERE / "misaligned.toml"), {}, []
    for name, modifications in flanks().items():
        for misalignment in MISALIGNMENTS:
            result = simulate(
                replace(scene, misalignment=Misalignment(in_plane=misalignment), lead_modifications=modifications)
            )
            results[name, misalignment] = result
            rows.append(row(misalignment, name, result))
            print(rows[-1], flush=True)
    text = table(rows)
    (directory / "table.md").write_text(text + "\n", encoding="utf-8")
    save_figure(picture(results), directory / "misaligned_spur.png")
    print(text)


if __name__ == "__main__":
    main()
