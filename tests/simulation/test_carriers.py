"""Carriers of planetary sets that give way between their pins, or stand on bearings that do."""

import numpy as np
import pytest
from tests.planets import planetary, planetary_text

from fenics_gears import SceneError, simulate_train, train_from_text

THREE = {"teeth": (17, 19, 55), "planets": "planets = 3"}
ERRORS = 'pin_errors = ["15 um", "0 um", "-5 um"]\nradial_pin_errors = ["0 um", "4 um", "0 um"]'


def with_carrier(tmp_path, stiffness: np.ndarray, more: str = "", load: str = 'input_torque = "600 N m"'):
    """The run of three planets whose carrier has a stiffness (6, 6), N/mm."""
    np.savetxt(tmp_path / "carrier.txt", stiffness, fmt="%.17g")
    text = planetary_text(**THREE, sections=f'[stages.set.carrier]\nstiffness = "carrier.txt"\n{more}', load=load)
    return simulate_train(train_from_text(text, directory=tmp_path))


def on_pins(more: str):
    return simulate_train(planetary(**THREE, sections=f"[stages.set.carrier]\n{more}\n{ERRORS}"))


def pushed(found) -> np.ndarray:
    """Forces (steps, planets, 2), N, of the planets on their pins, in the direction 0 and 90 degrees from it."""
    angles = 2.0 * np.pi / 3.0 * np.arange(3)
    outwards = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    onwards = np.stack([-outwards[:, 1], outwards[:, 0]], axis=1)
    pins = found["pin_force"].values
    return pins[..., :1] * onwards + pins[..., 1:] * outwards


@pytest.fixture(scope="module")
def springs():
    """Pins of one stiffness each in a rigid carrier that is held."""
    return on_pins('pin_stiffness = "3e5 N/mm"')


def same(found, other, tolerance: float = 1e-10) -> None:
    for name in ("overall_transmission_error", "normal_force", "pin_force"):
        size = float(np.abs(other[name]).max())
        np.testing.assert_allclose(found[name], other[name], rtol=0.0, atol=tolerance * size)


def test_a_carrier_of_springs_is_pins(tmp_path, springs):
    """A diagonal matrix is a spring at each pin; a matrix of 1e16 N/mm in series with pins leaves the pins."""
    same(with_carrier(tmp_path, 3e5 * np.eye(6), ERRORS), springs)
    same(with_carrier(tmp_path, 1e16 * np.eye(6), f'pin_stiffness = "3e5 N/mm"\n{ERRORS}'), springs)


def test_a_carrier_on_stiff_bearings_is_held(springs):
    """Bearings of 1e15 N/mm beside pins of 3e5: to 3e5/1e15."""
    same(on_pins('pin_stiffness = "3e5 N/mm"\nbearing_stiffness = "1e15 N/mm"'), springs, 1e-8)


def test_pins_in_series_give_way_as_sums_of_compliances(tmp_path):
    """A carrier and its pins, against the matrix whose compliance is that of both."""
    rng = np.random.default_rng(4)
    factor = rng.normal(size=(6, 6))
    own = 1e5 * (factor @ factor.T + 3.0 * np.eye(6))
    both = np.linalg.inv(np.linalg.inv(own) + np.eye(6) / 3e5)
    one = with_carrier(tmp_path, own, f'pin_stiffness = "3e5 N/mm"\n{ERRORS}')
    same(one, with_carrier(tmp_path, 0.5 * (both + both.T), ERRORS), 1e-9)


def test_soft_carriers_share_as_their_matrix_says(tmp_path):
    """All members held, the carrier so soft that it alone gives way: planets move by one arc less their pin errors, and
    radially as no radial force is left. Tangential forces F of a compliance C over the pins: C F = arc + errors."""
    rng = np.random.default_rng(7)
    factor = rng.normal(size=(6, 6))
    own = 2.0 * (factor @ factor.T + 3.0 * np.eye(6))
    found = with_carrier(tmp_path, own, 'pin_errors = ["0.1 mm", "0 mm", "0.05 mm"]', 'input_torque = "1 N m"')
    angles = 2.0 * np.pi / 3.0 * np.arange(3)
    onwards = np.zeros((3, 6))
    onwards[range(3), range(0, 6, 2)] = -np.sin(angles)
    onwards[range(3), range(1, 6, 2)] = np.cos(angles)
    held = np.linalg.inv(onwards @ np.linalg.inv(own) @ onwards.T)
    pins = found["pin_force"].values[..., 0]
    errors = held @ [0.1, 0.0, 0.05]
    arc = held.sum(axis=1)
    expected = errors + np.outer(pins.sum(axis=1) - errors.sum(), arc / arc.sum())
    np.testing.assert_allclose(pins, expected, rtol=0.0, atol=2e-3 * pins.max())
    assert np.ptp(pins[0]) > 0.1 * pins.max()


def test_bearings_of_a_carrier_balance_its_pins():
    """Its centre stands where springs hold all forces of the planets, at every instant."""
    found = on_pins('pin_stiffness = "3e5 N/mm"\nbearing_stiffness = "2e5 N/mm"')
    forces = pushed(found).sum(axis=1)
    centre = np.stack([found["member_x"].values[:, 2], found["member_y"].values[:, 2]], axis=1)
    assert np.abs(forces).max() > 100.0
    np.testing.assert_allclose(2e5 * centre, forces, rtol=0.0, atol=1e-10 * np.abs(pushed(found)).max())
    assert found.attrs["floating"] == "carrier"


def test_a_floating_carrier_shares_evenly_between_three():
    """Three tangential forces at 120 degrees with equal arms balance on a carrier that nothing else holds if, and only
    if, they are equal; sun and ring are held."""
    found = on_pins('pin_stiffness = "3e5 N/mm"\nbearing_stiffness = "0 N/mm"')
    pins = found["pin_force"].values[..., 0]
    assert np.ptp(pins, axis=1).max() < 1e-11 * pins.max()
    assert np.hypot(found["member_x"], found["member_y"])[:, 2].min() > 1e-3


def test_a_matrix_of_other_planets_is_refused(tmp_path):
    """Two displacements of each pin."""
    with pytest.raises(SceneError, match="has 4 rows for 3 planets; allowed are 6"):
        with_carrier(tmp_path, np.eye(4))
