"""A run's load capacity, row by row: by the standard's own formulas from the nominal load, and from the loads and stresses that the run has computed."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan

import numpy as np
import xarray as xr

from fenics_gears.errors import SceneError
from fenics_gears.geometry.pair import GearPair, gear_pair
from fenics_gears.model.drivetrain import lumped_gears
from fenics_gears.rating.finish import Finish
from fenics_gears.rating.flank import flank_stress
from fenics_gears.rating.flash_temperature import flash_temperature, standard_share, transverse_line_force
from fenics_gears.rating.load_factors import load_factors
from fenics_gears.rating.operation import Operation, solid_reduced_mass
from fenics_gears.rating.root import root_stresses
from fenics_gears.results.settled import of_settled
from fenics_gears.scene.data import Scene

KILOGRAM = 1e3
# Points along the path of contact at which the standard's flash temperature is taken.
POINTS = 201


@dataclass(frozen=True)
class Row:
    """One quantity: symbol with its meaning, unit, value by the standard, and from the run; nan where one of them has none."""

    name: str
    unit: str
    standard: float
    computed: float


def rate(result: xr.Dataset, scene: Scene, finish: Finish) -> list[Row]:
    """The rows of a run. Raises SceneError for a scene without speed, load or elastic teeth."""
    operation = _operation(scene)
    factors, found = load_factors(operation, finish), result.attrs
    flank, roots = flank_stress(operation, finish, factors), root_stresses(operation, finish, factors)
    rows = [
        Row("K_v, dynamic factor", "1", factors.dynamic, found.get("dynamic_factor_by_force", nan)),
        Row("K_Hbeta, face load factor", "1", factors.face, found.get("face_load_factor", nan)),
        Row("K_Halpha, transverse load factor", "1", factors.transverse, found.get("transverse_load_factor", nan)),
    ]
    pressure = found.get("peak_contact_pressure", nan)
    for name, stress in zip(("pinion", "wheel"), flank.stress):
        rows.append(Row(f"sigma_H, contact stress of the {name}", "MPa", stress, pressure))
        rows.append(Row(f"S_H, safety against pitting of the {name}", "1", flank.limit / stress, flank.limit / pressure))
    for name, root in zip(("pinion", "wheel"), roots):
        computed = found.get(f"largest_root_stress_{name}", nan)
        rows.append(Row(f"sigma_F, root stress of the {name}", "MPa", root.stress, computed))
        rows.append(Row(f"S_F, safety against tooth breakage of the {name}", "1", root.limit / root.stress, root.limit / computed))
    return rows + _flash(operation, finish, result)


def _operation(scene: Scene) -> Operation:
    """What the standard rates: the steady load and the nominal speed of the scene."""
    if scene.gears.materials is None:
        raise SceneError("a rating needs elastic teeth: the scene has no [gears.material].")
    if not scene.load.wheel_torque > 0.0:
        raise SceneError("a rating needs a torque that the pinion drives: load.wheel_torque is not above zero.")
    if not scene.motion.speed_given:
        raise SceneError("a rating needs a speed: give the scene motion.pinion_speed or motion.mesh_frequency.")
    pair = gear_pair(scene.gears)
    return Operation(
        pair=pair,
        materials=scene.gears.materials,
        pinion_torque=scene.load.wheel_torque * pair.pinion.teeth / pair.wheel.teeth,
        pinion_speed=60.0 * scene.motion.mesh_frequency / pair.pinion.teeth,
        tip_relief=_tip_relief(scene),
        reduced_mass=_reduced_mass(scene, pair),
        gears=scene.gears,
    )


def _tip_relief(scene: Scene) -> float:
    """C_a, um: the smaller depth of both gears; 0 without relief, where running-in makes one."""
    relief = scene.tip_relief
    depths = [] if relief is None else [0.0 if own is None else own.depth for own in (relief.pinion, relief.wheel)]
    return 1e3 * min(depths, default=0.0)


def _reduced_mass(scene: Scene, pair: GearPair) -> float:
    """kg/mm: of the scene's moments of inertia, or of solid steel gears."""
    if scene.inertia is None:
        return solid_reduced_mass(pair)
    gears = zip(lumped_gears(scene, pair).values(), (pair.pinion, pair.wheel))
    first, second = (KILOGRAM * each.moment_of_inertia / gear.base_radius**2 / pair.face_width for each, gear in gears)
    return first * second / (first + second)


def _flash(operation: Operation, finish: Finish, result: xr.Dataset) -> list[Row]:
    """The largest flash temperature of a run with friction, by the standard's load share and by the computed forces of the tooth pairs."""
    friction = result.attrs.get("friction_coefficient")
    if friction is None:
        return []
    pair, settled = operation.pair, of_settled(result)
    path = np.linspace(pair.path_start, pair.path_end, POINTS)
    whole = finish.application_factor * transverse_line_force(pair, operation.tangential_force)
    standard = flash_temperature(pair, operation.materials, path, whole * standard_share(pair, path), friction, operation.pinion_speed)
    forces = settled["pair_normal_force"].transpose("time", "slot").values
    since = settled["mesh_phase"].values[:, None] - (settled["pair_number"].transpose("time", "slot").values - settled["pair_number"].attrs["number_at_phase_0"])
    places = pair.path_start + since * pair.base_pitch
    # Teeth that bend touch a little before and after the path of contact, where the formula's speeds are not theirs.
    on_path = (places >= pair.path_start) & (places <= pair.path_end) & np.isfinite(forces)
    # The standard's line force is in the transverse section; those of the run are along the contact normal.
    transverse = pair.cosine * forces[on_path] / pair.face_width
    computed = flash_temperature(pair, operation.materials, places[on_path], transverse, friction, operation.pinion_speed)
    return [Row("flash temperature", "K", float(standard.max()), float(computed.max(initial=0.0)))]
