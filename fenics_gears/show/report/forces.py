"""Forces: of the mesh, of each tooth pair, and what they ask of the shafts."""

from __future__ import annotations

import numpy as np
import xarray as xr

from fenics_gears.show.curves import LEAST_LENGTH, LEAST_SHARE
from fenics_gears.show.panels import DARK, PALETTE
from fenics_gears.show.report.page import Plot, Section, Words
from fenics_gears.show.report.plotting import over_time
from fenics_gears.show.report.run import TOO_FEW, Run
from fenics_gears.show.units import in_unit

# More pairs than this share their curves with those that come so many pairs later.
NAMED_PAIRS = 6
COAST_NOTE = "Coast flanks are drawn downwards."


def forces(run: Run) -> Section:
    """Curves of all forces that the result has."""
    if not run.has_curves:
        return Section("forces", "Forces", [Words(TOO_FEW, warns=True)])
    dataset = run.dataset
    plots = [_normal(dataset), *_friction(dataset), *_pairs(dataset), *_reactions(dataset), *_openings(dataset)]
    return Section("forces", "Forces", plots)


def least(values: np.ndarray) -> float:
    """Smallest span that an axis shows of values of this size, so that round-off fills no plot; 1 for nothing but zeros."""
    finite = np.abs(values[np.isfinite(values)])
    return LEAST_SHARE * float(finite.max(initial=0.0)) or 1.0


def _normal(dataset: xr.Dataset) -> Plot:
    drive = in_unit(dataset["normal_force"], "N")
    if "coast_normal_force" not in dataset:
        return over_time(dataset, "Normal force of the mesh", "Normal force (N)", [("normal force", drive, PALETTE[0])], least=least(drive))
    coast = -in_unit(dataset["coast_normal_force"], "N")
    curves = [("drive flanks", drive, PALETTE[0]), ("coast flanks", coast, PALETTE[1])]
    return over_time(dataset, "Normal force of the mesh", "Normal force (N)", curves, least=least(np.append(drive, coast)), note=COAST_NOTE)


def _friction(dataset: xr.Dataset) -> list[Plot]:
    names = {"friction_force": "drive flanks", "coast_friction_force": "coast flanks"}
    curves = [(words, in_unit(dataset[name], "N"), colour) for (name, words), colour in zip(names.items(), PALETTE) if name in dataset]
    if not curves:
        return []
    return [
        over_time(
            dataset,
            "Friction force of the mesh",
            "Friction force (N)",
            curves,
            least=least(np.concatenate([each for _, each, _ in curves])),
        )
    ]


def _pairs(dataset: xr.Dataset) -> list[Plot]:
    """Shares of the tooth pairs in normal and in friction force."""
    plots = []
    for names, caption, total in (
        (("pair_normal_force", "pair_coast_normal_force"), "Load sharing: normal force of each tooth pair", "normal_force"),
        (("pair_friction_force",), "Friction force of each tooth pair", None),
    ):
        if names[0] not in dataset:
            continue
        curves = pair_curves(dataset, names[0])
        note = (
            "Where several rigid pairs touch at once their shares are not determined." if np.isnan(dataset[names[0]].values).any() else ""
        )
        if names[-1] != names[0] and names[-1] in dataset:
            coast = [(f"coast flank of {name}", -values, colour) for name, values, colour in pair_curves(dataset, names[-1])]
            curves, note = curves + coast, f"{COAST_NOTE} {note}".strip() if coast else note
        if total:
            # First, so that the pairs are drawn upon it.
            curves.insert(0, ("all drive flanks", in_unit(dataset[total], "N"), DARK))
        if curves:
            together = np.concatenate([each for _, each, _ in curves])
            plots.append(over_time(dataset, caption, "Force (N)", curves, least=least(together), note=note, height=340))
    return plots


def pair_curves(dataset: xr.Dataset, name: str) -> list[tuple[str, np.ndarray, str]]:
    """A curve of name, values (time,) and colour for each pair that carries, not a number where it does not; of many pairs every n-th
    shares a curve with the others of its turn, n being so many that they are never in contact together."""
    return shared_curves(dataset["pair"].values, in_unit(dataset[name].transpose("time", "pair"), "N"))


def shared_curves(numbers: np.ndarray, values: np.ndarray) -> list[tuple[str, np.ndarray, str]]:
    """The same for any values (time, pair) that are zero or not a number where a pair has none."""
    there = np.isfinite(values) & (values != 0.0)
    numbers, values, there = numbers[there.any(axis=0)], values[:, there.any(axis=0)], there[:, there.any(axis=0)]
    shown = _with_ends(there, values)
    if len(numbers) <= NAMED_PAIRS:
        return [(f"pair {number}", column, PALETTE[number % len(PALETTE)]) for number, column in zip(numbers, shown.T)]
    together = np.isfinite(shown).sum(axis=1).max(initial=1)
    turn = int(max(4, together + 1))
    curves = []
    for first in numbers[:turn]:
        own = (numbers - first) % turn == 0
        group = shown[:, own]
        one = np.where(np.isfinite(group).any(axis=1), np.nansum(group, axis=1), np.nan)
        listed = ", ".join(map(str, numbers[own][:3]))
        curves.append((f"pairs {listed}{', …' if own.sum() > 3 else ''}", one, PALETTE[first % len(PALETTE)]))
    return curves


def _with_ends(there: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The values (time, pair) where there are any, and beside these, so that curves begin and end at zero; else not a number."""
    near = there.copy()
    near[1:] |= there[:-1]
    near[:-1] |= there[1:]
    return np.where(near, values, np.nan)


def _reactions(dataset: xr.Dataset) -> list[Plot]:
    kinds = {
        "reaction_x": ("N", "Reaction of either gear on its shaft along the line of action", "Force (N)"),
        "reaction_y": ("N", "Reaction of either gear on its shaft off the line of action", "Force (N)"),
        "reaction_couple": ("N m", "Couple of either gear on its shaft", "Couple (N m)"),
    }
    plots = []
    for name, (unit, caption, y_title) in kinds.items():
        if name in dataset:
            values = in_unit(dataset[name].transpose("time", "gear"), unit)
            curves = [(str(gear), each, colour) for gear, each, colour in zip(dataset["gear"].values, values.T, PALETTE)]
            plots.append(over_time(dataset, caption, y_title, curves, least=least(values)))
    return plots


def _openings(dataset: xr.Dataset) -> list[Plot]:
    names = {"drive_flank_opening": "drive flanks", "coast_flank_opening": "coast flanks"}
    curves = [(words, in_unit(dataset[name], "µm"), colour) for (name, words), colour in zip(names.items(), PALETTE) if name in dataset]
    return [over_time(dataset, "Smallest distance of the flanks", "Distance (µm)", curves, least=LEAST_LENGTH)] if curves else []
