"""What has a part for each of the two gears of a pair, under the gear's name."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Self

from .tree import GEARS


class PerGear:
    """A dataclass with the fields `pinion` and `wheel`."""

    @property
    def of_gears(self) -> tuple[Any, Any]:
        """The parts of both, in the order of a pair's sides."""
        first, second = (getattr(self, gear) for gear in GEARS)
        return first, second

    def changed(self, change: Callable[[Any], Any], **others: Any) -> Self:
        """The same with both parts changed alike, and `others` of its fields replaced."""
        parts = {gear: change(own) for gear, own in zip(GEARS, self.of_gears)}
        return replace(self, **parts, **others)  # type: ignore[type-var]
