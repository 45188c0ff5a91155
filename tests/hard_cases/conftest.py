"""The coarse scene of many rows, and the lines that `tests.hard_cases.table` reads."""

import re

import pytest
from tests.coarse import coarse_scene


@pytest.fixture(scope="session")
def coarse(paper_scene):
    return coarse_scene(paper_scene)


@pytest.fixture
def measured(request, record_property):
    """`measured(what, value, limit, unit="")`: a line of the table for this file's row, or for `row`; `value` a number
    or words, `limit` words, or a number that the value must not exceed. The line comes before the assertion, so that a
    failing case shows its number too."""
    own = re.match(r"test_row_(\d\d)_", request.path.name)

    def record(what, value, limit, unit="", row=None):
        row = int(own.group(1)) if row is None else row
        shown = value if isinstance(value, str) else f"{value:.2g}"
        words = limit if isinstance(limit, str) else f"{limit:g} {unit}".rstrip()
        record_property("hard_case", f"{row}|{what}|{shown} {unit}".rstrip() + f"|{words}")
        assert isinstance(limit, str) or value <= limit, what

    return record
