"""A planetary set, `kind = "planetary"`, as a train in the frame of its carrier: there the centres of the planets stand
still, the sun drives them, and they drive the ring. Mistakes in it are told before anything is computed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from math import pi
from pathlib import Path
from typing import Any

from fenics_gears.dynamics.shafts import HousingFile
from fenics_gears.effects.elastic_shaft_housing import located
from fenics_gears.errors import GeometryError, SceneError
from fenics_gears.geometry.pair import GearPair
from fenics_gears.geometry.planetary import RING, PlanetarySet
from fenics_gears.inputs.problem import NOTHING_DONE
from fenics_gears.inputs.section import names_in
from fenics_gears.inputs.tree import GEARS
from fenics_gears.inputs.written import as_toml

from .carrier import Carrier, OfSet
from .data import Scene
from .gear_schema import Gears
from .parsing import parsed
from .planetary_assembly import check_centres, check_clear, set_of
from .planetary_in_time import check_in_time, wrong_in_time, wrong_inertia
from .planetary_points import POINTS, wrong_points
from .planetary_rules import OF_A_SET_ALONE, OF_THE_TRAIN, text_of_set, wrong_sections
from .planetary_run_out import pitches_of, run_outs_of, with_pitches, with_run_outs
from .planetary_schema import OF_THE_FACE, OF_THE_STEP, PlanetaryText, gears_in, meshes_in
from .train_mesh import MeshOfScene, gear_names, layout_of
from .train_pair import STAGES, MistakesOfStage, Placed, check_together, motion_put_in, pair_of, pair_scene
from .train_rules import TrainSections
from .train_shafts import TrainShafts
from .train_whole import INERTIA, whole_train

Tree = Mapping[str, Any]
SCENES_HELD = 32


def planetary_parts(tree: Tree, source: str, folder: Path) -> tuple[list[MeshOfScene], TrainSections]:
    """The meshes of a parsed set in the frame of its carrier, and its load and motion. Raises MistakesOfStage,
    SceneError and GeometryError for what is wrong."""
    problems = list(wrong_sections(tree, (*OF_THE_TRAIN, *OF_A_SET_ALONE)))
    whole, wrong = whole_train(tree)
    problems += [*wrong, *wrong_inertia(tree)]
    if whole is None or problems:
        raise MistakesOfStage(problems)
    ((stage, content),) = tree[STAGES].items()
    text, problems = text_of_set(stage, content)
    if text is not None and INERTIA in tree:
        problems += wrong_in_time((STAGES, stage), text, whole.motion)
    problems += wrong_points((STAGES, stage), tree, content)
    if text is None or problems:
        raise MistakesOfStage(problems)
    of_meshes = _of_meshes(stage, content)
    scenes = _scenes(tree, of_meshes, content, source, folder)
    pairs = [pair_of(scene, f"{source}, stage {stage}", own.words) for scene, own in zip(scenes, of_meshes)]
    place = f"{source}: stages.{stage}"
    check_centres(pairs, of_meshes[1].gears, place)
    own_set = set_of(text, pairs, of_meshes[1].gears, place)
    check_clear(own_set, pairs, place)
    for scene, own in zip(scenes, of_meshes):
        check_together(scene, f"{place}.{own.mesh}")
    carrier = _carrier(stage, text, own_set, place, folder)
    _check_in_plane(carrier, scenes[0], place)
    if scenes[0].friction is not None:
        _check_sun_drives(own_set, "friction", place)
    if INERTIA in tree:
        check_in_time(scenes[0], place)
        _check_sun_drives(own_set, INERTIA, place)
        carrier = replace(carrier, in_time=True)
    none = (None,) * len(carrier.shafts)
    shafts = TrainShafts(
        carrier.shafts,
        none,
        none,
        load=whole.load_inertia,
        damping=whole.damping,
        moving=True,
        carrier=carrier,
        ramp=whole.speed_ramp,
    )
    motion = whole.motion
    meshes = _meshes(carrier, of_meshes, scenes, pairs)
    if own_set.stepped:
        meshes = _clocked(meshes, carrier, text.step_angle or 0.0)
        motion = replace(motion, mesh_cycles=motion.mesh_cycles or min(own_set.cycles))
        motion = replace(motion, recorded_cycles=motion.recorded_cycles or motion.mesh_cycles)
    return meshes, TrainSections(whole.load, motion, shafts)


def _of_meshes(stage: str, content: Tree) -> tuple[OfSet, OfSet]:
    """The meshes with the sun and with the ring, or the second sun in its place."""
    sun, planet, *step, second = gears_in(content)
    with_sun, with_second = meshes_in(content)
    cut = tuple(name for name in OF_THE_STEP if name in content.get(with_second, {}))
    finely = "accuracy" in content
    with_step = OfSet(stage, ((*step, planet)[0], second), with_second, cut, finely)
    return OfSet(stage, (sun, planet), with_sun, own_accuracy=finely), with_step


def _scenes(tree: Tree, of_meshes: Sequence[OfSet], content: Tree, source: str, folder: Path) -> list[Scene]:
    """The scenes of the pairs of sun and planet, and planet and ring; a planet of one gear has the lower of the tips
    that its mates leave it."""
    gears = {name: dict(content[name]) for name in gears_in(content)}
    if RING in gears:
        teeth = gears[RING].get("teeth")
        if type(teeth) is int:
            gears[RING]["teeth"] = -abs(teeth)
        gears[RING].pop("internal", None)

    def read_all() -> list[Scene]:
        return [_scene(tree, own, content, gears, source, folder) for own in of_meshes]

    scenes = read_all()
    tips = [scenes[0].gears.wheel.tip_diameter, scenes[1].gears.pinion.tip_diameter]
    if tips[0] != tips[1] and of_meshes[0].gears[1] == of_meshes[1].gears[0]:
        gears["planet"]["tip_diameter"] = f"{min(tips)!r} mm"
        scenes = read_all()
    return scenes


def _scene(tree: Tree, own: OfSet, content: Tree, gears: Mapping[str, Any], source: str, folder: Path) -> Scene:
    """The scene of one pair of a set."""
    shared = {name: content[name] for name in names_in(Gears) if name in content and name not in GEARS}
    if "sun_hand" in content:
        # Planet and ring are seen in the mirror, where the planet has the hand of the sun.
        shared["pinion_hand"] = content["sun_hand"]
    over_face = {name for mesh in meshes_in(content) for name in content.get(mesh, {})} & {*OF_THE_FACE}
    of_mesh = dict(content.get(own.mesh, {}))
    shared |= {name: of_mesh.pop(name) for name in own.cut}
    sections = {
        # Both meshes are resolved over the face where one is.
        **({"misalignment": {"in_plane": "0 um"}} if over_face else {}),
        "gears": shared | {name: dict(gears[called]) for name, called in zip(GEARS, own.gears)},
        **{name: tree[name] for name in ("friction", "accuracy") if name in tree},
        **{name: content[name] for name in ("accuracy",) if name in content},
        **of_mesh,
        "load": {"wheel_torque": "1 N m"},
    }
    if own.gears[1] == RING and POINTS in gears[RING]:
        sections["wheel_points"] = sections["gears"]["wheel"].pop(POINTS)
    sections |= motion_put_in(sections, tree)
    try:
        return _scene_read(as_toml(sections), own, f"{source}, stage {own.stage}", folder)
    except GeometryError as error:
        raise GeometryError(own.words(str(error))) from error


@lru_cache(SCENES_HELD)
def _scene_read(text: str, own: OfSet, source: str, folder: Path) -> Scene:
    """That of a text, which names no file: thousands of cases with errors of their own have the pairs of one set."""
    sections = parsed(text, source)
    return pair_scene(sections, f"{own.stage} {own.mesh}", source, folder, Placed(own.place, own.words))


def _carrier(stage: str, text: PlanetaryText, own: PlanetarySet, place: str, folder: Path) -> Carrier:
    """The carrier, without speed and torque; the file of its stiffness is looked for from a folder on."""
    pins = text.carrier
    errors: tuple[tuple[float, float], ...] = ()
    if pins is not None and (pins.pin_errors or pins.radial_pin_errors):
        none = (0.0,) * own.planets
        both = zip(pins.pin_errors or none, pins.radial_pin_errors or none)
        errors = tuple((float(tangential), float(radial)) for tangential, radial in both)
    stiffness = None if pins is None else pins.pin_stiffness
    carrier = Carrier(stage, own, stiffness, errors, tuple(text.floating or ()), vibration=text.vibration)
    if pins is not None:
        file = None if pins.stiffness is None else located(pins.stiffness, folder)
        _check_file(file, own, f"{place}.carrier.stiffness")
        carrier = replace(carrier, file=file, bearing_stiffness=pins.bearing_stiffness)
    gears = carrier.sun, carrier.planets, carrier.ring
    return replace(
        carrier, run_outs=run_outs_of(text.eccentricity, *gears), pitches=pitches_of(text.pitch_errors, *gears)
    )


def _check_file(file: HousingFile | None, own: PlanetarySet, field: str) -> None:
    """Raise SceneError where a carrier's matrix cannot be read, or is not of so many pins."""
    if file is None:
        return
    rows = len(file.stiffness or ())
    size = 2 * own.planets
    problem = file.problem
    if not problem and rows != size:
        problem = f"has {rows} rows for {own.planets} planets; allowed are {size}: two displacements of each pin."
    if problem:
        raise SceneError(f'{field} = "{file.path}": {problem} {NOTHING_DONE}')


def _check_in_plane(carrier: Carrier, scene: Scene, place: str) -> None:
    """Raise SceneError for a carrier that gives way as a whole over the face."""
    if carrier.together is not None and scene.three_dimensional:
        raise SceneError(
            f"{place}.carrier: stiffness and bearing_stiffness are not computed over the face yet. Allowed:"
            f" pin_stiffness; or a set in the plane. {NOTHING_DONE}"
        )


def _check_sun_drives(own: PlanetarySet, named: str, place: str) -> None:
    """Raise SceneError for a section that is `named` where the ring drives."""
    if not own.sun_drives:
        raise SceneError(
            f"{place}: {named} where the {own.second} drives the planets, as the carrier sees it, is not computed yet."
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
    ring = abs(own.torques(torque)[own.second])
    speed = None if motion.input_speed is None else motion.input_speed * abs(float(own.sun_by_carrier))
    carrier = replace(carrier, torque=torque, speed=motion.input_speed if given else None)
    return TrainSections(
        replace(load, output_torque=ring, input_torque=None, power=None),
        replace(motion, input_speed=speed),
        replace(sections.shafts, carrier=carrier),
    )


def _meshes(
    carrier: Carrier, of_meshes: Sequence[OfSet], scenes: Sequence[Scene], pairs: Sequence[GearPair]
) -> list[MeshOfScene]:
    """The meshes, planet by planet: with the sun, then with the ring; of stepped planets all of either."""
    own = carrier.set
    count = own.planets
    firsts = [range(2 * count)[carrier.meshes(kind)][0] for kind in range(2)]
    # A second sun is on the other side of its planet.
    angles = own.angles, own.angles if own.second == RING else [each + pi for each in own.angles]
    phases = own.phases, own.phases_of_second
    found: dict[int, MeshOfScene] = {}
    for number, gear in enumerate(zip(carrier.planets, carrier.steps)):
        planet, step = (each.rpartition(".")[2] for each in gear)
        # The sun turns counter-clockwise, the planets clockwise.
        meshes = (
            (f"sun, {planet}", (carrier.sun, gear[0]), (0, number + 1), 1),
            (f"{step}, {own.second}", (gear[1], carrier.ring), (number + 1, count + 1), -1),
        )
        for kind, (name, gears, shafts, sense) in enumerate(meshes):
            phase = phases[kind][number]
            found[range(2 * count)[carrier.meshes(kind)][number]] = MeshOfScene(
                f"{carrier.stage}: {name}", scenes[kind], pairs[kind], angles[kind][number], gears, shafts, sense,
                of_set=of_meshes[kind], like=firsts[kind] if number else None,
                ahead=(phase.numerator, phase.denominator),
            )  # fmt: skip
    known = [found[number] for number in sorted(found)]
    if carrier.run_outs:
        known = with_run_outs(known, carrier.run_outs)
    return with_pitches(known, dict(carrier.pitches)) if carrier.pitches else known


def _clocked(meshes: list[MeshOfScene], carrier: Carrier, angle: float) -> list[MeshOfScene]:
    """The meshes of stepped planets, in which a tooth of the second gear stands by an angle (rad) counter-clockwise
    from one of the first: the phases of the second meshes follow."""
    layout = layout_of(meshes)
    planet, step = (gear_names(meshes).index(names[0]) for names in (carrier.planets, carrier.steps))
    first, _ = layout.graph.sides[step][0]
    turned = layout.tooth_angle(planet) + angle - layout.tooth_angle(step)
    begins = layout.graph.sense(first) * turned / layout.gear(step).angular_pitch % 1.0
    return [replace(mesh, begins=begins) if number == first else mesh for number, mesh in enumerate(meshes)]
