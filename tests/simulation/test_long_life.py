"""What a process holds that simulates one pair after the other."""

import gc
import weakref
from dataclasses import replace

import pytest
from tests.coarse import coarse_scene, quasi_static
from tests.helical import helical_scene
from tests.pinned_numbers import in_the_plane, over_the_face
from tests.programs import python

from fenics_gears import Load, simulate
from fenics_gears.effects.coast_flanks import CoastFlanks
from fenics_gears.effects.corner_contact import EdgeRadii

# Bytes beside what is held after the first pair (30 pairs in the plane: 12e6). When operators stayed, five pairs took
# half a gigabyte more.
MOST_MORE = 60e6


def kinds(scene):
    still = quasi_static(scene)
    return {
        "quasi-static with friction": (still, in_the_plane),
        "in time": (scene, in_the_plane),
        "corners": (replace(still, friction=None, corner_contact=EdgeRadii(0.0)), in_the_plane),
        "coast flanks": (replace(still, coast_flanks=CoastFlanks(), load=Load(-1e5)), in_the_plane),
        "over the face": (helical_scene(), over_the_face),
    }


BY_NIGHT = [pytest.param(kind, marks=pytest.mark.nightly) for kind in ("in time", "corners", "coast flanks")]


@pytest.mark.parametrize("kind", ["quasi-static with friction", "over the face", *BY_NIGHT])
def test_contact_operators_go_with_their_run(paper_scene, kind):
    """Definition: nothing but the result is left of a run."""
    scene, prepare = kinds(coarse_scene(paper_scene, cycles=1))[kind]
    left = []

    def preparation(*arguments):
        gears, cycle = prepare(*arguments)
        left.append(weakref.ref(cycle))
        return gears, cycle

    gc.collect()
    gc.disable()
    try:
        result = simulate(scene, preparation=preparation)
        assert result.attrs["complete"] and left[0]() is None
    finally:
        gc.enable()


@pytest.mark.nightly
@pytest.mark.parametrize(("kind", "pairs"), [("plane", 10), ("face", 3)])
def test_different_pairs_take_no_more_and_more(kind, pairs):
    """proc(5), VmRSS, after the first and the last of some pairs."""
    said = python("-P", "-m", "tests.benchmarks.long_life", kind, pairs).stdout
    held = [1e6 * float(line.split()[1]) for line in said.splitlines()[1:]]
    assert len(held) > 2 and max(held) < held[0] + MOST_MORE
