"""The same analyses by the program's own way."""

from dataclasses import dataclass
from functools import lru_cache
from math import radians

import numpy as np
from tests.contact.problems import pressed
from tests.face_reference.cases import FACE_WIDTH, STEEL, base_slope, reference_pair
from tests.face_reference.reference import OPENINGS

from fenics_gears.contact.face import Face, even_slices, finer_ends
from fenics_gears.contact.face_mesh import face_mesh, opening_over_face
from fenics_gears.contact.kinematics import COORDINATES
from fenics_gears.contact.mesh_cycle import Cycle, Gaps
from fenics_gears.contact.tooth_pair import Flanks, node_slices
from fenics_gears.contact.window import ContactGrid
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.face.compliance import face_compliance
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.elasticity.gear_compliance import flank_compliance

STEPS = 1000
REACH = Reach(2)


@dataclass(frozen=True)
class Answer:
    """Approach (mm, along the transverse line of action), and line load (N/mm) of each tooth pair in slices of `widths`
    at `positions` (mm)."""

    approach: float
    positions: np.ndarray
    widths: np.ndarray
    line_loads: dict[int, np.ndarray]


@lru_cache(maxsize=2)
def gears(helix_angle: float, section_size: float, layers: int, flank: float, cache):
    pair, slope = reference_pair(radians(helix_angle)), base_slope(radians(helix_angle))
    sections = tuple(
        flank_compliance(gear, STEEL, Discretisation("P2", flank), REACH, cache) for gear in (pair.pinion, pair.wheel)
    )
    bodies = tuple(
        face_compliance(
            gear,
            STEEL,
            FaceDiscretisation(section_size, layers, FACE_WIDTH, sense * slope / gear.base_radius),
            REACH,
            cache,
        )
        for gear, sense in ((pair.pinion, 1.0), (pair.wheel, -1.0))
    )
    return pair, slope, sections, bodies


def answer(
    helix_angle: float,
    phase: float,
    opening: str,
    force: float,
    cache=None,
    *,
    section_size=1.0,
    layers=8,
    slices=16,
    cut_ends=False,
    flank=0.045,
    spacing=0.03,
) -> Answer:
    """By sizes in mm and numbers over the face; `cut_ends`: the outermost slices are cut in two."""
    pair, slope, sections, bodies = gears(helix_angle, section_size, layers, flank, cache)
    even = even_slices(FACE_WIDTH, slices)
    face = Face(*(finer_ends(*even) if cut_ends else even), slope)
    grid = ContactGrid(74 * spacing, 75, closer_at_edges=True, inner_length=30 * spacing)

    def opened(heights, positions):
        return OPENINGS[opening](heights) / face.cosine

    mesh = face_mesh(Flanks(pair, sections), bodies, face, grid)
    cycle = Cycle(mesh, STEPS, [COORDINATES.index("rotation_2")], tangential=False)
    cycle = cycle.with_gaps(Gaps(openings=(opening_over_face(cycle, opened),)))
    operator = cycle.position(round(phase * STEPS)).operator
    solution = pressed(operator, force * face.cosine)
    found: dict[int, np.ndarray] = {}
    for tooth_pair, nodes in zip(operator.pairs, node_slices(operator.pairs)):
        line = found.setdefault(tooth_pair.place.index, np.zeros(face.slices))
        line[tooth_pair.place.slice] += solution.forces[nodes].sum() / face.widths[tooth_pair.place.slice]
    return Answer(float(solution.coordinates[0]), face.positions, face.widths, found)
