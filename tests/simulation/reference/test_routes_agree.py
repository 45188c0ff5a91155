"""The reference route against the fast route."""

import numpy as np
import pytest
from tests.simulation.reference.involute_lever_arms import with_involute_arms

CASES = ("static", "static frictionless", "200 Hz", "200 Hz frictionless")


def distance(fast, reference):
    """Root mean square difference of T_E by its mean, and of T_EPP by itself."""
    difference = fast.transmission_error.values - reference.transmission_error.values
    mean = reference.transmission_error.values.mean()
    peaks = [np.ptp(result.transmission_error.values) for result in (fast, reference)]
    return np.sqrt(np.mean(difference**2)) / mean, abs(peaks[0] / peaks[1] - 1.0)


@pytest.mark.parametrize("case", [*CASES[:3], pytest.param(CASES[3], marks=pytest.mark.nightly)])
def test_routes_agree_on_the_papers_pair(case, paper_cases, both_routes):
    """T_E within 0.5 % of its mean and T_EPP within 3 % at equal flank resolution."""
    error, peak_to_peak = distance(*both_routes(paper_cases[case]))
    assert error < 0.005
    assert peak_to_peak < 0.03


@pytest.mark.nightly
@pytest.mark.parametrize("case, element", [*((case, "P2") for case in CASES), ("200 Hz", "Q1 incompatible")])
def test_routes_agree_at_the_papers_resolution(case, element, paper_cases, both_routes):
    """As above with 100 steps per mesh cycle."""
    error, peak_to_peak = distance(*both_routes(paper_cases[case], element, steps=100))
    assert error < 0.005
    assert peak_to_peak < 0.03


@pytest.mark.nightly
def test_routes_approach_each_other(paper_cases, both_routes):
    """With the same arms of the normal forces only discretisation is between the routes, of order one."""
    sizes = (0.16, 0.08)
    errors = [
        distance(*both_routes(paper_cases["200 Hz"], size=size, preparation=with_involute_arms))[0] for size in sizes
    ]
    assert errors[1] < 0.5 * errors[0]
    assert errors[1] < 1e-3


def test_published_arms_are_what_remains(paper_cases, both_routes):
    """Exact kinematics: the arms h = rb -+ y put the difference in T_E, below y/rb of the window."""
    published = distance(*both_routes(paper_cases["200 Hz"]))[0]
    involute = distance(*both_routes(paper_cases["200 Hz"], preparation=with_involute_arms))[0]
    assert involute < 0.5 * published
    assert published < 0.5 * 1.5 / 34.0


def test_newton_solves_every_step(paper_cases, both_routes):
    """The paper [B], whose method needs nothing else: no step needs a fallback."""
    for case in CASES[:3]:
        reference = both_routes(paper_cases[case])[1]
        steps = reference.attrs["steps_by_rung: newton"]
        assert steps == reference.attrs["steps"]


def test_result_is_labelled_and_complete(paper_cases, both_routes):
    """docs/promises.md: the same dataset, which says its route."""
    fast, reference = both_routes(paper_cases["static"])
    assert set(fast.data_vars) == set(reference.data_vars)
    assert (fast.attrs["condensation"], reference.attrs["condensation"]) == ("once", "every step")
    for name in fast.data_vars:
        assert fast[name].attrs == reference[name].attrs
        assert fast[name].dims == reference[name].dims
