"""What a run says of a planetary set: shares of its planets, forces of their pins, torques, centres and rotations of
its members, efficiency. All in the frame of the carrier, the sun being seen to turn counter-clockwise there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from fenics_gears.geometry.gear_train import Layout
from fenics_gears.geometry.planetary import CARRIER, MEMBERS, RING, SUN
from fenics_gears.model.train import RowModel
from fenics_gears.scene.carrier import Carrier
from fenics_gears.scene.train_mesh import gear_names

from .layout import OVERALL, in_microradians
from .train_shafts import ResultOfShafts

MEMBER = "member"
PLANET = "planet"
PIN_DIRECTIONS = ("tangential", "radial")
Curves = Mapping[str, np.ndarray]
# Numbers of each set, of which those of a train with several are the largest; and further ones that a set may have.
LARGEST_OF_SETS = {
    "load_sharing_factor": ("1", "K_gamma of the sun's meshes"),
    "load_sharing_factor_ring": ("1", "K_gamma of the ring's meshes"),
    "largest_pin_force": ("N", "largest force of a planet on its pin"),
}
NUMBERS_OF_SETS = {
    **LARGEST_OF_SETS,
    f"mean_{OVERALL}": ("rad", "lag of the output behind the input, mean"),
    f"peak_to_peak_{OVERALL}": ("rad", "lag of the output behind the input, peak to peak"),
    "efficiency": ("1", "power out over power in"),
    "basic_efficiency": ("1", "efficiency with the carrier at rest"),
    "floating": ("", "members whose centre nothing holds but their meshes"),
}


def result_of_set(row: RowModel, carrier: Carrier, states: np.ndarray, meshes: Sequence[Curves]) -> ResultOfShafts:
    """What the states (steps, k) of a march and the curves of all meshes say of a set. Numbers are of the
    recorded mesh cycles."""
    own = carrier.set
    last = slice(-1 - row.recorded, -1)
    shares = {name: _shares(meshes[kind::2]) for kind, name in enumerate((SUN, RING))}
    torques = _member_torques(carrier, meshes)
    pins = _pin_forces(row.layout, carrier, meshes)
    lag = _output_lag(row, carrier, states)
    rotation = np.zeros((len(states), len(MEMBERS)))
    # It stays behind, whichever way it turns; the sun turns counter-clockwise as the carrier sees it.
    onwards = np.sign(float(own.speeds[own.output] * own.sun_by_carrier))
    rotation[:, MEMBERS.index(own.output)] = -onwards * lag
    over = ("time", PLANET)
    variables = {
        "planet_load_share": (over, shares[SUN], _said("1", "force of the sun on a planet over their mean")),
        "planet_load_share_ring": (over, shares[RING], _said("1", "force of a planet on the ring over their mean")),
        "pin_force": ((*over, "pin_direction"), pins, _said("N", "force of a planet on its pin")),
        "member_torque": (
            ("time", MEMBER), torques, _said("N mm", "torque on a member from outside, positive as the input's")
        ),
        "member_rotation": (
            ("time", MEMBER), rotation, _said("rad", "rotation of a member beyond its nominal one, counter-clockwise")
        ),
        **_centres(row, carrier, states),
        OVERALL: ("time", lag, _said("rad", "lag of the output behind the nominal motion of the input")),
    }  # fmt: skip
    coordinates = {
        PLANET: (PLANET, np.arange(1, own.planets + 1), {"long_name": "planet"}),
        MEMBER: (MEMBER, list(MEMBERS), {"long_name": "member of the planetary set"}),
        "pin_direction": (
            "pin_direction", list(PIN_DIRECTIONS), {"long_name": "as the sun pushes its planet, and outwards"}
        ),
    }  # fmt: skip
    numbers: dict[str, Any] = {
        "load_sharing_factor": float(shares[SUN][last].max()),
        "load_sharing_factor_ring": float(shares[RING][last].max()),
        "largest_pin_force": float(np.linalg.norm(pins[last], axis=-1).max()),
        "mean_overall_transmission_error": float(lag[last].mean()),
        "peak_to_peak_overall_transmission_error": float(np.ptp(lag[last])),
    }
    if carrier.floating:
        numbers["floating"] = " ".join(carrier.floating)
    if row.models[0].scene.friction is not None:
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
    sun = sum(np.abs(np.asarray(each["reaction_couple"])[:, 0]) for each in meshes[0::2])
    ring = sum(np.abs(np.asarray(each["reaction_couple"])[:, 1]) for each in meshes[1::2])
    by_member = {SUN: sun, RING: ring, CARRIER: -(sun + ring)}
    sign = np.sign(carrier.set.weights[carrier.set.input])
    return sign * np.stack([by_member[each] for each in MEMBERS], axis=1)


def _pin_forces(layout: Layout, carrier: Carrier, meshes: Sequence[Curves]) -> np.ndarray:
    """Forces (steps, planets, 2), N, of the planets on their pins, tangential and radial."""
    found = []
    for number, angle in enumerate(carrier.set.angles):
        force = 0.0
        # The planet is driven by the sun and drives the ring.
        for mesh, side in ((2 * number, 1), (2 * number + 1, 0)):
            own = meshes[mesh]
            along = np.stack([np.asarray(own["reaction_x"])[:, side], np.asarray(own["reaction_y"])[:, side]], axis=1)
            force = force + along @ layout.axes(mesh)
        outwards = np.array([np.cos(angle), np.sin(angle)])
        onwards = np.array([-outwards[1], outwards[0]])
        found.append(force @ np.stack([onwards, outwards], axis=1))
    return np.stack(found, axis=1)


def _output_lag(row: RowModel, carrier: Carrier, states: np.ndarray) -> np.ndarray:
    """Lag (steps,), rad, of the output: the ring's, as the carrier sees it, by the teeth of ring and output."""
    weights = carrier.set.weights
    return (states @ row.drivetrain.angle) * abs(weights[RING] / weights[carrier.set.output])


def _centres(row: RowModel, carrier: Carrier, states: np.ndarray) -> dict[str, tuple]:
    """Where the centres of the members stand (mm), to the right and upwards; only of what floats it is not zero."""
    if not carrier.floating:
        return {}
    centres = np.zeros((len(states), 2, len(MEMBERS)))
    names = gear_names(row.meshes)
    coordinates = row.drivetrain.coordinates
    for member, gear in ((SUN, carrier.sun), (RING, carrier.ring)):
        if member not in carrier.floating:
            continue
        number = names.index(gear)
        first, _ = row.graph.sides[number][0]
        places = [coordinates.index(f"centre_{axis}{number + 1}") for axis in "xy"]
        centres[:, :, MEMBERS.index(member)] = states[:, places] @ row.layout.axes(first)
    return {
        f"member_{axis}": (("time", MEMBER), centres[:, place], _said("mm", f"place of a member's centre, {where}"))
        for place, (axis, where) in enumerate(zip("xy", ("in the direction 0", "90 degrees counter-clockwise of it")))
    }


def _efficiencies(carrier: Carrier, torques: np.ndarray) -> dict[str, float]:
    """Efficiency of the set by mean torques (members,), and that with the carrier at rest, of the same meshes."""
    own = carrier.set
    on = dict(zip(MEMBERS, torques))
    whole = -on[own.output] * float(own.speeds[own.output]) / on[own.input]
    basic = on[RING] * own.teeth[0] / (on[SUN] * own.teeth[2])
    return {"efficiency": whole, "basic_efficiency": abs(basic), "friction_loss": 1.0 - whole}


def set_rows(found: xr.Dataset) -> list[tuple[str, str, str]]:
    """What is printed of a set: rows of label, value and unit; of both kinds of meshes the largest of all planets."""
    attrs = found.attrs
    rows = [
        (f"overall transmission error, {label}", in_microradians(attrs[f"{name}_{OVERALL}"]), "urad of the output")
        for name, label in (("peak_to_peak", "peak to peak"), ("mean", "mean"))
    ]
    rows += [
        ("load sharing factor K_gamma, of the sun's meshes", f"{attrs['load_sharing_factor']:.6g}", ""),
        ("load sharing factor K_gamma, of the ring's meshes", f"{attrs['load_sharing_factor_ring']:.6g}", ""),
        ("largest force of a planet on its pin", f"{attrs['largest_pin_force']:.5g}", "N"),
    ]
    for place, member in enumerate(MEMBERS):
        torque = 1e-6 * float(found["member_torque"][:-1, place].mean())
        rows.append((f"torque on the {member} from outside, mean", f"{torque:.6g}", "kN m"))
    for member in attrs.get("floating", "").split():
        place = MEMBERS.index(member)
        radius = np.hypot(found["member_x"][:, place], found["member_y"][:, place])
        rows.append((f"centre of the {member}, farthest from its place", f"{1e3 * float(radius.max()):.4g}", "um"))
    for name, label in (("efficiency", "efficiency"), ("basic_efficiency", "efficiency with the carrier at rest")):
        if name in attrs:
            rows.append((label, f"{100.0 * attrs[name]:.5g}", "%"))
    for kind, name in enumerate(("sun and planets", "planets and ring")):
        own = found.isel(mesh=slice(kind, None, 2))
        for number, label, unit in OF_MESHES:
            if number in own and own[number].notnull().any():
                rows.append((f"{name}: {label}", f"{float(own[number].max()):.4g}", unit))
    return rows


OF_MESHES = (
    ("mean_mesh_stiffness", "mesh stiffness, mean", "N/(mm um)"),
    ("face_load_factor", "face load factor K_Hbeta", ""),
    ("largest_pair_force", "largest force of a tooth pair", "N"),
    ("peak_contact_pressure", "peak contact pressure", "MPa"),
)
