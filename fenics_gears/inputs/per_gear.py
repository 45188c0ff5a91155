"""What has a part for each of the two gears of a pair, under the gear's name."""

from typing import Any

from .tree import GEARS


class PerGear:
    """Has the fields `pinion` and `wheel`."""

    @property
    def of_gears(self) -> tuple[Any, Any]:
        """The parts of both, in the order of a pair's sides."""
        first, second = (getattr(self, gear) for gear in GEARS)
        return first, second
