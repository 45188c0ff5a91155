"""Where the largest value of a curve that is known at some steps can lie between them.

The curve is taken to stay, between two steps, below the straight lines through the steps on either side, as it does at
smooth crests and at corners where a tooth pair enters or leaves contact. Lines through further points replace these,
until no crossing lies above the largest value found. Of a smooth curve that is known at the steps alone it is the
largest of the cubics through four steps, which is of fourth order.
"""

from __future__ import annotations

from collections.abc import Callable
from math import floor, log2

import numpy as np

# Values asked for at most.
MOST_SOLVED = 20
# How far down from the largest value a curve is followed, in parts of what is sought. What falls within less than this
# part of a step jumps.
NEAR, WIDTH_OF_JUMP = 50.0, 1e-3
# A curve has not jumped where it falls in the next step by at least this part of the fall before. A crest is smooth
# where the lower of the parabolas from either side is above the steps by at least this part of the higher one.
LIKE = 0.5
# A position is sought no nearer to a step than this part of the distance to the next.
NEAREST = 0.02
# Positions are sought where halves, quarters and so on of a step are, next to where the lines cross: so that runs that
# differ little ask for the same ones. They divide the interval by more than 2 to this power.
HALVINGS = 3


def highest(
    steps: np.ndarray, values: np.ndarray, value: Callable[[float], float], sought: float
) -> tuple[float, float]:
    """Place and largest value of a curve given at `steps` (s,) by `values` (s,), and anywhere between them by `value`,
    which may be not a number.

    Between the first two and the last two steps nothing is sought. Ends where no crossing of lines is higher by
    `sought` and on either side of the largest value the curve falls by NEAR times that in small parts, so that lines
    are those beside the crest; or after MOST_SOLVED.
    """
    for _ in range(MOST_SOLVED):
        bounds, places = _bounds(steps, values)
        interval = int(bounds.argmax()) + 1 if len(bounds) else 0
        if not len(bounds) or bounds[interval - 1] <= values.max() + sought:
            interval = _steep_neighbour(steps, values, NEAR * sought)
            if not interval:
                break
            place = 0.5 * (steps[interval] + steps[interval + 1])
        else:
            place = _rounded(places[interval - 1], steps[interval], steps[interval + 1])
        found = value(place)
        if np.isnan(found):
            break
        steps, values = np.insert(steps, interval + 1, place), np.insert(values, interval + 1, found)
    return float(steps[values.argmax()]), float(values.max())


def _rounded(place: float, start: float, end: float) -> float:
    """The place of few digits in base 2 next to another between `start` and `end`, which have few themselves."""
    part = 2.0 ** (floor(log2(end - start)) - HALVINGS)
    return min(max(part * round(place / part), start + part), end - part)


def _steep_neighbour(steps: np.ndarray, values: np.ndarray, near: float) -> int:
    """The steeper of the intervals in which a curve falls below the largest value by more than `near` on either side
    within a step of it; 0 where neither falls by so much in itself, over more than a jump's width, or both are at an
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
        if 0 < interval < len(values) - 2 and steps[interval + 1] - steps[interval] > WIDTH_OF_JUMP:
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
