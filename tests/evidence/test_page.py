"""The page of the evidence is what its command gives."""

import pytest
from tests.benchmarks.marked_section import markers
from tests.evidence.kept import numbers_of
from tests.evidence.page import PAGE, README, RED, page, readme_rows
from tests.evidence.parts import PARTS

CHEAP = [part for part in PARTS if not part.minutes and not part.needs]


def test_the_page_is_made_of_the_numbers():
    """Identity, of the README's rows too; `python -m tests.evidence --draw` writes them anew."""
    assert PAGE.read_text(encoding="utf-8") == page(PARTS)
    begin, end = markers("evidence")
    shown = README.read_text(encoding="utf-8").partition(begin)[2].partition(end)[0]
    assert shown.strip() == readme_rows(PARTS)


def test_every_row_outside_its_band_is_marked():
    """The bands, counted apart from the page's cells."""
    outside = [
        name for part in PARTS for name, claim in part.claims.items() if not claim.holds(*numbers_of(part)[name])
    ]
    assert sum(RED in line for line in PAGE.read_text(encoding="utf-8").splitlines() if "| `" in line) == len(outside)


@pytest.mark.nightly
@pytest.mark.parametrize("part", CHEAP, ids=lambda part: part.name)
def test_cheap_rows_are_what_is_measured(part):
    """The rows' own authorities; none has moved by more than a tenth of its band."""
    kept, measured = numbers_of(part), part.measure("")
    for name, claim in part.claims.items():
        before, now = claim.difference(*kept[name]), claim.difference(*measured[name])
        assert claim.holds(*measured[name]) == claim.holds(*kept[name]), name
        assert abs(now - before) <= 0.1 * (claim.band[1] - claim.band[0]), name
