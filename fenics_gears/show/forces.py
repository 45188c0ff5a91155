"""Charts of the forces: of the mesh, of each tooth pair, and their reactions on the shafts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fenics_gears.show.chart import Chart, of_variables, over_time, span
from fenics_gears.show.panels import DARK, PALETTE
from fenics_gears.show.run import Run

COAST_NOTE = "Coast flanks are drawn downwards."
SHARES_UNKNOWN = "Where several rigid pairs touch at once their shares are not determined."


def force_charts(run: Run) -> list[Chart]:
    """All forces that the result has."""
    openings = of_variables(
        run,
        "Smallest distance of the flanks",
        "Distance",
        "µm",
        {"drive_flank_opening": "drive flanks", "coast_flank_opening": "coast flanks"},
        least=0.1,
        height=300,
    )
    return [*mesh_forces(run), *pair_forces(run), *_reactions(run), *openings]


def mesh_forces(run: Run) -> list[Chart]:
    """Normal and friction force of the mesh, on either side of the teeth."""
    if "normal_force" not in run.dataset:
        return []
    drive = run.values("normal_force", "N")
    curves, note = [("normal force", drive, PALETTE[0])], ""
    if "coast_normal_force" in run.dataset:
        curves = [
            ("drive flanks", drive, PALETTE[0]),
            ("coast flanks (drawn downwards)", -run.values("coast_normal_force", "N"), PALETTE[1]),
        ]
        note = COAST_NOTE
    normal = over_time(
        run, "Normal force of the mesh", "Normal force (N)", curves, least=span(curves), height=240, note=note
    )
    return [
        normal,
        *of_variables(
            run,
            "Friction force of the mesh",
            "Friction force",
            "N",
            {"friction_force": "drive flanks", "coast_friction_force": "coast flanks"},
        ),
    ]


def pair_forces(run: Run) -> Iterator[Chart]:
    """Shares of the tooth pairs in normal and in friction force."""
    for name, caption in (
        ("pair_normal_force", "Load sharing: normal force of each tooth pair"),
        ("pair_friction_force", "Friction force of each tooth pair"),
    ):
        if name not in run.dataset:
            continue
        curves = [(words, values, PALETTE[number % len(PALETTE)]) for words, values, number in run.of_pairs(name, "N")]
        note = SHARES_UNKNOWN if np.isnan(run.dataset[name].values).any() else ""
        if name == "pair_normal_force":
            coast = run.of_pairs("pair_coast_normal_force", "N") if "pair_coast_normal_force" in run.dataset else []
            curves += [
                (f"{words}, coast flanks", -values, PALETTE[number % len(PALETTE)]) for words, values, number in coast
            ]
            note = f"{COAST_NOTE} {note}".strip() if coast else note
            # First, so that the pairs are drawn upon it.
            curves.insert(0, ("all drive flanks" if coast else "all pairs", run.values("normal_force", "N"), DARK))
        if curves:
            yield over_time(run, caption, "Force (N)", curves, least=span(curves), note=note, height=380)


def shaft_torques(run: Run) -> list[Chart]:
    """Torque of either gear on its shaft."""
    return of_variables(run, "Torque of either gear on its shaft", "Torque", "N m", {"reaction_couple": ""})


def _reactions(run: Run) -> list[Chart]:
    sides = {"reaction_x": "along", "reaction_y": "off"} if "friction_force" in run.dataset else {"reaction_x": "along"}
    charts = [
        of_variables(run, f"Reaction of either gear on its shaft {words} the line of action", "Force", "N", {name: ""})
        for name, words in sides.items()
    ]
    return [*sum(charts, []), *shaft_torques(run)]
