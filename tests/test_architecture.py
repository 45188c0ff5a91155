"""Which folders may import which: imports point one way only, those inside functions too."""

from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


def test_imports_point_one_way(monkeypatch):
    """Authority: the contracts of import-linter in pyproject.toml. Where import-linter is not installed `.ci/run` checks them."""
    cli = pytest.importorskip("importlinter.cli")
    monkeypatch.chdir(ROOT)
    assert cli.lint_imports(no_cache=True) == 0
