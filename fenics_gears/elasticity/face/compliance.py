"""Flank compliance of a gear over its face: sweep one tooth sector, condense it, join the ring; or from the cache."""

from __future__ import annotations

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.system.job import together
from fenics_gears.system.second_process import SecondProcess

from ..cache import Cache, kept
from ..compliance import FlankCompliance, Reach
from ..face_compliance_data import FaceCompliance
from ..gear_compliance import check_inputs, similar_inputs
from .discretisation import FaceDiscretisation
from .near_field import NearField

# Not a choice: heights of the nodes, here and in FaceCompliance, follow from it.
ORDER = 2


def face_compliance(
    gear: Gear,
    material: Material,
    discretisation: FaceDiscretisation,
    reach: Reach,
    cache: Cache | None = None,
    process: SecondProcess | None = None,
) -> FaceCompliance:
    """Flank compliance of a gear over its face, from the cache or by condensing one swept tooth sector, hub held, end
    faces free.

    gear: its transverse section. With `reach.across` the coast flank's dofs follow the drive flank's. They are in the
    tooth's frame mirrored at its centreline at that height: x and y of the mirrored section, heights and z unchanged.
    process: that does the work, this one unless given. Raises SceneError for an impossible size, ComputationError when
    a stage fails.
    """
    check_inputs(gear, material, reach)
    discretisation.check()
    similar, scaled = gear.of_module_one, discretisation.in_modules_of(gear)
    farthest, both = reach.farthest, reach.across is not None
    inputs = similar_inputs("over the face", gear, material, discretisation)
    inputs |= {"farthest": farthest, "both flanks": both}

    def compute() -> tuple[dict, dict]:
        # Imported here: a run whose gears are all in the cache needs neither gmsh nor DOLFINx.
        from .computed import computed_body

        return together(process, computed_body, similar, scaled, material.poissons_ratio, farthest, both)[0]

    arrays, timings = kept(cache, inputs, compute)
    # In place: the arrays are large, and nothing else refers to them.
    arrays["blocks"] *= 1.0 / (material.youngs_modulus * gear.module)
    arrays["plane"] *= 1.0 / material.youngs_modulus
    rolls, flanks = arrays["roll_angle"], 2 if both else 1
    return FaceCompliance(
        roll_angle=rolls,
        element_order=ORDER,
        heights=gear.module * arrays["heights"],
        blocks=arrays["blocks"],
        plane=FlankCompliance(rolls, ORDER, arrays["plane"], flanks=flanks),
        timings=timings,
        flanks=flanks,
        near=NearField.of_arrays(arrays).scaled(gear.module, material.youngs_modulus),
    )
