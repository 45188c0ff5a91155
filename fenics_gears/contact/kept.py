"""The memory that contact operators may take."""

from dataclasses import dataclass
from math import inf

# Shares of the memory for contact operators: of those kept, and of a block of steps of a march, twice.
SHARE_KEPT = 0.7
SHARE_OF_A_BLOCK = 0.12


@dataclass
class Kept:
    """Memory (bytes) that operators may take at `most`, that the kept ones have `taken`, and of `others`, those of
    other cycles. Operators beyond are made again each time the cycle comes round."""

    most: float = inf
    taken: float = 0.0
    others: float = 0.0

    def takes(self, size: float) -> bool:
        """Whether there is room for this many bytes more, which are then counted."""
        if self.others + self.taken + size > SHARE_KEPT * self.most:
            return False
        self.taken += size
        return True
