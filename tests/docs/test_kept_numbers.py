"""Tables of the evidence pages are those of the numbers kept."""

import pytest
from tests.benchmarks.marked_section import markers
from tests.docs.kept_numbers import EVIDENCE, SECTIONS, rows

from fenics_gears.model.description import SOFTER


@pytest.mark.parametrize("page, name", SECTIONS)
def test_the_table_is_that_of_the_numbers(page, name):
    """Identity, with docs/pictures; `python -m tests.docs.write` writes it anew."""
    begin, end = markers(name)
    shown = (EVIDENCE / page).read_text(encoding="utf-8").partition(begin)[2].partition(end)[0]
    assert shown.strip() == SECTIONS[page, name]()


def test_every_target_was_reached():
    """The guide's promise; the true errors measured."""
    found = rows("target_of_pairs")
    assert len(found) > 50 and all(float(line["true, %"]) <= float(line["target, %"]) for line in found)
    over_face = rows("target_over_face")
    assert over_face and all(float(line["true_over_target"]) <= 1.0 for line in over_face)


def test_the_guide_says_how_much_too_stiff_plane_strain_is():
    """Identity, with what `gears check` interpolates."""
    guide = (EVIDENCE.parent / "third_dimension.md").read_text(encoding="utf-8")
    widths, parts = (" | ".join(f"{value:g}" for value in row) for row in (SOFTER, SOFTER.values()))
    assert f"| face width over module | {widths} |" in guide and f"| over plane strain, % | {parts} |" in guide
