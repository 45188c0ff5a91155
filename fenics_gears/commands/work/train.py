"""What ``gears run`` and ``gears check`` do with a train of gears."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from functools import partial
from math import pi
from pathlib import Path
from typing import Any

from fenics_gears import results
from fenics_gears.effects import common_period
from fenics_gears.errors import ComputationError
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.description import derived_rows
from fenics_gears.model.model import Model
from fenics_gears.model.motion_rows import Rows, period_rows
from fenics_gears.model.planetary_frequencies import set_frequency_rows
from fenics_gears.model.planetary_rows import member_rows, planet_rows, set_rows
from fenics_gears.model.train import TrainModel, train_model_of
from fenics_gears.model.train_cost import row_cost, row_too_large, train_cost
from fenics_gears.model.train_motion_rows import frequencies_of_train, loop_rows, motion_rows
from fenics_gears.results.train_rows import train_rows
from fenics_gears.scene.train import TrainScene
from fenics_gears.scene.train_mesh import MeshOfScene
from fenics_gears.show import TRAIN_PICTURE_FILES
from fenics_gears.system.console import print_rows
from fenics_gears.system.memory import allowed_memory
from fenics_gears.system.output import check_writable, write_whole
from fenics_gears.system.progress import Interruption

from ..shared import RUN_FILE, WITHOUT_SOMETHING
from .shared import after_result, plots, shown_progress, worth

SCENE_FILE = "scene.toml"
Row = tuple[str, str, str]


def run_train(scene: TrainScene, options: argparse.Namespace) -> int:
    """Run a train, write its result and pictures, print its numbers; return the exit code."""
    directory = options.output or Path("results") / scene.name
    check_writable(directory, RUN_FILE, *TRAIN_PICTURE_FILES)
    model = train_model_of(scene)
    from fenics_gears.runs.train import simulate_train

    file = directory / RUN_FILE
    pictures: list[Path] | None = []
    with Interruption(shown_progress(options.quiet)) as interruption:
        stages: list[tuple[Path, Any]] = []
        found = simulate_train(model, interruption, keep=lambda mesh, of: stages.append(_stage(directory, mesh, of)))
        _save(found, file)
        if not options.no_pictures:
            interruption.stage("draw pictures")
            pictures = after_result(file, "pictures", lambda: plots("train").draw_train(found, directory))
            for own, of in stages:
                after_result(own / RUN_FILE, "pictures", partial(plots().draw_run, of, own))
    if not options.quiet:
        said = [("WARNING", warning, "") for warning in found.attrs["warnings"].splitlines()]
        print_rows(scene.title, [*train_rows(found), *said])
        print_rows("Files", [("", str(each), "") for each in (file, *(pictures or []))])
        if stages:
            print_rows("Stages as pairs, for all other commands", [("", str(own), "") for own, _ in stages])
    return worth(found, file) or (WITHOUT_SOMETHING if pictures is None else 0)


def _stage(directory: Path, mesh: MeshOfScene, found) -> tuple[Path, Any]:
    """Write the result of a stage, and the scene of its pair as it was run, into a folder of its own; the folder and
    the result."""
    own = directory / mesh.name
    own.mkdir(parents=True, exist_ok=True)
    write_whole(own / RUN_FILE, lambda path: results.save(found, path))
    write_whole(own / SCENE_FILE, lambda path: Path(path).write_text(str(found.attrs["scene"]), encoding="utf-8"))
    return own, found


def _save(found, file: Path) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    write_whole(file, lambda path: results.save(found, path))
    for picture in TRAIN_PICTURE_FILES:
        # Those of an earlier run would be taken for pictures of this one.
        (file.parent / picture).unlink(missing_ok=True)


def check_train(scene: TrainScene) -> int:
    """Print the description of a train: speeds, torques, meshes and their phases. Raises ComputationError, as a run
    would, where memory does not hold it."""
    model = train_model_of(scene)
    print(f"{scene.title}\n")
    if scene.joined:
        print_rows("Train", _train_rows(model))
        print_rows("Shafts between its parts", list(_joint_rows(scene)))
    for part in model.parts:
        _print_part(part, f"{part.scene.title}: " if scene.joined else "")
    for row in model.rows:
        for mesh, own, phase in zip(row.meshes, row.models, row.layout.phases):
            if mesh.like is not None:
                continue
            print_rows(f"Mesh {mesh.name}", _mesh_rows(mesh, own, phase))
            if derived := _derived_rows(mesh):
                print_rows(f"Mesh {mesh.name}: derived, since the scene leaves it out", derived)
    if scene.shafts.moving and scene.shafts.carrier is None:
        print_rows("Motion of all stages together", motion_rows(model.rows[0]))
        if frequencies := frequencies_of_train(model.rows[0]):
            print_rows("Natural frequencies, about, with one tooth pair in each mesh", frequencies)
    print_rows("Expected cost", _cost_rows(model))
    if model.warnings:
        print_rows("Warnings", [("", said, "") for said in model.warnings])
    for row in model.rows:
        if said := row_too_large(row, row_cost(row), allowed_memory()):
            raise ComputationError(f"CANNOT FIT: {said}")
    return 0


def _print_part(model: TrainModel, name: str) -> None:
    """Speeds, torques and assembly of a train, or of a part of one with this `name` before its headings."""
    scene = model.scene
    if (carrier := scene.shafts.carrier) is not None:
        print_rows(f"{name}Planetary set", set_rows(model.rows[0]))
        print_rows(f"{name}Members, without losses", member_rows(carrier))
        print_rows(f"{name}Planets", planet_rows(model.rows[0]))
        if carrier.vibration is not None:
            print_rows(f"{name}Natural frequencies of lumped members", set_frequency_rows(model.rows[0]))
        return
    print_rows(f"{name}Train", _train_rows(model))
    print_rows(f"{name}Shafts", list(_shaft_rows(model)))
    if scene.graph.loops:
        print_rows(f"{name}Loops of meshes", loop_rows(scene))


def _joint_rows(scene: TrainScene) -> Iterator[Row]:
    """Speed, torque and twist of the shafts between the parts of a train."""
    for joint, before, behind in zip(scene.joints, scene.parts, scene.parts[1:]):
        said = f"{1e-3 * before.output_torque:.6g} N m"
        if scene.speed_given:
            power = 2e-6 * pi * behind.input_speed * before.output_torque
            said += f", {60.0 * behind.input_speed:.6g} rpm, {power:.5g} kW"
        if joint.stiffness is not None:
            said += f", twists by {1e6 * before.output_torque / joint.stiffness:.5g} urad"
        yield ", ".join(joint.carries), said, ""


def _train_rows(model: TrainModel) -> list[Row]:
    scene = model.scene
    rows = [
        ("meshes", f"{len(scene.meshes)}", ""),
        ("turns of the first shaft in one of the last", f"{scene.ratio:.6g}", ""),
        ("torque on the first shaft, without losses", f"{1e-3 * scene.input_torque:.5g}", "N m"),
        ("torque on the last shaft", f"{1e-3 * scene.output_torque:.5g}", "N m"),
    ]
    if (ramp := scene.shafts.ramp) is not None:
        held = f", after {ramp.hold_cycles} cycles of the slowest mesh" if ramp.hold_cycles else ""
        speeds = f"{60.0 * scene.input_speed:.5g} to {30.0 / pi * ramp.end_speed:.5g}"
        rows.append(("speed of the first shaft", speeds, f"rpm, linear in time{held}; below at the start"))
    if any(common_period(mesh.scene) > 1 for mesh in scene.meshes) and scene.shafts.carrier is None:
        whole = scene.period
        slowest = min(mesh.scene.motion.mesh_frequency for mesh in scene.meshes)
        run = f"turns of the first shaft, {slowest / scene.input_speed * whole:.6g} cycles of the slowest mesh"
        rows.append(("all meshes and gears repeat together after", f"{float(whole):g}", run))
    if scene.speed_given:
        rows.append(("power", f"{1e-6 * 2.0 * pi * scene.input_speed * scene.input_torque:.5g}", "kW"))
    return rows


def _cost_rows(model: TrainModel) -> list[Row]:
    cost = train_cost(model)
    return [
        ("meshing and condensing, unless cached", f"{cost.condensing:.1f}", "s"),
        ("marching", f"{cost.marching:.1f}", "s"),
        ("memory", f"{cost.memory / 1e6:.0f}", "MB"),
    ]


def _shaft_rows(model: TrainModel) -> Iterator[Row]:
    """Speed and torque of each shaft; the first one turns counter-clockwise."""
    scene = model.scene
    graph = scene.graph
    for shaft, (turns, sense) in enumerate(zip(scene.turns, graph.senses)):
        turning = "counter-clockwise" if sense > 0 else "clockwise"
        rate = f"{60.0 * scene.input_speed * turns:.5g} rpm, " if scene.speed_given else ""
        driven = [scene.meshes[mesh].scene.load.wheel_torque for mesh in graph.into(shaft)]
        torque = sum(driven) if shaft else scene.input_torque
        own = scene.loads[shaft]
        beside = f", of which {1e-3 * own:.5g} N m are its load" if own and own != torque else ""
        power = f", {2e-6 * pi * scene.input_speed * turns * torque:.5g} kW" if scene.speed_given else ""
        carried = f"{beside}{power}, carries {', '.join(scene.shafts.carried[shaft])}"
        yield f"shaft {shaft + 1}", f"{rate}{turning}, {1e-3 * torque:.5g} N m{carried}", ""


def _derived_rows(mesh: MeshOfScene) -> Rows:
    """What the scene leaves out of the gears of a mesh, by their own names: "sun", "gear 2"."""
    own = [gear.partition(".")[2] for gear in mesh.gears]
    names = [f"gear {name}" if name.isdigit() else name for name in own]
    said = []
    for label, value, unit in derived_rows(mesh.scene):
        side, space, rest = label.partition(" ")
        own_label = names[GEARS.index(side)] + space + rest if side in GEARS else label
        said.append((own_label, value, unit))
    return said


def _mesh_rows(mesh: MeshOfScene, own: Model, phase: float) -> Rows:
    pair = own.pair
    rows: Rows = [
        ("teeth", f"{pair.pinion.teeth} / {pair.wheel.tooth_count}", "internal" if pair.wheel.internal else ""),
        ("centre distance", f"{abs(pair.centre_distance):.6g}", "mm"),
        ("direction of the wheel from the pinion", f"{180.0 / pi * mesh.direction:.4g}", "deg"),
        ("contact ratio, with overlap", f"{pair.total_contact_ratio:.4g}", ""),
        ("torque on its wheel", f"{1e-3 * own.scene.load.wheel_torque:.5g}", "N m"),
        ("steps in a mesh cycle", f"{own.resolution.steps_per_mesh_cycle}", ""),
        ("begins at mesh phase", f"{phase:.6g}", ""),
        ("flank elements", f"{own.resolution.flank_element_size:.3g}", "mm"),
    ]
    slices, layers = own.slices_and_layers
    if slices:
        rows.append(("slices over the face, layers of the bodies", f"{slices}, {layers}", ""))
    if common_period(own.scene) > 1:
        rows += [*period_rows(own), ("mesh cycles that are run", own.scene.motion.mesh_cycles, "")]
    if own.scene.accuracy.target is not None:
        rows.append(("target", f"{own.scene.accuracy.target:.3%}", "a run chooses steps and elements first"))
    if own.scene.motion.speed_given:
        rows.append(("mesh frequency", f"{own.scene.motion.mesh_frequency:.6g}", "Hz"))
    return rows
