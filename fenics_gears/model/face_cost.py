"""Expected time and memory of a run whose flanks are resolved over the face, on the machine of `model.cost`."""

from functools import lru_cache

import numpy as np

from fenics_gears.contact.face import Face
from fenics_gears.contact.operator import SHARE_FORMED
from fenics_gears.contact.places import face_places
from fenics_gears.contact.window import ends_of, offsets_of
from fenics_gears.elasticity.face.cost import expected_memory, expected_size
from fenics_gears.system.memory import allowed_memory

from .cost import CONDENSING_PROGRAM, ON_FLANKS, ExpectedCost, root_stress_cost
from .face_resolution import face_discretisation
from .model import Model

# Seconds of an unknown of a body, of the cube of the unknowns that it is condensed onto, and of the cube of those of a
# cut for each harmonic of the ring, of which there are half as many as teeth; of a folded sector (measured on helical
# gears of 23 to 67 teeth), and of one that is not, since its web is not in the middle (of 35 and 61 teeth).
FOLDED_SECTOR, WHOLE_SECTOR = (3e-5, 2e-11, 4e-12), (6e-5, 4e-11, 3e-11)
# Of the root stress, an unknown, factorised and solved for one load.
FACTORISED_UNKNOWN, SOLVED_UNKNOWN = 6e-5, 4e-7
# Seconds at a position of each tooth pair in a slice and of the square of contact nodes; of a step, of their square and
# their cube (elimination; measured on 160 to 2,400 contact nodes, most of which are open: within 2 times).
PAIR_IN_SLICE, NODES_SQUARE, STEP_NODES_SQUARE, STEP_NODES_CUBE = 2e-4, 5e-10, 3e-10, 2e-13
# With friction: of a position, of a step.
POSITION_WITH_FRICTION, STEP_WITH_FRICTION = 3.0, 2.5
# Nodes of a section's flank where body elements are 0.35 modules, and the power by which they grow as elements become
# smaller.
FLANK_NODES, POWER = 17.0, 0.6


# At how many phases of the mesh cycle contact nodes are counted.
PHASES = 4


def contact_nodes(model: Model) -> tuple[float, float]:
    face, coast = model.face, model.scene.coast_flanks is not None
    along = tuple(face.positions.tolist()), tuple(face.widths.tolist()), face.slope
    return _contact_nodes(model.pair, model.resolution.contact_grid, along, coast, model.corner)


# The designs of a search have the same; to count them takes as long as three steps.
@lru_cache(maxsize=64)
def _contact_nodes(pair, grid, along, coast, corner) -> tuple[float, float]:
    positions, widths, slope = along
    face = Face(np.array(positions), np.array(widths), slope)
    places = [
        place for phase in range(PHASES) for place in face_places(pair, grid, face, phase / PHASES, coast, corner)
    ]
    rolls = np.array([place.contact_rolls for place in places]).reshape(-1, 2).T
    nodes = len(offsets_of(ends_of(pair, rolls), grid)[0])
    return len(places) / PHASES, nodes / PHASES


def _size(model: Model, number: int) -> tuple[int, int]:
    """Unknowns of a gear's body, and those that it is condensed onto."""
    return expected_size(
        (model.pair.pinion, model.pair.wheel)[number],
        face_discretisation(model, number),
        model.scene.coast_flanks is not None,
    )


def both_at_once(model: Model) -> bool:
    """Whether the bodies of both gears differ, and can be condensed at the same time in the memory that the run may
    take."""
    gears = zip((model.pair.pinion, model.pair.wheel), model.scene.gears.materials)
    if len({(gear, material, face_discretisation(model, number)) for number, (gear, material) in enumerate(gears)}) < 2:
        return False
    memory = (
        expected_memory(*_size(model, number), face_discretisation(model, number).sweep.alike) for number in range(2)
    )
    return CONDENSING_PROGRAM + sum(memory) <= allowed_memory()


def face_cost(model: Model, sections: ExpectedCost) -> ExpectedCost:
    bodies, ways, condensing, largest = [], [], sections.condensing, 0.0
    # What the sections hold, without their contact operators, which are not made.
    held, stress_step = sections.held, 0.0
    coast, friction = model.scene.coast_flanks is not None, model.scene.friction is not None
    for number, (name, gear) in enumerate((("pinion", model.pair.pinion), ("wheel", model.pair.wheel))):
        division = face_discretisation(model, number)
        unknowns, condensed = _size(model, number)
        bodies.append((f"the {name}'s body", unknowns))
        of_flank = expected_size(gear, division, True)[1] - expected_size(gear, division, False)[1]
        of_cut = 0.5 * (condensed - of_flank * (2 if coast else 1))
        halves = division.sweep.alike
        unknown, condensed_cube, harmonic_cube = FOLDED_SECTOR if halves else WHOLE_SECTOR
        condensing += unknown * unknowns + condensed_cube * condensed**3
        condensing += harmonic_cube * (gear.teeth // 2 + 1) * of_cut**3
        memory = expected_memory(unknowns, condensed, halves)
        largest = max(largest, memory)
        ways.append((f"the {name}'s body", f"{memory / 1e9:.3g} GB"))
        finer = 0.35 * gear.module / division.section_size
        on_slices = 3.0 * FLANK_NODES * finer**POWER * model.face.slices * (2 if coast else 1)
        held += 8.0 * (2 * model.touching.reach.farthest + 1) * on_slices**2
        if model.scene.output.root_stress:
            seconds, kept, step = root_stress_cost(model, unknowns, (FACTORISED_UNKNOWN, SOLVED_UNKNOWN), on_slices)
            condensing, held, stress_step = condensing + seconds, held + kept, stress_step + step
    pairs, nodes = contact_nodes(model)
    positions = min(model.resolution.steps_per_mesh_cycle, model.steps + 2)
    position = (PAIR_IN_SLICE * pairs + NODES_SQUARE * nodes**2) * (POSITION_WITH_FRICTION if friction else 1.0)
    step = (STEP_NODES_SQUARE * nodes**2 + STEP_NODES_CUBE * nodes**3) * (STEP_WITH_FRICTION if friction else 1.0)
    if model.scene.output.root_stress:
        held += ON_FLANKS * positions * nodes * (2.0 if friction else 1.0)
    # Normals alone, or both kinds and by the forces of the step before; as many rows as are closed at some time.
    operators = SHARE_FORMED * 8.0 * positions * nodes**2 * (6.0 if friction else 1.0)
    return ExpectedCost(
        condensing,
        positions * position + model.steps * (step + stress_step),
        max(held + operators, CONDENSING_PROGRAM + model.stored_bytes + largest),
        operators,
        (*sections.unknowns, *bodies),
        tuple(ways),
        positions * position,
    )
