"""Windows and levels of made-up signals."""

import numpy as np
import pytest
import scipy.signal

from fenics_gears.results.spectrum import FLAT_TOP, HANN, NO_WINDOW, WINDOWS, order_lines, weights_of

TEETH, PERIOD, STEPS = (16, 24), 48, 40


def turns(cycles):
    """Turns of the pinion at each step of so many mesh cycles."""
    return np.arange(round(cycles * STEPS) + 1) / (STEPS * TEETH[0])


def cosine(order, cycles, amplitude=1.0):
    return amplitude * np.cos(2.0 * np.pi * order * turns(cycles) + 0.3)


@pytest.mark.parametrize("window, scipys", [(NO_WINDOW, "boxcar"), (HANN, "hann"), (FLAT_TOP, "flattop")])
def test_weights_are_scipys(window, scipys):
    """scipy.signal.get_window."""
    np.testing.assert_allclose(weights_of(window, 480), scipy.signal.get_window(scipys, 480), atol=1e-14)


@pytest.mark.parametrize("window", WINDOWS)
def test_a_line_on_a_bin_has_its_amplitude_and_its_square(window):
    """Exact: a cosine of 3.7 um with an offset; a window spreads it over as many bins as it has cosines."""
    found = order_lines(5.0 + cosine(16.0, PERIOD, 3.7), PERIOD, TEETH, window)
    assert found.at(16.0) == pytest.approx(3.7, rel=1e-6)
    assert found.square(16.0) == pytest.approx(3.7**2, rel=1e-6)
    beyond = np.abs(found.orders - 16.0) > (found.spread + 0.5) * found.spacing
    assert found.amplitudes[beyond].max() < 1e-9


@pytest.mark.parametrize(
    "window, most, left",
    [(NO_WINDOW, 1.0 - 2.0 / np.pi, 0.1), (HANN, 1.0 - 8.0 / (3.0 * np.pi), 2.5e-3), (FLAT_TOP, 1.2e-3, 1e-4)],
)
def test_a_line_between_bins_is_too_low_by_no_more_than_is_known(window, most, left):
    """Exact for a long record: 2/pi without a window, 8/(3 pi) in Hann's; 0.01 dB for the flat top (Harris 1978).
    `left`: leakage, 2/(pi d), 2/(pi d (d^2 - 1)) d bins away."""
    order = 16.0 + 0.5 * TEETH[0] / PERIOD
    found = order_lines(cosine(order, PERIOD), PERIOD, TEETH, window)
    assert abs(1.0 - found.amplitudes.max()) <= most * (1.0 + 5e-3)
    assert found.amplitudes[np.abs(found.orders - order) > 6.0 * found.spacing].max() < left
    if window != NO_WINDOW:
        assert found.square(order) == pytest.approx(1.0, abs=2e-3)
