"""The nearest known name for a misspelt one, and the one that a synonym stands for."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from functools import lru_cache


def nearest(word: str, names: Iterable[str], likeness: float = 0.6) -> str | None:
    """The one of ``names`` that ``word`` most likely meant, whatever its case; None where none is alike.

    >>> nearest("frictoin", ["friction", "inertia"])
    'friction'
    >>> nearest("oil", ["friction", "inertia"]) is None
    True
    """
    return _nearest(word, tuple(names), likeness)


@lru_cache(maxsize=1024)
def _nearest(word: str, names: tuple[str, ...], likeness: float) -> str | None:
    """Remembered: scenes of a study have the same names hundreds of times."""
    by_lower_case = {name.lower(): name for name in names}
    if word.lower() in by_lower_case:
        return by_lower_case[word.lower()]
    found = difflib.get_close_matches(word.lower(), by_lower_case, n=1, cutoff=likeness)
    return by_lower_case[found[0]] if found else None


def did_you_mean(word: str, names: Iterable[str], likeness: float = 0.6) -> str:
    """A question naming the nearest known name, with a blank before it; empty where none is alike."""
    name = nearest(word, names, likeness)
    return f' Did you mean "{name}"?' if name else ""


def meant(section: Iterable[str], word: str, known: Iterable[str]) -> str | None:
    """The one of the known names of a section (its path) that engineers also call `word`; None where none is.

    >>> meant(["tip_relief", "pinion"], "amount", ["depth", "start"])
    'depth'
    """
    # A scene without misspelt names does not load it.
    from fenics_gears.inputs.synonyms import SYNONYMS

    section, known = tuple(section), tuple(known)
    homes = [section, *([section[:-1], (*section[:-1], "pinion")] if section[-1:] in (("pinion",), ("wheel",)) else [])]
    found = (
        name for home in homes for name in known if word.lower() in SYNONYMS.get(".".join((*home, name)), "").split()
    )
    return next(found, None)
