"""Expected time and memory of a run whose flanks are resolved over the face; as of `model.cost`."""

from __future__ import annotations

from dataclasses import dataclass

from fenics_gears.contact.face_cycle import face_places
from fenics_gears.contact.window import flank_ends, node_offsets
from fenics_gears.model.face_resolution import face_discretisation
from fenics_gears.model.model import Model

# Nodes of a section along fillets and flanks, whose elements are small anyway, and in the body where elements are 0.35 modules; nodes of a cut there, and
# the power by which these grow as elements become smaller (measured).
OUTLINE_NODES, BODY_NODES, CUT_NODES, CUT_POWER = 230.0, 135.0, 14.0, 0.6
# Seconds of an unknown of a body, and of the cube of a cut's dofs for each tooth.
UNKNOWN, CUT_CUBE = 1e-4, 2e-10
# Seconds at a position of each tooth pair in a slice and of the square of contact nodes; of a step, of their square and their cube (elimination).
PAIR_IN_SLICE, NODES_SQUARE, STEP_NODES_SQUARE, STEP_NODES_CUBE = 5e-4, 7e-9, 1.5e-9, 5e-12
# With friction: of a position, of a step.
POSITION_WITH_FRICTION, STEP_WITH_FRICTION = 3.5, 2.5
# Factor of MUMPS, the dense Schur complement and its copies: bytes of an unknown, and of the square of the dofs that are kept.
BYTES_OF_AN_UNKNOWN, BYTES_OF_A_KEPT_SQUARE = 6e3, 60.0
# Nodes of a section's flank where body elements are 0.35 modules; copies beside the contact operators while positions are built and marched (measured).
FLANK_NODES, WITH_COPIES = 17.0, 1.25


@dataclass(frozen=True)
class FaceCost:
    """Seconds of condensing both bodies and of marching, unknowns of the bodies, bytes while condensing, of the bodies' compliances on slices (`kept`) and
    of the contact operators."""

    condensing: float
    marching: float
    unknowns: tuple[float, float]
    memory: float
    operators: float
    kept: float


def contact_nodes(model: Model, phases: int = 4) -> tuple[float, float]:
    """Tooth pairs in slices, and their contact nodes, on the average over the mesh cycle."""
    pair, grid, face = model.pair, model.resolution.contact_grid, model.face
    places = [place for phase in range(phases) for place in face_places(pair, grid, face, phase / phases, model.scene.coast_flanks is not None, model.corner)]
    nodes = sum(len(node_offsets(flank_ends(pair, place.contact_rolls), grid)) for place in places)
    return len(places) / phases, nodes / phases


def face_cost(model: Model) -> FaceCost:
    """What the bodies and contact over the face cost beside the plane sections."""
    bodies, condensing, memory, kept = [], 0.0, 0.0, 0.0
    for number, gear in enumerate((model.pair.pinion, model.pair.wheel)):
        division = face_discretisation(model, number)
        heights = 3.0 * (2 * division.layers + 1)
        finer = 0.35 * gear.module / division.section_size
        unknowns, cut = (OUTLINE_NODES + BODY_NODES * finer**2) * heights, CUT_NODES * finer**CUT_POWER * heights
        bodies.append(unknowns)
        condensing += UNKNOWN * unknowns + CUT_CUBE * gear.teeth * cut**3
        memory = max(memory, BYTES_OF_AN_UNKNOWN * unknowns + BYTES_OF_A_KEPT_SQUARE * (3.0 * cut) ** 2)
        on_slices = 3.0 * FLANK_NODES * finer**CUT_POWER * model.face.slices * (2 if model.scene.coast_flanks is not None else 1)
        kept += 8.0 * (2 * model.touching.reach.farthest + 1) * on_slices**2
    pairs, nodes = contact_nodes(model)
    rubbing = model.scene.friction is not None
    positions = min(model.resolution.steps_per_mesh_cycle, model.steps + 2)
    position = (PAIR_IN_SLICE * pairs + NODES_SQUARE * nodes**2) * (POSITION_WITH_FRICTION if rubbing else 1.0)
    step = (STEP_NODES_SQUARE * nodes**2 + STEP_NODES_CUBE * nodes**3) * (STEP_WITH_FRICTION if rubbing else 1.0)
    # Normals alone, or both kinds and by the forces of the step before.
    operators = WITH_COPIES * 8.0 * positions * nodes**2 * (6.0 if rubbing else 1.0)
    return FaceCost(condensing, positions * position + model.steps * step, (bodies[0], bodies[1]), memory, operators, kept)
