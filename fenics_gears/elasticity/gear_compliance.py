"""From gear data to flank compliance: the stages of the elastic model of a gear."""

from __future__ import annotations

from dataclasses import asdict, replace
from time import perf_counter

import numpy as np

from fenics_gears.elasticity.cache import Cache, content_key
from fenics_gears.elasticity.compliance import BothFlanksCompliance, FlankCompliance, Reach
from fenics_gears.elasticity.element_sizes import ElementSizes
from fenics_gears.elasticity.elements import Element, element_named
from fenics_gears.elasticity.packed_symmetric import packed, unpacked
from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material

# To be raised by one whenever the same inputs give other numbers.
ALGORITHM_VERSION = 8

KEPT_COUNTS = ("unknowns", "condensed_unknowns")

# By element order, in modules (the flank's size is always given). Against a mesh several times finer everywhere, the mean compliance
# under 1 mm of uniform pressure at tip, middle and form circle is then within 0.05 % (P2, Q2) and 0.3 % (P1, Q1) with 0.06 mm on the flank.
DEFAULT_SIZES = {
    1: ElementSizes(flank=np.nan, fillet=0.01, coast=0.02, body=0.08, depth=4.0, growth=0.1),
    2: ElementSizes(flank=np.nan, fillet=0.04, coast=0.08, body=0.3, depth=2.5, growth=0.35),
}


def flank_compliance(
    gear: Gear,
    material: Material,
    *,
    element: str = "P2",
    flank_element_size: float,
    reach: Reach,
    body_element_size: float | None = None,
    elastic_teeth: int | None = None,
    cache: Cache | None = None,
    comm=None,
) -> FlankCompliance:
    """Flank compliance of a gear in plane strain, from the cache or by meshing and condensing one tooth sector.

    In plane strain similar gears have the same displacement per line force: the gear of module one stands for all of them, and
    they share an entry of the cache.

    flank_element_size, body_element_size: mm, along the working flank and the largest in tooth and rim (None: from the module).
    reach: of the teeth whose interaction is wanted, and whether the coast flanks' is. elastic_teeth: teeth this many pitches apart and
    further do not feel each other (1: each feels itself alone), all do when None.
    comm: communicator of one rank, COMM_SELF when None. Raises SceneError for an unknown element or an impossible size, ComputationError when a stage fails.
    """
    chosen = element_named(element)
    sizes = replace(element_sizes(gear, chosen, flank_element_size, body_element_size), both_flanks=reach.across is not None)
    _check(gear, material, reach)
    similar, sizes = gear.of_module_one, sizes.in_modules_of(gear)
    clock = perf_counter()
    felt = reach if elastic_teeth is None else _within(reach, elastic_teeth - 1)
    key = content_key({
        "version": ALGORITHM_VERSION,
        "gear": asdict(similar),
        "poissons_ratio": material.poissons_ratio,
        "element": chosen.name,
        "sizes": asdict(sizes),
        "reach": asdict(felt),
    })
    arrays = cache.load(key) if cache is not None else None
    if arrays is not None:
        unit = _from_arrays(arrays, chosen.order)
        timings = {"from_cache": True, "time_mesh": 0.0, "time_compile": 0.0, "time_condense": perf_counter() - clock}
    else:
        unit, timings = _computed(similar, chosen, sizes, material.poissons_ratio, felt, comm)
        if cache is not None:
            cache.store(key, _as_arrays(unit))
    found = replace(_scaled(unit, 1.0 / material.youngs_modulus), timings={**unit.timings, **timings})
    return found if felt == reach else with_unfelt_teeth(found, reach.farthest)


def _within(reach: Reach, felt: int) -> Reach:
    """What is left of a reach where teeth farther apart than `felt` pitches do not feel each other; all of that, where anything is left out."""
    return reach if reach.farthest <= felt else Reach(felt, reach.across and (-felt, felt))


def with_unfelt_teeth(body: FlankCompliance, offsets: int) -> FlankCompliance:
    """The compliance over more offsets, zero for teeth further away than those that are known.

    Raises SceneError where what is left is no compliance: the load of teeth whose coupling is left out in part would do negative work.
    """
    known, unfelt = body.offsets, np.zeros((offsets - body.offsets, *body.blocks.shape[1:]))
    padded = replace(body, blocks=np.concatenate([body.blocks, unfelt]))
    if isinstance(body, BothFlanksCompliance):
        padded = replace(padded, across=np.concatenate([unfelt, body.across, unfelt]), first_across=-offsets)
    if known:
        whole = np.block([[padded.block(a - b) for b in range(offsets + 1)] for a in range(offsets + 1)])
        try:
            np.linalg.cholesky(whole)
        except np.linalg.LinAlgError:
            raise SceneError(
                f"accuracy.elastic_teeth = {known + 1}: the gear's body couples its teeth too strongly to leave out the farther ones alone; "
                f"choose 1, or at least {offsets + 1}, or leave it out"
            ) from None
    return padded


def element_sizes(gear: Gear, element: Element, flank: float, body: float | None = None) -> ElementSizes:
    """Element sizes (mm) of a gear's sector mesh for a wanted size on the flank and, if not None, in the body.

    With the body's size all others but the flank's are made larger or smaller than by default, as much as it is. Raises SceneError for a size that is not positive and finite.
    """
    for name, size in (("flank_element_size", flank), ("body_element_size", body)):
        if size is not None and not (np.isfinite(size) and size > 0.0):
            raise SceneError(f"{name} is {size} mm, must be positive and finite")
    default = DEFAULT_SIZES[element.order]
    fillet, coast, largest = (gear.module * size for size in (default.fillet, default.coast, default.body))
    sizes = replace(default, flank=flank, fillet=fillet, coast=coast, body=largest)
    return sizes if body is None else sizes.refined(body / largest)


def _check(gear: Gear, material: Material, reach: Reach) -> None:
    if not 0 <= reach.farthest < gear.teeth:
        raise SceneError(f"reach is {reach.farthest}, must lie between 0 and {gear.teeth - 1}, the gear's other teeth")
    if not -1.0 < material.poissons_ratio < 0.5:
        raise SceneError(f"poissons_ratio is {material.poissons_ratio}, must lie between -1 and 0.5, both excluded")
    if not (np.isfinite(material.youngs_modulus) and material.youngs_modulus > 0.0):
        raise SceneError(f"youngs_modulus is {material.youngs_modulus} MPa, must be positive and finite")


def _as_arrays(body: FlankCompliance) -> dict[str, np.ndarray]:
    """What the cache keeps of a compliance for Young's modulus 1 MPa."""
    arrays = {
        "roll_angle": body.roll_angle,
        "same_tooth": packed(body.blocks[:1]),
        "other_teeth": body.blocks[1:],
        **{name: np.array(body.timings[name]) for name in KEPT_COUNTS},
    }
    if not isinstance(body, BothFlanksCompliance):
        return arrays
    return {**arrays, "across": packed(body.across), "first_across": np.array(body.first_across)}


def _from_arrays(arrays: dict[str, np.ndarray], order: int) -> FlankCompliance:
    blocks = np.concatenate([unpacked(arrays["same_tooth"]), arrays["other_teeth"]])
    counts = {name: int(arrays[name]) for name in KEPT_COUNTS}
    if "across" not in arrays:
        return FlankCompliance(arrays["roll_angle"], order, blocks, counts)
    return BothFlanksCompliance(arrays["roll_angle"], order, blocks, counts, across=unpacked(arrays["across"]), first_across=int(arrays["first_across"]))


def _scaled(body: FlankCompliance, factor: float) -> FlankCompliance:
    """The compliance times a number; nobody else has the arrays, which are as large as all else together."""
    np.multiply(body.blocks, factor, out=body.blocks)
    if isinstance(body, BothFlanksCompliance):
        np.multiply(body.across, factor, out=body.across)
    return body


def _computed(gear, element, sizes, poissons_ratio, reach, comm):
    """Compliance for Young's modulus 1 MPa, and what it took."""
    # Imported here: a run whose gears are all in the cache needs neither gmsh nor DOLFINx.
    from fenics_gears.elasticity.roll_angles import node_roll_angles
    from fenics_gears.elasticity.sector_mesh import half_sector_mesh, sector_mesh

    clock = perf_counter()
    mesh = (half_sector_mesh if sizes.both_flanks else sector_mesh)(gear, sizes, element.quadrilateral)
    meshed = perf_counter()
    sector, parts, joining = (_both_flanks if sizes.both_flanks else _drive_flank)(gear, element, mesh, poissons_ratio, reach, comm)
    compiling = sector.timings["time_compile"]
    corners = mesh.points[mesh.edge_points("flank")]
    rolls = node_roll_angles(gear, corners[np.argsort(np.linalg.norm(corners, axis=1))], element.order)
    timings = {
        **sector.timings,
        "from_cache": False,
        "time_mesh": meshed - clock,
        "time_condense": perf_counter() - meshed - compiling,
        "time_ring": joining,
    }
    kind = BothFlanksCompliance if sizes.both_flanks else FlankCompliance
    return kind(roll_angle=rolls, element_order=element.order, timings=sector.timings, **parts), timings


def _drive_flank(gear, element, mesh, poissons_ratio, reach: Reach, comm):
    from fenics_gears.elasticity.ring import condensed_sector, ring_compliance

    sector = condensed_sector(mesh, element, poissons_ratio, comm)
    clock = perf_counter()
    blocks = ring_compliance(sector, gear.teeth, reach.same)
    return sector, {"blocks": blocks}, perf_counter() - clock


def _both_flanks(gear, element, mesh, poissons_ratio, reach: Reach, comm):
    from fenics_gears.elasticity.half_sector import centreline_direction
    from fenics_gears.elasticity.mirrored_ring import both_flanks_compliance, condensed_half

    sector = condensed_half(mesh, element, poissons_ratio, comm)
    clock = perf_counter()
    blocks, across = both_flanks_compliance(sector, centreline_direction(mesh), gear.teeth, reach)
    return sector, {"blocks": blocks, "across": across, "first_across": reach.across[0]}, perf_counter() - clock
