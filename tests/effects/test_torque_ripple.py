"""``[torque_ripple]``: the couple on the wheel's shaft, what it does, and what the section says when it is wrong."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import COARSE, frictionless, quasi_static
from tests.frozen_gears import frozen_marcher
from tests.paper_text import PAPER as DEMO

from fenics_gears import SceneError, scene_from_text, simulate
from fenics_gears.contact.laws import OPEN
from fenics_gears.dynamics.average_acceleration import State
from fenics_gears.dynamics.steps import Record
from fenics_gears.dynamics.torque_ripple import varying_load
from fenics_gears.effects.torque_ripple import Harmonic, TorqueRipple
from fenics_gears.scene.data import Motion

ORDER = 24.0  # of the wheel's turn: once a mesh cycle
RIPPLE = TorqueRipple((Harmonic(ORDER, 30e3, 0.4), Harmonic(2.5, 10e3)))


def coarse(scene, cycles=2):
    """The scene on a coarse mesh, every cycle kept."""
    return replace(scene, accuracy=COARSE, motion=Motion(200.0, cycles, cycles))


def expected_couple(result, ripple, torque=437e3, teeth=24):
    """The couple (time,), N mm, written out by hand."""
    turned = 2.0 * np.pi * result.mesh_phase.values / teeth
    return torque + sum(each.amplitude * np.cos(each.order * turned + each.phase) for each in ripple.harmonics)


@pytest.mark.parametrize(
    ("harmonics", "said"),
    [
        ("[]", "is empty"),
        ('"20 N m"', "is not a list"),
        ("[3]", "is no table"),
        ('[{ amplitude = "20 N m" }]', "has no order at place 1"),
        ('[{ order = 1, amplitude = "20 N m" }, { order = 0, amplitude = "20 N m" }]', "order = 0 at place 2"),
        ('[{ order = 1, amplitude = "20 mm" }]', "is a length, not a torque"),
        ('[{ order = 1, amplitude = "-20 N m" }]', "is negative"),
        ('[{ order = 1, amplitud = "20 N m" }]', 'Did you mean "amplitude"?'),
        (
            '[{ order = 1, amplitude = "400 N m" }, { order = 2, amplitude = "40 N m" }]',
            "440 N m together, more than load.wheel_torque",
        ),
    ],
)
def test_a_wrong_section_is_refused(harmonics, said):
    """House rule 7; what is wrong, at which place of the list, and what is allowed."""
    with pytest.raises(SceneError) as refused:
        scene_from_text(DEMO + f"[torque_ripple]\nharmonics = {harmonics}\n")
    assert said in str(refused.value) and "Allowed: " in str(refused.value)


def test_quasi_static_transmission_error_follows_the_couple(paper_scene):
    """Exact: without friction and inertia a step knows only its own couple, so that the error at a step is that under
    the constant couple of the same size; on elastic shafts and teeth alike."""
    scene = coarse(frictionless(quasi_static(paper_scene)), cycles=1)
    result = simulate(replace(scene, torque_ripple=RIPPLE))
    couples = expected_couple(result, RIPPLE)
    assert result.wheel_couple.values == pytest.approx(couples, rel=1e-14)
    for step in (0, 13, 29):
        constant = simulate(replace(scene, load=replace(scene.load, wheel_torque=float(couples[step]))))
        assert result.transmission_error.values[step] == pytest.approx(
            constant.transmission_error.values[step], rel=1e-10
        )
        assert result.normal_force.values[step] == pytest.approx(
            couples[step] / result.attrs["base_radius_wheel"], rel=1e-10
        )


def tied(marcher, shafts):
    """Stiffness (k, k), N/mm, of drivetrain and contact with the nodes that are closed at rest; and the record at
    rest."""
    rest = marcher.start()
    operator, closed = rest.position.operator, np.flatnonzero(rest.solution.status != OPEN)
    rigid = operator.jacobian[closed]
    return shafts.stiffness + rigid.T @ np.linalg.solve(operator.compliance[np.ix_(closed, closed)], rigid), rest


def with_ripple(scene, pair, flanks, time_step, ripple, shaft_step):
    """A marcher of gears that do not roll, under a couple that ripples."""
    marcher, shafts = frozen_marcher(replace(scene, friction=None), pair, flanks, time_step)
    marcher.loads = (varying_load(ripple, shafts, shaft_step),)
    return marcher, shafts


@pytest.mark.parametrize("frequency", [5.0, 120.0, 400.0])
def test_steady_vibration_is_the_frequency_response(paper_scene, paper_pair, stand_in_flanks, frequency):
    """Exact solution: gears that do not roll, closed nodes staying closed, are linear; the march's steady answer to one
    harmonic is that of the matrices, with (2/dt) tan(omega dt/2) for omega, which is how average acceleration sees it
    (Bathe, Finite Element Procedures, 9.4);
    that tends to the frequency response with order two."""
    per_period, errors = 40, []
    for refinement in (1, 2):
        count = per_period * refinement
        time_step, ripple = 1.0 / (frequency * count), TorqueRipple((Harmonic(1.0, 0.5),))
        marcher, shafts = with_ripple(paper_scene, paper_pair, stand_in_flanks, time_step, ripple, 2.0 * np.pi / count)
        marcher.loads, loads = (), marcher.loads
        stiffness, rest = tied(marcher, shafts)
        marcher.loads = loads
        force = loads[0](0)

        def response(omega):
            return np.linalg.solve(stiffness + 1j * omega * shafts.damping - omega**2 * shafts.mass, force)

        omega = 2.0 * np.pi * frequency
        seen = 2.0 / time_step * np.tan(0.5 * omega * time_step)
        answer = response(seen)
        # Begun on the steady vibration itself, so that nothing has to die away.
        start = State(rest.state.position + answer.real, (1j * seen * answer).real, (-(seen**2) * answer).real)
        closed = rest.solution.status
        operator, nodes = rest.position.operator, np.flatnonzero(closed != OPEN)
        forces = rest.solution.forces.copy()
        forces[nodes] += np.linalg.solve(
            operator.compliance[np.ix_(nodes, nodes)], operator.jacobian[nodes] @ answer.real
        )
        record, positions = Record(0, start, rest.position, replace(rest.solution, forces=forces)), []
        for step in range(1, 2 * count + 1):
            record = marcher.step(marcher.dynamic, record, step)
            assert np.array_equal(record.solution.status, closed)
            positions.append(record.state.position - rest.state.position)
        turned = np.exp(-2j * np.pi * np.arange(1, 2 * count + 1) / count)
        phasor = 1.0 / count * turned @ np.array(positions)
        assert phasor == pytest.approx(answer, abs=1e-6 * np.abs(answer).max())
        errors.append(np.abs(phasor - response(omega)).max() / np.abs(answer).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.15)


def test_a_ripple_far_above_all_vibrations_is_not_felt(paper_scene):
    """Known limit: at 20 kHz the gears stay at their mean position whatever rides on the couple; they start where the
    loads of a whole cycle balance, so that nothing rings."""
    scene = replace(frictionless(coarse(paper_scene)), motion=Motion(20e3, 30, 2))
    ripple = TorqueRipple((Harmonic(24.0, 200e3),))
    off, on = (simulate(replace(scene, torque_ripple=each)) for each in (None, ripple))
    static = simulate(quasi_static(coarse(frictionless(paper_scene))))
    assert on.attrs["mean_transmission_error"] == pytest.approx(off.attrs["mean_transmission_error"], rel=2e-3)
    assert on.attrs["peak_to_peak_transmission_error"] < 0.05 * static.attrs["peak_to_peak_transmission_error"]
    assert "lose contact" not in on.attrs["warnings"]
