"""A swept tooth sector condensed onto its flanks and cuts, and the ring of such sectors."""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter

import numpy as np

from fenics_gears.geometry.outline import rotation

from ..condensation import by_radius, line_of
from ..element_nodes import dofs_of
from ..mesh_data import BodyMesh
from ..mumps import schur_complement
from ..ring import Parts, check_congruent, flank_free, turn_last
from .coarse_cuts import cut_nodes, narrow_sweep, on_cut_nodes, root_pitch
from .cut_motions import between_few_motions
from .layers import Sweep, swept_nodes
from .swept_stiffness import ELEMENT, SectionForms, swept_stiffness


@dataclass(frozen=True)
class SweptSector:
    """A swept sector with its hub held or on its foundation, Young's modulus 1 MPa, condensed onto its flank (or its
    drive and coast flank), its lower and its upper cut.

    stiffness: (f + 2 c, f + 2 c), N/mm; dofs by height, radius, then x, y, z in the section's frame that turns with it,
    of cuts as of `coarse_cuts.CutNodes`. Dofs of the upper cut are in the next sector's frame. lower: (c / 3, 3), X, Y,
    z of the lower cut's nodes. profile: nodes of a flank at a height.
    """

    stiffness: np.ndarray
    lower: np.ndarray
    profile: int
    timings: dict


def condensed_swept_sector(
    mesh: BodyMesh, sweep: Sweep, poissons_ratio: float, teeth: int, both: bool = False
) -> SweptSector:
    """A sector of a gear of `teeth`; `both`: with its coast flank after its drive flank.

    With flanks, cuts and hub held, motions decay along the face within a module. So a wide sector of equal layers is
    condensed from a narrow one: stiffness between two heights is that of the same distance, as near to the same end.
    """
    narrow = narrow_sweep(sweep, root_pitch(line_of(mesh, "lower cut", ELEMENT.order), teeth))
    sector = _condensed(mesh, narrow, poissons_ratio, teeth, both)
    return sector if narrow is sweep else _widened(sector, narrow, mesh, sweep, teeth)


def _condensed(mesh: BodyMesh, sweep: Sweep, poissons_ratio: float, teeth: int, both: bool) -> SweptSector:
    clock = perf_counter()
    section = SectionForms(mesh, poissons_ratio, sweep.web)
    compiled = perf_counter()
    flanks = [by_radius(mesh.edge_nodes(side, ELEMENT.order)) for side in ("flank", "coast")[: 2 if both else 1]]
    cuts = [line_of(mesh, f"{name} cut", ELEMENT.order) for name in ("lower", "upper")]
    check_congruent(cuts[0], cuts[1], teeth)
    nodes = section.nodes.points
    there = section.material(sweep).ravel()
    numbers = [swept_nodes(nodes, line, len(sweep.heights)) for line in (*flanks, *cuts)]
    numbers = [own[there[own]] for own in numbers]
    if mesh.foundation is None:
        there[swept_nodes(nodes, mesh.edge_nodes("hub", ELEMENT.order), len(sweep.heights))] = False
    free = dofs_of(np.flatnonzero(there), 3)
    stiffness = swept_stiffness(section, sweep)[free][:, free]
    placed = [(np.cumsum(there) - 1)[own] for own in numbers]
    if sweep.web is None:
        lower, weights = cut_nodes(cuts[0], sweep, teeth)
        stiffness, kept = on_cut_nodes(stiffness, np.concatenate(placed[:-2]), placed[-2:], weights)
    else:
        kept = dofs_of(np.concatenate(placed), 3)
        lower = np.column_stack([nodes[numbers[-2] % len(nodes)], sweep.heights[numbers[-2] // len(nodes)]])
    condensed = schur_complement(stiffness, kept)
    turn_last(condensed, lower.size, rotation(2.0 * np.pi / teeth, 3))
    timings = {"time_compile": compiled - clock, "unknowns": len(free), "condensed_unknowns": len(kept)}
    return SweptSector(condensed, lower, len(flanks[0]), timings)


def _widened(sector: SweptSector, narrow: Sweep, mesh: BodyMesh, sweep: Sweep, teeth: int) -> SweptSector:
    """A sector of more layers, all like those of a narrow `sector`."""
    lower = cut_nodes(line_of(mesh, "lower cut", ELEMENT.order), sweep, teeth).places
    flanks = (len(sector.stiffness) - 2 * sector.lower.size) // (3 * sector.profile * len(narrow.heights))
    own, wide = (_dofs_by_height(flanks, sector.profile, *each) for each in ((sector.lower, narrow), (lower, sweep)))
    beyond = len(wide) - len(own)
    stiffness = np.zeros((sum(map(len, wide)),) * 2)
    for low, high in np.ndindex(len(wide), len(wide)):
        # Deep nodes of cuts are alike from two layers to the next two, which have four heights more.
        shift = min(max(4 * round((low + high - len(own) + 1) / 8), 0), beyond)
        if 0 <= min(low, high) - shift and max(low, high) - shift < len(own):
            stiffness[np.ix_(wide[low], wide[high])] = sector.stiffness[np.ix_(own[low - shift], own[high - shift])]
    grown = len(wide) / len(own)
    timings = {
        **sector.timings,
        "unknowns": round(grown * sector.timings["unknowns"]),
        "condensed_unknowns": len(stiffness),
    }
    return SweptSector(stiffness, lower, sector.profile, timings)


def _dofs_by_height(flanks: int, profile: int, lower: np.ndarray, sweep: Sweep) -> list[np.ndarray]:
    """Dofs of a SweptSector at each height: of flanks with `profile` nodes there, and of both cuts."""
    heights = sweep.heights
    cut = np.abs(lower[:, 2:] - heights).argmin(axis=1)
    of_flanks = np.tile(np.repeat(np.arange(len(heights)), profile), flanks)
    of_nodes = np.concatenate([of_flanks, cut, cut])
    return [dofs_of(np.flatnonzero(of_nodes == height), 3) for height in range(len(heights))]


def parts_of_ring(sector: SweptSector, teeth: int) -> Parts:
    """Of a sector between cuts that move in few ways, what `ring.between_cuts` gives of all their dofs."""
    flanks = len(sector.stiffness) - 2 * sector.lower.size
    return between_few_motions(flank_free(sector.stiffness, flanks), sector.profile, teeth)
