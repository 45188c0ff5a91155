"""One window of contact nodes for runs over a face that differ in gaps alone, so that they share contact operators."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from fenics_gears.model.model import Model

from .gear_store import operators_key


class CommonWindows:
    """The longest windows that runs have asked for so far, by the contact operators that they would share.

    In a longer window a run has the same contact nodes and others beyond them, which stay open.
    """

    def __init__(self) -> None:
        self._longest: dict[tuple, float] = {}

    def of(self, models: Sequence[Any]) -> list[Any]:
        """The models with the longest window that these or others before them asked for and that share its
        operators."""
        keys = [self._key(model) for model in models]
        for model, key in zip(models, keys):
            if key is not None and (own := model.resolution.contact_grid.inner_length) is not None:
                self._longest[key] = max(own, self._longest.get(key, own))
        return [model if key is None else _with_window(model, self._longest[key]) for model, key in zip(models, keys)]

    @staticmethod
    def _key(model: Any) -> tuple | None:
        """What models share that differ in their windows; None of one without, and of trains."""
        if not isinstance(model, Model):
            return None
        grid = model.resolution.contact_grid
        return None if grid.inner_length is None else operators_key(model, replace(grid, inner_length=None))


def _with_window(model: Model, length: float) -> Model:
    grid = model.resolution.contact_grid
    if grid.inner_length == length:
        return model
    return replace(model, resolution=replace(model.resolution, contact_grid=replace(grid, inner_length=length)))
