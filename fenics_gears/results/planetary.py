"""What a run says of a planetary set: shares of its planets, forces of their pins, torques, centres and rotations of
its members, efficiency. All in the frame of the carrier, the sun being seen to turn counter-clockwise there."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fenics_gears.effects.wheel_points import FORCES
from fenics_gears.geometry.gear_train import Layout
from fenics_gears.geometry.planetary import CARRIER, RING, SUN
from fenics_gears.model.row_model import RowModel
from fenics_gears.scene.carrier import Carrier
from fenics_gears.scene.train_mesh import gear_names

from .layout import OVERALL
from .train_shafts import ResultOfShafts

MEMBER = "member"
PLANET = "planet"
# Those that hold the ring, and its motion there.
POINT = "ring_point"
RING_DEFLECTION = "ring_deflection"
PIN_DIRECTIONS = ("tangential", "radial")
Curves = Mapping[str, np.ndarray]
# Numbers of each set, of which those of a train with several are the largest; and further ones that a set may have.
LARGEST_OF_SETS = {
    "load_sharing_factor": ("1", "K_gamma of the sun's meshes"),
    "load_sharing_factor_ring": ("1", "K_gamma of the ring's meshes"),
    "largest_pin_force": ("N", "largest force of a planet on its pin"),
}
# Those that sets have where nothing else of them is asked for.
OF_SETS = {*LARGEST_OF_SETS, f"mean_{OVERALL}", f"peak_to_peak_{OVERALL}"}
NUMBERS_OF_SETS = {
    **LARGEST_OF_SETS,
    f"mean_{OVERALL}": ("rad", "lag of the output behind the input, mean"),
    f"peak_to_peak_{OVERALL}": ("rad", "lag of the output behind the input, peak to peak"),
    "efficiency": ("1", "power out over power in"),
    "basic_efficiency": ("1", "efficiency with the carrier at rest"),
    "floating": ("", "members whose centres move"),
}


def kinds_of_meshes(names: Sequence[str]) -> dict[str, list[int]]:
    """Places of meshes by what is said of them: those of all planets with the sun together, and with the ring.

    >>> kinds_of_meshes(["pair", "set: sun, planet 1", "set: planet 1, ring", "set: sun, planet 2"])
    {'pair': [0], 'set: sun and planets': [1, 3], 'set: planets and ring': [2]}
    """
    found: dict[str, list[int]] = {}
    for place, name in enumerate(names):
        with_sun = re.sub(r", planet \d+$", " and planets", name)
        kind = re.sub(r"(planet|step) \d+, (\w+)$", r"planets and \2", with_sun)
        found.setdefault(kind, []).append(place)
    return found


TORQUE = "torque on a member from outside, positive as the input's"
TORQUE_IN_TIME = "torque that a member takes to its teeth or pins, positive as the input's"


def result_of_set(row: RowModel, carrier: Carrier, states: np.ndarray, meshes: Sequence[Curves]) -> ResultOfShafts:
    """What the states (steps, k) of a march and the curves of all meshes say of a set. Numbers are of the
    recorded mesh cycles."""
    own = carrier.set
    last = slice(-1 - row.recorded, -1)
    shares = {name: _shares(meshes[carrier.meshes(kind)]) for kind, name in enumerate((SUN, RING))}
    torques = _member_torques(carrier, meshes)
    if carrier.in_time:
        pins = _pin_springs(row, carrier, states)
        arm = abs(row.models[0].pair.centre_distance)
        of_carrier = np.sign(own.weights[own.input]) * arm * pins[..., 0].sum(axis=1)
        torques[:, own.members.index(CARRIER)] = -of_carrier
        lag = states @ row.drivetrain.angle
        rotation = states @ row.drivetrain.of_members.T
    else:
        pins = _pin_forces(row.layout, carrier, meshes)
        lag = _output_lag(row, carrier, states)
        rotation = np.zeros((len(states), len(own.members)))
        # It stays behind, whichever way it turns; the sun turns counter-clockwise as the carrier sees it.
        onwards = np.sign(float(own.speeds[own.output] * own.sun_by_carrier))
        rotation[:, own.members.index(own.output)] = -onwards * lag
    over = ("time", PLANET)
    variables = {
        "planet_load_share": (over, shares[SUN], _said("1", "force of the sun on a planet over their mean")),
        "planet_load_share_ring": (over, shares[RING], _said("1", "force of a planet on the ring over their mean")),
        "pin_force": ((*over, "pin_direction"), pins, _said("N", "force of a planet on its pin")),
        "member_torque": (
            ("time", MEMBER), torques, _said("N mm", TORQUE_IN_TIME if carrier.in_time else TORQUE)
        ),
        "member_rotation": (
            ("time", MEMBER), rotation, _said("rad", "rotation of a member beyond its nominal one, counter-clockwise")
        ),
        **_centres(row, carrier, states),
        **_points(row, carrier, meshes),
        OVERALL: ("time", lag, _said("rad", "lag of the output behind the nominal motion of the input")),
    }  # fmt: skip
    coordinates = {
        PLANET: (PLANET, np.arange(1, own.planets + 1), {"long_name": "planet"}),
        MEMBER: (MEMBER, list(own.members), {"long_name": "member of the planetary set"}),
        "pin_direction": (
            "pin_direction", list(PIN_DIRECTIONS), {"long_name": "as the sun pushes its planet, and outwards"}
        ),
    }  # fmt: skip
    points = len(variables[RING_DEFLECTION][1].T) if RING_DEFLECTION in variables else 0
    if points:
        coordinates[POINT] = (POINT, np.arange(1, points + 1), {"long_name": "point that holds the ring"})
    numbers: dict[str, Any] = {
        "load_sharing_factor": float(shares[SUN][last].max()),
        "load_sharing_factor_ring": float(shares[RING][last].max()),
        "largest_pin_force": float(np.linalg.norm(pins[last], axis=-1).max()),
        "mean_overall_transmission_error": float(lag[last].mean()),
        "peak_to_peak_overall_transmission_error": float(np.ptp(lag[last])),
    }
    if carrier.moving:
        numbers["floating"] = " ".join(carrier.moving)
    if row.friction:
        numbers |= _efficiencies(carrier, torques[last].mean(axis=0))
    return ResultOfShafts(variables, coordinates, numbers)


def _said(units: str, words: str) -> dict[str, str]:
    return {"units": units, "long_name": words}


def _shares(meshes: Sequence[Curves]) -> np.ndarray:
    """Force of each planet over the mean of all (steps, planets)."""
    forces = np.stack([np.asarray(each["normal_force"]) for each in meshes], axis=1)
    mean = forces.mean(axis=1, keepdims=True)
    return np.divide(forces, mean, out=np.full_like(forces, np.nan), where=mean > 0.0)


def _member_torques(carrier: Carrier, meshes: Sequence[Curves]) -> np.ndarray:
    """Torques (steps, members), N mm, on the members from outside, without mass in balance with each other."""
    own = carrier.set
    sun, ring = (
        sum(np.abs(np.asarray(each["reaction_couple"])[:, kind]) for each in meshes[carrier.meshes(kind)])
        for kind in range(2)
    )
    # Against a second sun the planets turn it as the first one turns.
    ring = np.sign(own.weights[own.second]) * ring
    sign = np.sign(own.weights[own.input])
    return sign * np.stack([sun, ring, -(sun + ring)], axis=1)


def _pin_forces(layout: Layout, carrier: Carrier, meshes: Sequence[Curves]) -> np.ndarray:
    """Forces (steps, planets, 2), N, of the planets on their pins, tangential and radial."""
    found = []
    for number, angle in enumerate(carrier.set.angles):
        force = 0.0
        with_sun, with_ring = (range(len(meshes))[carrier.meshes(kind)][number] for kind in range(2))
        # The planet is driven by the sun and drives the ring.
        for mesh, side in ((with_sun, 1), (with_ring, 0)):
            own = meshes[mesh]
            along = np.stack([np.asarray(own["reaction_x"])[:, side], np.asarray(own["reaction_y"])[:, side]], axis=1)
            force = force + along @ layout.axes(mesh)
        outwards = np.array([np.cos(angle), np.sin(angle)])
        onwards = np.array([-outwards[1], outwards[0]])
        found.append(force @ np.stack([onwards, outwards], axis=1))
    return np.stack(found, axis=1)


def _pin_springs(row: RowModel, carrier: Carrier, states: np.ndarray) -> np.ndarray:
    """The same of a set with masses: what the springs of the pins take."""
    found = []
    for planet, angle in zip(carrier.planets, carrier.set.angles):
        outwards = np.array([np.cos(angle), np.sin(angle)])
        onwards = np.array([-outwards[1], outwards[0]])
        found.append(_places(row, states, planet) @ np.stack([onwards, outwards], axis=1))
    return (carrier.pin_stiffness or 0.0) * np.stack(found, axis=1)


def _places(row: RowModel, states: np.ndarray, gear: str) -> np.ndarray:
    """Where (steps, 2), mm, the centre of a gear stands beside its place, in space."""
    number = gear_names(row.meshes).index(gear)
    first, _ = row.graph.sides[number][0]
    places = [row.drivetrain.coordinates.index(f"centre_{axis}{number + 1}") for axis in "xy"]
    return states[:, places] @ row.layout.axes(first)


def _output_lag(row: RowModel, carrier: Carrier, states: np.ndarray) -> np.ndarray:
    """Lag (steps,), rad, of the output: the ring's, as the carrier sees it, by the teeth of ring and output."""
    own = carrier.set
    return (states @ row.drivetrain.angle) * abs(own.weights[own.second] / own.weights[own.output])


def _centres(row: RowModel, carrier: Carrier, states: np.ndarray) -> dict[str, tuple]:
    """Where the centres of the members stand (mm), to the right and upwards; only of what moves it is not zero."""
    if not carrier.moving:
        return {}
    members = carrier.set.members
    centres = np.zeros((len(states), 2, len(members)))
    for place, gear in enumerate((carrier.sun, carrier.ring)):
        if members[place] in carrier.moving:
            centres[:, :, place] = _places(row, states, gear)
    if CARRIER in carrier.moving:
        planets = np.hstack([_places(row, states, each) for each in carrier.planets])
        centres[:, :, -1] = planets @ carrier.centre_by_planets.T
    return {
        f"member_{axis}": (("time", MEMBER), centres[:, place], _said("mm", f"place of a member's centre, {where}"))
        for place, (axis, where) in enumerate(zip("xy", ("in the direction 0", "90 degrees counter-clockwise of it")))
    }


def _points(row: RowModel, carrier: Carrier, meshes: Sequence[Curves]) -> dict[str, tuple]:
    """Forces (steps, points), N, of the points that hold the ring, by all planets together, and its motion there."""
    with_ring = range(len(meshes))[carrier.meshes(1)]
    points = row.models[with_ring[0]].scene.wheel_points
    if points is None:
        return {}
    radial, tangential = (sum(np.asarray(meshes[mesh][name]) for mesh in with_ring) for name in FORCES)
    of_points = "force of a point on the ring, positive"
    return {
        "ring_support_radial": (("time", POINT), radial, _said("N", f"radial {of_points} outwards")),
        "ring_support_tangential": (
            ("time", POINT), tangential, _said("N", f"tangential {of_points} as the sun turns the planets")
        ),
        RING_DEFLECTION: (
            ("time", POINT), -radial / points.radial_stiffness, _said("mm", "motion of the ring at a point, outwards")
        ),
    }  # fmt: skip


def _efficiencies(carrier: Carrier, torques: np.ndarray) -> dict[str, float]:
    """Efficiency of the set by mean torques (members,), and that with the carrier at rest, of the same meshes."""
    own = carrier.set
    on = dict(zip(own.members, torques))
    whole = -on[own.output] * float(own.speeds[own.output]) / on[own.input]
    basic = on[own.second] * own.weights[SUN] / (on[SUN] * own.weights[own.second])
    return {"efficiency": whole, "basic_efficiency": abs(basic), "friction_loss": 1.0 - whole}
