"""Where the largest value of a curve that is known at some steps can lie between them.

Where a cubic through four steps agrees with the value in the middle of the inner two, the curve is that cubic there:
the largest value is that of its crest, and nothing more is asked for. Elsewhere the curve is taken to stay, between two
steps, below the straight lines through the steps on either side, as it does at corners where a tooth pair enters or
leaves contact. Lines through further points replace these, until no crossing lies above the largest value found.
Of a smooth curve that is known at the steps alone the largest value is that of the cubics, which is of fourth order.
"""

from __future__ import annotations

from collections.abc import Callable
from math import floor, log2, sqrt

import numpy as np

from fenics_gears.results.numbers import SAME

# Values asked for at most.
MOST_SOLVED = 20
# How far down from the largest value a curve is followed, in parts of what is sought. What falls within less than this
# part of a step jumps.
NEAR, WIDTH_OF_JUMP = 50.0, 1e-3
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
# Positions are sought in the middle between steps, and then where quarters, eighths and so on of a step are, next to
# where the lines cross: so that runs that differ little ask for the same ones. They divide the interval by more than 2
# to this power.
HALVINGS = 3


def highest(
    steps: np.ndarray, values: np.ndarray, value: Callable[[float], float], sought: float, finest: float = 0.0
) -> tuple[float, float]:
    """Place and largest value of a curve given at `steps` (s,) by `values` (s,), and anywhere between them by `value`,
    which may be not a number.

    Between the first two and the last two steps nothing is sought, nor between places nearer than twice the `finest`
    part of a step, of which all places are multiples; nor where the curve is level at its top: it reaches what bounds
    it there. Ends where no crossing of lines is higher by `sought` and on either side of the largest value
    the curve falls by NEAR times that in small parts, so that lines are those beside the crest; or after MOST_SOLVED.
    """
    # Of the intervals: what is known of a cubic in them, nothing where no value was asked for.
    asked, cubic = np.zeros((2, len(steps) - 1), dtype=bool)
    for _ in range(0 if _is_level(values) else MOST_SOLVED):
        interval, place = _next(steps, values, asked, cubic, sought, finest)
        found = value(place) if interval else np.nan
        if np.isnan(found):
            break
        four = slice(interval - 1, interval + 3)
        holds = _holds(steps[four], values[four], place, found, AGREES * sought)
        steps, values = np.insert(steps, interval + 1, place), np.insert(values, interval + 1, found)
        asked, cubic = np.insert(asked, interval, True), np.insert(cubic, interval, holds)
        asked[interval + 1], cubic[interval + 1] = True, holds
    return _top(steps, values, cubic)


def _is_level(values: np.ndarray) -> bool:
    """Whether a curve has its largest value at three steps in a row: two may lie on either side of a crest."""
    top = values >= values.max() - SAME * np.abs(values).max()
    return bool((top[2:] & top[1:-1] & top[:-2]).any())


def _next(
    steps: np.ndarray, values: np.ndarray, asked: np.ndarray, cubic: np.ndarray, sought: float, finest: float
) -> tuple[int, float]:
    """The interval in which the largest value may lie, and the place there to ask for; 0 where it is known."""
    bounds, places = _bounds(steps, values)
    bounds[cubic[1:-1] | (np.diff(steps)[1:-1] < 2.0 * finest)] = -np.inf
    interval, crossing = int(bounds.argmax()) + 1 if len(bounds) else 0, True
    if not interval or bounds[interval - 1] <= _top(steps, values, cubic)[1] + sought:
        top, crossing = int(values.argmax()), False
        # Beside the crest of a cubic that holds there are no lines.
        known = cubic[max(top - 1, 0) : top + 1].any()
        interval = 0 if known else _steep_neighbour(steps, values, NEAR * sought, max(2.0 * finest, WIDTH_OF_JUMP))
    start, end = steps[interval], steps[interval + 1]
    place = places[interval - 1] if crossing and asked[interval] else 0.5 * (start + end)
    return interval, _rounded(place, start, end, finest)


def _top(steps: np.ndarray, values: np.ndarray, cubic: np.ndarray) -> tuple[float, float]:
    """Place and largest value of all points and of the crests of the cubics that hold."""
    found = [_crest(steps[each - 1 : each + 3], values[each - 1 : each + 3]) for each in np.flatnonzero(cubic)]
    return max([(float(steps[values.argmax()]), float(values.max())), *found], key=lambda crest: crest[1])


def _differences(x: np.ndarray, y: np.ndarray) -> tuple[float, tuple[float, float], float]:
    """Divided differences of four points x, y (4,): the middle first one, both second ones, the third one."""
    first = np.diff(y) / np.diff(x)
    second = np.diff(first) / (x[2:] - x[:-2])
    return float(first[1]), (float(second[0]), float(second[1])), float((second[1] - second[0]) / (x[3] - x[0]))


def _holds(x: np.ndarray, y: np.ndarray, place: float, found: float, most: float) -> bool:
    """Whether the cubic through four points x, y (4,), concave between the middle two, has the value `found` at a place
    in the middle there, but for `most`."""
    slope, (one, other), third = _differences(x, y)
    after = place - x[1]
    cubic = y[1] + after * (slope + (place - x[2]) * (one + third * (place - x[0])))
    alike = max(one, other) < 0.0 and min(one / other, other / one) >= LIKE
    return bool(alike and abs(found - cubic) <= most and abs(after / (x[2] - x[1]) - 0.5) <= MIDDLE)


def _crest(x: np.ndarray, y: np.ndarray) -> tuple[float, float]:
    """Place and value of the crest of the cubic through four points x, y (4,) between the middle two; no value where it
    has none there."""
    slope, (one, _), third = _differences(x, y)
    # It is y[1] + u (a + u (b + u third)), u from x[1] on.
    curvature, h = one + third * (x[1] - x[0]), x[2] - x[1]
    a, b = slope - h * curvature, curvature - h * third
    inside = b * b - 3.0 * a * third
    fall = sqrt(inside) - b if inside >= 0.0 else 0.0
    u = a / fall if fall > 0.0 else 0.0
    return (float(x[1] + u), float(y[1] + u * (a + u * (b + u * third)))) if 0.0 < u < h else (float(x[1]), -np.inf)


def _rounded(place: float, start: float, end: float, finest: float) -> float:
    """The place of few digits in base 2 next to another between `start` and `end`, which have few themselves."""
    part = max(2.0 ** (floor(log2(end - start)) - HALVINGS), finest)
    return min(max(part * round(place / part), start + part), end - part)


def _steep_neighbour(steps: np.ndarray, values: np.ndarray, near: float, least: float) -> int:
    """The steeper of the intervals in which a curve falls below the largest value by more than `near` on either side
    within a step of it; 0 where neither falls by so much in itself, over the `least` part of a step, or both are at an
    end."""
    top, found = int(values.argmax()), {}
    for side in (-1, 1):
        end = top
        while (
            0 < end + side < len(values) - 1
            and values[end + side] >= values[top] - near
            and abs(steps[end + side] - steps[top]) < 1.0
        ):
            end += side
        interval = min(end, end + side)
        if 0 < interval < len(values) - 2 and steps[interval + 1] - steps[interval] >= least:
            found[interval] = float(values[end] - values[end + side])
    interval = max(found, key=found.__getitem__, default=0)
    return interval if interval and found[interval] > near else 0


def _bounds(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How high a curve may be (s - 3,) between points x, y (s,), each interval but the outer ones; and the place that
    is to be solved there.

    That is the crossing of the lines from either side. Where one rises into the interval and the other lies far below
    its end, the curve may have jumped down anywhere: then half-way.
    """
    slope, h = np.diff(y) / np.diff(x), np.diff(x)[1:-1]
    left, right, a, b = slope[:-2], slope[2:], y[1:-2], y[2:-1]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = np.clip((b - right * h - a) / (left - right) / h, NEAREST, 1.0 - NEAREST)
    meets = (left > right) & (b - right * h > a) & (a + left * h > b)
    height = np.where(meets, a + left * crossing * h, np.maximum(a, b))
    fell = (a >= b) & (left > 0.0) & (b - right * h < a - LIKE * (a - b))
    rose = (b > a) & (right < 0.0) & (a + left * h < b - LIKE * (b - a))
    height = np.where(fell, a + left * h, np.where(rose, b - right * h, height))
    return height, x[1:-2] + np.where(fell | rose, 0.5, np.where(meets, crossing, 0.5)) * h


def largest_of_cubics(steps: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """Place and largest value of the cubics through each four consecutive `values` (s,) at equal distances, between the
    middle two.

    Only where the parabolas through three of them, either way, have crests alike: where the curve has a corner it is
    not a cubic.
    """
    if len(values) < 4:
        return float(steps[values.argmax()]), float(values.max())
    y0, y1, y2, y3 = values[:-3], values[1:-2], values[2:-1], values[3:]
    top = np.maximum(y1, y2)
    first, second, third = 0.5 * (y2 - y0), y0 - 2.0 * y1 + y2, y3 - 3.0 * (y2 - y1) - y0
    other = second + third
    with np.errstate(divide="ignore", invalid="ignore"):
        # Crests of both parabolas above the middle two values; their curvatures are `second` and `other`.
        crests = [y1 - first**2 / (2.0 * second), y2 - (0.5 * (y3 - y1)) ** 2 / (2.0 * other)]
        slope = first - third / 6.0
        # Stationary point of y1 + slope t + second t^2/2 + third t^3/6, in the form without cancellation.
        t = -2.0 * slope / (second - np.sqrt(second**2 - 2.0 * slope * third))
        cubic = y1 + t * (slope + t * (0.5 * second + t * third / 6.0))
    low, high = np.minimum(*crests) - top, np.maximum(*crests) - top
    smooth = (second < 0.0) & (other < 0.0) & (t > 0.0) & (t < 1.0) & (low >= LIKE * high)
    cubic = np.where(smooth, cubic, top)
    place = int(cubic.argmax())
    at = float(t[place]) if smooth[place] else float(y2[place] > y1[place])
    return float(steps[1 + place]) + at, float(cubic[place])
