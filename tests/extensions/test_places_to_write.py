"""A place that cannot take the result is refused before anything is computed (hard case 26)."""

from pathlib import Path

import pytest
from tests.commands.test_places_to_write import DESIGN, check_refusal

CALLS = {"map.nc": ["map", "pair.toml", "--loads", "100 N m"], "best.toml": ["optimize", "design.toml"]}


@pytest.mark.parametrize("name", CALLS)
def test_a_folder_under_the_results_name(tmp_path, monkeypatch, capsys, name):
    monkeypatch.chdir(tmp_path)
    Path("design.toml").write_text(DESIGN)
    check_refusal(CALLS[name], name, capsys)
