"""The numbers of this demonstration as Markdown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from demos.tip_relief.design import Bench, Design
from demos.tip_relief.findings import DRAWN, Optima, best_depth, single_pair_deflection

LOADS = (0.5, 1.0, 2.0)
NO_LOAD = 0.002


def table(
    benches: Mapping[str, Bench],
    teeth_alone: Bench,
    optima: Optima,
    designs: Mapping[str, Design | None],
    loads: Sequence[float] = LOADS,
    tolerance: float = 0.1,
) -> str:
    """Three tables: the best reliefs, what they leave at other `loads` (in parts of the benches' torque), and the best
    depth at these, within a tolerance (um)."""
    return (
        "\n".join(
            [
                *_best(benches, optima),
                "",
                *_over_load(benches, designs, (NO_LOAD, *loads)),
                "",
                *_rule(benches, teeth_alone, loads, tolerance),
            ]
        )
        + "\n"
    )


def _best(benches: Mapping[str, Bench], optima: Optima) -> list[str]:
    """A row for each condition and shape; ranges are those of at most a micrometre more."""
    rows = [
        (
            "| condition | relief | best depth (um) | best length | least T_EPP (um) | depths within 1 um | lengths"
            " within 1 um | T_EPP of true involutes (um) |"
        ),
        "|---|---|---|---|---|---|---|---|",
    ]
    for (name, shape), best in optima.items():
        depths, lengths = (
            f"{low:{form}} to {high:{form}}" for (low, high), form in ((best.depths, ".0f"), (best.lengths, ".2f"))
        )
        none = benches[name].peak_to_peak(None)
        rows.append(
            f"| {name} | {shape} | {best.design.depth:.1f} | {best.design.length:.2f} | {best.peak_to_peak:.1f} |"
            f" {depths} | {lengths} | {none:.1f} |"
        )
    return rows


def _over_load(benches: Mapping[str, Bench], designs: Mapping[str, Design | None], loads: Sequence[float]) -> list[str]:
    rows = [
        "| T_EPP (um) | | " + " | ".join(f"{benches['μ = 0'].torque(load):.3g} N m" for load in loads) + " |",
        "|---|---|" + "---|" * len(loads),
    ]
    for name in DRAWN:
        for design, relief in designs.items():
            rows.append(
                f"| {name} | {design} | "
                + " | ".join(f"{benches[name].peak_to_peak(relief, load):.1f}" for load in loads)
                + " |"
            )
    return rows


def _rule(benches: Mapping[str, Bench], teeth_alone: Bench, loads: Sequence[float], tolerance: float) -> list[str]:
    low, high = single_pair_deflection(teeth_alone)
    rows = [f"One tooth pair under the whole load gives way by {low:.1f} to {high:.1f} um.", ""]
    rows += [
        "| best depth of a long linear relief (um) | "
        + " | ".join(f"{teeth_alone.torque(load):.3g} N m" for load in loads)
        + " |",
        "|---|" + "---|" * len(loads),
    ]
    for name in DRAWN:
        rows.append(
            f"| {name} | "
            + " | ".join(f"{best_depth(benches[name], load, tolerance=tolerance):.1f}" for load in loads)
            + " |"
        )
    return rows
