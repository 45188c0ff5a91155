"""``[output] root_stress``: the matrices of both gears from flank forces to root stress, by which a march records
it."""

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.root_stress import RootStressRows, root_stress_rows
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model
from fenics_gears.results.root_stress_variables import RootStress
from fenics_gears.system.progress import Progress

from .bodies import discretisation_of


def root_stress(model: Model, cycle: Cycle, progress: Progress, cache: Cache | None) -> RootStress:
    rows = []
    for name in GEARS:
        progress.stage(f"root stress of the {name}")
        rows.append(rows_of(model, name, cache))
    return RootStress(model.pair, cycle, (rows[0], rows[1]))


def rows_of(model: Model, name: str, cache: Cache | None) -> RootStressRows:
    """Root stress rows of the "pinion" or the "wheel", in the slices of the face where it has some, on the mesh of its
    compliance."""
    gear = GEARS.index(name)
    face = model.face
    coast = model.scene.coast_flanks is not None
    return root_stress_rows(
        getattr(model.pair, name),
        model.scene.gears.material_of(name),
        discretisation_of(model, gear),
        # Pairs are numbered by their drive flanks' teeth; the wheel's tooth of a coast pair stands one beside.
        reach=model.touching.reach.farthest + (1 if coast else 0),
        coast_flank=coast,
        cache=cache,
        slices=(face.positions - face.middles[gear], face.widths),
    )
