"""Flanks pressed together at the pitch point against Hertz's exact solution: no limit is extrapolated."""

import numpy as np
import pytest
from tests.benchmarks.hertz import pressed_scene
from tests.hertz_contact import QUANTITIES, HertzContact

FLANK_ELEMENTS = (1, 2, 4, 8)


@pytest.fixture(scope="module")
def hertz():
    """The paper's pair under its whole load."""
    return HertzContact(pressed_scene(1.0))


@pytest.fixture(scope="module")
def gears(hertz):
    """Both gears by flank elements in a half-width."""
    width = hertz.half_width(hertz.line_load)
    return {n: hertz.compliances(width / n) for n in FLANK_ELEMENTS}


def observed(errors):
    return np.log2(np.abs(np.array(errors[:-1]) / np.array(errors[1:])))


@pytest.mark.nightly
def test_contact_nodes_converge_to_hertz(hertz, gears):
    """Literature (Johnson 1985, ch. 4 and 5): peak pressure, half-width, and what the approach changes by with the
    load, order 2 or better."""
    width = hertz.half_width(hertz.line_load)
    errors = [hertz.errors(gears[8], width / n) for n in (2, 4, 8)]
    for name in QUANTITIES:
        falling = np.abs([each[name] for each in errors])
        assert np.log2(falling[0] / falling[-1]) / 2.0 > 1.6, name
    assert (
        abs(errors[1]["approach"]) < 0.002
        and abs(errors[1]["half-width"]) < 0.02
        and abs(errors[1]["peak pressure"]) < 0.003
    )


@pytest.mark.nightly
@pytest.mark.parametrize("gear", [0, 1])
def test_flank_elements_converge_to_the_half_plane(hertz, gears, gear):
    """Exact: under pressures of one shape and load the half-plane's displacement goes with the logarithm of their width
    alone; order 2."""
    body = (hertz.pair.pinion, hertz.pair.wheel)[gear]
    errors = [hertz.flank_error(body, gears[n][gear]) for n in (1, 2, 4)]
    assert (np.abs(observed(errors) - 2.0) < 0.5).all()
    assert abs(errors[-1]) < 0.01
