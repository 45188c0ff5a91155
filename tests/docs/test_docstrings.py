"""Examples in docstrings give what they say."""

import doctest
import importlib
import inspect
from pathlib import Path

import pytest

import fenics_gears

PACKAGE = Path(fenics_gears.__file__).parent
WITH_EXAMPLES = sorted(path for path in PACKAGE.rglob("*.py") if ">>> " in path.read_text(encoding="utf-8"))
MODULES = [".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts) for path in WITH_EXAMPLES]


@pytest.mark.parametrize("name", fenics_gears.__all__)
def test_a_function_that_everybody_may_use_has_an_example(name):
    """docs/api.md is made from these docstrings; the next test runs the examples."""
    thing = getattr(fenics_gears, name)
    assert not inspect.isfunction(thing) or (">>> " in thing.__doc__ and thing.__module__ in MODULES)


@pytest.mark.parametrize("name", MODULES)
def test_examples_give_what_they_say(name):
    """The docstring."""
    outcome = doctest.testmod(importlib.import_module(name))
    assert outcome.attempted and not outcome.failed
