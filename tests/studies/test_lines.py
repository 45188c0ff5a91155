"""Runs of a search that are kept as lines."""

from fenics_gears.runs.lines import FolderOfLines, append
from fenics_gears.runs.runs import Failure


def test_a_line_without_what_is_asked_for_is_no_run(tmp_path):
    """Definition: all numbers asked for, also from two lines, or a failure."""
    for key, said in (
        ("one", {"numbers": {"a": 1.0}}),
        ("both", {"numbers": {"a": 1.0}}),
        ("both", {"numbers": {"b": 2.0}}),
        ("none", {"failure": "why"}),
    ):
        append(tmp_path, {"key": key, **said})

    def known(*asked):
        return FolderOfLines(tmp_path, lambda run, result: {}, asked).known([])

    assert known("a").keys() == {"one", "both", "none"} and known("a", "b").keys() == {"both", "none"}
    assert known("a", "b")["both"]["numbers"] == {"a": 1.0, "b": 2.0} and isinstance(known("a")["none"], Failure)
