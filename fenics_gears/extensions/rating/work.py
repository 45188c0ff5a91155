"""What ``gears rate`` does."""

import argparse
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import isnan
from pathlib import Path
from typing import Any

import xarray as xr

from fenics_gears import OVERALL, Scene, SceneError, carried_scene, carried_train, gear_pair, mesh_run
from fenics_gears.command_line import file_to_write, loaded_run, number_of_option, run_file, write_whole
from fenics_gears.scene_text import GEARS
from fenics_gears.shown import TrainScene, set_runs

from . import rating
from .command import FILE, NUMBERS, QUANTITIES, option_of
from .finish import Finish

ROUND_OFF = 1e-9


def rate(options: argparse.Namespace) -> int:
    file = run_file(options.run)
    output = file_to_write(options, file.parent / FILE, "the table")
    meshes = _meshes(loaded_run(file, trains=True))
    finishes = [_finish(options, mesh) for mesh in meshes]
    tables = [rating.rate(mesh.result, mesh.scene, finish, mesh.idlers) for mesh, finish in zip(meshes, finishes)]
    write_whole(output, lambda path: _save({mesh.name: rows for mesh, rows in zip(meshes, tables)}, path))
    if not options.quiet:
        for mesh, finish, rows in zip(meshes, finishes, tables):
            _tell(mesh, finish, rows)
        _explain([row for rows in tables for row in rows], meshes)
        print(output)
    return 0


@dataclass(frozen=True)
class RatedMesh:
    """A mesh with its result and its scene, as of a pair: a name in a train, which of its gears are idlers, and whether
    it is a stage by itself, with a folder of its own. `sharing`: K_gamma of a planetary set, by this run."""

    name: str
    result: xr.Dataset
    scene: Scene
    idlers: tuple[str, ...] = ()
    alone: bool = False
    sharing: float | None = None


def _meshes(result: xr.Dataset) -> list[RatedMesh]:
    """The meshes of a run, of which a pair has one."""
    if OVERALL not in result:
        return [RatedMesh("", result, carried_scene(result))]
    train = carried_train(result)
    driving, driven = ({mesh.gears[side] for mesh in train.meshes} for side in (0, 1))
    found = []
    for number, sharing in _rated(result, train):
        mesh = train.meshes[number]
        idlers = tuple(name for name, gear in zip(GEARS, mesh.gears) if gear in driving & driven)
        own = mesh_run(result, train, number)
        found.append(RatedMesh(mesh.name, own, mesh.scene, idlers, number in train.alone, sharing))
    return found


def _rated(result: xr.Dataset, train: TrainScene) -> Iterator[tuple[int, float | None]]:
    """Numbers of the meshes of a train that are rated: of a planetary set that of the sun and the planet that carries
    most, with K_gamma."""
    sets = iter(set_runs(result))
    for first, part in train.numbered:
        if part.shafts.carrier is None:
            yield from ((first + number, None) for number in range(len(part.meshes)))
            continue
        with_sun = range(first, first + len(part.meshes))[part.shafts.carrier.meshes(0)]
        forces = result["largest_pair_force"].values[list(with_sun)]
        # Of planets that carry the same the first.
        most = int((forces > forces.max() * (1.0 - ROUND_OFF)).argmax())
        yield with_sun[most], float(next(sets).attrs["load_sharing_factor"])


def _tell(mesh: RatedMesh, finish: Finish, rows: list[rating.RatingRow]) -> None:
    """The table of a mesh, and what is said of it."""
    if mesh.name:
        print(f"Mesh {mesh.name}")
    _show(rows)
    if end := mesh.result.attrs.get("peak_contact_pressure_beside"):
        why = "where lines of contact end and their line load rises (buttressing); ISO 6336-2 has no such rise"
        print(f"sigma_H of this run is near the {end} of the pinion's active profile, {why}.")
    if place := rating.of_place(mesh.result.attrs, gear_pair(mesh.scene.gears)):
        print(place)
    print(rating.of_misalignment(mesh.scene, finish))
    if mesh.sharing is not None:
        print(
            f"K_gamma of this run, {mesh.sharing:.4g}, multiplies forces by the standard. Teeth of the ring: not rated."
        )
    if mesh.name:
        print()


def _finish(options: argparse.Namespace, mesh: RatedMesh) -> Finish:
    scene = mesh.scene
    given: dict[str, Any] = {}
    if scene.flank_errors is not None and scene.flank_errors.tolerance_class is not None:
        given["tolerance_class"] = scene.flank_errors.tolerance_class
    for name, (unit, low, high, _) in QUANTITIES.items():
        text = getattr(options, name)
        if text is not None:
            given[name] = number_of_option(option_of(name), text, unit, low, high)
    for name, (low, high, _) in NUMBERS.items():
        value = getattr(options, name)
        whole = name == "tolerance_class"
        if value is None:
            continue
        if not low <= value <= high or whole and value != int(value):
            kind = "a whole number " if whole else ""
            raise SceneError(f"{option_of(name)} {value:g}: allowed is {kind}from {low:g} to {high:g}.")
        given[name] = int(value) if whole else value
    finish = Finish(**given)
    # Forces of the standard are multiplied by both alike.
    return replace(finish, application_factor=finish.application_factor * (mesh.sharing or 1.0))


def _save(tables: Mapping[str, list[rating.RatingRow]], path: Path) -> None:
    """One table of all meshes; that of a pair has no column for the mesh."""
    import csv

    with open(path, "w", encoding="utf-8", newline="") as table:
        writer = csv.writer(table)
        writer.writerow([*(["mesh"] if any(tables) else []), "quantity", "unit", "ISO 6336", "this run"])
        for name, rows in tables.items():
            of = [name] if name else []
            writer.writerows(
                [*of, row.name, row.unit, _written(row.standard, 8), _written(row.computed, 8)] for row in rows
            )


def _show(rows) -> None:
    print(f"{'':50}{'ISO 6336':>10}{'this run':>10}")
    for row in rows:
        unit = "" if row.unit == "1" else f" {row.unit}"
        name = row.name + ("," + unit if unit else "")
        print(f"{name:50}{_written(row.standard, 4):>10}{_written(row.computed, 4) or '-':>10}")


def _explain(rows: list[rating.RatingRow], meshes: list[RatedMesh]) -> None:
    print("K_v of this run: largest force of a tooth pair over that without inertia. Safeties: by the same limits.")
    if meshes[0].name:
        file = (
            "a stage's own scene.toml, which is in its folder,"
            if any(mesh.alone for mesh in meshes)
            else "a scene of one of its pairs,"
        )
        print(f"-: not in this run. Root stress and dynamic factor: run {file}")
        print(
            "   with [output] root_stress = true and [inertia]. Face and transverse factors: helical stages have them."
        )
    elif any(isnan(row.computed) for row in rows):
        print(
            "-: not in this run. Root stress needs [output] root_stress = true, the dynamic factor [inertia], face and"
        )
        print("   transverse factors a run over the face, such as with [misalignment].")

    if any(mesh.idlers for mesh in meshes):
        print(f"S_F of idlers: their teeth are bent both ways, which leaves {rating.REVERSED:g} of sigma_Flim.")


def _written(value: float, digits: int) -> str:
    return "" if isnan(value) else f"{value:.{digits}g}"
