"""A swept tooth sector condensed onto its flanks and cuts: each of the two halves that it is folded into, then
unfolded."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter

import numpy as np
from scipy import sparse

from fenics_gears.elasticity.condensation import by_radius, without
from fenics_gears.elasticity.face.fold import EVEN, ODD, Fold
from fenics_gears.elasticity.face.layers import Sweep
from fenics_gears.elasticity.face.swept_stiffness import ELEMENT, SectionForms, swept_stiffness
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.mirrored_ring import Parts, flank_free, unfolded, unfolded_link, within_and_across
from fenics_gears.elasticity.mumps import Factor, distributed
from fenics_gears.elasticity.ring import check_congruent, turned_nodes


@dataclass(frozen=True)
class SweptSector:
    """A sector with its hub held, Young's modulus 1 MPa; dofs by height, radius, then x, y, z in the section's frame
    turned with it.

    held: (f, f), compliance of the drive flank, or of drive and coast flank, with the cuts held. to_cuts: (f, 2 c),
    (minus) the flanks' motion per motion of the lower and the upper cut. link: (2 c, 2 c), stiffness between the cuts,
    flanks free. The upper cut's dofs are in the next sector's frame. lower: (c / 3, 3), X, Y, z of the lower cut's
    nodes.
    """

    held: np.ndarray
    to_cuts: np.ndarray
    link: np.ndarray
    lower: np.ndarray
    timings: dict


def condensed_swept_sector(
    mesh: BodyMesh,
    sweep: Sweep,
    poissons_ratio: float,
    centreline: float,
    teeth: int,
    both: bool = False,
    comm=None,
    iterative: bool = False,
) -> SweptSector:
    """A sector of a gear of `teeth`, its section symmetric about a line at the polar angle `centreline` (rad); `both`:
    with its coast flank.

    iterative: by conjugate gradients instead of MUMPS. comm: communicator whose ranks share the work: one half of them
    has the even motions, the other the odd ones, and each half shares out the heights. Every rank calls this and gets
    the result.
    """
    clock = perf_counter()
    section = SectionForms(mesh, poissons_ratio)
    compiled = perf_counter()
    heights = len(sweep.heights)
    fold = Fold(mesh, section.nodes.points, heights, centreline)
    group, signs = (
        (comm, (EVEN, ODD))
        if comm is None or comm.size == 1
        else (comm.Split(comm.rank % 2), (EVEN, ODD)[comm.rank % 2 :][:1])
    )
    own = (
        range(heights)
        if group is None
        else range(*np.linspace(0, heights, group.size + 1).astype(int)[[group.rank, group.rank + 1]])
    )
    rows = swept_stiffness(section, sweep, own, fold.standing)
    halves = [fold.folded(rows, own, sign) for sign in signs]
    del rows
    assembled = perf_counter()
    parts: list[Parts | None] = []
    while halves:
        parts.append(
            _by_gradients(halves.pop(0), fold, own, sweep, group)
            if iterative
            else _condensed(halves.pop(0), fold, group)
        )
    if len(signs) == 1:
        parts = [_of_rank(parts[0], fold, comm, rank) for rank in (0, 1)]
    timings = {
        "time_compile": compiled - clock,
        "time_assemble": assembled - compiled,
        "time_schur": perf_counter() - assembled,
        "unknowns": 2 * fold.unknowns,
        "condensed_unknowns": (2 if both else 1) * len(fold.flank) + 2 * len(fold.cut),
    }
    cuts = [
        by_radius(without(mesh.edge_nodes(f"{name} cut", ELEMENT.order), mesh.edge_nodes("hub", ELEMENT.order)))
        for name in ("lower", "upper")
    ]
    check_congruent(cuts[0], cuts[1], teeth)
    lower = np.column_stack([np.tile(cuts[0], (heights, 1)), np.repeat(sweep.heights, len(cuts[0]))])
    return SweptSector(*_unfolded(parts, fold, teeth, both), lower, timings)


def _condensed(rows: sparse.csr_matrix, fold: Fold, group) -> Parts | None:
    """One half; on the group's rank 0."""
    alone = group is None or group.size == 1
    factor = Factor(
        rows if alone else distributed(rows, group), "the body's stiffness", np.concatenate([fold.flank, fold.cut])
    )
    del rows
    try:
        condensed = factor.schur()
    finally:
        factor.close()
    return None if condensed is None else flank_free(condensed, len(fold.flank))


def _by_gradients(rows: sparse.csr_matrix, fold: Fold, own: range, sweep: Sweep, group) -> Parts:
    # Imported here: few bodies need it.
    from fenics_gears.elasticity.face.conjugate_gradients import flank_free_by_gradients, rigid_motions

    height, place = np.divmod(fold.kept, len(fold.nodes))
    return flank_free_by_gradients(
        rows, fold, own, rigid_motions(np.column_stack([fold.nodes[place], sweep.heights[height]]), sweep.twist), group
    )


def _of_rank(parts: Parts | None, fold: Fold, comm, rank: int) -> Parts:
    """The parts that a rank has, on all ranks."""
    flank, cut = len(fold.flank), len(fold.cut)
    found = tuple(np.empty(shape) for shape in ((flank, flank), (flank, cut), (cut, cut)))
    for number, each in enumerate(found):
        # mpi4py does not know the type of an array made from C's memory.
        each[:] = parts[number] if comm.rank == rank else 0.0
        comm.Bcast(each, root=rank)
    return found


def _unfolded(parts: list[Parts], fold: Fold, teeth: int, both: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """`held`, `to_cuts` and `link` of a SweptSector."""
    (held, to_cut, cut), (held_cross, to_cut_cross, cut_cross) = within_and_across(*parts)
    image, turn = fold.cut_turned, sparse.csr_matrix(turned_nodes(teeth, len(fold.cut) // 3, 3))
    link, to_cuts = unfolded_link(cut, cut_cross, image, turn), unfolded(to_cut, to_cut_cross, image, turn)
    if both:
        coast, image = unfolded(to_cut_cross, to_cut, image, turn), fold.flank_turned
        to_cuts = np.vstack([to_cuts, image @ coast])
        held = np.block([[held, (image @ held_cross.T).T], [image @ held_cross, image @ (image @ held).T]])
    return held, to_cuts, link
