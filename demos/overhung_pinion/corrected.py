"""An input shaft whose pinion overhangs its bearings: true flanks, the correction that a run proposes, and the best one
over three torques with axes that scatter. Called by `run`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from demos.arguments import output_directory

HERE = Path(__file__).parent
SLOPE, CROWNING = (f"lead_modifications.pinion.{name}" for name in ("helix_slope", "crowning"))
FACTOR, ERROR = "face_load_factor", "peak_to_peak_transmission_error"


@dataclass(frozen=True)
class Flanks:
    """Flanks of the pinion: helix slope and crowning, um.

    On nominal axes face load factor and T_EPP (um) at each torque, and results by torque, N m; the mean of the factors
    over the torques (samples,) at misalignments (samples,), um, and the value that nine of ten stay below.
    """

    slope: float
    crowning: float
    factors: np.ndarray
    errors: np.ndarray
    results: dict
    misalignments: np.ndarray
    scattered: np.ndarray
    nine_of_ten: float

    def cells(self, name: str) -> tuple[str, ...]:
        """Its row of the table."""
        numbers = *(f"{each:.2f}" for each in self.factors), f"{self.nine_of_ten:.2f}"
        return name, f"{self.slope:.1f}", f"{self.crowning:.1f}", *numbers, *(f"{each:.1f}" for each in self.errors)


def compared(scene_file: Path, design_file: Path, directory: Path) -> tuple[dict[str, Flanks], float]:
    """The three flanks by name, and the mean inclination (um) of the axes in the plane of action with true ones."""
    from fenics_gears import load_scene, simulate
    from fenics_gears.extensions.optimization.conditions import samples
    from fenics_gears.extensions.optimization.evaluations import Evaluator
    from fenics_gears.extensions.optimization.optimize import optimize
    from fenics_gears.runs.team import Alone
    from fenics_gears.system.progress import Interruption, LineProgress

    true = simulate(load_scene(scene_file)).attrs
    found = optimize(design_file, directory / "search", LineProgress())
    amounts = {
        "true": (0.0, 0.0),
        "proposed by the run": (true["proposed_helix_slope"], true["proposed_crowning"]),
        "best over three torques": (found.chosen.values[SLOPE], found.chosen.values[CROWNING]),
    }
    designs, fresh = [dict(zip((SLOPE, CROWNING), each)) for each in amounts.values()], samples(found.design, True)
    with Interruption(LineProgress()) as progress:
        progress.stage("compare")
        evaluator = Evaluator(found.design, directory / "search" / "runs", Alone(), progress)
        nominal, scattered = (evaluator.of_designs(designs, each) for each in (np.zeros((1, fresh.shape[1])), fresh))
    limit = found.design.tolerances.scatters[0].limit
    torques = [float(str(value).split()[0]) for point in found.design.loads.points for value in point.values()]
    flanks = {
        name: Flanks(
            *each, at.at_points[FACTOR], at.at_points[ERROR], _results(load_scene(scene_file), torques, *each),
            limit * fresh[:, 0], around.of_samples[FACTOR], around.goals[FACTOR],
        )
        for (name, each), at, around in zip(amounts.items(), nominal, scattered)
    }  # fmt: skip
    return flanks, true["mean_axis_inclination_in_plane"]


def _results(scene, torques: list[float], slope: float, crowning: float) -> dict:
    """Results of a scene by torque, N m, with a helix slope and a crowning (um)."""
    from fenics_gears import simulate
    from fenics_gears.geometry.lead_modification import LeadModification, LeadModifications

    leads = LeadModifications(pinion=LeadModification(crowning=1e-3 * crowning, helix_slope=1e-3 * slope))
    corrected = replace(scene, lead_modifications=leads)
    return {each: simulate(replace(corrected, load=replace(scene.load, wheel_torque=1e3 * each))) for each in torques}


def table(flanks: dict[str, Flanks]) -> str:
    """The flanks as a table in Markdown."""
    torques = [f"{each:g} N m" for each in flanks["true"].results]
    head = [
        "flanks of the pinion", "helix slope (µm)", "crowning (µm)", *(f"K_Hβ at {each}" for each in torques),
        "nine of ten below", *(f"T_EPP at {each} (µm)" for each in torques),
    ]  # fmt: skip
    rows = [head, ["---"] * len(head), *(each.cells(name) for name, each in flanks.items())]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in rows)


def main(arguments: list[str] | None = None) -> None:
    """Run all; write `table.md`, `overhung_pinion.png` and the search."""
    directory = output_directory("overhung_pinion", __doc__.splitlines()[0], arguments)
    from demos.overhung_pinion.picture import picture
    from fenics_gears.show.plots import save_figure

    flanks, inclination = compared(HERE / "input_shaft.toml", HERE / "design.toml", directory)
    text = table(flanks)
    (directory / "table.md").write_text(text + "\n", encoding="utf-8")
    save_figure(picture(flanks), directory / "overhung_pinion.png")
    print(f"The pinion leans by {inclination:.1f} µm over the face.\n{text}")


if __name__ == "__main__":
    main()
