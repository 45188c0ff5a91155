"""The result of a run as a labelled dataset, and its file."""

from .files import load, save
from .pairs import by_pair, shown

__all__ = ["by_pair", "load", "save", "shown"]
