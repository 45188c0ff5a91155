"""The result of a run as a labelled dataset, and its file."""

from fenics_gears.results.files import load, save
from fenics_gears.results.pairs import by_pair, shown

__all__ = ["by_pair", "load", "save", "shown"]
