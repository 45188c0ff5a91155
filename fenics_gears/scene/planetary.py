"""A planetary set, `kind = "planetary"`, as a train in the frame of its carrier: there the centres of the planets stand
still, the sun drives them, and they drive the ring. Mistakes in it are told before anything is computed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

from fenics_gears.errors import GeometryError, SceneError
from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.planetary import MEMBERS, RING, PlanetarySet, planets_that_assemble
from fenics_gears.inputs.problem import NOTHING_DONE
from fenics_gears.inputs.section import names_in
from fenics_gears.inputs.tree import GEARS

from .carrier import Carrier, OfSet
from .data import Scene
from .gear_schema import Gears
from .planetary_in_time import INERTIA, check_in_time, inertia_and_damping, wrong_in_time
from .planetary_rules import OF_A_SET_ALONE, OF_THE_TRAIN, text_of_set, wrong_sections
from .planetary_run_out import run_outs_of, with_run_outs
from .planetary_schema import GEARS_OF_SET, MESHES, OF_THE_FACE, RING_MESH, SUN_MESH, PlanetaryText
from .train_loads import TrainLoad, TrainMotion
from .train_mesh import MeshOfScene
from .train_pair import STAGES, MistakesOfStage, Placed, check_together, pair_of, pair_scene
from .train_rules import TrainSections, load_and_motion
from .train_shafts import TrainShafts

# Planets may be so far from where they can be assembled, in pitches: angles are written with few digits.
LEAST_BESIDE = 1e-3
Tree = Mapping[str, Any]


def planetary_parts(tree: Tree, source: str, folder: Path) -> tuple[list[MeshOfScene], TrainSections]:
    """The meshes of a parsed set in the frame of its carrier, and its load and motion. Raises MistakesOfStage,
    SceneError and GeometryError for what is wrong."""
    problems = list(wrong_sections(tree, (*OF_THE_TRAIN, *OF_A_SET_ALONE)))
    found, wrong = load_and_motion(tree)
    problems += wrong
    inertia, damping, wrong = inertia_and_damping(tree)
    problems += wrong
    if problems:
        raise MistakesOfStage(problems)
    ((stage, content),) = tree[STAGES].items()
    text, problems = text_of_set(stage, content)
    load, motion = found
    if text is not None and INERTIA in tree:
        problems += wrong_in_time((STAGES, stage), text, motion)
    if text is None or problems:
        raise MistakesOfStage(problems)
    scenes = _scenes(tree, stage, content, source, folder)
    pairs = [pair_of(scene, f"{source}, stage {stage}", own.words) for scene, own in zip(scenes, _of_meshes(stage))]
    place = f"{source}: stages.{stage}"
    _check_centres(pairs, place)
    own_set = _set_of(text, pairs, place)
    _check_clear(own_set, pairs, place)
    for scene, mesh in zip(scenes, MESHES):
        check_together(scene, f"{place}.{mesh}")
    carrier = _carrier(stage, text, own_set)
    _check_motion(own_set, load, motion, "friction" if scenes[0].friction is not None else "", place)
    if INERTIA in tree:
        check_in_time(scenes[0], place)
        _check_motion(own_set, load, motion, INERTIA, place)
        carrier = replace(carrier, in_time=True)
    shafts = TrainShafts(
        tuple((gear,) for gear in carrier.gears),
        (None,) * len(carrier.gears),
        (None,) * len(carrier.gears),
        load=inertia,
        damping=damping,
        moving=True,
        carrier=carrier,
    )
    return _meshes(carrier, scenes, pairs), TrainSections(load, motion, shafts)


def _of_meshes(stage: str) -> tuple[OfSet, OfSet]:
    return OfSet(stage, ("sun", "planet"), SUN_MESH), OfSet(stage, ("planet", "ring"), RING_MESH)


def _scenes(tree: Tree, stage: str, content: Tree, source: str, folder: Path) -> list[Scene]:
    """The scenes of the pairs of sun and planet, and planet and ring; the planet has the lower of the tips that its
    mates leave it."""
    gears = {name: dict(content[name]) for name in GEARS_OF_SET}
    teeth = gears["ring"].get("teeth")
    if type(teeth) is int:
        gears["ring"]["teeth"] = -abs(teeth)
    gears["ring"].pop("internal", None)

    def read_all() -> list[Scene]:
        return [_scene(tree, own, content, gears, source, folder) for own in _of_meshes(stage)]

    scenes = read_all()
    tips = [scenes[0].gears.wheel.tip_diameter, scenes[1].gears.pinion.tip_diameter]
    if tips[0] != tips[1]:
        gears["planet"]["tip_diameter"] = f"{min(tips)!r} mm"
        scenes = read_all()
    return scenes


def _scene(tree: Tree, own: OfSet, content: Tree, gears: Mapping[str, Any], source: str, folder: Path) -> Scene:
    """The scene of one pair of a set."""
    shared = {name: content[name] for name in names_in(Gears) if name in content and name not in GEARS}
    if "sun_hand" in content:
        # Planet and ring are seen in the mirror, where the planet has the hand of the sun.
        shared["pinion_hand"] = content["sun_hand"]
    over_face = {name for mesh in MESHES for name in content.get(mesh, {})} & {*OF_THE_FACE}
    sections = {
        # Both meshes are resolved over the face where one is.
        **({"misalignment": {"in_plane": "0 um"}} if over_face else {}),
        "gears": shared | {name: gears[called] for name, called in zip(GEARS, own.gears)},
        **{name: tree[name] for name in ("friction", "accuracy") if name in tree},
        **content.get(own.mesh, {}),
        "load": {"wheel_torque": "1 N m"},
    }
    name = f"{own.stage} {own.mesh}"
    try:
        return pair_scene(sections, name, f"{source}, stage {own.stage}", folder, Placed(own.place, own.words))
    except GeometryError as error:
        raise GeometryError(own.words(str(error))) from error


def _check_centres(pairs: Sequence[GearPair], place: str) -> None:
    """Raise GeometryError where the planets would have two centre distances."""
    sun, ring = (abs(pair.centre_distance) for pair in pairs)
    if abs(sun - ring) > 1e-6 * pairs[0].pinion.module:
        raise GeometryError(
            f"{place}: the planets do not fit: their centres are {sun:.6g} mm from that of the sun and {ring:.6g} mm"
            " from that of the ring. Give centre_distance, with profile shifts that leave backlash there, or change"
            f" the profile shifts or the teeth: without shifts z_ring = z_sun + 2 z_planet. {NOTHING_DONE}"
        )


def _set_of(text: PlanetaryText, pairs: Sequence[GearPair], place: str) -> PlanetarySet:
    """The set, its planets where they can be assembled. Raises GeometryError, with the nearest places that can."""
    teeth = pairs[0].pinion.teeth, pairs[0].wheel.teeth, pairs[1].wheel.tooth_count
    turn = teeth[0] + teeth[2]
    if text.planets is not None:
        wanted = [number * turn / text.planets for number in range(text.planets)]
        sizes = abs(pairs[0].centre_distance), 2.0 * pairs[0].wheel.tip_radius
        possible = ", ".join(map(str, planets_that_assemble(teeth, *sizes)[:8])) or "none"
        more = f" Equally spaced, {possible} planets can."
    else:
        wanted = [float(angle) / (2.0 * pi) * turn for angle in text.planet_angles or ()]
        more = ""
    places = [round(each - wanted[0]) for each in wanted]
    beside = [each - wanted[0] - found for each, found in zip(wanted, places)]
    if max(map(abs, beside)) > LEAST_BESIDE:
        worst = max(range(len(beside)), key=lambda each: abs(beside[each]))
        nearest = ", ".join(f'"{360.0 * (each + wanted[0]) / turn:.8g} deg"' for each in places)
        raise GeometryError(
            f"{place}: the set cannot be assembled: planet {worst + 1} would stand {abs(beside[worst]):.4g} pitches"
            f" beside the teeth of sun and ring. Planets fit at multiples of 360 deg/(z_sun + z_ring) ="
            f" {360.0 / turn:.6g} deg.{more} The nearest that can: planet_angles = [{nearest}]. {NOTHING_DONE}"
        )
    output = text.output or next(each for each in MEMBERS if each not in (text.fixed, text.input))
    assert text.fixed is not None and text.input is not None
    return PlanetarySet(teeth, tuple(places), text.fixed, text.input, output)


def _check_clear(own: PlanetarySet, pairs: Sequence[GearPair], place: str) -> None:
    """Raise GeometryError for planets that touch each other."""
    distance = abs(pairs[0].centre_distance)
    tip = 2.0 * pairs[0].wheel.tip_radius
    for one, other, clear in own.clearances(distance, tip):
        if clear <= 0.0:
            most = max((each for each in planets_that_assemble(own.teeth, distance, tip)), default=0)
            allowed = f"Equally spaced, up to {most} planets have room." if most else "No two planets have room."
            raise GeometryError(
                f"{place}: planets {one + 1} and {other + 1} touch: their tip circles of {tip:.6g} mm overlap by"
                f" {-clear:.4g} mm. {allowed} {NOTHING_DONE}"
            )


def _carrier(stage: str, text: PlanetaryText, own: PlanetarySet) -> Carrier:
    """The carrier, without speed and torque."""
    pins = text.carrier
    errors: tuple[tuple[float, float], ...] = ()
    if pins is not None and (pins.pin_errors or pins.radial_pin_errors):
        none = (0.0,) * own.planets
        both = zip(pins.pin_errors or none, pins.radial_pin_errors or none)
        errors = tuple((float(tangential), float(radial)) for tangential, radial in both)
    stiffness = None if pins is None else pins.pin_stiffness
    carrier = Carrier(stage, own, stiffness, errors, tuple(text.floating or ()), vibration=text.vibration)
    return replace(carrier, run_outs=run_outs_of(text.eccentricity, carrier.sun, carrier.planets, carrier.ring))


def _check_motion(own: PlanetarySet, load: TrainLoad, motion: TrainMotion, named: str, place: str) -> None:
    """Raise SceneError for a power without a speed, and for a section that is `named` where the ring drives."""
    if load.power is not None and motion.input_speed is None:
        raise SceneError(f"{place}: load.power needs a speed. Allowed: with motion.input_speed. {NOTHING_DONE}")
    if named and not own.sun_drives:
        raise SceneError(
            f"{place}: {named} where the ring drives the planets, as the carrier sees it, is not computed yet."
            f" Allowed: without [{named}], or with input and output exchanged, where the sun drives."
            f" {NOTHING_DONE}"
        )


def seen_by_carrier(sections: TrainSections, given: bool) -> TrainSections:
    """Load and motion of a set as its carrier sees them, the torque of the ring and the speed of the sun; the carrier
    has those of the input, the speed where it is `given`. Other trains as they are."""
    load = sections.load
    motion = sections.motion
    carrier = sections.shafts.carrier
    if carrier is None:
        return sections
    own = carrier.set
    if load.input_torque is not None:
        torque = load.input_torque
    elif load.output_torque is not None:
        torque = load.output_torque * abs(own.weights[own.input] / own.weights[own.output])
    else:
        torque = (load.power or 0.0) / (motion.input_speed or 1.0)
    ring = abs(own.torques(torque)[RING])
    speed = None if motion.input_speed is None else motion.input_speed * abs(float(own.sun_by_carrier))
    carrier = replace(carrier, torque=torque, speed=motion.input_speed if given else None)
    return TrainSections(
        replace(load, output_torque=ring, input_torque=None, power=None),
        replace(motion, input_speed=speed),
        replace(sections.shafts, carrier=carrier),
    )


def _meshes(carrier: Carrier, scenes: Sequence[Scene], pairs: Sequence[GearPair]) -> list[MeshOfScene]:
    """The meshes, planet by planet: with the sun, then with the ring."""
    own = carrier.set
    found = []
    sun, ring = _of_meshes(carrier.stage)
    count = own.planets
    for number, (planet, angle, phase) in enumerate(zip(carrier.planets, own.angles, own.phases)):
        # The sun turns counter-clockwise, the planets clockwise.
        meshes = (
            (f"sun, planet {number + 1}", sun, (carrier.sun, planet), (0, number + 1), 1),
            (f"planet {number + 1}, ring", ring, (planet, carrier.ring), (number + 1, count + 1), -1),
        )
        for kind, (name, of_set, gears, shafts, sense) in enumerate(meshes):
            found.append(
                MeshOfScene(
                    f"{carrier.stage}: {name}", scenes[kind], pairs[kind], angle, gears, shafts, sense,
                    of_set=of_set, like=kind if number else None, ahead=(phase.numerator, phase.denominator),
                )
            )  # fmt: skip
    return with_run_outs(found, carrier.run_outs) if carrier.run_outs else found
