"""Where the largest value of a curve that is known at some steps can lie between them.

Where a cubic through four steps agrees with the value in the middle of the inner two, the curve is that cubic there:
the largest value is that of its crest, and nothing more is asked for. Elsewhere the curve is taken to stay, between two
steps, below the straight lines through the steps on either side, as it does at corners where a tooth pair enters or
leaves contact. Lines through further points replace these, until no crossing lies above the largest value found.
All places are multiples of a part of a step, so that the runs of a search ask for the same ones; between two such
places the curve is a cubic or, at a corner, a parabola on either side.
Of a smooth curve that is known at the steps alone the largest value is that of the cubics, which is of fourth order.
"""

from __future__ import annotations

from collections.abc import Generator
from math import inf, isnan, nan, sqrt

import numpy as np

from fenics_gears.results.numbers import SAME

# Values asked for at most.
MOST_SOLVED = 20
# How far down from the largest value a curve is followed, in parts of what is sought.
NEAR = 25.0
# A curve has not jumped where it falls in the next step by at least this part of the fall before. A crest is smooth
# where the lower of the parabolas from either side is above the steps by at least this part of the higher one; between
# steps where their curvatures are as much alike.
LIKE = 0.5
# A cubic holds where it differs from a value between its steps by at most so many parts of what is sought: those
# through this value then differ by a tenth of that. Such a value is asked for at most this part of the interval from
# its middle.
AGREES, MIDDLE = 2.0, 0.25
# A position is sought no nearer to a step than this part of the distance to the next.
NEAREST = 0.02


def highest(
    steps: np.ndarray, values: np.ndarray, sought: float, finest: float, corners: bool = True
) -> Generator[float, float, tuple[float, float]]:
    """Place and largest value of a curve given at `steps` (s,) by `values` (s,): as a generator, which asks for its
    value, which may be not a number, at one place after the other between them. These are multiples of the `finest`
    part of a step; `corners`: between two of them the curve may be higher than both at a corner.

    Between the first two and the last two steps nothing is sought, nor where the curve is level at its top: it reaches
    what bounds it there. Ends where no crossing of lines is higher by `sought` and on either side of the largest value
    the curve falls by NEAR times that in small parts, so that lines are those beside the crest; or after MOST_SOLVED.
    """
    curve = _Curve(steps, values, sought, finest, corners)
    for _ in range(0 if _is_level(values) else MOST_SOLVED):
        interval, place = curve.next_place()
        found = (yield place) if interval else nan
        if isnan(found):
            break
        curve.take(interval, place, found)
    return curve.top()


def _is_level(values: np.ndarray) -> bool:
    """Whether a curve has its largest value at three steps in a row: two may lie on either side of a crest."""
    top = values >= values.max() - SAME * np.abs(values).max()
    return bool((top[2:] & top[1:-1] & top[:-2]).any())


class _Curve:
    """What a search knows of a curve: its points, and of each interval between two of them how high the curve may be
    there and where that is, whether a value was asked for, whether a cubic holds; and its crest, place and height,
    where a cubic holds or there is no place between.

    Plain numbers in lists: a new point changes four intervals, for which numpy takes ten times as long.
    """

    def __init__(self, steps: np.ndarray, values: np.ndarray, sought: float, finest: float, corners: bool):
        self._x, self._y, self._sought, self._finest = steps.tolist(), values.tolist(), sought, finest
        self._corners = corners
        count = max(len(values) - 1, 0)
        self._bounds, self._places, self._asked = [-inf] * count, [0.0] * count, [False] * count
        self._cubic, self._crests, self._heights = [False] * count, [0.0] * count, [-inf] * count
        for interval in _rising_beyond(steps, values, sought).tolist():
            self._look_at(interval)

    def top(self) -> tuple[float, float]:
        """Place and largest value of all points and crests."""
        value, crest = max(self._y), max(self._heights, default=-inf)
        if value >= crest:
            return self._x[self._y.index(value)], value
        return self._crests[self._heights.index(crest)], crest

    def next_place(self) -> tuple[int, float]:
        """The interval in which the largest value may lie, and the place there to ask for; 0 where it is known."""
        bound, crossing = max(self._bounds, default=-inf), True
        interval = self._bounds.index(bound) if bound > -inf else 0
        if bound <= self.top()[1] + self._sought:
            top, crossing = self._y.index(max(self._y)), False
            # Beside the crest of a cubic that holds there are no lines.
            known = any(self._cubic[max(top - 1, 0) : top + 1])
            interval = 0 if known else self._steep_neighbour(top)
        if not interval:
            return 0, nan
        start, end, part = self._x[interval], self._x[interval + 1], self._finest
        place = self._places[interval] if crossing and self._asked[interval] else 0.5 * (start + end)
        return interval, min(max(part * round(place / part), start + part), end - part)

    def take(self, interval: int, place: float, found: float) -> None:
        """The value found at a place in an interval, which it divides."""
        four = slice(interval - 1, interval + 3)
        holds = _holds(self._x[four], self._y[four], place, found, AGREES * self._sought)
        self._x.insert(interval + 1, place)
        self._y.insert(interval + 1, found)
        for known, both in (
            (self._bounds, -inf), (self._places, 0.0), (self._asked, True), (self._cubic, holds), (self._crests, 0.0),
            (self._heights, -inf),
        ):  # fmt: skip
            known[interval : interval + 1] = [both, both]
        for each in range(max(interval - 2, 1), min(interval + 4, len(self._bounds) - 1)):
            self._look_at(each)

    def _look_at(self, interval: int) -> None:
        """How high the curve may be in an interval, or is."""
        x, y = (of[interval - 1 : interval + 3] for of in (self._x, self._y))
        height, place, jumps = _bound(x, y)
        divisible, cubic = x[2] - x[1] >= 2.0 * self._finest, self._cubic[interval]
        self._bounds[interval], self._places[interval] = height if divisible and not cubic else -inf, place
        crest = 0.0, -inf
        if self._corners and not (divisible or cubic or jumps) and 1 < interval < len(self._x) - 3:
            crest = _corner(*(of[interval - 2 : interval + 4] for of in (self._x, self._y)))
        if cubic or not divisible and _is_smooth(x, y):
            of_cubic = tuple(float(each) for each in _crests(np.array(x), np.array(y)))
            crest = max(crest, of_cubic, key=lambda each: each[1])
        self._crests[interval], self._heights[interval] = crest

    def _steep_neighbour(self, top: int) -> int:
        """The steeper of the intervals in which the curve falls below its largest value, at the point `top`, by more
        than NEAR times what is sought on either side within a step of it; 0 where neither falls by so much in itself,
        has a place between, or both are at an end."""
        x, y, found = self._x, self._y, {}
        near = NEAR * self._sought
        for side in (-1, 1):
            end = top
            while 0 < end + side < len(y) - 1 and y[end + side] >= y[top] - near and abs(x[end + side] - x[top]) < 1.0:
                end += side
            interval = min(end, end + side)
            if 0 < interval < len(y) - 2 and x[interval + 1] - x[interval] >= 2.0 * self._finest:
                found[interval] = y[end] - y[end + side]
        interval = max(found, key=found.__getitem__, default=0)
        return interval if interval and found[interval] > near else 0


def _rising_beyond(steps: np.ndarray, values: np.ndarray, sought: float) -> np.ndarray:
    """The intervals but the outer ones in which a line from either side rises above the largest value by more than is
    sought: elsewhere the curve is lower, whatever is found beside it."""
    slope, h = np.diff(values) / np.diff(steps), np.diff(steps)[1:-1]
    highest_line = np.maximum(values[1:-2] + slope[:-2] * h, values[2:-1] - slope[2:] * h)
    return np.flatnonzero(highest_line > values.max() + sought) + 1


def _bound(x: list[float], y: list[float]) -> tuple[float, float, bool]:
    """How high a curve may be between the middle two of four points x, y (4,); the place that is to be solved there;
    and whether it may jump.

    That is the crossing of the lines from either side. Where one rises into the interval and the other lies far below
    its end, the curve may have jumped down anywhere: then half-way.
    """
    h, a, b = x[2] - x[1], y[1], y[2]
    left, right = (a - y[0]) / (x[1] - x[0]), (y[3] - b) / (x[3] - x[2])
    from_left, from_right = a + left * h, b - right * h
    if a >= b and left > 0.0 and from_right < a - LIKE * (a - b):
        return from_left, x[1] + 0.5 * h, True
    if b > a and right < 0.0 and from_left < b - LIKE * (b - a):
        return from_right, x[1] + 0.5 * h, True
    if left > right and from_right > a and from_left > b:
        crossing = min(max((from_right - a) / (left - right) / h, NEAREST), 1.0 - NEAREST)
        return a + left * crossing * h, x[1] + crossing * h, False
    return max(a, b), x[1] + 0.5 * h, False


def _corner(x: list[float], y: list[float]) -> tuple[float, float]:
    """Place and height of the crossing of the parabolas through the first and the last three of six points x, y (6,)
    between them; no height where they do not cross there, the first from below."""
    h = x[3] - x[2]
    before, after = (y[2] - y[1]) / (x[2] - x[1]), (y[4] - y[3]) / (x[4] - x[3])
    bend_before = (before - (y[1] - y[0]) / (x[1] - x[0])) / (x[2] - x[0])
    bend_after = ((y[5] - y[4]) / (x[5] - x[4]) - after) / (x[5] - x[3])
    # Slopes at the third and the fourth point; the first parabola less the second is c + u (b + u a), u from the third.
    before, after = before + (x[2] - x[1]) * bend_before, after - (x[4] - x[3]) * bend_after
    a, b, c = (
        bend_before - bend_after,
        before - after + 2.0 * h * bend_after,
        y[2] - y[3] + h * (after - h * bend_after),
    )
    inside = b * b - 4.0 * a * c
    if not (c < 0.0 < c + h * (b + h * a) and inside >= 0.0):
        return 0.0, -inf
    u = -2.0 * c / (b + sqrt(inside))
    return x[2] + u, y[2] + u * (before + u * bend_before)


def _differences(x, y):
    """Divided differences of four points x, y (4, ...): the middle first one, both second ones, the third one."""
    first = [(y[k + 1] - y[k]) / (x[k + 1] - x[k]) for k in range(3)]
    one, other = ((first[k + 1] - first[k]) / (x[k + 2] - x[k]) for k in range(2))
    return first[1], (one, other), (other - one) / (x[3] - x[0])


def _holds(x: list[float], y: list[float], place: float, found: float, most: float) -> bool:
    """Whether the cubic through four points x, y (4,), concave between the middle two, has the value `found` at a place
    in the middle there, but for `most`."""
    slope, (one, _), third = _differences(x, y)
    after = place - x[1]
    cubic = y[1] + after * (slope + (place - x[2]) * (one + third * (place - x[0])))
    return _is_smooth(x, y) and abs(found - cubic) <= most and abs(after / (x[2] - x[1]) - 0.5) <= MIDDLE


def _is_smooth(x: list[float], y: list[float]) -> bool:
    """Whether a curve bends alike through the first and the last three of four points x, y (4,), and down."""
    one, other = _differences(x, y)[1]
    return max(one, other) < 0.0 and min(one / other, other / one) >= LIKE


def _crests(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places and values of the crests of the cubics through each four points x, y (4, ...) between the middle two; no
    value where one has none there."""
    slope, (one, _), third = _differences(x, y)
    # It is y[1] + u (a + u (b + u third)), u from x[1] on.
    curvature, h = one + third * (x[1] - x[0]), x[2] - x[1]
    a, b = slope - h * curvature, curvature - h * third
    with np.errstate(divide="ignore", invalid="ignore"):
        # Not a number where there is none.
        fall = np.sqrt(b * b - 3.0 * a * third) - b
        u = a / fall
        inside = (fall > 0.0) & (u > 0.0) & (u < h)
        return x[1] + u, np.where(inside, y[1] + u * (a + u * (b + u * third)), -inf)


def largest_of_cubics(steps: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """Place and largest value of the cubics through each four consecutive `values` (s,) at whole `steps`, between the
    middle two.

    Only where the parabolas through three of them, either way, have crests alike: where the curve has a corner it is
    not a cubic.
    """
    place = int(values.argmax())
    found = float(steps[place]), float(values[place])
    if len(values) < 4:
        return found
    x, y = (np.array([each[k : len(each) - 3 + k] for k in range(4)], dtype=float) for each in (steps, values))
    _, (one, other), _ = _differences(x, y)
    top = np.maximum(y[1], y[2])
    with np.errstate(divide="ignore", invalid="ignore"):
        # Crests of both parabolas above the middle two values.
        crests = y[1] - (0.5 * (y[2] - y[0])) ** 2 / (4.0 * one), y[2] - (0.5 * (y[3] - y[1])) ** 2 / (4.0 * other)
        alike = np.minimum(*crests) - top >= LIKE * (np.maximum(*crests) - top)
    places, cubic = _crests(x, y)
    cubic = np.where((one < 0.0) & (other < 0.0) & alike, cubic, -inf)
    highest_one = int(cubic.argmax())
    return max(found, (float(places[highest_one]), float(cubic[highest_one])), key=lambda crest: crest[1])
