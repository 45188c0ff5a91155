"""FVA's set with masses over its speed: how a floating sun shares the load, and moves aside, where its mass counts.

python -m demos.planetary_sets.in_time [DIR]
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from demos.arguments import output_directory
from matplotlib.figure import Figure

from fenics_gears.dynamics.planetary_modes import ROTATIONAL, TRANSLATIONAL, set_modes
from fenics_gears.model.planetary_frequencies import lumped_set
from fenics_gears.model.train import train_model_of
from fenics_gears.scene.train import TrainScene, train_from_text
from fenics_gears.show.panels import PALETTE, styled

SCENE = Path(__file__).parent / "in_time.toml"
# Mesh frequencies, Hz.
FREQUENCIES = tuple(range(100, 2401, 100))
STYLES = ("--", "-.", ":")
NUMBERS = (("load_sharing_factor", "K_gamma, sun"), ("orbit", "Sun off its place, most (µm)"))


def at(frequency: float, cycles: int = 24) -> TrainScene:
    """The set at a mesh frequency (Hz)."""
    text = SCENE.read_text(encoding="utf-8")
    speed = 60.0 * frequency / 17.0 * (17.0 + 61.0) / 61.0
    text = text.replace("5000 rpm", f"{speed!r} rpm").replace("mesh_cycles = 24", f"mesh_cycles = {cycles}")
    return train_from_text(text, "in_time", source=str(SCENE))


def numbers(result) -> dict[str, float]:
    """Of the last six mesh cycles."""
    steps = 6 * int(result["steps_per_mesh_cycle"][0])
    x, y = (result[f"member_{axis}"].values[-1 - steps :, 0] for axis in "xy")
    return {
        "load_sharing_factor": float(result.attrs["load_sharing_factor"]),
        "orbit": 1e3 * float(np.hypot(x, y).max()),
    }


def resonances() -> dict[tuple[str, int], list[float]]:
    """By kind of modes and harmonic of the mesh, the first three, mesh frequencies (Hz) at which it meets a mode that
    it moves by the phase law (Parker 2000)."""
    (row,) = train_model_of(at(FREQUENCIES[0])).rows
    modes = set_modes(lumped_set(row))
    law = row.shafts.carrier.set.phase_law(3)
    kinds = {"r": ROTATIONAL, "t": TRANSLATIONAL}
    return {
        (kinds[letter], harmonic): sorted(
            {round(each.frequency / harmonic, 3) for each in modes if each.kind == kinds[letter]}
        )
        for harmonic, letter in enumerate(law, 1)
    }


@styled
def picture(found: dict[float, dict[str, float]]) -> Figure:
    """Numbers by mesh frequency (Hz), over the mesh frequencies whose harmonics the phase law leads to a mode."""
    figure = Figure(figsize=(9.0, 6.0), layout="constrained")
    title = "FVA's set in time: a floating sun between three planets"
    figure.suptitle(title, x=0.012, ha="left", fontsize=14)
    parts = figure.subplots(2, 1, sharex=True)
    for axes, (name, words), colour in zip(parts, NUMBERS, PALETTE):
        axes.plot(list(found), [each[name] for each in found.values()], color=colour, marker="o", markersize=3)
        for (kind, harmonic), frequencies in resonances().items():
            within = [each for each in frequencies if min(found) < each < max(found)]
            for number, frequency in enumerate(within):
                label = f"harmonic {harmonic}, {kind} mode" if number == 0 else None
                axes.axvline(frequency, color="0.35", linestyle=STYLES[harmonic - 1], linewidth=1.0, label=label)
        axes.set_ylabel(words)
    parts[0].legend(loc="upper left", fontsize=9, frameon=True, framealpha=1.0)
    parts[1].set_xlabel("Mesh frequency (Hz)")
    return figure


def main(arguments: list[str] | None = None) -> None:
    """Run all speeds; print their numbers, and write `in_time.png`."""
    directory = output_directory("planetary_sets", __doc__.splitlines()[0], arguments)
    from fenics_gears import simulate_train
    from fenics_gears.show.plots import save_figure

    directory.mkdir(parents=True, exist_ok=True)
    found = {}
    for frequency in FREQUENCIES:
        found[frequency] = numbers(simulate_train(at(frequency)))
        print(f"{frequency} Hz: {found[frequency]}")
    save_figure(picture(found), directory / "in_time.png")


if __name__ == "__main__":
    main()
