"""Flank compliance of a gear over its face: sweep one tooth sector, condense it, join the ring; or from the cache."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.system.job import together
from fenics_gears.system.second_process import SecondProcess

from ..cache import Cache, kept
from ..compliance import FlankCompliance, Reach
from ..face_compliance_data import BetweenMates, FaceCompliance, SharedCompliance
from ..gear_compliance import check_inputs, similar_inputs
from .discretisation import FaceDiscretisation
from .free_end import FreeEnds, free_ends
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
    near = NearField.of_arrays(arrays).scaled(gear.module, material.youngs_modulus)
    ends = free_ends(discretisation.twist * gear.base_radius, material, _element(gear, arrays["roll_angle"]))
    return _body(gear, arrays, (arrays["blocks"], arrays["plane"], near, ends), 2 if both else 1, timings)


def shared_compliance(
    gear: Gear, material: Material, discretisation: FaceDiscretisation, reach: Reach, cache: Cache | None = None
) -> SharedCompliance:
    """The body of a gear that several mates load, with `reach.across` also its coast flanks. Arguments and errors are
    those of `face_compliance`."""
    check_inputs(gear, material, reach)
    discretisation.check()
    similar, scaled = gear.of_module_one, discretisation.in_modules_of(gear)
    inputs = similar_inputs("between mates over the face", gear, material, discretisation) | {"reach": asdict(reach)}

    def compute() -> tuple[dict, dict]:
        from .computed import computed_shared

        return computed_shared(similar, scaled, material.poissons_ratio, reach)

    arrays, timings = kept(cache, inputs, compute)
    for name in arrays:
        if name.startswith(("blocks", "between")):
            arrays[name] *= 1.0 / (material.youngs_modulus * gear.module)
    arrays["plane"] *= 1.0 / material.youngs_modulus
    near = NearField.of_arrays(arrays).scaled(gear.module, material.youngs_modulus)
    slope, element = discretisation.twist * gear.base_radius, _element(gear, arrays["roll_angle"])
    flanks = []
    for kind in range(1 if reach.across is None else 2):
        plane = _in_the_mirror(arrays["plane"]) if kind else arrays["plane"]
        if reach.own is None:
            size = 2 * len(arrays["roll_angle"])
            blocks, plane, of_flanks = arrays[f"blocks_{kind}"], plane[:, :size, :size], slice(kind, kind + 1)
        else:
            blocks = _in_the_mirror(arrays["blocks"]) if kind else arrays["blocks"]
            of_flanks = slice(None, None, -1 if kind else 1)
        # The image leans the other way.
        parts = blocks, plane, near.of_flanks(of_flanks), free_ends(-slope if kind else slope, material, element)
        flanks.append(_body(gear, arrays, parts, 1 if reach.own is None else 2, timings))
    motions = tuple(arrays[f"motions_{kind}"] for kind in range(len(flanks)))
    known = {kinds: (first, arrays["between_{}{}".format(*kinds)]) for kinds, (first, _) in reach.between_mates.items()}
    return SharedCompliance(tuple(flanks), BetweenMates(motions, known))


def _in_the_mirror(blocks: np.ndarray) -> np.ndarray:
    """Blocks (k, 2 f, 2 f) of both flanks as the mirror image has them: a coast flank is a drive flank there, and a
    tooth ahead is one behind."""
    return np.ascontiguousarray(np.roll(blocks, blocks.shape[1] // 2, axis=(1, 2)).swapaxes(1, 2))


def _body(
    gear: Gear, arrays: dict, parts: tuple[np.ndarray, np.ndarray, NearField, FreeEnds], flanks: int, timings: dict
) -> FaceCompliance:
    """The body of these blocks, blocks of its section, near field and ends."""
    blocks, plane, near, ends = parts
    rolls = arrays["roll_angle"]
    return FaceCompliance(
        roll_angle=rolls,
        element_order=ORDER,
        heights=gear.module * arrays["heights"],
        blocks=blocks,
        plane=FlankCompliance(rolls, ORDER, np.ascontiguousarray(plane), flanks=flanks),
        timings=timings,
        flanks=flanks,
        near=near,
        ends=ends,
    )


def _element(gear: Gear, rolls: np.ndarray) -> float:
    """Mean length (mm) of the elements along a flank with nodes at `rolls` (n,), rad."""
    return 0.5 * abs(gear.base_radius) * float(rolls[-1] ** 2 - rolls[0] ** 2) * ORDER / (len(rolls) - 1)
