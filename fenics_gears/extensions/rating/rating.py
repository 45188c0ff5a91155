"""A run's load capacity, row by row: by the standard's formulas from the nominal load, and by what the run has
computed."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from math import isnan, nan

import numpy as np
import xarray as xr

from fenics_gears import (
    GearPair,
    Scene,
    SceneError,
    face_compliance_of_shafts,
    face_opening,
    gear_pair,
    lumped_gears,
    middles_of_slices,
    model_of,
    of_settled,
)
from fenics_gears.scene_text import GEARS

from .finish import Finish
from .flank import flank_stress
from .flash_temperature import flash_temperature, standard_share, transverse_line_force
from .load_factors import iterated_face_factor, load_factors, mesh_misalignment
from .operation import Operation, solid_reduced_mass
from .root import root_stresses

KILOGRAM = 1e3
# The axes' inclination by the load, um over the common face.
INCLINED = "mean_axis_inclination_in_plane"
# Points along the path of contact at which the standard's flash temperature is taken.
POINTS = 201
# Of the endurance limit of the root, for teeth that are fully bent both ways in each turn, as those of idlers (ISO
# 6336-5:2016, 5.3.3, reversed bending; fewer reversals by ISO 6336-3, annex B).
REVERSED = 0.7
# How near to a place, in base pitches, is there.
BESIDE = 0.03


@dataclass(frozen=True)
class RatingRow:
    """One quantity: symbol with its meaning, unit, value by the standard, and from the run; NaN where one has none."""

    name: str
    unit: str
    standard: float
    computed: float


def rate(result: xr.Dataset, scene: Scene, finish: Finish, idlers: Collection[str] = ()) -> list[RatingRow]:
    """The rows of a run; `idlers`: which of "pinion" and "wheel" are bent both ways. Raises SceneError for a scene
    without speed, load or elastic teeth."""
    operation = _operation(scene, finish, result)
    factors = load_factors(operation)
    numbers = result.attrs
    face = numbers.get("face_load_factor", nan)
    misaligned = nan if isnan(face) else abs(operation.misalignment or 0.0)
    flank = flank_stress(operation, factors)
    roots = root_stresses(operation, factors)
    rows = [
        RatingRow("K_v, dynamic factor", "1", factors.dynamic, numbers.get("dynamic_factor_by_force", nan)),
        RatingRow("F_betax, misalignment over the face", "um", mesh_misalignment(operation), misaligned),
        RatingRow("K_Hbeta, face load factor", "1", factors.face, face),
    ]
    if operation.shafts is not None:
        iterated = iterated_face_factor(operation, factors.dynamic)
        rows.append(RatingRow("K_Hbeta, line load iterated over the shafts", "1", iterated, face))
    transverse = numbers.get("transverse_load_factor", nan)
    rows.append(RatingRow("K_Halpha, transverse load factor", "1", factors.transverse, transverse))
    pressure = numbers.get("peak_contact_pressure", nan)
    for name, stress in zip(GEARS, flank.stress):
        rows.append(RatingRow(f"sigma_H, contact stress of the {name}", "MPa", stress, pressure))
        safeties = flank.limit / stress, flank.limit / pressure
        rows.append(RatingRow(f"S_H, safety against pitting of the {name}", "1", *safeties))
    for name, root in zip(GEARS, roots):
        computed = numbers.get(f"largest_root_stress_{name}", nan)
        rows.append(RatingRow(f"sigma_F, root stress of the {name}", "MPa", root.stress, computed))
        limit = root.limit * (REVERSED if name in idlers else 1.0)
        safeties = limit / root.stress, limit / computed
        rows.append(RatingRow(f"S_F, safety against tooth breakage of the {name}", "1", *safeties))
    return rows + _flash(operation, result)


def _operation(scene: Scene, finish: Finish, result: xr.Dataset) -> Operation:
    if scene.gears.materials is None:
        raise SceneError("a rating needs elastic teeth: the scene has no [gears.material].")
    if not scene.load.wheel_torque > 0.0:
        raise SceneError("a rating needs a torque that the pinion drives: load.wheel_torque is not above zero.")
    if not scene.motion.speed_given:
        speeds = "motion.pinion_speed or motion.mesh_frequency, a train motion.input_speed"
        raise SceneError(f"a rating needs a speed: give the scene {speeds}.")
    if scene.gears.wheel.teeth < 0:
        raise SceneError("ratings of internal gears are not computed yet. Allowed: two external gears.")
    pair = gear_pair(scene.gears)
    misalignment = _misalignment(scene, pair)
    inclined = result.attrs.get(INCLINED)
    return Operation(
        pair=pair,
        materials=scene.gears.materials,
        pinion_torque=scene.load.wheel_torque * pair.pinion.teeth / pair.wheel.teeth,
        pinion_speed=60.0 * scene.motion.mesh_frequency / pair.pinion.teeth,
        tip_relief=_tip_relief(scene),
        reduced_mass=_reduced_mass(scene, pair),
        gears=scene.gears,
        finish=finish,
        misalignment=misalignment if inclined is None else (misalignment or 0.0) + inclined,
        **_on_bent_shafts(scene, pair),
    )


def _shafts_bend(scene: Scene) -> bool:
    return scene.shafts is not None and scene.shafts.sections is not None


def _on_bent_shafts(scene: Scene, pair: GearPair) -> dict[str, np.ndarray]:
    # In a train other gears bend its shafts too.
    if not _shafts_bend(scene) or scene.shafts.in_train:
        return {}
    z = middles_of_slices(pair)
    return {
        "shafts": face_compliance_of_shafts(model_of(scene).drivetrain.systems, pair, z),
        "opening": face_opening(pair, scene.lead_modifications, scene.misalignment, z),
    }


def _misalignment(scene: Scene, pair: GearPair) -> float | None:
    """Misalignment (um) over the common face of the scene's axes and helix slopes, in the plane of action; None of a
    scene that names neither.

    It is the straight part of the gap between the unloaded flanks along the face.
    """
    leads = scene.lead_modifications
    sloped = leads is not None and any(own is not None and own.helix_slope for own in (leads.pinion, leads.wheel))
    if scene.misalignment is None and not sloped:
        return None
    z = np.linspace(*pair.common_face, POINTS)
    return 1e3 * pair.face_width * float(np.polyfit(z, face_opening(pair, leads, scene.misalignment, z), 1)[0])


def of_misalignment(scene: Scene, finish: Finish) -> str:
    """A sentence on the misalignment that the standard's K_Hbeta counts, and whether the run has the same."""
    if _shafts_bend(scene):
        iterated = "; iterated: method B, without running-in, with the twist within the teeth cut into a shaft"
        return (
            "K_Hbeta of ISO 6336 is of the axes' inclination in this run with the scene's misalignment and helix slopes"
            f" (method C, less running-in{'' if scene.shafts.in_train else iterated}), not of helix slopes of the"
            " tolerance class."
        )
    if _misalignment(scene, gear_pair(scene.gears)) is not None:
        which = "the scene's misalignment and helix slopes (method C, less running-in)"
        return f"K_Hbeta of ISO 6336 is of {which}; shafts do not bend in it."
    which = f"helix slopes of tolerance class {finish.tolerance_class} (method C)"
    return f"K_Hbeta of ISO 6336 is of {which}, which this run has not: the scene has no misalignment."


def of_place(numbers: Mapping, pair: GearPair) -> str:
    """A sentence on where the run has its largest pressure, unless the standard looks there too: from the pitch point
    to the inner points of single tooth contact. Nothing of a run that says that it is at an end of a line of
    contact."""
    if "peak_contact_pressure_diameter" not in numbers or "peak_contact_pressure_beside" in numbers:
        return ""
    diameter = numbers["peak_contact_pressure_diameter"]
    position = pair.pinion.base_radius * float(pair.pinion.roll_angle(max(0.5 * diameter, pair.pinion.base_radius)))
    looked_at = sorted((pair.pitch_point, pair.lpstc, pair.hpstc))
    if looked_at[0] - BESIDE * pair.base_pitch <= position <= looked_at[-1] + BESIDE * pair.base_pitch:
        return ""
    pitch = 2.0 * float(pair.pinion.radius(pair.pinion_roll_angle(pair.pitch_point)))
    up = position - pair.path_start
    down = pair.path_end - position
    nearer = f"{max(up, 0.0):.2f} mm after the start" if up < down else f"{max(down, 0.0):.2f} mm before the end"
    return (
        f"sigma_H of this run is at the pinion's diameter {diameter:.5g} mm, {nearer} of the path of contact. ISO"
        f" 6336-2 has it at the pitch point, diameter {pitch:.5g} mm, and at the inner points of single tooth contact."
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
    gears = zip(lumped_gears(scene, pair).values(), pair.gears)
    first, second = (KILOGRAM * each.moment_of_inertia / gear.base_radius**2 / pair.face_width for each, gear in gears)
    return first * second / (first + second)


def _flash(operation: Operation, result: xr.Dataset) -> list[RatingRow]:
    """The largest flash temperature of a run with friction, by the standard's load share and by the computed forces."""
    friction = result.attrs.get("friction_coefficient")
    if friction is None:
        return []
    pair = operation.pair
    settled = of_settled(result)
    path = np.linspace(pair.path_start, pair.path_end, POINTS)
    whole = operation.finish.application_factor * transverse_line_force(pair, operation.tangential_force)
    at_work = friction, operation.pinion_speed
    standard = flash_temperature(pair, operation.materials, path, whole * standard_share(pair, path), *at_work)
    forces, numbers = (settled[name].transpose("time", "slot").values for name in ("pair_normal_force", "pair_number"))
    since = settled["mesh_phase"].values[:, None] - (numbers - settled["pair_number"].attrs["number_at_phase_0"])
    places = pair.path_start + since * pair.base_pitch
    # Teeth that bend touch a little before and after the path of contact, where the formula's speeds are not theirs.
    on_path = (places >= pair.path_start) & (places <= pair.path_end) & np.isfinite(forces)
    # The standard's line force is in the transverse section; line forces of the run are along the contact normal.
    transverse = pair.cosine * forces[on_path] / pair.face_width
    computed = flash_temperature(pair, operation.materials, places[on_path], transverse, *at_work)
    return [RatingRow("flash temperature", "K", float(standard.max()), float(computed.max(initial=0.0)))]
