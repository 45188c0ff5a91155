"""The coarse scene of many rows, and how they say what they measured, which `tests.hard_cases.table` reads."""

import re

import pytest
from tests.coarse import coarse_scene


@pytest.fixture(scope="session")
def coarse(paper_scene):
    """The paper's scene with the coarse settings."""
    return coarse_scene(paper_scene)


@pytest.fixture
def measured(request, record_property):
    """`measured(what, value, limit, unit="")`: a line of the table for this file's row; `value` a number or words,
    `limit` as words.

    Call it before the assertion, so that a failing case shows its number too. A file that belongs to several rows says
    `row=`.
    """
    own = re.match(r"test_row_(\d\d)_", request.path.name)

    def record(what, value, limit, unit="", row=None):
        row = int(own.group(1)) if row is None else row
        shown = value if isinstance(value, str) else f"{value:.2g}"
        record_property("hard_case", f"{row}|{what}|{shown} {unit}".rstrip() + f"|{limit}")

    return record
