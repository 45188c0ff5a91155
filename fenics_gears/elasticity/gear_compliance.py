"""From gear data to flank compliance: the stages of the elastic model of a gear."""

from __future__ import annotations

from dataclasses import asdict, replace
from time import perf_counter

import numpy as np

from fenics_gears.elasticity.cache import Cache, content_key
from fenics_gears.elasticity.compliance import FlankCompliance
from fenics_gears.elasticity.element_sizes import ElementSizes
from fenics_gears.elasticity.elements import Element, element_named
from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear import Gear
from fenics_gears.scene.data import Material

# To be raised by one whenever the same inputs give other numbers.
ALGORITHM_VERSION = 7

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
    tooth_offsets: int,
    body_element_size: float | None = None,
    elastic_teeth: int | None = None,
    coast_flank: bool = False,
    cache: Cache | None = None,
    comm=None,
) -> FlankCompliance:
    """Flank compliance of a gear in plane strain, from the cache or by meshing and condensing one tooth sector.

    In plane strain similar gears have the same displacement per line force: the gear of module one stands for all of them, and
    they share an entry of the cache.

    flank_element_size, body_element_size: mm, along the working flank and the largest in tooth and rim (None: from the module).
    tooth_offsets: largest distance, in pitches, of teeth whose interaction is wanted. elastic_teeth: teeth this many pitches apart and
    further do not feel each other (1: each feels itself alone), all do when None. coast_flank: know the coast flank too.
    comm: communicator of one rank, COMM_SELF when None. Raises SceneError for an unknown element or an impossible size, ComputationError when a stage fails.
    """
    chosen = element_named(element)
    sizes = replace(element_sizes(gear, chosen, flank_element_size, body_element_size), both_flanks=coast_flank)
    _check(gear, material, tooth_offsets)
    similar, sizes = gear.of_module_one, sizes.in_modules_of(gear)
    clock = perf_counter()
    wanted, tooth_offsets = tooth_offsets, tooth_offsets if elastic_teeth is None else min(tooth_offsets, elastic_teeth - 1)
    key = content_key({
        "version": ALGORITHM_VERSION,
        "gear": asdict(similar),
        "poissons_ratio": material.poissons_ratio,
        "element": chosen.name,
        "sizes": asdict(sizes),
        "tooth_offsets": tooth_offsets,
    })
    arrays = cache.load(key) if cache is not None else None
    if arrays is not None:
        timings = {"from_cache": True, "time_mesh": 0.0, "time_compile": 0.0, "time_condense": perf_counter() - clock}
    else:
        arrays, timings = _computed(similar, chosen, sizes, material.poissons_ratio, tooth_offsets, comm)
        if cache is not None:
            cache.store(key, arrays)
    blocks = arrays["unit_blocks"] / material.youngs_modulus
    return FlankCompliance(
        roll_angle=arrays["roll_angle"],
        element_order=chosen.order,
        blocks=blocks if wanted == tooth_offsets else with_unfelt_teeth(blocks, wanted),
        timings={**timings, "unknowns": int(arrays["unknowns"]), "condensed_unknowns": int(arrays["condensed_unknowns"])},
        flanks=2 if coast_flank else 1,
    )


def with_unfelt_teeth(blocks: np.ndarray, offsets: int) -> np.ndarray:
    """Compliance blocks (offsets + 1, n, n) with zeros for teeth further away than those that are known.

    Raises SceneError where what is left is no compliance: the load of teeth whose coupling is left out in part would do negative work.
    """
    known, size = len(blocks) - 1, blocks.shape[1]
    padded = np.concatenate([blocks, np.zeros((offsets - known, size, size))])
    if known:
        whole = np.block([
            [padded[b - a].T if b >= a else padded[a - b] for b in range(offsets + 1)] for a in range(offsets + 1)
        ])
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


def _check(gear: Gear, material: Material, tooth_offsets: int) -> None:
    if not 0 <= tooth_offsets < gear.teeth:
        raise SceneError(f"tooth_offsets is {tooth_offsets}, must lie between 0 and {gear.teeth - 1}, the gear's other teeth")
    if not -1.0 < material.poissons_ratio < 0.5:
        raise SceneError(f"poissons_ratio is {material.poissons_ratio}, must lie between -1 and 0.5, both excluded")
    if not (np.isfinite(material.youngs_modulus) and material.youngs_modulus > 0.0):
        raise SceneError(f"youngs_modulus is {material.youngs_modulus} MPa, must be positive and finite")


def coast_mirrored(blocks: np.ndarray, gear: Gear) -> np.ndarray:
    """Blocks (offsets + 1, 4n, 4n) over drive and coast flank, the coast flank's components mirrored at the tooth's centreline."""
    centreline = -0.5 * np.pi - gear.tooth_half_angle_at_base
    mirror = np.array([
        [np.cos(2.0 * centreline), np.sin(2.0 * centreline)], [np.sin(2.0 * centreline), -np.cos(2.0 * centreline)]
    ])
    half = blocks.shape[1] // 2
    frame = np.eye(2 * half)
    frame[half:, half:] = np.kron(np.eye(half // 2), mirror)
    mirrored = frame @ blocks @ frame.T
    mirrored[0] = 0.5 * (mirrored[0] + mirrored[0].T)
    return mirrored


def _computed(gear, element, sizes, poissons_ratio, tooth_offsets, comm):
    # Imported here: a run whose gears are all in the cache needs neither gmsh nor DOLFINx.
    from fenics_gears.elasticity.ring import condensed_sector, ring_compliance
    from fenics_gears.elasticity.roll_angles import node_roll_angles
    from fenics_gears.elasticity.sector_mesh import sector_mesh

    clock = perf_counter()
    mesh = sector_mesh(gear, sizes, element.quadrilateral)
    meshed = perf_counter()
    sector = condensed_sector(mesh, element, poissons_ratio, comm, both_flanks=sizes.both_flanks)
    condensed = perf_counter()
    blocks = ring_compliance(sector, gear.teeth, tooth_offsets)
    if sizes.both_flanks:
        blocks = coast_mirrored(blocks, gear)
    joined = perf_counter()
    corners = mesh.points[mesh.edge_points("flank")]
    arrays = {
        "roll_angle": node_roll_angles(gear, corners[np.argsort(np.linalg.norm(corners, axis=1))], element.order),
        "unit_blocks": blocks,
        "unknowns": np.array(sector.timings["unknowns"]),
        "condensed_unknowns": np.array(sector.timings["condensed_unknowns"]),
    }
    compiling = sector.timings["time_compile"]
    timings = {
        **sector.timings,
        "from_cache": False,
        "time_mesh": meshed - clock,
        "time_condense": joined - meshed - compiling,
        "time_ring": joined - condensed,
    }
    return arrays, timings
