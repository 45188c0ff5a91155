"""What is kept on disk is kept under the version of the program's numbers."""

import json

import pytest
from tests.pinned_numbers import FILE, pinned

from fenics_gears.numbers_version import NUMBERS_VERSION


def test_numbers_are_those_of_their_version():
    """Numbers of the version to 1e-9, more than machines differ by. Whoever changes numbers on purpose raises
    `NUMBERS_VERSION` in fenics_gears/numbers_version.py and calls `python -m tests.pinned_numbers`."""
    kept, found = json.loads(FILE.read_text()), pinned()
    assert kept["numbers_version"] == NUMBERS_VERSION, (
        "the pinned numbers are of another version: python -m tests.pinned_numbers"
    )
    assert found["numbers"] == pytest.approx(kept["numbers"], rel=1e-9), (
        "numbers have changed: raise NUMBERS_VERSION, then python -m tests.pinned_numbers"
    )
