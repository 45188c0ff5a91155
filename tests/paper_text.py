"""The text of the paper's scene, and a scene's text without some sections."""

import re
from pathlib import Path

PAPER = (Path(__file__).parents[1] / "demos" / "lundvall2004.toml").read_text(encoding="utf-8")


def without(text: str, *sections: str) -> str:
    names = "|".join(map(re.escape, sections))
    return re.sub(rf"^\[({names})\].*?(?=^\[|\Z)", "", text, flags=re.M | re.S)


# Settings of runs that take a fraction of a second; those of `tests.coarse`.
ACCURACY = """[accuracy]
flank_element_size = "0.3 mm"
contact_length = "2.4 mm"
contact_nodes = 9
steps_per_mesh_cycle = 20
"""
COARSE = """[accuracy]
element = "P1"
flank_element_size = "0.12 mm"
contact_length = "3 mm"
contact_nodes = 26
steps_per_mesh_cycle = 40
"""


def coarse_text(*left_out: str, more: str = "", cycles: int = 2, recorded: int = 2, accuracy: str = ACCURACY) -> str:
    """The paper's scene over some cycles, without the sections `left_out` and with `more`."""
    text = without(PAPER, "accuracy", *left_out).replace("mesh_cycles = 30 ", f"mesh_cycles = {cycles} ")
    text = text.replace("recorded_cycles = 2", f"recorded_cycles = {recorded}")
    return f"{text.rstrip()}\n\n{more}\n{accuracy}"
