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
        self._longest: dict[tuple | None, float] = {}

    def of(self, models: Sequence[Any]) -> list[Any]:
        """The models, of pairs or of trains, with the longest windows that these or others before them asked for and
        that share their operators."""
        for model in models:
            for each in model.models:
                key = _key(each)
                if key is not None:
                    own = each.resolution.contact_grid.inner_length
                    self._longest[key] = max(own, self._longest.get(key, own))
        return [model.changed(self._with_window) for model in models]

    def _with_window(self, model: Model) -> Model:
        grid = model.resolution.contact_grid
        length = self._longest.get(_key(model))
        if grid.inner_length == length:
            return model
        return replace(model, resolution=replace(model.resolution, contact_grid=replace(grid, inner_length=length)))


def _key(model: Model) -> tuple | None:
    """What models share that differ in their windows; None of one without."""
    grid = model.resolution.contact_grid
    return None if grid.inner_length is None else operators_key(model, replace(grid, inner_length=None))
