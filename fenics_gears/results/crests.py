"""Where the largest value of a curve that is known at some steps can lie between them.

Where a cubic through four steps agrees with the value in the middle of the inner two, the curve is that cubic there,
and its crest is the largest value. Elsewhere the curve is taken to stay, between two steps, below the straight lines
through the steps on either side, as at corners where a tooth pair enters or leaves contact. Lines through further
points replace these, until no crossing lies above the largest value found. All places are multiples of a part of a
step, so that the runs of a search ask for the same ones. Between two of them the curve is a cubic or, at a corner, a
parabola on either side. Of a smooth curve that is known at the steps alone the largest value is that of the cubics,
which is of fourth order.
"""

from math import inf, isnan, nan, sqrt

import numpy as np
from numba import njit

from .numbers import LIKE, SAME, crest_of_cubic, differences, is_smooth

# Values asked for at most.
MOST_SOLVED = 20
# How far down from the largest value a curve is followed, in parts of what is sought.
NEAR = 25.0
# A cubic holds where it differs from a value between its steps by at most so many parts of what is sought. The value is
# asked for near the middle of the interval, at most this part of it away.
AGREES = 2.0
MIDDLE = 0.25
# A position is sought no nearer to a step than this part of the distance to the next.
NEAREST = 0.02

# Of an interval between two points: how high the curve may be there and where that is; whether a value was asked for,
# whether a cubic holds. Place and height of its crest, where a cubic holds or no place is between.
KNOWN = BOUND, PLACE, ASKED, CUBIC, CREST, HEIGHT = range(6)
# Of a search: its points, values that it may still ask for (-1 before it begins), interval of the one asked for now.
COUNTED = COUNT, LEFT, AT = range(3)


class Searches:
    """Searches for the largest values of curves (c, s) that are given at `steps` (s,), side by side. Each asks for
    values of its curve between steps, at multiples of the `finest` part of a step. It ends when its largest value is
    known to `sought` (c,). `corners`: between two places a curve may be higher than both at a corner.

    `asked` (c,): the places asked for now, not a number where a search has ended; `tops` (c, 2): place and largest
    value, as far as they are known.

    Between the first two and the last two steps nothing is sought, nor where the curve is level at its top. A search
    ends where no crossing of lines is higher by what is sought, and the curve falls on either side of its largest value
    by NEAR times that in small parts. It ends after MOST_SOLVED values at the latest.
    """

    def __init__(self, steps: np.ndarray, curves: np.ndarray, sought: np.ndarray, finest: float, corners: bool = True):
        count, s = curves.shape
        self._points = np.zeros((count, 2, s + MOST_SOLVED))
        self._points[:, 0, :s] = steps
        self._points[:, 1, :s] = curves
        self._intervals = np.zeros((count, len(KNOWN), s + MOST_SOLVED))
        self._counted = np.tile([s, -1, 0], (count, 1))
        self._ends = np.full((count, 3), nan)
        self._settings = sought, float(finest), bool(corners)
        self.asked = self._ends[:, 0]
        self.tops = self._ends[:, 1:]
        self.take(self.asked)

    def take(self, values: np.ndarray) -> None:
        """Go on with the values (c,) at the places that were asked for; a search that gets none (not a number) ends."""
        _go_on(self._points, self._intervals, self._counted, self._ends, np.array(values), *self._settings)


@njit(cache=True)
def _go_on(points, intervals, counted, ends, values, sought, finest, corners):
    """Take the values (c,) that were asked for, and ask for the next ones."""
    for c in range(len(points)):
        x = points[c, 0]
        y = points[c, 1]
        known = intervals[c]
        own = counted[c]
        settings = (sought[c], finest, corners)
        if own[LEFT] < 0:
            own[LEFT] = 0 if _is_level(y[: own[COUNT]]) else MOST_SOLVED
            _begin(x[: own[COUNT]], y[: own[COUNT]], known, settings)
        elif isnan(values[c]):
            own[LEFT] = 0
        else:
            _take(x, y, known, own[COUNT], (own[AT], ends[c, 0], values[c]), settings)
            own[COUNT] += 1
            own[LEFT] -= 1
        x = x[: own[COUNT]]
        y = y[: own[COUNT]]
        known = known[:, : max(own[COUNT] - 1, 0)]
        place, top = _top(x, y, known)
        own[AT], asked = _next(x, y, known, top, settings) if own[LEFT] else (0, nan)
        ends[c] = asked, place, top


@njit(cache=True)
def _is_level(values):
    """Whether a curve has its largest value at three steps in a row: two may lie on either side of a crest."""
    least = values.max() - SAME * np.abs(values).max()
    row = 0
    for value in values:
        row = row + 1 if value >= least or row >= 3 else 0
    return row >= 3


@njit(cache=True)
def _begin(x, y, known, settings):
    """Look at the intervals but the outer ones in which a line from either side rises above the largest value by more
    than is sought."""
    known[BOUND] = -inf
    known[HEIGHT] = -inf
    highest = y.max() + settings[0]
    for i in range(1, len(x) - 2):
        h = x[i + 1] - x[i]
        from_left = y[i] + (y[i] - y[i - 1]) / (x[i] - x[i - 1]) * h
        from_right = y[i + 1] - (y[i + 2] - y[i + 1]) / (x[i + 2] - x[i + 1]) * h
        if max(from_left, from_right) > highest:
            _look_at(x, y, known, i, settings)


@njit(cache=True)
def _top(x, y, known):
    top = y.argmax()
    if len(known[HEIGHT]):
        crest = known[HEIGHT].argmax()
        if known[HEIGHT, crest] > y[top]:
            return known[CREST, crest], known[HEIGHT, crest]
    return x[top], y[top]


@njit(cache=True)
def _next(x, y, known, top, settings):
    """The interval in which the largest value may lie, and the place there to ask for; 0 where it is known."""
    interval = 0
    crossing = True
    bound = -inf
    sought, finest, _ = settings
    if len(known[BOUND]):
        bound = known[BOUND].max()
        interval = known[BOUND].argmax() if bound > -inf else 0
    if bound <= top + sought:
        at = y.argmax()
        crossing = False
        # Beside the crest of a cubic that holds there are no lines.
        interval = 0 if known[CUBIC, max(at - 1, 0) : at + 1].any() else _steep_neighbour(x, y, at, sought, finest)
    if not interval:
        return 0, nan
    start = x[interval]
    end = x[interval + 1]
    place = known[PLACE, interval] if crossing and known[ASKED, interval] else 0.5 * (start + end)
    return interval, min(max(finest * round(place / finest), start + finest), end - finest)


@njit(cache=True)
def _steep_neighbour(x, y, top, sought, finest):
    """The steeper of the two intervals next to the largest value, at the point `top`, where the curve falls by more
    than NEAR times what is sought within a step. 0 where neither falls so far, none has a place between, or both are at
    an end."""
    near = NEAR * sought
    steepest = 0
    fall = -inf
    for side in (-1, 1):
        end = top
        while 0 < end + side < len(y) - 1 and y[end + side] >= y[top] - near and abs(x[end + side] - x[top]) < 1.0:
            end += side
        interval = min(end, end + side)
        if (
            0 < interval < len(y) - 2
            and x[interval + 1] - x[interval] >= 2.0 * finest
            and y[end] - y[end + side] > fall
        ):
            steepest = interval
            fall = y[end] - y[end + side]
    return steepest if fall > near else 0


@njit(cache=True)
def _take(x, y, known, count, value, settings):
    """The value found in an interval at a place, which divides it."""
    interval, place, height = value
    holds = _holds(x[interval - 1 :], y[interval - 1 :], place, height, AGREES * settings[0])
    for i in range(count, interval + 1, -1):
        x[i] = x[i - 1]
        y[i] = y[i - 1]
        known[:, i - 1] = known[:, i - 2]
    x[interval + 1] = place
    y[interval + 1] = height
    for i in (interval, interval + 1):
        known[:, i] = 0.0
        known[BOUND, i] = -inf
        known[HEIGHT, i] = -inf
        known[ASKED, i] = 1.0
        known[CUBIC, i] = holds
    for i in range(max(interval - 2, 1), min(interval + 4, count - 1)):
        _look_at(x[: count + 1], y[: count + 1], known, i, settings)


@njit(cache=True)
def _look_at(x, y, known, interval, settings):
    """How high the curve may be in an interval, or is."""
    _, finest, corners = settings
    four = x[interval - 1 : interval + 3]
    heights = y[interval - 1 : interval + 3]
    height, place, jumps = _bound(four, heights)
    divisible = four[2] - four[1] >= 2.0 * finest
    cubic = known[CUBIC, interval] != 0.0
    known[BOUND, interval] = height if divisible and not cubic else -inf
    known[PLACE, interval] = place
    crest = 0.0
    top = -inf
    if corners and not (divisible or cubic or jumps) and 1 < interval < len(x) - 3:
        crest, top = _corner(x[interval - 2 : interval + 4], y[interval - 2 : interval + 4])
    if cubic or not divisible and is_smooth(four, heights):
        of_cubic, its_height = crest_of_cubic(four, heights)
        if its_height > top:
            crest = of_cubic
            top = its_height
    known[CREST, interval] = crest
    known[HEIGHT, interval] = top


@njit(cache=True)
def _bound(x, y):
    """How high a curve may be between the middle two of four points x, y (4,); the place that is to be solved there;
    and whether it may jump.

    That is the crossing of the lines from either side. It is half-way where one line rises into the interval and the
    other lies far below its end: the curve may have jumped down anywhere.
    """
    h = x[2] - x[1]
    a = y[1]
    b = y[2]
    left = (a - y[0]) / (x[1] - x[0])
    right = (y[3] - b) / (x[3] - x[2])
    from_left = a + left * h
    from_right = b - right * h
    if a >= b and left > 0.0 and from_right < a - LIKE * (a - b):
        return from_left, x[1] + 0.5 * h, True
    if b > a and right < 0.0 and from_left < b - LIKE * (b - a):
        return from_right, x[1] + 0.5 * h, True
    if left > right and from_right > a and from_left > b:
        crossing = min(max((from_right - a) / (left - right) / h, NEAREST), 1.0 - NEAREST)
        return a + left * crossing * h, x[1] + crossing * h, False
    return max(a, b), x[1] + 0.5 * h, False


@njit(cache=True)
def _corner(x, y):
    """Place and height where two parabolas cross: through the first and the last three of six points x, y (6,), between
    the two groups. No height where they do not cross there, the first from below."""
    h = x[3] - x[2]
    before = (y[2] - y[1]) / (x[2] - x[1])
    after = (y[4] - y[3]) / (x[4] - x[3])
    bend_before = (before - (y[1] - y[0]) / (x[1] - x[0])) / (x[2] - x[0])
    bend_after = ((y[5] - y[4]) / (x[5] - x[4]) - after) / (x[5] - x[3])
    # Slopes at the third and the fourth point; the first parabola less the second is c + u (b + u a), u from the third.
    before = before + (x[2] - x[1]) * bend_before
    after = after - (x[4] - x[3]) * bend_after
    a = bend_before - bend_after
    b = before - after + 2.0 * h * bend_after
    c = y[2] - y[3] + h * (after - h * bend_after)
    inside = b * b - 4.0 * a * c
    if not (c < 0.0 < c + h * (b + h * a) and inside >= 0.0):
        return 0.0, -inf
    u = -2.0 * c / (b + sqrt(inside))
    return x[2] + u, y[2] + u * (before + u * bend_before)


@njit(cache=True)
def _holds(x, y, place, height, most):
    """Whether the cubic through four points x, y (4,), concave in the middle, is `height` at a place, by `most`."""
    slope, (one, _), third = differences(x, y)
    after = place - x[1]
    cubic = y[1] + after * (slope + (place - x[2]) * (one + third * (place - x[0])))
    return is_smooth(x, y) and abs(height - cubic) <= most and abs(after / (x[2] - x[1]) - 0.5) <= MIDDLE
