"""The route of `condensation = "every step"`: both gears meshed anew at every position of a mesh cycle, as the paper
does it; the yardstick of the fast route, with which it shares no interpolation."""

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.node_to_node import loaded_teeth
from fenics_gears.contact.remeshed_mesh import paired_nodes, remeshed_mesh
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.elements import element_named
from fenics_gears.elasticity.remeshing import RemeshedStiffness, remeshed_stiffness
from fenics_gears.errors import SceneError
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model
from fenics_gears.model.resolution import EVERY_STEP, ONCE
from fenics_gears.system.job import Job
from fenics_gears.system.progress import Progress

from .elastic_route import cycle_of


def reference_route(
    model: Model, progress: Progress, cache: Cache | None, job: Job | None = None
) -> tuple[tuple[RemeshedStiffness, RemeshedStiffness], Cycle]:
    """Stiffness of pinion and wheel at every position, and the contact equations on them; `job`: whose ranks share the
    positions out. Raises SceneError where the scene has coast flanks."""
    if model.scene.coast_flanks is not None:
        raise SceneError(
            f'{model.scene.name}: condensation = "{EVERY_STEP}" meshes the drive flanks only. Leave [coast_flanks] out,'
            f' or choose condensation = "{ONCE}".'
        )
    resolution = model.resolution
    order = element_named(model.resolution.element).order
    nodes = paired_nodes(model.pair, model.removal, resolution.contact_grid, order, resolution.steps_per_mesh_cycle)
    gears = []
    for number, name in enumerate(GEARS):
        progress.stage(f"remesh {name}")
        gear = getattr(model.pair, name)
        material = model.scene.gears.material_of(name)
        teeth = [loaded_teeth(pairs, number, order) for pairs in nodes]
        division = resolution.discretisation(number)
        how = {"cache": cache, "job": job, "report": progress.update}
        gears.append(remeshed_stiffness(gear, material, teeth, division, **how))
    positions = list(zip(*(gear.positions for gear in gears)))
    mesh = remeshed_mesh(model.pair, nodes, positions, resolution.contact_grid, order)
    return (gears[0], gears[1]), cycle_of(model, mesh)
