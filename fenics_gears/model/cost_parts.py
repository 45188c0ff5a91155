"""What costs are made of, in the plane and over the face: contact nodes at all positions, contact operators, root
stress; on the machine of `model.cost`."""

from dataclasses import dataclass
from functools import lru_cache
from math import lcm

import numpy as np

from fenics_gears.contact.face import Face
from fenics_gears.contact.places import face_places
from fenics_gears.contact.tooth_pair import contact_rolls_of
from fenics_gears.contact.window import ends_of, offsets_of
from fenics_gears.inputs.tree import GEARS

from .model import Model
from .storage import fillet_points

# Bytes: the program with its libraries; the same with those that mesh and condense; one number.
PROGRAM = 230e6
CONDENSING_PROGRAM = 335e6
BYTES_OF_A_NUMBER = 8.0
# What a result needs to know of a contact node at a position, numbers, and their copies side by side; with what its
# place on the flanks takes (measured).
NUMBERS_OF_A_NODE = 80
# Mesh cycles that are unlike where a gear is meshed as a whole: those in which a cracked tooth or its neighbours are in
# mesh (measured).
UNLIKE_CYCLES = 5
# Of root stress: seconds of a step for each stress of a tooth per force on one (measured; several loaded teeth), and of
# each pair of flanks at a position; bytes for each contact row of a position: what its force is on the flank nodes of
# both gears (measured).
STEP_STRESS = 5e-9
PAIR_ON_FLANKS = 5e-4
ON_FLANKS = 450.0
# At how many phases of the mesh cycle contact nodes are counted.
PHASES = 4


@dataclass(frozen=True)
class ExpectedCost:
    """Seconds of condensing (None where nothing is condensed) and of marching, of which `building` make the contact
    operators; unknowns (words, number) of the gears; how bodies over the face are condensed (words, way).

    Bytes: `memory` of all, of which `operators` need not be kept: they are made again each time the mesh cycle comes
    round; and `passing` are free again when the gears are condensed.
    """

    condensing: float | None
    marching: float
    memory: float
    operators: float = 0.0
    unknowns: tuple[tuple[str, float], ...] = ()
    ways: tuple[tuple[str, str], ...] = ()
    building: float = 0.0
    passing: float = 0.0

    @property
    def held(self) -> float:
        """Bytes that a run takes at least."""
        return self.memory - self.operators


@dataclass(frozen=True)
class Contact:
    """Contact of a run: `positions` with operators of their own; at one of them, on the average over the mesh cycle,
    `pairs` of flanks (in each slice of a face), their contact `nodes`, and the square of these."""

    positions: int
    pairs: float
    nodes: float
    squares: float


def contact_of(model: Model) -> Contact:
    """Counted at a few phases, as flanks end within their windows."""
    face = model.face
    coast = model.scene.coast_flanks is not None
    along = tuple(face.positions.tolist()), tuple(face.widths.tolist()), face.slope
    return Contact(_positions(model), *_counted(model.pair, model.resolution.contact_grid, along, coast, model.corner))


# The designs of a search have the same; to count them takes as long as three steps.
@lru_cache(maxsize=64)
def _counted(pair, grid, along, coast, corner) -> tuple[float, float, float]:
    positions, widths, slope = along
    face = Face(np.array(positions), np.array(widths), slope)
    counts = []
    for phase in range(PHASES):
        places = face_places(pair, grid, face, (phase + 0.5) / PHASES, coast, corner)
        ends = ends_of(pair, contact_rolls_of(places))
        counts.append((len(places), len(offsets_of(ends, grid)[0])))
    pairs, nodes = np.mean(counts, axis=0)
    return float(pairs), float(nodes), float(np.mean([own**2 for _, own in counts]))


def _positions(model: Model) -> int:
    """Positions of the run that have contact operators of their own."""
    on_points = (None, model.scene.wheel_points)
    unlike = (meshed_unknowns(model, name) or given for name, given in zip(GEARS, on_points))
    teeth = [gear.tooth_count for gear, own in zip(model.pair.gears, unlike) if own is not None]
    cycles = min(lcm(*teeth), UNLIKE_CYCLES ** len(teeth))
    return min(cycles * model.resolution.steps_per_mesh_cycle, model.steps + 2)


def meshed_unknowns(model: Model, name: str) -> int | None:
    """Unknowns of a gear with a mesh of its own; None for a ring of sectors."""
    given = model.scene.body_meshes
    if given is None:
        return None
    return given.unknowns_of(name, model.pair, model.resolution.element)


# Numbers of a contact operator for each one between normal forces, with friction.
OF_FRICTION = 6.0


def operator_bytes(model: Model, contact: Contact) -> float:
    """Of the contact operators: between normal forces, or with friction between forces of both kinds and those of the
    step before."""
    kinds = OF_FRICTION if model.scene.friction is not None else 1.0
    return BYTES_OF_A_NUMBER * contact.positions * contact.squares * kinds


def root_stress_cost(
    model: Model, unknowns: float, seconds: tuple[float, float], flank: float
) -> tuple[float, float, float]:
    """Of the root stress of a gear, in the plane or in slices: seconds of condensing, bytes of its rows, seconds of a
    step. `seconds`: of an unknown, factorised and solved for once; `flank`: dofs of the flank or flanks."""
    factorised, solved = seconds
    points = 2.0 * (fillet_points(model.face.slices) + 1) * model.face.slices
    teeth = 2 * model.touching.reach.farthest + (3 if model.scene.coast_flanks is not None else 1)
    condensing = unknowns * (factorised + solved * (points + flank))
    return condensing, BYTES_OF_A_NUMBER * teeth * points * flank, STEP_STRESS * points * flank
