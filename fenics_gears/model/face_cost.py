"""Expected time and memory of a run whose flanks are resolved over the face, on the machine of `model.cost`."""

from dataclasses import replace

from fenics_gears.contact.operator import SHARE_FORMED
from fenics_gears.elasticity.face.cost import BYTES_OF_AN_UNKNOWN, expected_condensing, expected_size, held_dofs
from fenics_gears.inputs.tree import GEARS
from fenics_gears.system.memory import allowed_memory

from .cost_parts import (
    BYTES_OF_A_NUMBER,
    CONDENSING_PROGRAM,
    NUMBERS_OF_A_NODE,
    ON_FLANKS,
    PAIR_ON_FLANKS,
    Contact,
    ExpectedCost,
    contact_of,
    operator_bytes,
    root_stress_cost,
)
from .face_resolution import face_discretisation
from .model import Model

# Seconds of an unknown of a body, of one in a section of a held tooth (measured of two gears), and of a multiplication
# of dense matrices.
UNKNOWN = 4e-5
HELD_DOF = 1.4e-3
MULTIPLICATION = 5e-11
# Of the root stress, an unknown, factorised and solved for one load; of the cube of a cut's dofs.
FACTORISED_UNKNOWN = 6e-5
SOLVED_UNKNOWN = 4e-7
RECOVERED_CUT = 2.2e-9
# For each entry of the stiffness between the cuts that stresses are recovered by.
BYTES_OF_A_LINK = 40.0
# Seconds of a run; at a position of each tooth pair in a slice and of the square of contact nodes, whose rows are
# formed when they close; of a step, of their square and their cube (elimination).
RUN = 0.08
PAIR_IN_SLICE = 2.5e-4
NODES_SQUARE = 9e-9
STEP_NODES_SQUARE = 3e-10
STEP_NODES_CUBE = 2e-13
# With friction, in those without.
WITH_FRICTION = 3.0


def _size(model: Model, number: int):
    """Of a gear's body."""
    both = model.scene.coast_flanks is not None
    return expected_size(model.pair.gears[number], face_discretisation(model, number), both)


def _condensing(model: Model, number: int):
    """What it takes to condense a gear's body."""
    gear = model.pair.gears[number]
    division = face_discretisation(model, number)
    both = model.scene.coast_flanks is not None
    return expected_condensing(gear, division, model.touching.reach.farthest, both)


def both_at_once(model: Model) -> bool:
    """Whether the bodies of both gears differ, and can be condensed at the same time in the memory that the run may
    take."""
    gears = zip(model.pair.gears, model.scene.gears.materials)
    if len({(gear, material, face_discretisation(model, number)) for number, (gear, material) in enumerate(gears)}) < 2:
        return False
    return 2 * CONDENSING_PROGRAM + sum(_condensing(model, number).memory for number in range(2)) <= allowed_memory()


def face_cost(model: Model, sections: ExpectedCost, fine: tuple[float, float]) -> ExpectedCost:
    """Of the whole run, beside what its plane `sections` take; `fine`: numbers in the compliance of these, and as
    contact reads it."""
    bodies = []
    ways = []
    condensing = sections.condensing
    largest = 0.0
    recovering = 0.0
    contact = contact_of(model)
    friction = model.scene.friction is not None
    condensed = CONDENSING_PROGRAM + model.stored_bytes + BYTES_OF_A_NUMBER * fine[0]
    pushing = 0.0
    stress_step = 0.0
    held = condensed + BYTES_OF_A_NUMBER * (fine[1] + NUMBERS_OF_A_NODE * contact.positions * contact.nodes)
    for number, name in enumerate(GEARS):
        size = _size(model, number)
        own = _condensing(model, number)
        bodies.append((f"the {name}'s body", size.unknowns))
        ways.append((f"the {name}'s body", f"{own.memory / 1e9:.3g} GB"))
        condensing += UNKNOWN * size.unknowns + MULTIPLICATION * own.operations
        condensing += HELD_DOF * held_dofs(model.pair.gears[number], face_discretisation(model, number))
        # The flanks' compliance by heights, and by slices for teeth ahead and behind: of two slices some teeth of all
        # touch at a time.
        on_slices = size.flanks * model.face.slices / len(face_discretisation(model, number).sweep.heights)
        reach = model.touching.reach.farthest
        teeth = min(2 * reach + 1, 2.0 * model.pair.contact_ratio + 2.0)
        held += BYTES_OF_A_NUMBER * ((reach + 1) * size.flanks**2 + teeth * on_slices**2)
        largest = max(largest, own.memory)
        if model.scene.output.root_stress:
            seconds, kept, step = root_stress_cost(
                model, size.unknowns, (FACTORISED_UNKNOWN, SOLVED_UNKNOWN), on_slices
            )
            condensing += seconds + RECOVERED_CUT * size.cut**3
            held += kept
            stress_step += step
            # The sector factorised once more, and matrices of its cuts, beside what is held by then.
            recovering = max(recovering, BYTES_OF_AN_UNKNOWN * size.unknowns + BYTES_OF_A_LINK * (2 * size.cut) ** 2)
    passing = max(condensed + largest - held, 0.0)
    held += passing + recovering
    if model.scene.output.root_stress:
        held += ON_FLANKS * contact.positions * contact.nodes * (2.0 if friction else 1.0)
        pushing = PAIR_ON_FLANKS * contact.positions * contact.pairs
    building = _building(model, contact)
    operators = SHARE_FORMED * operator_bytes(model, contact)
    return replace(
        sections,
        condensing=condensing,
        marching=RUN + building + pushing + model.steps * (_step(contact, friction) + stress_step),
        memory=held + operators,
        operators=operators,
        unknowns=(*sections.unknowns, *bodies),
        ways=tuple(ways),
        building=building,
        passing=passing,
    )


def _building(model: Model, contact: Contact) -> float:
    position = PAIR_IN_SLICE * contact.pairs + NODES_SQUARE * contact.nodes**2
    return contact.positions * position * (WITH_FRICTION if model.scene.friction is not None else 1.0)


def _step(contact: Contact, friction: bool) -> float:
    step = STEP_NODES_SQUARE * contact.nodes**2 + STEP_NODES_CUBE * contact.nodes**3
    return step * (WITH_FRICTION if friction else 1.0)
