"""The result of a run as a labelled dataset, and its file."""

from fenics_gears.results.dataset import dataset
from fenics_gears.results.files import load, save

__all__ = ["dataset", "load", "save"]
