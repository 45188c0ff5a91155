"""A place that cannot take the result is refused before anything is computed (hard case 26)."""

from pathlib import Path

import pytest
from tests.commands.test_places_to_write import check_nowhere, check_refusal

DESIGN = """
scene = "pair.toml"
set.tip_relief.start = "HPSTC"
variables.tip_relief.depth = ["5 um", "60 um"]
goals.peak_to_peak_transmission_error = 1
"""
CALLS = {
    "map.nc": ["map", "pair.toml", "--loads", "100 N m"], "best.toml": ["optimize", "design.toml"],
    "accuracy.csv": ["accuracy", "pair.toml"], "effects.png": ["effects", "pair.toml"],
}  # fmt: skip


@pytest.mark.parametrize("name", CALLS)
def test_a_folder_under_the_results_name(tmp_path, monkeypatch, capsys, name):
    monkeypatch.chdir(tmp_path)
    Path("design.toml").write_text(DESIGN)
    check_refusal(CALLS[name], name, capsys)


NOWHERE = {
    "map pair.toml --loads '100 N m'": "", "optimize design.toml": "", "plot run.nc --spectrum": "",
    "effects pair.toml": "", "accuracy pair.toml": "", "report run.nc": ".html", "import pair.rexs": ".toml",
    "rate run.nc": ".csv", "listen run.nc": ".wav",
}  # fmt: skip


@pytest.mark.parametrize("call", NOWHERE)
def test_a_place_that_permissions_say_nothing_of(tmp_path, monkeypatch, capsys, call):
    """As of the core's commands."""
    monkeypatch.chdir(tmp_path)
    Path("design.toml").write_text(DESIGN)
    check_nowhere(call, NOWHERE[call], capsys)
