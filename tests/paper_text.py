"""The text of the paper's scene, and a scene's text without some sections."""

import re
from pathlib import Path

PAPER = (Path(__file__).parents[1] / "demos" / "lundvall2004.toml").read_text(encoding="utf-8")


def without(text: str, *sections: str) -> str:
    """Without sections of these names, whose subsections stay."""
    names = "|".join(map(re.escape, sections))
    return re.sub(rf"^\[({names})\].*?(?=^\[|\Z)", "", text, flags=re.M | re.S)
