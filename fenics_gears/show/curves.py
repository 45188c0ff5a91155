"""Curves over the recorded mesh cycles: transmission error, mesh forces, load sharing between tooth pairs.

Each function takes a result (docs/result.md) and returns a Figure, or None where the result has nothing to show in it.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fenics_gears.results.pairs import lives, shown
from fenics_gears.show.panels import DARK, GREY, PALETTE, legend, limits, panels, styled
from fenics_gears.show.units import factor, in_unit

# Smallest spans shown. Contact is solved to 1e-4 um and 1e-6 of the transmitted force; what is smaller is no curve.
LEAST_LENGTH = 0.1  # um
LEAST_SHARE = 0.02  # of the largest value


@styled
def transmission_error(dataset: xr.Dataset) -> Figure | None:
    """Transmission error in µrad and, as length on the wheel's base circle, in µm; below it the wheel's sideways motion."""
    if "transmission_error" not in dataset:
        return None
    dataset = shown(dataset)
    below = "centre_y" in dataset
    figure, axes = panels(dataset, "Transmission error", [3.6, 2.2] if below else [4.4])
    _draw_transmission_error(axes[0], dataset)
    if below:
        _draw_off_line_motion(axes[1], dataset)
    return figure


def _draw_transmission_error(axes: Axes, dataset: xr.Dataset) -> None:
    variable = dataset["transmission_error"]
    error = in_unit(variable, "µrad")
    axes.plot(dataset["mesh_phase"].values, error, color=PALETTE[0])
    peak_to_peak, over = np.ptp(error), " of what is stored"
    if dataset.attrs.get("complete", 1) and "peak_to_peak_transmission_error" in dataset.attrs:
        peak_to_peak, over = dataset.attrs["peak_to_peak_transmission_error"] * factor("rad", "µrad"), ""
    spelled = f"{_four_digits(peak_to_peak)} µrad"
    axes.set_ylabel("Transmission error (µrad)")
    axes.set_ylim(*limits(error, LEAST_SHARE * np.abs(error).max()))
    radius = dataset.attrs.get("base_radius_wheel")
    if radius:
        per_microradian = radius * factor("mm", "µm") / factor("rad", "µrad")
        spelled += f" = {_four_digits(peak_to_peak * per_microradian)} µm on the wheel's base circle"
        length = axes.secondary_yaxis("right", functions=(lambda e: e * per_microradian, lambda e: e / per_microradian))
        length.set_ylabel("On the wheel's base circle (µm)")
    axes.set_title(f"Peak to peak{over} {spelled}")


def _four_digits(value: float) -> str:
    return f"{value:#.4g}".rstrip(".")


def _draw_off_line_motion(axes: Axes, dataset: xr.Dataset) -> None:
    motion = in_unit(dataset["centre_y"].sel(gear="wheel"), "µm")
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.plot(dataset["mesh_phase"].values, motion, color=PALETTE[1])
    axes.set_title("Displacement of the wheel's shaft off the line of action")
    axes.set_ylabel("Displacement (µm)")
    axes.set_ylim(*limits(motion, LEAST_LENGTH))


@styled
def mesh_forces(dataset: xr.Dataset) -> Figure | None:
    """Normal force, friction force and the couples that the gears put on their shafts, one panel each."""
    drawings = {
        "normal_force": _draw_normal_force,
        "friction_force": _draw_friction_force,
        "reaction_couple": _draw_couples,
    }
    there = [name for name in drawings if name in dataset]
    if not there:
        return None
    dataset = shown(dataset)
    figure, axes = panels(dataset, "Mesh forces", [2.2] * len(there) if len(there) > 1 else [4.4])
    for each, name in zip(axes, there):
        drawings[name](each, dataset)
    return figure


def _draw_normal_force(axes: Axes, dataset: xr.Dataset) -> None:
    if "coast_normal_force" in dataset:
        drive, coast = in_unit(dataset["normal_force"], "N"), in_unit(dataset["coast_normal_force"], "N")
        axes.axhline(0.0, color=GREY, linewidth=0.8)
        axes.plot(dataset["mesh_phase"].values, drive, color=PALETTE[0], label="drive flanks")
        axes.plot(dataset["mesh_phase"].values, -coast, color=PALETTE[1], label="coast flanks (drawn downwards)")
        axes.set_title("Normal force of the mesh")
        axes.set_ylabel("Normal force (N)")
        both = np.concatenate([drive, -coast])
        axes.set_ylim(*limits(both, _least(both)))
        legend(axes, columns=2)
        return
    _draw_force(axes, dataset, "normal_force", PALETTE[0])
    axes.set_title("Along the line of action: normal force of the mesh = reaction of either shaft")
    axes.set_ylabel("Normal force (N)")


def _draw_friction_force(axes: Axes, dataset: xr.Dataset) -> None:
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.set_ylabel("Friction force (N)")
    if "coast_friction_force" not in dataset:
        _draw_force(axes, dataset, "friction_force", PALETTE[1])
        alone = "coast_normal_force" not in dataset
        axes.set_title("Off the line of action: friction force of the mesh = reaction of either shaft" if alone else "Friction force of the drive flanks")
        return
    both = [in_unit(dataset[name], "N") for name in ("friction_force", "coast_friction_force")]
    for force, colour, label in zip(both, PALETTE, ("drive flanks", "coast flanks")):
        axes.plot(dataset["mesh_phase"].values, force, color=colour, label=label)
    axes.set_title("Friction force of the mesh")
    axes.set_ylim(*limits(np.concatenate(both), _least(np.concatenate(both))))
    legend(axes, columns=2)


def _draw_force(axes: Axes, dataset: xr.Dataset, name: str, colour: str) -> None:
    force = in_unit(dataset[name], "N")
    axes.plot(dataset["mesh_phase"].values, force, color=colour)
    axes.set_ylim(*limits(force, _least(force)))


def _draw_couples(axes: Axes, dataset: xr.Dataset) -> None:
    couples = in_unit(dataset["reaction_couple"].transpose("time", "gear"), "N m")
    for gear, couple, colour in zip(dataset["gear"].values, couples.T, (PALETTE[2], PALETTE[3])):
        axes.plot(dataset["mesh_phase"].values, couple, color=colour, label=str(gear))
    axes.set_title("Reaction couple of either gear on its shaft")
    axes.set_ylabel("Couple (N m)")
    axes.set_ylim(*limits(couples, _least(couples)))
    legend(axes, columns=2)


@styled
def load_sharing(dataset: xr.Dataset) -> Figure | None:
    """Normal force of each tooth pair that carries, and their sum; on the coast flanks downwards."""
    if "pair_normal_force" not in dataset:
        return None
    dataset = shown(dataset)
    figure, (axes,) = panels(dataset, "Load sharing between tooth pairs", [4.6])
    phase = dataset["mesh_phase"].values
    forces = dataset["pair_normal_force"].values
    total = in_unit(dataset["normal_force"], "N")
    if np.isnan(forces).any():
        axes.set_title("Rigid flanks: where two pairs touch at once their shares are not determined", pad=30.0)
    axes.plot(phase, total, color=DARK, linewidth=1.4, linestyle=(0, (4, 2)), label="all pairs" if "pair_coast_normal_force" not in dataset else "all drive flanks", zorder=3)
    for number, steps, force in pair_curves(dataset, "pair_normal_force"):
        if np.any(force != 0.0):
            axes.plot(phase[steps], _while_carrying(force), color=PALETTE[number % len(PALETTE)], label=f"pair {number}")
    lowest = 0.0
    if "pair_coast_normal_force" in dataset:
        lowest = -float(in_unit(dataset["coast_normal_force"], "N").max())
        for number, steps, force in pair_curves(dataset, "pair_coast_normal_force"):
            if np.any(force != 0.0):
                axes.plot(phase[steps], -_while_carrying(force), color=PALETTE[number % len(PALETTE)], linestyle=":", label=f"coast flank {number}")
        axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.set_ylabel("Normal force (N)")
    if not total.any() and lowest == 0.0:
        axes.set_title("No tooth pair carries")
    highest = float(total.max())
    axes.set_ylim(1.06 * lowest, max(1.06 * highest, -0.06 * lowest) or 1.0)
    legend(axes, columns=6 if lowest == 0.0 else 5, location="lower left")
    return figure


def pair_curves(dataset: xr.Dataset, name: str) -> Iterator[tuple[int, slice, np.ndarray]]:
    """Number, steps and force (N) of each tooth pair while it is in reach, and a zero on either side."""
    forces = in_unit(dataset[name].transpose("time", "slot"), "N")
    for life in lives(dataset["pair_number"].values):
        steps = slice(max(life.steps.start - 1, 0), min(life.steps.stop + 1, len(forces)))
        force = np.zeros(steps.stop - steps.start)
        force[life.steps.start - steps.start : life.steps.stop - steps.start] = forces[life.steps, life.slot]
        yield life.number, steps, force


def _while_carrying(force: np.ndarray) -> np.ndarray:
    """The force (n,) with NaN where the pair carries nothing, but for the zeros that its curve begins and ends with."""
    carries = force != 0.0
    near = carries.copy()
    near[1:] |= carries[:-1]
    near[:-1] |= carries[1:]
    return np.where(near, force, np.nan)


def _least(force: np.ndarray) -> float:
    """Smallest span of a force's axis; a force that is zero throughout gets one that shows so."""
    return LEAST_SHARE * float(np.abs(force).max()) or 1.0
