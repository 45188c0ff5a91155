"""Values of the steps of a march, kept in memory: all of some, of others those of the last steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fenics_gears.dynamics.march import March
from fenics_gears.model.storage import Arrays

Values = Mapping[str, np.ndarray]


@dataclass(frozen=True)
class Kind:
    """One step's value of a variable: its type and shape, and of how many last steps it is kept; 0: of all."""

    type: np.dtype
    shape: tuple[int, ...]
    last: int = 0

    @classmethod
    def of(cls, name: str, values: np.ndarray, stored: Arrays, steps: int, last: int) -> Kind:
        """That of `values` (s, ...), by the list of stored arrays or, where it does not name them, as they are; a run
        has so many `steps` at most."""
        dims, kind = stored.get(name, (("time",), values.dtype))
        return cls(kind, values.shape[1:], last if dims[0] == "contact_time" and last < steps else 0)

    def places(self, first: int, end: int, spare: int = 0) -> np.ndarray | slice:
        """Where the values of the steps from `first` to before `end` lie; `spare`: places beside those of the last
        steps."""
        return np.arange(first, end) % (self.last + spare) if self.last else slice(first, end)

    def kept_from(self, steps: int) -> int:
        """The first of so many steps that is kept."""
        return max(steps - self.last, 0) if self.last else 0


class Kept(Protocol):
    """Values that have been kept, in memory or on disk."""

    def get(self, name: str, steps: int) -> np.ndarray:
        """The values of the first so many steps, in the order of time."""


class InMemory:
    """Keeps the values of at most so many `steps`, of contact fields those of the `last`; `stored`: the arrays with a
    type of their own."""

    def __init__(self, stored: Arrays, steps: int, last: int):
        self.stored, self.steps, self.last = stored, steps, last
        self.kinds: dict[str, Kind] = {}
        self._arrays: dict[str, np.ndarray] = {}

    def put(self, first: int, values: Values, march: March | None = None) -> None:
        """Keep the values (s, ...) of the steps from `first` on, by name; the `march` so far is kept by who needs
        it."""
        for name, own in values.items():
            if name not in self.kinds:
                kind = self.kinds[name] = Kind.of(name, own, self.stored, self.steps, self.last)
                self._arrays[name] = np.empty((kind.last or self.steps, *kind.shape), kind.type)
            kind, end = self.kinds[name], first + len(own)
            begin = max(first, kind.kept_from(end))
            self._arrays[name][kind.places(begin, end)] = own[begin - first :]

    def get(self, name: str, steps: int) -> np.ndarray:
        """The values of the first so many steps, which all have been put, in the order of time."""
        kind = self.kinds[name]
        return self._arrays[name][kind.places(kind.kept_from(steps), steps)]
