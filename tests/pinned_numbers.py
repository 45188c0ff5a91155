"""Numbers of small runs and of a condensed body, in `pinned_numbers.json` beside their version. ``python -m
tests.pinned_numbers`` writes them anew, after a change that has raised `NUMBERS_VERSION`. No gmsh, whose meshes
differ by version."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
from tests.annulus import annulus
from tests.coarse import coarse_scene, frictionless, quasi_static
from tests.helical import helical_scene, on_stand_in_bodies
from tests.stand_in import stand_in_compliance

from fenics_gears import load_scene, model_of, simulate
from fenics_gears.elasticity.compliance import Body
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.ring import condensed_sector, ring_compliance
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.face_resolution import face_discretisation
from fenics_gears.numbers_version import NUMBERS_VERSION
from fenics_gears.simulation.elastic_route import mesh_cycle

FILE = Path(__file__).with_suffix(".json")
DEMO = Path(__file__).parents[1] / "demos" / "lundvall2004.toml"
# Not extremes, which are sought up to a tolerance.
ATTRIBUTES = ("mean_transmission_error", "mean_mesh_stiffness", "rms_transmission_error")
SECTORS = 8


def pinned() -> dict:
    scene = coarse_scene(load_scene(DEMO), cycles=1)
    runs = {
        "quasi-static": simulate(frictionless(quasi_static(scene)), preparation=in_the_plane),
        "with friction": simulate(quasi_static(scene), preparation=in_the_plane),
        "in time": simulate(replace(scene, motion=replace(scene.motion, mesh_cycles=2)), preparation=in_the_plane),
        "over the face": simulate(helical_scene('[misalignment]\nin_plane = "6 um"\n'), preparation=over_the_face),
    }
    found = {f"{name}: {number}": value for name, run in runs.items() for number, value in _numbers(run).items()}
    return {"numbers_version": NUMBERS_VERSION, "numbers": found | _of_a_body() | _of_default_layers()}


def _numbers(run) -> dict[str, float]:
    """Means over the steps."""
    curves = {
        name: float(np.abs(run[name].values).mean())
        for name in (
            "transmission_error",
            "normal_force",
            "pair_normal_force",
            "contact_pressure",
            "rotation",
            "energy",
        )
    }
    return curves | {name: float(run.attrs[name]) for name in ATTRIBUTES}


def in_the_plane(model, progress, cache):
    coast = model.scene.coast_flanks is not None
    gears = tuple(Body(stand_in_compliance(gear, coast_flank=coast)) for gear in (model.pair.pinion, model.pair.wheel))
    return (), mesh_cycle(model, gears)


def over_the_face(model, progress, cache):
    return (), mesh_cycle(model, on_stand_in_bodies(model))


def _of_a_body() -> dict[str, float]:
    """A ring of sectors, its flank a part of the rim: means of the compliance."""
    whole, element = annulus(4, across=4, around=8 * SECTORS), ELEMENTS["Q2"]
    angle = np.unwrap(np.arctan2(whole.points[:, 1], whole.points[:, 0]))
    kept = np.flatnonzero(angle % (2 * np.pi) <= 2 * np.pi / SECTORS + 1e-9)
    number = np.full(len(whole.points), -1)
    number[kept] = np.arange(len(kept))
    cells = number[whole.cells]
    points, edges = whole.points[kept], {name: number[each] for name, each in whole.edges.items()}
    edges = {name: each[(each >= 0).all(axis=1)] for name, each in edges.items()}
    along = np.arange(5) * 9
    cuts = {"lower cut": along, "upper cut": along + 8}
    rings = {"hub": edges["hub"], "flank": edges["rim"][2:5]}
    sector = BodyMesh(
        points,
        cells[(cells >= 0).all(axis=1)],
        rings | {name: np.stack([each[:-1], each[1:]], axis=-1) for name, each in cuts.items()},
    )
    blocks = ring_compliance(condensed_sector(sector, element, 0.3), SECTORS, 2)
    return {f"body: teeth {offset} apart": float(np.abs(block).mean()) for offset, block in enumerate(blocks)}


def _of_default_layers() -> dict[str, float]:
    """Slices and layers of little helix and much."""
    numbers = {}
    for helix in (10.0, 30.0):
        model = model_of(helical_scene(helix=helix, accuracy=""))
        numbers[f"{helix:g} deg: slices"] = float(model.face.slices)
        for gear, name in enumerate(GEARS):
            divided = face_discretisation(model, gear)
            ends = divided.sweep.boundaries
            numbers[f"{helix:g} deg: layers, {name}"] = float(len(ends) - 1)
            numbers[f"{helix:g} deg: ends of layers, {name}"] = float(np.abs(ends).mean())
    return numbers


def main() -> None:
    FILE.write_text(json.dumps(pinned(), indent=1) + "\n", encoding="utf-8")
    print(FILE)


if __name__ == "__main__":
    main()
