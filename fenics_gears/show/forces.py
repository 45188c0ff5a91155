"""Charts of the forces: of the mesh, of each tooth pair, and their reactions on the shafts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fenics_gears.show.chart import Chart, over_time
from fenics_gears.show.panels import DARK, PALETTE
from fenics_gears.show.run import Run

COAST_NOTE = "Coast flanks are drawn downwards."
SHARES_UNKNOWN = "Where several rigid pairs touch at once their shares are not determined."
# Smallest span that an axis shows, in parts of the largest value.
LEAST_SHARE = 0.02


def force_charts(run: Run) -> list[Chart]:
    """All forces that the result has."""
    return [*mesh_forces(run), *pair_forces(run), *_reactions(run), *_openings(run)]


def least(values: np.ndarray) -> float:
    """Smallest span that an axis shows of values of this size, so that round-off fills no chart; 1 for nothing but zeros."""
    finite = np.abs(values[np.isfinite(values)])
    return LEAST_SHARE * float(finite.max(initial=0.0)) or 1.0


def mesh_forces(run: Run) -> list[Chart]:
    """Normal and friction force of the mesh, on either side of the teeth."""
    if "normal_force" not in run.dataset:
        return []
    drive = run.values("normal_force", "N")
    curves, note = [("normal force", drive, PALETTE[0])], ""
    if "coast_normal_force" in run.dataset:
        curves = [("drive flanks", drive, PALETTE[0]), ("coast flanks (drawn downwards)", -run.values("coast_normal_force", "N"), PALETTE[1])]
        note = COAST_NOTE
    charts = [_of_size(run, "Normal force of the mesh", "Normal force (N)", curves, note=note)]
    names = {"friction_force": "drive flanks", "coast_friction_force": "coast flanks"}
    rubbing = [(words, run.values(name, "N"), colour) for (name, words), colour in zip(names.items(), PALETTE) if name in run.dataset]
    return charts + [_of_size(run, "Friction force of the mesh", "Friction force (N)", rubbing)] if rubbing else charts


def pair_forces(run: Run) -> Iterator[Chart]:
    """Shares of the tooth pairs in normal and in friction force."""
    for name, caption in (("pair_normal_force", "Load sharing: normal force of each tooth pair"), ("pair_friction_force", "Friction force of each tooth pair")):
        if name not in run.dataset:
            continue
        curves = [(words, values, PALETTE[number % len(PALETTE)]) for words, values, number in run.of_pairs(name, "N")]
        note = SHARES_UNKNOWN if np.isnan(run.dataset[name].values).any() else ""
        if name == "pair_normal_force":
            coast = run.of_pairs("pair_coast_normal_force", "N") if "pair_coast_normal_force" in run.dataset else []
            curves += [(f"{words}, coast flanks", -values, PALETTE[number % len(PALETTE)]) for words, values, number in coast]
            note = f"{COAST_NOTE} {note}".strip() if coast else note
            # First, so that the pairs are drawn upon it.
            curves.insert(0, ("all drive flanks" if coast else "all pairs", run.values("normal_force", "N"), DARK))
        if curves:
            yield _of_size(run, caption, "Force (N)", curves, note=note, height=380)


def shaft_torques(run: Run) -> list[Chart]:
    """Torque of either gear on its shaft."""
    if "reaction_couple" not in run.dataset:
        return []
    return [of_gears(run, "reaction_couple", "N m", "Torque of either gear on its shaft", "Torque")]


def _reactions(run: Run) -> list[Chart]:
    charts = []
    for name, words in {"reaction_x": "along", "reaction_y": "off"}.items():
        if name in run.dataset and (words == "along" or "friction_force" in run.dataset):
            charts.append(of_gears(run, name, "N", f"Reaction of either gear on its shaft {words} the line of action", "Force"))
    return charts + shaft_torques(run)


def _openings(run: Run) -> list[Chart]:
    names = {"drive_flank_opening": "drive flanks", "coast_flank_opening": "coast flanks"}
    curves = [(words, run.values(name, "µm"), colour) for (name, words), colour in zip(names.items(), PALETTE) if name in run.dataset]
    return [over_time(run, "Smallest distance of the flanks", "Distance (µm)", curves, least=0.1)] if curves else []


def of_gears(run: Run, name: str, unit: str, caption: str, what: str, smallest: float = 0.0) -> Chart:
    """A variable of both gears."""
    values = run.values(name, unit)
    curves = [(str(gear), each, colour) for gear, each, colour in zip(run.dataset["gear"].values, values.T, PALETTE[2:4])]
    return over_time(run, caption, f"{what} ({unit})", curves, least=smallest or least(values), height=240)


def _of_size(run: Run, caption: str, y_title: str, curves: list, height: int = 240, **options) -> Chart:
    together = np.concatenate([values for _, values, _ in curves])
    return over_time(run, caption, y_title, curves, least=least(together), height=height, **options)
