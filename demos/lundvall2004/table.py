"""The table of claims as a Markdown file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from demos.lundvall2004.claims import Claim, claims_of_inertia, table_of_claims
from demos.lundvall2004.measured import PRINTED, READ, WITH, Measured, frequencies_of
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
    claims = {reading: claims_of_inertia(measured, reading) for reading in HEADINGS}
    parts += ["", "| | claim | " + " | ".join(HEADINGS.values()) + " |", "|---|---|---|---|"]
    for rows in zip(*claims.values()):
        cells = [f"**{each.verdict}.** {_measured(each)}" for each in rows]
        parts.append(f"| {rows[0].number} | {rows[0].statement} | " + " | ".join(cells) + " |")
    return "\n".join(parts) + "\n"


def _rows(claims: Sequence[Claim]) -> list[str]:
    head = ["| | claim | where | criterion | measured | |", "|---|---|---|---|---|---|"]
    return head + [
        f"| {c.number} | {c.statement} | {c.where} | {c.criterion} | {_measured(c)} | **{c.verdict}** |" for c in claims
    ]


def _measured(claim: Claim) -> str:
    return f"{claim.measured}. Why: {claim.why}" if claim.why else claim.measured


def _frequencies(measured: Measured, reading: str) -> str:
    return ", ".join(
        f"{frequency:.0f}" for frequency in frequencies_of(measured.run(f"{reading}figure05", friction=WITH))
    )
