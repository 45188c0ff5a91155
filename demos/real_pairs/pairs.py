"""Three real pairs, each gear with an inertia of its own: quasi-static, and at speed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from demos.arguments import output_directory

HERE = Path(__file__).parent
SCENES = ("fzg_type_c", "ben_gurion_18_35", "meng_25_30")
COLUMNS = (
    "pair",
    "mesh frequency (Hz)",
    "J1 (kg mm²)",
    "J2 (kg mm²)",
    "mesh mode (Hz)",
    "T_EPP without inertia (µm)",
    "T_EPP at speed (µm)",
    "dynamic factor",
)


@dataclass(frozen=True)
class Pair:
    """A scene's results at speed and without inertia (datasets), and its row of the table."""

    at_speed: object
    static: object
    row: tuple[str, ...]


def measured(path: Path) -> Pair:
    """The last cycles of both runs of a scene; the dynamic factor is the largest force of a tooth pair over that
    without inertia."""
    from fenics_gears import load_scene, simulate
    from fenics_gears.model.drivetrain import lumped_gears
    from fenics_gears.model.model import model_of
    from fenics_gears.results import shown

    scene = load_scene(path)
    model = model_of(scene)
    at_speed = shown(simulate(scene))
    static = shown(simulate(replace(scene, inertia=None, damping=None, motion=replace(scene.motion, mesh_cycles=2))))
    inertias = [1e3 * gear.moment_of_inertia for gear in lumped_gears(scene, model.pair).values()]
    errors = [
        1e3 * model.pair.wheel.base_radius * run.attrs["peak_to_peak_transmission_error"] for run in (static, at_speed)
    ]
    forces = [float(run.pair_normal_force.max()) for run in (at_speed, static)]
    row = (
        scene.title, f"{scene.motion.mesh_frequency:.0f}", *(f"{each:.0f}" for each in inertias),
        f"{model.vibrations[-1].frequency:.0f}",
        *(f"{error:.3g}" for error in errors), f"{forces[0] / forces[1]:.3f}",
    )  # fmt: skip
    return Pair(at_speed, static, row)


def table(rows: list[tuple[str, ...]]) -> str:
    """The rows as a table in Markdown."""
    return "\n".join("| " + " | ".join(cells) + " |" for cells in (COLUMNS, ["---"] * len(COLUMNS), *rows))


def main(arguments: list[str] | None = None) -> None:
    """Run all three; write `table.md` and `real_pairs.png`."""
    directory = output_directory("real_pairs", __doc__.splitlines()[0], arguments)
    from demos.real_pairs.picture import picture

    directory.mkdir(parents=True, exist_ok=True)
    pairs = []
    for name in SCENES:
        pairs.append(measured(HERE / f"{name}.toml"))
        print(pairs[-1].row, flush=True)
    text = table([pair.row for pair in pairs])
    (directory / "table.md").write_text(text + "\n", encoding="utf-8")
    picture(pairs).savefig(directory / "real_pairs.png")
    print(f"{text}\n{directory}/table.md, {directory}/real_pairs.png")


if __name__ == "__main__":
    main()
