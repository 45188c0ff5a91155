"""Dynamic, face and transverse load factors of ISO 6336-1:2006: K_v and K_Halpha by method B, K_Hbeta by method C, of
pairs on shafts that bend also by method B."""

from dataclasses import dataclass
from math import cos, hypot, pi, sin, sqrt

import numpy as np

from fenics_gears import flank_tolerance, helix_tolerance

from .operation import Operation


@dataclass(frozen=True)
class LoadFactors:
    """K_v, K_Hbeta, K_Fbeta, K_Halpha, K_Falpha."""

    dynamic: float
    face: float
    face_root: float
    transverse: float
    transverse_root: float


@dataclass(frozen=True)
class _Deviations:
    """Of the worse gear, um: base pitch f_pb, profile form f_fa, and what running-in leaves of both."""

    base_pitch: float
    base_pitch_left: float
    profile_form_left: float


def load_factors(operation: Operation) -> LoadFactors:
    """The standard's factors of a pair whose case-hardened flanks run in by 7.5 % of their deviations."""
    deviations = _deviations(operation)
    dynamic = _dynamic(operation, deviations)
    face = _face(operation, dynamic)
    height = max(gear.tip_radius - gear.root_radius for gear in operation.pair.gears)
    part = min(height / operation.face_width, 1.0 / 3.0)
    transverse = _transverse(operation, deviations, dynamic * face)
    total = operation.pair.total_contact_ratio
    alpha = operation.pair.contact_ratio
    highest = total / (alpha * contact_ratio_factor(operation) ** 2), total / (0.25 * alpha + 0.75)
    root = face ** (1.0 / (1.0 + part + part**2))
    return LoadFactors(dynamic, face, root, *(min(max(transverse, 1.0), most) for most in highest))


def _deviations(operation: Operation) -> _Deviations:
    gears = operation.pair.gears
    grade = operation.finish.tolerance_class
    tolerances = [flank_tolerance(2.0 * gear.reference_radius, gear.normal_module, grade) for gear in gears]
    base_pitch = 1e3 * max(each.single_pitch for each in tolerances) * cos(gears[0].pressure_angle)
    form = 1e3 * max(each.profile_form for each in tolerances)
    return _Deviations(base_pitch, base_pitch - _run_in(base_pitch), form - _run_in(form))


def _run_in(deviation: float) -> float:
    """y_alpha (um) of case-hardened and nitrided gears, section 8.3.2."""
    return min(0.075 * deviation, 3.0)


def _dynamic(operation: Operation, deviations: _Deviations) -> float:
    """K_v by method B, section 6.5: below, in and above the main resonance."""
    line_load = operation.line_load()
    relief = operation.tip_relief or (operation.finish.flank_limit / 97.0 - 18.45) ** 2 / 18.0 + 1.5
    stiffness = operation.single_stiffness
    total = operation.pair.total_contact_ratio
    pitch = stiffness * deviations.base_pitch_left / line_load
    form = stiffness * deviations.profile_form_left / line_load
    modified = abs(1.0 - stiffness * relief / line_load)
    c1 = 0.32
    c5 = 0.47
    if total <= 2.0:
        c2 = 0.34
        c3 = 0.23
        c4 = 0.90
        c6 = 0.47
    else:
        c2 = 0.57 / (total - 0.3)
        c3 = 0.096 / (total - 1.56)
        c4 = (0.57 - 0.05 * total) / (total - 1.44)
        c6 = 0.12 / (total - 1.74)
    c7 = 0.75 if total <= 1.5 else 0.125 * sin(pi * (total - 2.0)) + 0.875 if total <= 2.5 else 1.0
    resonance = 30e3 / (pi * operation.pair.pinion.teeth) * sqrt(operation.mesh_stiffness / operation.reduced_mass)
    ratio = operation.pinion_speed / resonance
    main = 0.85 if line_load >= 100.0 else 0.5 + 0.35 * sqrt(line_load / 100.0)
    at_resonance = c1 * pitch + c2 * form + c4 * modified + 1.0
    above = c5 * pitch + c6 * form + c7
    if ratio <= main:
        return 1.0 + ratio * (c1 * pitch + c2 * form + c3 * modified)
    if ratio <= 1.15:
        return at_resonance
    return above + (at_resonance - above) * max(1.5 - ratio, 0.0) / 0.35


def _face(operation: Operation, dynamic: float) -> float:
    """K_Hbeta by method C, section 7.6, of `mesh_misalignment`."""
    misalignment = mesh_misalignment(operation)
    left = misalignment - min(0.15 * misalignment, 6.0)
    line_load = operation.line_load(dynamic)
    unevenness = 0.5 * left * 0.85 * operation.mesh_stiffness / line_load
    return 1.0 + unevenness if unevenness < 1.0 else 2.0 * sqrt(unevenness)


def iterated_face_factor(operation: Operation, dynamic: float) -> float:
    """K_Hbeta by method B (annex E): the largest line load over the mean one, on shafts that bend and a foundation of
    0.85 c_gamma_alpha, where flanks can part. Without running-in."""
    slices = len(operation.opening)
    force = operation.finish.application_factor * dynamic * operation.base_force
    foundation = 1e3 * 0.85 * operation.mesh_stiffness * operation.face_width
    yielding = operation.shafts + np.eye(slices) * slices / foundation
    loaded = np.full(slices, True)
    for _ in range(slices):
        # Approach and loads: gaps of loaded slices close, loads add up to the force.
        own = np.flatnonzero(loaded)
        system = np.zeros((len(own) + 1,) * 2)
        system[:-1, :-1] = yielding[np.ix_(own, own)]
        system[:-1, -1] = -1.0
        system[-1, :-1] = 1.0
        loads = np.linalg.solve(system, np.append(-operation.opening[own], force))[:-1]
        if (loads >= 0.0).all():
            break
        loaded[own[loads < 0.0]] = False
    return float(loads.max() * slices / force)


def mesh_misalignment(operation: Operation) -> float:
    """F_betax (um) over the face: the scene's own with the inclination of shafts that bend, which is known and gets no
    factor 1.33. Else, from manufacture alone, helix slopes of both gears within their class."""
    if operation.misalignment is not None:
        return abs(operation.misalignment)
    gears = operation.pair.gears
    face = operation.face_width
    grade = operation.finish.tolerance_class
    return 1e3 * hypot(*(helix_tolerance(2.0 * gear.reference_radius, face, grade).slope for gear in gears))


def _transverse(operation: Operation, deviations: _Deviations, before: float) -> float:
    """K_Halpha by method B, section 8.3.2, before its limits; `before`: K_v K_Hbeta."""
    line_load = operation.line_load(before)
    term = 0.4 * operation.mesh_stiffness * deviations.base_pitch_left / line_load
    total = operation.pair.total_contact_ratio
    return 0.5 * total * (0.9 + term) if total <= 2.0 else 0.9 + term * sqrt(2.0 * (total - 1.0) / total)


def contact_ratio_factor(operation: Operation) -> float:
    """Z_eps, ISO 6336-2:2006 section 8."""
    alpha = operation.pair.contact_ratio
    beta = min(operation.pair.overlap_ratio, 1.0)
    return sqrt((4.0 - alpha) / 3.0 * (1.0 - beta) + beta / alpha)
