"""The energy account: energy stored, work put in, work done and lost, and the unexplained rest."""

from functools import partial

import numpy as np

from fenics_gears.charts import DARK, PALETTE, span
from fenics_gears.pages import Facts, PageSection, sentence
from fenics_gears.shown import TOO_FEW, ShownRun, digits, factor, in_unit, over_time, transmitted

PARTS = {
    "energy_teeth": "teeth",
    "energy_shafts": "shafts",
    "energy_bearings": "bearings",
    "energy_kinetic": "motion (kinetic)",
}
TAKEN = {"work_friction": "friction", "work_damping": "damping"}
HEADING = "Energy account"
# N m and J are the same; the results' unit is N mm.
UNIT = "N m"


def energy(run: ShownRun) -> PageSection:
    """The account over the settled cycles as numbers and curves."""
    run = run.settled
    if "energy" not in run.dataset or not run.has_curves:
        said = TOO_FEW if "energy" in run.dataset else "The result has no energies."
        return sentence("energy", HEADING, said, True)
    return PageSection(
        "energy", HEADING, [Facts(_rows(run), "Over the settled mesh cycles (1 N m = 1 J)"), *_curves(run)]
    )


def _rows(run: ShownRun) -> list[tuple[str, str, str]]:
    last = {
        name: float(np.subtract(*in_unit(run.dataset[name], UNIT)[[-1, 0]]))
        for name in (*TAKEN, "work_contact_changes") if name in run.dataset
    }  # fmt: skip
    held = in_unit(run.dataset["energy"], UNIT)
    work = transmitted(run.dataset)
    to_unit = factor("N mm", UNIT)
    drive = abs(work.drive) * to_unit

    def row(label: str, value: float) -> tuple[str, str, str]:
        # What rounding leaves of two equal numbers is none.
        shown = value if abs(value) > 1e-9 * drive else 0.0
        share = f" ({100.0 * shown / drive:.4g} % of the drive's work)" if drive else ""
        return label, digits(shown), UNIT + share

    driving, driven = ("wheel", "pinion") if work.wheel_drives else ("pinion", "wheel")
    rows = [(f"work of the drive, the {driving}'s shaft", digits(work.drive * to_unit), UNIT)]
    rows.append(row(f"work done on the load, the {driven}'s shaft", work.load * to_unit))
    rows += [row(f"lost to {words}", last[name]) for name, words in TAKEN.items() if name in last]
    rows.append(row("put in by the time stepping where contact changes", last["work_contact_changes"]))
    rows.append(row("more energy held at the end than at the beginning", float(held[-1] - held[0])))
    rest = float(np.abs(_since_first(run.dataset["energy_defect"])).max())
    return [*rows, ("not explained by any of these", f"{rest:.2g}", f"{UNIT} at most, at any of their steps")]


def _since_first(work) -> np.ndarray:
    """Work (time,), N m, since the first step."""
    values = in_unit(work, UNIT)
    return values - values[:1]


def _curves(run: ShownRun) -> list:
    dataset = run.dataset

    def stored(names: dict[str, str], values) -> list[tuple[str, np.ndarray, str]]:
        named = zip(names.items(), PALETTE)
        return [(words, values(dataset[name]), colour) for (name, words), colour in named if name in dataset]

    held = stored(PARTS, partial(in_unit, wanted=UNIT))
    held.append(("all", in_unit(dataset["energy"], UNIT), DARK))
    taken = stored(TAKEN, _since_first)
    taken.append(("contact changes, by the time stepping", -_since_first(dataset["work_contact_changes"]), PALETTE[3]))
    defect = [("defect", _since_first(dataset["energy_defect"]), DARK)]
    # A plot of one curve has no legend.
    alone = f": {taken[0][0]}" if len(taken) == 1 else ""
    return [
        over_time(run, "Energy held", "Energy (N m)", held, least=1e-6 * span(held)),
        over_time(run, f"Work lost since the first settled step{alone}", "Work (N m)", taken, least=1e-6 * span(taken)),
        over_time(run, "What the account does not explain: round-off", "Energy (N m)", defect, least=1e-15),
    ]
