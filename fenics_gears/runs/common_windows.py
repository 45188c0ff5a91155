"""One window of contact nodes for runs over a face that differ in what opens their flanks, so that they share contact
operators."""

from collections.abc import Iterable
from dataclasses import replace

from fenics_gears.model.model import Model

from .gear_store import operators_key


class CommonWindows:
    """The longest windows that runs have asked for so far, by the contact operators that they would share.

    In a longer window a run has the same contact nodes and others beyond them, which stay open.
    """

    def __init__(self) -> None:
        self._longest: dict[tuple, float] = {}

    def take(self, models: Iterable[Model]) -> None:
        """Runs that are to come."""
        for model in models:
            if model.resolution.contact_grid.inner_length is not None:
                key, own = self._key(model)
                self._longest[key] = max(own, self._longest.get(key, own))

    def of(self, model: Model) -> Model:
        """The model with the longest window of those that were taken and share its operators."""
        if model.resolution.contact_grid.inner_length is None:
            return model
        key, own = self._key(model)
        longest = self._longest.get(key, own)
        if longest <= own:
            return model
        grid = replace(model.resolution.contact_grid, inner_length=longest)
        return replace(model, resolution=replace(model.resolution, contact_grid=grid))

    @staticmethod
    def _key(model: Model) -> tuple[tuple, float]:
        grid = model.resolution.contact_grid
        assert grid.inner_length is not None
        return operators_key(model, replace(grid, inner_length=None)), grid.inner_length
