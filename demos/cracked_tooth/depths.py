"""The scene of this folder with cracks of several depths: a turn of the pinion each, on meshes that are fine enough for
the contact."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import xarray as xr

from fenics_gears import load_scene, simulate
from fenics_gears.effects.body_meshes import BodyMeshes, MeshFile, located
from meshes.mesh_file import write_body_mesh
from fenics_gears.model.model import model_of
from fenics_gears.results import by_pair
from fenics_gears.scene.data import Scene
from fenics_gears.results.spectrum import OrderLines, order_lines
from meshes.root_crack import RootCrack, cracked_gear_mesh

HERE = Path(__file__).parent
# Depths of the crack (mm); none is the healthy pinion, a ring of equal sectors.
DEPTHS = (0.0, 1.5, 3.0, 4.5)
# The cracked tooth, counted counter-clockwise, and the mesh cycle at whose beginning it reaches the start of contact:
# teeth 16 - 8 = 8.
CRACKED_TOOTH, ITS_CYCLE = 8, 8


@dataclass(frozen=True)
class Turn:
    """A turn of the pinion: mesh cycles (n,), transmission error (n,) in um on the wheel's base circle, forces (pairs,
    n) in N of the pairs."""

    depth: float
    phase: np.ndarray
    error: np.ndarray
    pairs: np.ndarray
    pair_force: np.ndarray
    load: float

    @property
    def stiffness(self) -> np.ndarray:
        """Load over deflection of the mesh (n,), N/um: flanks are true involutes, without load there is no transmission
        error."""
        return self.load / np.abs(self.error)

    def force_of(self, cycle: int) -> np.ndarray:
        """Force (n,), N, of the tooth pair that reaches the start of contact with a mesh cycle."""
        return self.pair_force[int(np.flatnonzero(self.pairs == cycle)[0])]

    def orders(self, teeth: int) -> OrderLines:
        """Amplitudes (um) by order, turns of the pinion being order 1: the pattern repeats with each."""
        return order_lines(self.error, float(self.phase[-1] - self.phase[0]), (teeth, teeth))


def healthy(scene: Scene) -> Scene:
    """The scene with a pinion of equal sectors."""
    return replace(scene, body_meshes=None)


def cracked(scene: Scene, depth: float, file: Path) -> Scene:
    """The scene with a crack of some depth (mm) in its pinion, whose mesh is written to a file; as fine as the contact
    asks for."""
    model = model_of(healthy(scene))
    sizes = model.resolution.discretisation(0).sizes(model.pair.pinion)
    write_body_mesh(cracked_gear_mesh(model.pair.pinion, sizes, {CRACKED_TOOTH: RootCrack(depth)}), file)
    return replace(scene, body_meshes=located(BodyMeshes(MeshFile(str(file)), None), file.parent))


def turn(scene: Scene, depth: float) -> Turn:
    """Run a scene and keep what this folder shows of it."""
    return _turn(simulate(scene), depth)


def _turn(result: xr.Dataset, depth: float) -> Turn:
    radius, force = result.attrs["base_radius_wheel"], by_pair(result.pair_normal_force, absent=0.0)
    return Turn(
        depth=depth,
        phase=result.mesh_phase.values,
        error=1e3 * radius * result.transmission_error.values,
        # Counted from the pair that reaches the start of contact with mesh cycle 0.
        pairs=force.pair.values - result.pair_number.attrs["number_at_phase_0"],
        pair_force=force.values.T,
        load=float(result.normal_force.values.mean()),
    )


def turns(directory: Path, depths: Sequence[float] = DEPTHS) -> list[Turn]:
    """A turn of the pinion for every depth; meshes are written into a directory."""
    scene, found = load_scene(HERE / "cracked_tooth.toml"), []
    for depth in depths:
        file = directory / f"pinion_{depth:g}_mm.msh"
        found.append(turn(cracked(scene, depth, file) if depth else healthy(scene), depth))
    return found
