"""A swept tooth sector that half a turn does not map on itself (`fold`), as with a web towards one end of the face:
condensed as a whole, and joined to the ring by complex harmonics.

The cuts of a sector have thousands of dofs, but move its flanks in a few hundred ways alone: with
``to_cuts = shapes @ rows`` a harmonic of stiffness D = U^H U is solved for these (`ring.ring_compliance`), and is not
inverted.
"""

from __future__ import annotations

from time import perf_counter

import numpy as np
from scipy.linalg.blas import zherk, ztrsm

from fenics_gears.elasticity.condensation import CondensedBody, by_radius, dofs_of, without
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.mumps import Factor
from fenics_gears.elasticity.ring import cyclic, definite_factor, definite_inverse, harmonic_of, sector_cuts
from fenics_gears.elasticity.triangle import symmetric

from .condensed import spanned
from .layers import Sweep, swept_nodes
from .swept_stiffness import ELEMENT, SectionForms, swept_stiffness


def condensed_whole_sector(mesh: BodyMesh, sweep: Sweep, poissons_ratio: float, both: bool = False) -> CondensedBody:
    """A swept sector condensed onto "flank" (with `both` the coast flank's
    nodes after the drive flank's), "lower" and "upper", hub held, Young's modulus 1 MPa; dofs in the
    section's frame turned with it."""
    clock = perf_counter()
    section = SectionForms(mesh, poissons_ratio, sweep.web)
    compiled = perf_counter()
    nodes, heights, there = section.nodes.points, len(sweep.heights), section.material(sweep).ravel()
    hub = mesh.edge_nodes("hub", ELEMENT.order)
    lines = {
        "flank": [by_radius(mesh.edge_nodes(side, ELEMENT.order)) for side in ("flank", *(("coast",) if both else ()))],
        "lower": [by_radius(without(mesh.edge_nodes("lower cut", ELEMENT.order), hub))],
        "upper": [by_radius(without(mesh.edge_nodes("upper cut", ELEMENT.order), hub))],
    }
    numbers = {
        name: np.concatenate([swept_nodes(nodes, line, heights) for line in part]) for name, part in lines.items()
    }
    numbers = {name: own[there[own]] for name, own in numbers.items()}
    there[swept_nodes(nodes, hub, heights)] = False
    free, number = dofs_of(np.flatnonzero(there), 3), np.cumsum(there) - 1
    stiffness = swept_stiffness(section, sweep)[free][:, free]
    assembled, kept = perf_counter(), dofs_of(number[np.concatenate(list(numbers.values()))], 3)
    factor = Factor(stiffness, "the body's stiffness", kept)
    try:
        condensed = factor.schur()
    finally:
        factor.close()
    points = {
        name: np.column_stack([nodes[own % len(nodes)], sweep.heights[own // len(nodes)]])
        for name, own in numbers.items()
    }
    timings = {
        "time_compile": compiled - clock,
        "time_assemble": assembled - compiled,
        "time_schur": perf_counter() - assembled,
        "unknowns": len(free),
        "condensed_unknowns": len(condensed),
    }
    return CondensedBody(points, condensed, timings)


def whole_ring_blocks(sector: CondensedBody, teeth: int, offsets: int) -> np.ndarray:
    """Flank compliance blocks (offsets + 1, f, f) of the ring of such sectors, as `ring.ring_compliance`."""
    cuts, turn = sector_cuts(sector, teeth)
    coupling = sector.stiffness[np.ix_(sector.dofs("flank"), cuts)] @ turn
    held = definite_inverse(sector.between("flank", "flank"), "a flank")
    to_cuts = held @ coupling
    link = turn.T @ sector.stiffness[np.ix_(cuts, cuts)] @ turn - coupling.T @ to_cuts
    same, ahead = cyclic(link)
    shapes, rows = spanned(to_cuts, energy=definite_factor(link, "a cut"))
    lower, upper = np.hsplit(rows, 2)
    within = np.zeros((offsets + 1, len(rows), len(rows)))
    for harmonic in range(teeth // 2 + 1):
        angle, weight = harmonic_of(harmonic, teeth)
        phase = np.exp(1j * angle)
        # Transposed, the conjugate is in LAPACK's order.
        factor = definite_factor((same + ahead * np.conj(phase) + ahead.T * phase).T, "a harmonic")
        moved = ztrsm(1.0, factor, np.conj(lower + upper * phase).T, trans_a=2)
        product = symmetric(zherk(1.0, moved, trans=2))
        for offset, block in enumerate(within):
            turned = weight * phase**offset
            block += turned.real * product.real - turned.imag * product.imag
    blocks = np.stack([shapes @ block @ shapes.T for block in within])
    blocks[0] += held
    symmetric(blocks[0])
    return blocks
