"""``[output] root_stress`` where flanks are resolved over the face."""

from __future__ import annotations

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.face.root_stress import face_root_stress_rows
from fenics_gears.elasticity.root_stress import RootStressRows
from fenics_gears.model.face_resolution import face_discretisation
from fenics_gears.model.model import Model
from fenics_gears.results.face_root_stress import FaceRootStress
from fenics_gears.system.progress import Progress


def face_root_stress(model: Model, cycle: Cycle, progress: Progress, cache: Cache | None) -> FaceRootStress:
    """The root stress of both gears over the face at the steps of a cycle."""
    rows = []
    for gear, name in enumerate(("pinion", "wheel")):
        progress.stage(f"root stress of the {name}")
        rows.append(_gear_rows(model, gear, name, cache))
    return FaceRootStress(model.pair, cycle, (rows[0], rows[1]))


def _gear_rows(model: Model, gear: int, name: str, cache: Cache | None) -> RootStressRows:
    face, scene = model.face, model.scene
    coast = scene.coast_flanks is not None
    return face_root_stress_rows(
        getattr(model.pair, name),
        scene.gears.material_of(name),
        face_discretisation(model, gear),
        (face.positions - face.middles[gear], face.widths),
        # Pairs are numbered by their drive flanks' teeth; the wheel's tooth of a coast pair stands one beside.
        reach=model.touching.reach.farthest + (1 if coast else 0),
        coast_flank=coast,
        cache=cache,
    )
