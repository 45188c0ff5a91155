"""Forces: of the mesh, of each tooth pair, and what they ask of the shafts."""

from __future__ import annotations

import numpy as np
import xarray as xr

from fenics_gears.results.pairs import lives
from fenics_gears.show.curves import LEAST_LENGTH, LEAST_SHARE
from fenics_gears.show.panels import DARK, PALETTE
from fenics_gears.show.report.page import Plot, Section, Words
from fenics_gears.show.report.plotting import over_time
from fenics_gears.show.report.run import TOO_FEW, Run
from fenics_gears.show.units import in_unit

# More pairs than this share their curves with those that are kept in the same slot.
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
    """A curve of name, values (time,) and colour for each pair that carries, not a number where it does not; of many pairs those
    that are kept in one slot share a curve, being never in contact together."""
    return shared_curves(dataset["pair_number"].values, in_unit(dataset[name].transpose("time", "slot"), "N"))


def shared_curves(numbers: np.ndarray, values: np.ndarray) -> list[tuple[str, np.ndarray, str]]:
    """The same for any values (time, slot), of pairs of those `numbers` (time, slot), that are zero or not a number where a pair has none."""
    there = np.isfinite(values) & (values != 0.0)
    shown = _with_ends(there, values)
    carrying = [life for life in lives(numbers) if there[life.steps, life.slot].any()]
    if len(carrying) <= NAMED_PAIRS:
        curves = []
        for life in carrying:
            near = slice(max(life.steps.start - 1, 0), life.steps.stop + 1)
            own = np.full(len(values), np.nan)
            own[near] = shown[near, life.slot]
            curves.append((f"pair {life.number}", own, PALETTE[life.number % len(PALETTE)]))
        return curves
    curves = []
    for first in sorted({life.slot: life for life in reversed(carrying)}.values(), key=lambda life: life.number):
        own = [life.number for life in carrying if life.slot == first.slot]
        listed = ", ".join(map(str, own[:3]))
        curves.append((f"pairs {listed}{', …' if len(own) > 3 else ''}", shown[:, first.slot], PALETTE[first.number % len(PALETTE)]))
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
