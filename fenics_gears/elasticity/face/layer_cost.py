"""What joining runs of layers takes: the steps of `runs_of_layers` with sizes in place of matrices."""

from __future__ import annotations

from dataclasses import dataclass, field

# Whether a layer has the whole section, and its thickness, as of `Sweep.kinds`.
Kind = tuple[float, bool]


@dataclass(frozen=True)
class LayeredSize:
    """Dofs of part of a section at a height, by whether it is that of a web's layer: off the `lines` and on them."""

    inside: dict[bool, float]
    lines: dict[bool, float]


@dataclass(frozen=True)
class _Run:
    """Dofs of a run of layers: at its lowest height off the lines and on them, on all lines, at the highest height."""

    low: float
    first: float
    lines: float
    last: float
    high: float

    @property
    def size(self) -> float:
        return self.low + self.lines + self.high


@dataclass
class LayerCost:
    """Numbers that are held at most while layers are joined, and multiplications; `size`: dofs on all lines."""

    numbers: float = 0.0
    operations: float = 0.0
    size: float = 0.0
    _known: dict[tuple, _Run] = field(default_factory=dict)

    @classmethod
    def of(cls, part: LayeredSize, kinds: list[Kind]) -> LayerCost:
        cost = cls()
        cost.size = cost._run(part, kinds, 0, len(kinds)).size
        cost._known.clear()
        return cost

    def _run(self, part: LayeredSize, kinds: list[Kind], first: int, last: int) -> _Run:
        ends, middle = (first == 0, last == len(kinds)), (first + last) // 2
        key = ends, *kinds[first:last]
        if key not in self._known:
            if last - first == 1:
                self._known[key] = self._layer(part, kinds[first][1], ends)
            else:
                below, above = self._run(part, kinds, first, middle), self._run(part, kinds, middle, last)
                if all(ends):
                    self._known.clear()
                self._known[key] = self._joined(below, above)
        return self._known[key]

    def _layer(self, part: LayeredSize, whole: bool, ends: tuple[bool, bool]) -> _Run:
        inside, line = part.inside[whole], part.lines[whole]
        low, high = (0.0 if end else inside for end in ends)
        run = _Run(low, line, 3.0 * line, line, high)
        self._eliminate(inside * (1 + sum(ends)), run.size, 0.0)
        return run

    def _joined(self, below: _Run, above: _Run) -> _Run:
        common, line = max(below.high, above.low), max(below.last, above.first)
        run = _Run(below.low, below.first, below.lines + above.lines - line, above.last, above.high)
        self._eliminate(common, run.size, below.size**2 + above.size**2)
        return run

    def _eliminate(self, free: float, kept: float, beside: float) -> None:
        """Count an elimination, the runs that are joined and those that are known `beside` it."""
        known = sum(run.size**2 for run in self._known.values())
        self.numbers = max(self.numbers, max(known, beside) + kept**2 + free * kept + free**2)
        self.operations += eliminating(free, kept)


def eliminating(free: float, kept: float) -> float:
    """Multiplications by which so many dofs are eliminated from others that are kept."""
    return free**3 / 6.0 + 0.5 * free**2 * kept + 0.5 * free * kept**2
