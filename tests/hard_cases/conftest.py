"""How a hard case says what it measured: the fixture `measured`, read by `tests.hard_cases.table`."""

import re

import pytest


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
