"""A swept tooth sector that half a turn does not map on itself (`fold`): condensed as a whole, joined by complex
harmonics.

The cuts of a sector have thousands of dofs, but move its flanks in a few hundred ways: with ``to_cuts = shapes @ rows``
a harmonic of stiffness D = U^H U is solved for these (`ring.ring_compliance`), and is not inverted.
"""

from time import perf_counter

import numpy as np
from scipy.linalg.blas import zherk, ztrsm

from ..condensation import CondensedBody, by_radius, dofs_of, line_of
from ..mesh_data import BodyMesh
from ..mumps import schur_complement
from ..ring import between_cuts, cyclic, definite_factor, harmonic_of
from ..triangle import symmetric
from .condensed import spanned
from .layers import Sweep, swept_nodes
from .swept_stiffness import ELEMENT, SectionForms, swept_stiffness


def condensed_whole_sector(mesh: BodyMesh, sweep: Sweep, poissons_ratio: float, both: bool = False) -> CondensedBody:
    """A swept sector condensed onto "flank" (with `both` the coast flank's nodes after the drive flank's), "lower" and
    "upper", hub held, Young's modulus 1 MPa; dofs in the section's frame turned with it."""
    clock = perf_counter()
    section = SectionForms(mesh, poissons_ratio, sweep.web)
    compiled = perf_counter()
    nodes, heights, there = section.nodes.points, len(sweep.heights), section.material(sweep).ravel()
    lines = {
        "flank": [by_radius(mesh.edge_nodes(side, ELEMENT.order)) for side in ("flank", "coast")[: 2 if both else 1]],
        "lower": [line_of(mesh, "lower cut", ELEMENT.order)],
        "upper": [line_of(mesh, "upper cut", ELEMENT.order)],
    }
    swept = {name: np.concatenate([swept_nodes(nodes, line, heights) for line in part]) for name, part in lines.items()}
    numbers = {name: own[there[own]] for name, own in swept.items()}
    there[swept_nodes(nodes, mesh.edge_nodes("hub", ELEMENT.order), heights)] = False
    free, number = dofs_of(np.flatnonzero(there), 3), np.cumsum(there) - 1
    stiffness = swept_stiffness(section, sweep)[free][:, free]
    condensed = schur_complement(stiffness, dofs_of(number[np.concatenate(list(numbers.values()))], 3))
    points = {
        name: np.column_stack([nodes[own % len(nodes)], sweep.heights[own // len(nodes)]])
        for name, own in numbers.items()
    }
    timings = {"time_compile": compiled - clock, "unknowns": len(free), "condensed_unknowns": len(condensed)}
    return CondensedBody(points, condensed, timings)


def whole_ring_blocks(sector: CondensedBody, teeth: int, offsets: int) -> np.ndarray:
    """Flank compliance blocks (offsets + 1, f, f) of the ring of such sectors, as `ring.ring_compliance`."""
    held, to_cuts, link = between_cuts(sector, teeth)
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
