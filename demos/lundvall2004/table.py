"""The table of claims as a Markdown file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from demos.lundvall2004 import claims, spectrum
from demos.lundvall2004.claims import Claim
from demos.lundvall2004.measured import PRINTED, READ, WITH, WITHOUT, Measured, frequencies_of
from fenics_gears.system.output import written_aside

HEADINGS = {READ: "J = 24.5 N mm s^2, as we read it", PRINTED: "J = 24.5 kg mm^2, as printed"}


def write_table(measured: Measured, file: Path) -> Path:
    """Write the claims with what was measured, and those that depend on J under both readings of it."""
    text = claims_text(measured)
    with written_aside(file.parent, []) as aside:
        (aside / file.name).write_text(text, encoding="utf-8")
    return file


def claims_text(measured: Measured) -> str:
    """The Markdown of both tables."""
    parts = [
        "# What the paper claims, and what was measured",
        "",
        *_rows(table_of_claims(measured)),
        "",
        "## The two readings of J",
        "",
    ]
    parts += [
        f"* {HEADINGS[reading]}: natural frequencies {_frequencies(measured, reading)} Hz (one tooth pair in mesh)"
        for reading in HEADINGS
    ]
    by_reading = {reading: claims_of_inertia(measured, reading) for reading in HEADINGS}
    parts += ["", "| | claim | " + " | ".join(HEADINGS.values()) + " |", "|---|---|---|---|"]
    for rows in zip(*by_reading.values()):
        cells = [f"**{each.verdict}.** {_measured(each)}" for each in rows]
        parts.append(f"| {rows[0].number} | {rows[0].statement} | " + " | ".join(cells) + " |")
    return "\n".join(parts) + "\n"


def table_of_claims(measured: Measured) -> list[Claim]:
    """All claims, with J as we read it."""
    static, run = measured.study("figure02"), measured.run
    first = [
        claims.claim_1(static),
        claims.claim_2(static),
        claims.claim_3(static),
        claims.claim_4(run("figure04", friction=WITH), run("figure04", friction=WITHOUT)),
    ]
    smooth = claims.claim_7(run("figure04", friction=WITH), run("figure08", friction=WITH))
    of_inertia = claims_of_inertia(measured, READ)
    undamped = claims.claim_10(measured.study("undamped"), measured.curves(READ, "06"))
    return [*first, *of_inertia[:-2], smooth, *of_inertia[-2:], undamped]


def claims_of_inertia(measured: Measured, reading: str) -> list[Claim]:
    """Claims 5, 6, 8 and 9 under a reading of J."""
    static, depths = measured.study("figure02"), measured.study("figure09_static")
    unmodified, modified = measured.curves(reading, "06"), measured.curves(reading, "10")
    highest = frequencies_of(measured.run(f"{reading}figure05", friction=WITH))[-1]
    raised = [
        claims.claim_6a(unmodified),
        claims.claim_6a(modified, "Section 6, Fig. 10", "6c", " of the modified pair too"),
    ]
    for place, (figure, curve) in enumerate((("06", unmodified), ("10", modified))):
        if raised[place].verdict != claims.HELD:
            raised[place] = replace(raised[place], why=spectrum.why_friction_lowers(measured, reading, figure, curve))
    return [
        claims.claim_5(static, measured.study(f"{reading}figure05")),
        raised[0],
        claims.claim_6b(unmodified, static, highest),
        raised[1],
        claims.claim_8(depths, measured.study(f"{reading}figure09_dynamic")),
        claims.claim_9(unmodified, modified, depths),
    ]


def _rows(told: Sequence[Claim]) -> list[str]:
    head = ["| | claim | where | criterion | measured | |", "|---|---|---|---|---|---|"]
    return head + [
        f"| {c.number} | {c.statement} | {c.where} | {c.criterion} | {_measured(c)} | **{c.verdict}** |" for c in told
    ]


def _measured(claim: Claim) -> str:
    return f"{claim.measured}. Why: {claim.why}" if claim.why else claim.measured


def _frequencies(measured: Measured, reading: str) -> str:
    return ", ".join(
        f"{frequency:.0f}" for frequency in frequencies_of(measured.run(f"{reading}figure05", friction=WITH))
    )
