"""A planet in its ring, the ring's rim held or on springs of several stiffnesses."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from demos.arguments import output_directory

HERE = Path(__file__).parent
# N/mm^3, radial and tangential; None: held.
STIFFNESSES = (None, 5000.0, 1000.0, 200.0)
COLUMNS = ("springs (N/mm³)", "mean T_E (µm)", "T_EPP (µm)", "mesh stiffness (N/(mm µm))")


def supported(scene, stiffness: float | None):
    """The scene with its ring held, or on springs."""
    from fenics_gears.geometry.gear_data import RingSupport

    support = RingSupport("held") if stiffness is None else RingSupport("foundation", stiffness, stiffness)
    return replace(scene, gears=replace(scene.gears, wheel=replace(scene.gears.wheel, support=support)))


def row(stiffness: float | None, result) -> tuple[str, ...]:
    """A row of the table."""
    numbers = result.attrs
    length = 1e3 * numbers["base_radius_wheel"]
    width = 50.0
    return (
        words_of(stiffness),
        f"{length * numbers['mean_transmission_error']:.1f}",
        f"{length * numbers['peak_to_peak_transmission_error']:.2f}",
        f"{1e-3 * float(result.mesh_stiffness.mean()) / width:.1f}",
    )


def words_of(stiffness: float | None) -> str:
    """A support in words."""
    return "held" if stiffness is None else f"{stiffness:g}"


def main(arguments: list[str] | None = None) -> None:
    """Run all; write `table.md` and `internal_gears.png`."""
    directory = output_directory("internal_gears", __doc__.splitlines()[0], arguments)
    from demos.internal_gears.picture import picture
    from fenics_gears import load_scene, simulate
    from fenics_gears.show.plots import save_figure

    directory.mkdir(parents=True, exist_ok=True)
    scene = load_scene(HERE / "planet_in_ring.toml")
    results = {stiffness: simulate(supported(scene, stiffness)) for stiffness in STIFFNESSES}
    rows = [row(stiffness, result) for stiffness, result in results.items()]
    text = "\n".join("| " + " | ".join(cells) + " |" for cells in (COLUMNS, ["---"] * len(COLUMNS), *rows))
    (directory / "table.md").write_text(text + "\n", encoding="utf-8")
    save_figure(picture(scene, results), directory / "internal_gears.png")
    print(text)


if __name__ == "__main__":
    main()
