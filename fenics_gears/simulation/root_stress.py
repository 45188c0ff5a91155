"""``[output] root_stress``: the matrices of both gears from flank forces to root stress, by which a march records
it."""

from __future__ import annotations

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.root_stress import RootStressRows, root_stress_rows
from fenics_gears.model.model import Model
from fenics_gears.results.root_stress_variables import RootStress
from fenics_gears.system.progress import Progress


def root_stress(model: Model, cycle: Cycle, progress: Progress, cache: Cache | None) -> RootStress:
    """The root stress of both gears at the steps of a cycle, ready to be taken at each."""
    made = RootStress
    if cycle.face is not None:
        # Imported here: plane scenes have none.
        from fenics_gears.results.face_root_stress import FaceRootStress

        made = FaceRootStress
    rows = []
    for name in ("pinion", "wheel"):
        progress.stage(f"root stress of the {name}")
        rows.append(rows_of(model, name, cache))
    return made(model.pair, cycle, (rows[0], rows[1]))


def rows_of(model: Model, name: str, cache: Cache | None) -> RootStressRows:
    """Root stress rows of the "pinion" or the "wheel", in the slices of the face where it has some."""
    return (gear_rows if model.face is None else face_rows)(model, name, cache)


def gear_rows(model: Model, name: str, cache: Cache | None) -> RootStressRows:
    """Root stress rows of the "pinion" or the "wheel", on the mesh of its compliance."""
    return root_stress_rows(
        getattr(model.pair, name),
        model.scene.gears.material_of(name),
        model.resolution.discretisation(("pinion", "wheel").index(name)),
        # Pairs are numbered by their drive flanks' teeth; the wheel's tooth of a coast pair stands one beside.
        reach=model.touching.reach.farthest + 1,
        coast_flank=model.scene.coast_flanks is not None,
        cache=cache,
    )


def face_rows(model: Model, name: str, cache: Cache | None) -> RootStressRows:
    """The same in the slices of the face, on the mesh of its body."""
    from fenics_gears.elasticity.face.root_stress import face_root_stress_rows
    from fenics_gears.model.face_resolution import face_discretisation

    gear, face, coast = ("pinion", "wheel").index(name), model.face, model.scene.coast_flanks is not None
    return face_root_stress_rows(
        getattr(model.pair, name),
        model.scene.gears.material_of(name),
        face_discretisation(model, gear),
        (face.positions - face.middles[gear], face.widths),
        reach=model.touching.reach.farthest + (1 if coast else 0),
        coast_flank=coast,
        cache=cache,
    )
