"""Rows 1 to 3 at every step of random pairs whose flanks are resolved over the face."""

from collections import Counter

import pytest
from hypothesis import strategies as st
from tests.hard_cases.random_effects import decades
from tests.hard_cases.test_any_scene import Tally, judged
from tests.helical import INERTIA, SHAFTS, helical_scene, on_stand_in_bodies

from fenics_gears.contact.step_solver import NEWTON

# N mm on the wheel: ten times what these teeth are used at.
MOST_TORQUE = 2e6


@st.composite
def face_scenes(draw, frictions=st.one_of(st.just(0.0), decades(1e-4, 0.2))):
    """Any scene of flanks over a face; `frictions`: coefficients, 0 for none."""
    width, coast = draw(st.floats(6.0, 60.0)), draw(st.booleans())
    torque = MOST_TORQUE * draw(decades(1e-5, 1.0)) * (draw(st.sampled_from((1, -1))) if coast else 1)
    sign, friction = draw(st.sampled_from((1, -1))), draw(frictions)
    more = (
        f'[misalignment]\nin_plane = "{sign * draw(decades(1e-4, 0.2))!r} mm"\nout_of_plane ='
        f' "{draw(st.floats(-0.02, 0.02))!r} mm"\n'
    )
    if draw(st.booleans()):
        more += (
            f"[lead_modifications.{draw(st.sampled_from(('pinion', 'wheel')))}]\ncrowning ="
            f' "{draw(decades(1e-4, 0.03))!r} mm"\n'
        )
    if draw(st.booleans()):
        more += _bearings(draw)
    more += SHAFTS if draw(st.booleans()) else ""
    more += INERTIA if draw(st.integers(0, 2)) == 2 else ""
    more += f"[friction]\ncoefficient = {friction!r}\n" if friction else ""
    return helical_scene(
        more + ("[coast_flanks]\n" if coast else ""),
        teeth=(draw(st.integers(18, 40)), draw(st.integers(18, 90))),
        helix=draw(st.one_of(st.just(0.0), st.floats(1.0, 35.0))),
        hand=draw(st.sampled_from(("right", "left"))), width=width, torque=torque,
        offset=draw(st.floats(-0.2, 0.2)) * width, frequency=draw(decades(0.1, 1e4)), cycles=2,
        accuracy=f"slices = {draw(st.integers(2, 9))}\ncontact_nodes = "
            f"{draw(st.integers(2, 13))}\nsteps_per_mesh_cycle = 20",
    )  # fmt: skip


def _bearings(draw) -> str:
    stiffness, axial = (f"{draw(decades(1e3, 1e9))!r} N/mm" for _ in range(2))
    return (
        f'[bearings]\nstiffness = "{stiffness}"\naxial_stiffness = "{axial}"\nplaces = {{ pinion = ["-40 mm", "60 mm"],'
        ' wheel = ["-45 mm", "50 mm"] }\n'
    )


class MethodsToo(Tally):
    """The tally, and by which method steps were solved."""

    def __init__(self):
        super().__init__()
        self.methods = Counter()

    def judge(self, scene, compliances_of):
        run = super().judge(scene, compliances_of)
        self.methods.update(part.solution.method for record in run.records for part in record.parts or (record,))

    def tell(self, measured, gears):
        super().tell(measured, gears)
        solved = sum(self.methods.values())
        fallbacks = (
            ", ".join(f"{count} {method}" for method, count in self.methods.most_common() if method != NEWTON) or "none"
        )
        measured(f"steps by another method than Newton's, {gears}", f"of {solved}: {fallbacks}", "recorded", row=1)


@pytest.mark.parametrize("examples", [2, pytest.param(60, marks=pytest.mark.nightly)])
def test_every_step_of_any_scene_over_the_face(measured, examples):
    """The contact laws and Newton's third law in three dimensions, from the equations."""
    judged(MethodsToo(), measured, "stand-in bodies", on_stand_in_bodies, examples, face_scenes())


@pytest.mark.nightly
def test_every_step_with_strong_friction(measured):
    """As above, with friction up to 1."""
    judged(
        MethodsToo(),
        measured,
        "stand-in bodies, friction to 1",
        on_stand_in_bodies,
        60,
        face_scenes(decades(0.05, 1.0)),
    )
