"""docs/evidence/index.md from the numbers that are kept."""

from tests.docs.blocks import ROOT
from tests.docs.markdown import table
from tests.evidence.claim import EXPERIMENTS, GROUPS, Claim, Part
from tests.evidence.kept import numbers_of

PAGE, README = ROOT / "docs" / "evidence" / "index.md", ROOT / "README.md"
MOST_ROWS = 80
RED = "🔴 **outside**"
HEAD = """# Evidence

What the program was held against, and by how much it missed. `python -m tests.evidence` measures all rows and writes
this page; nobody edits it. `python -m tests.evidence NAME` measures the rows of one name, the last column. A nightly
test measures every row that takes seconds again.

The difference is the program's number over the authority's, less 1; where the authority's is 0, it is the program's.
**Band** is what counts as agreement. A row that leaves it is marked {red}. {count} rows, {outside} outside.
"""
NO_EXPERIMENT = """No row. Measured values with the inputs that a run needs were not to be had:
[what was searched, found and missing](experiments.md)."""
STORIES = """## The longer stories

| page | what it has |
|---|---|
| [Experiments](experiments.md) | measurements that were looked for; contact loss of a pair over speed; losses |
| [Accuracy](accuracy.md) | how errors are measured, orders, targets, Hertz |
| [Time](performance.md) | stages of a run, what limits a step, the cost of each effect |
| [Growth](growth.md) | exponents of time and memory beside theory |
| [The third dimension](third_dimension.md) | plane limits, overlap, misalignment, crowning, resolved models |
| [Gears from drawings](geometry.md) | published pairs, cutting, thin rims, webs |
| [Stress](stress.md) | recovery, root stress |
| [Other programs and standards](other_programs.md) | CalculiX, GetFEM, Exudyn, ISO 6336, optimisers |
| [The paper](paper.md) | its data, its claims, differences from it |
| [Hard cases](../hard_cases.md) | laws of contact, equilibrium, energy in every step: what is tested for stability |
| [Platforms](platforms.md) | tests on three versions of Debian |
| [Tried and not taken](tried.md) | what else was tried |
"""


def _number(value: float) -> str:
    return f"{value:.6g}" if value and abs(value) >= 1e-3 else f"{value:.1e}" if value else "0"


def _part(difference: float) -> str:
    if abs(difference) >= 1e-6:
        return f"{100.0 * difference:+.2g} %"
    return f"{difference:.0e}" if difference else "0"


def _band(claim: Claim, relative: bool) -> str:
    least, most = claim.band
    words = [(f"{100.0 * each:g} %" if abs(each) > 1e-6 else f"{each:g}") if relative else f"{each:g}"
             for each in (least, most)]  # fmt: skip
    return f"± {words[1]}" if least == -most else f"{words[0]} to {words[1]}"


def cells(part: Part, name: str) -> list[str]:
    claim, (value, ours) = part.claims[name], numbers_of(part)[name]
    difference = _part(claim.difference(value, ours)) if value else ""
    if not claim.holds(value, ours):
        difference = f"{RED} {difference}".strip()
    unit = f" {claim.unit}" if claim.unit else ""
    return [
        claim.quantity, claim.authority, f"{_number(value)}{unit}", f"{_number(ours)}{unit}", difference,
        _band(claim, bool(value)), f"[{claim.made_of}]({part.story})", f"`{part.name}`",
    ]  # fmt: skip


# Rows that the README shows.
IN_README = (
    ("hertz", "peak pressure"),
    ("resolved", "helical, 20 deg, plain"),
    ("corner", "the wheel's tip enters"),
    ("calculix", "0.8"),
    ("function", "smallest"),
    ("contact_loss", "softening"),
)
HEADINGS = ("quantity", "authority", "its value", "here", "difference", "band", "made of", "name")


def readme_rows(parts: list[Part]) -> str:
    by_name, lines = {part.name: part for part in parts}, ["|quantity|authority|difference|", "|---|---|---|"]
    for name, claim in IN_README:
        shown = cells(by_name[name], claim)
        lines.append(f"|{shown[0]}|{shown[1].partition(';')[0].partition(',')[0]}|{shown[4]}|")
    return "\n".join(lines)


def page(parts: list[Part]) -> str:
    rows = [(part, name) for part in parts for name in part.claims]
    outside = sum(not part.claims[name].holds(*numbers_of(part)[name]) for part, name in rows)
    lines = [HEAD.format(red=RED, count=len(rows), outside=outside)]
    for group in GROUPS:
        own = [cells(part, name) for part, name in rows if part.group == group]
        lines += [f"## {group}", "", *(table(HEADINGS, own) if own else []), ""]
        if group == EXPERIMENTS and not own:
            lines[-1:] = [NO_EXPERIMENT, ""]
    needs = {part.name: part.needs for part in parts if part.needs}
    long = {part.name: part.minutes for part in parts if part.minutes}
    said = [
        "Rows of " + ", ".join(f"`{name}`" for name in long)
        + f" take some {sum(long.values()):.0f} minutes of a core together, all others seconds. "
        + ", ".join(f"`{name}` needs {program}" for name, program in needs.items())
        + ": give a Python that has it as `--python PYTHON`.", "",
    ]  # fmt: skip
    return "\n".join([*lines, *said, STORIES])
