"""Expected time and memory of a run whose flanks are resolved over the face, on the machine of `model.cost`."""

from __future__ import annotations

from dataclasses import dataclass

from fenics_gears.contact.places import face_places
from fenics_gears.contact.window import flank_ends, node_offsets
from fenics_gears.elasticity.face.cost import expected_memory, expected_size, is_iterative
from fenics_gears.model.face_resolution import face_discretisation
from fenics_gears.model.model import Model
from fenics_gears.model.storage import FILLET_POINTS_OVER_FACE
from fenics_gears.system.memory import usual_memory

# Seconds of an unknown of a body, of the cube of the unknowns that it is condensed onto, and of the cube of those of a
# cut for each harmonic of the ring, of which there are half as many as teeth.
UNKNOWN, CONDENSED_CUBE, HARMONIC_CUBE = 6e-5, 2e-10, 1e-10
# Of conjugate gradients, for each of the condensed unknowns a second time.
SOLVED_BY_GRADIENTS = 3e-5
# Seconds at a position of each tooth pair in a slice and of the square of contact nodes; of a step, of their square and
# their cube (elimination).
PAIR_IN_SLICE, NODES_SQUARE, STEP_NODES_SQUARE, STEP_NODES_CUBE = 5e-4, 7e-9, 1.5e-9, 5e-12
# With friction: of a position, of a step.
POSITION_WITH_FRICTION, STEP_WITH_FRICTION = 3.5, 2.5
# Nodes of a section's flank where body elements are 0.35 modules, and the power by which they grow as elements become
# smaller; memory of the contact operators with the copies that building and marching make, in that of the operators
# (measured).
FLANK_NODES, POWER, WITH_COPIES = 17.0, 0.6, 1.25

# Of root stress, seconds: an unknown for each column solved, and a step for each stress of a tooth per force on one
# (measured; several loaded teeth).
SOLVED_UNKNOWN, STEP_STRESS = 4e-7, 5e-9
# Bytes for each contact node of a position: the matrices from its force to forces on the flank nodes of both gears
# (measured).
ON_FLANKS = 200.0


@dataclass(frozen=True)
class FaceCost:
    """Seconds of condensing both bodies and of marching, of which `building` make the contact operators, unknowns of
    the bodies, bytes while condensing, of the bodies' compliances on slices (`kept`) and
    of the contact operators; how each body is condensed, in words."""

    condensing: float
    marching: float
    unknowns: tuple[int, int]
    memory: float
    operators: float
    kept: float
    ways: tuple[str, ...]
    building: float


def contact_nodes(model: Model, phases: int = 4) -> tuple[float, float]:
    """Tooth pairs in slices, and their contact nodes, on the average over the mesh cycle."""
    pair, grid, face = model.pair, model.resolution.contact_grid, model.face
    places = [
        place
        for phase in range(phases)
        for place in face_places(pair, grid, face, phase / phases, model.scene.coast_flanks is not None, model.corner)
    ]
    nodes = sum(len(node_offsets(flank_ends(pair, place.contact_rolls), grid)) for place in places)
    return len(places) / phases, nodes / phases


def _size(model: Model, number: int) -> tuple[int, int]:
    """Unknowns of a gear's body, and those that it is condensed onto."""
    return expected_size(
        (model.pair.pinion, model.pair.wheel)[number],
        face_discretisation(model, number),
        model.scene.coast_flanks is not None,
    )


def by_gradients(model: Model, number: int, ranks: int = 1) -> bool:
    """Whether the body of a gear, 0 or 1, is condensed by conjugate gradients."""
    return is_iterative(*_size(model, number), ranks)


def face_cost(model: Model, ranks: int = 1) -> FaceCost:
    """Cost of the three-dimensional bodies and of contact over the face, without that of the plane sections; memory of
    each of some MPI ranks that share the bodies."""
    bodies, ways, condensing, memory, kept, stress_step = [], [], 0.0, 0.0, 0.0, 0.0
    coast = model.scene.coast_flanks is not None
    for number, gear in enumerate((model.pair.pinion, model.pair.wheel)):
        division = face_discretisation(model, number)
        unknowns, condensed = _size(model, number)
        bodies.append(unknowns)
        of_flank = expected_size(gear, division, True)[1] - expected_size(gear, division, False)[1]
        of_cut = 0.5 * (condensed - of_flank * (2 if coast else 1))
        iterative = by_gradients(model, number, ranks)
        condensing += (UNKNOWN + (SOLVED_BY_GRADIENTS * condensed if iterative else 0.0)) * unknowns
        condensing += CONDENSED_CUBE * condensed**3 + HARMONIC_CUBE * (gear.teeth // 2 + 1) * of_cut**3
        memory = max(memory, expected_memory(unknowns, condensed, iterative, ranks))
        ways.append(
            _way(iterative, *(expected_memory(unknowns, condensed, each, ranks) for each in (iterative, False)))
        )
        finer = 0.35 * gear.module / division.section_size
        on_slices = 3.0 * FLANK_NODES * finer**POWER * model.face.slices * (2 if coast else 1)
        kept += 8.0 * (2 * model.touching.reach.farthest + 1) * on_slices**2
        if model.scene.output.root_stress:
            points = 2.0 * (FILLET_POINTS_OVER_FACE + 1) * model.face.slices
            condensing += unknowns * (UNKNOWN + SOLVED_UNKNOWN * (points + on_slices))
            kept += 8.0 * (2 * model.touching.reach.farthest + (3 if coast else 1)) * points * on_slices
            stress_step += STEP_STRESS * points * on_slices
    pairs, nodes = contact_nodes(model)
    rubbing = model.scene.friction is not None
    positions = min(model.resolution.steps_per_mesh_cycle, model.steps + 2)
    position = (PAIR_IN_SLICE * pairs + NODES_SQUARE * nodes**2) * (POSITION_WITH_FRICTION if rubbing else 1.0)
    step = (STEP_NODES_SQUARE * nodes**2 + STEP_NODES_CUBE * nodes**3) * (STEP_WITH_FRICTION if rubbing else 1.0)
    if model.scene.output.root_stress:
        kept += ON_FLANKS * positions * nodes * (2.0 if rubbing else 1.0)
    # Normals alone, or both kinds and by the forces of the step before.
    operators = WITH_COPIES * 8.0 * positions * nodes**2 * (6.0 if rubbing else 1.0)
    building = positions * position
    return FaceCost(
        condensing,
        building + model.steps * (step + stress_step),
        (bodies[0], bodies[1]),
        memory,
        operators,
        kept,
        tuple(ways),
        building,
    )


def _way(iterative: bool, memory: float, by_factor: float) -> str:
    """How a body is condensed, and why."""
    if iterative:
        return (
            f"conjugate gradients, {memory / 1e9:.3g} GB: a factorisation takes {by_factor / 1e9:.3g} GB, and"
            f" {usual_memory() / 1e9:.3g} GB are allowed"
        )
    return f"factorisation by MUMPS, {memory / 1e9:.3g} GB"
