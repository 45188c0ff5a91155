"""Flank compliance of a gear from its data: mesh one sector, condense it, join the ring; or read it from the cache."""

from dataclasses import asdict, replace

import numpy as np

from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.numbers_version import NUMBERS_VERSION

from .cache import Cache, kept
from .compliance import BothFlanksCompliance, FlankCompliance, Reach
from .element_sizes import Discretisation, ElementSizes
from .elements import Element, element_named


def flank_compliance(
    gear: Gear, material: Material, discretisation: Discretisation, reach: Reach, cache: Cache | None = None
) -> FlankCompliance:
    """Flank compliance of a gear in plane strain, from the cache or by meshing and condensing one tooth sector.

    Similar gears have the same displacement per line force: the gear of module one stands for all of them, also in the
    cache. reach: of the teeth whose interaction is wanted, and whether the coast flanks' is. Raises SceneError for an
    unknown element or an impossible size, ComputationError when a stage fails.
    """
    chosen = element_named(discretisation.element)
    sizes = discretisation.sizes(gear, both_flanks=reach.across is not None)
    check_inputs(gear, material, reach)
    similar = gear.of_module_one
    sizes = sizes.in_modules_of(gear)
    coupled = _coupled(reach, discretisation.elastic_teeth)
    inputs = similar_inputs("plane strain", gear, material, discretisation, reach.across is not None)
    inputs["reach"] = {"same": coupled.same, "across": coupled.across}
    arrays, timings = kept(cache, inputs, lambda: _computed(similar, chosen, sizes, material.poissons_ratio, coupled))
    # In place: the arrays are large, and nothing else refers to them.
    for name in {"blocks", "across"} & arrays.keys():
        arrays[name] *= 1.0 / material.youngs_modulus
    own = arrays["roll_angle"], chosen.order, arrays["blocks"], timings
    compliance = FlankCompliance(*own)
    if sizes.both_flanks:
        compliance = BothFlanksCompliance(*own, across=arrays["across"], first_across=int(arrays["first_across"]))
    return compliance if coupled == reach else _with_uncoupled_teeth(compliance, reach.farthest)


def similar_inputs(kind: str, gear: Gear, material: Material, discretisation, both_flanks: bool = True) -> dict:
    """What any quantity of a gear's body follows from, the same for similar gears."""
    return {
        "kind": kind,
        "version": NUMBERS_VERSION,
        "gear": asdict(gear.of_module_one),
        "poissons_ratio": material.poissons_ratio,
        **discretisation.inputs(gear, both_flanks),
    }


def _coupled(reach: Reach, elastic_teeth: int | None) -> Reach:
    """The part of a reach within which teeth feel each other (`Discretisation`)."""
    if elastic_teeth is None or reach.farthest < elastic_teeth:
        return reach
    farthest = elastic_teeth - 1
    return Reach(farthest, reach.across and (-farthest, farthest))


def _with_uncoupled_teeth(body: FlankCompliance, offsets: int) -> FlankCompliance:
    """The compliance over more offsets, zero for teeth farther away than those that are known. Raises SceneError where
    it is not positive definite: loads on the teeth would then do negative work."""
    known = body.offsets
    zeros = np.zeros((offsets - body.offsets, *body.blocks.shape[1:]))
    padded = replace(body, blocks=np.concatenate([body.blocks, zeros]))
    if isinstance(body, BothFlanksCompliance):
        padded = replace(padded, across=np.concatenate([zeros, body.across, zeros]), first_across=-offsets)
    if known:
        whole = np.block([[padded.block(a - b) for b in range(offsets + 1)] for a in range(offsets + 1)])
        try:
            np.linalg.cholesky(whole)
        except np.linalg.LinAlgError:
            raise SceneError(
                f"accuracy.elastic_teeth = {known + 1}: the gear's body couples its teeth too strongly to leave out the"
                f" farther ones alone; choose 1, or at least {offsets + 1}, or leave it out"
            ) from None
    return padded


def check_inputs(gear: Gear, material: Material, reach: Reach) -> None:
    """Raise SceneError for a reach or a material that a gear cannot have."""
    if not 0 <= reach.farthest < gear.tooth_count:
        others = gear.tooth_count - 1
        raise SceneError(f"reach is {reach.farthest}, must lie between 0 and {others}, the gear's other teeth")
    if not -1.0 < material.poissons_ratio < 0.5:
        raise SceneError(f"poissons_ratio is {material.poissons_ratio}, must lie between -1 and 0.5, both excluded")
    if not (np.isfinite(material.youngs_modulus) and material.youngs_modulus > 0.0):
        raise SceneError(f"youngs_modulus is {material.youngs_modulus} MPa, must be positive and finite")


def _computed(
    gear: Gear, element: Element, sizes: ElementSizes, poissons_ratio: float, reach: Reach
) -> tuple[dict, dict]:
    """Arrays of the compliance for Young's modulus 1 MPa, and the times that it took."""
    # A run whose gears are all in the cache needs neither gmsh nor DOLFINx.
    from .computed_ring import computed_ring

    return computed_ring(gear, element, sizes, poissons_ratio, reach)
