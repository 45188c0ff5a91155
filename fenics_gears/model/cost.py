"""Expected time and memory of a run: operations are counted, their times were measured on one machine.

Seconds are those of one core of the reference machine (Intel Xeon of 2023, 2 cores, Debian 12's OpenBLAS, one thread);
machines differ by a factor of two. `python -m tests.benchmarks.expected_cost` prints what is expected beside what is
measured.
"""

from dataclasses import dataclass, replace
from math import lcm

import numpy as np

from fenics_gears.contact.places import pairs_in_windows
from fenics_gears.effects import effects_on
from fenics_gears.geometry.gear import Gear

from .model import Model
from .resolution import EVERY_STEP
from .storage import fillet_points

Number = float | np.ndarray

# Unknowns of a sector mesh: a body part and one part per flank node; fitted to meshes from 0.16 to 0.01 mm of the
# paper's pair.
SECTOR_UNKNOWNS = {"P1": (5200, 35.0), "P2": (2300, 30.0), "Q1": (6500, 31.0), "Q2": (3000, 35.0)}
SECTOR_UNKNOWNS["Q1 incompatible"] = SECTOR_UNKNOWNS["Q1"]
# Seconds of meshing and condensing: a gear, an unknown, the cube of a flank's dofs (a dense inverse), their square for
# each block of compliance.
GEAR, UNKNOWN, FLANK_CUBE, FLANK_SQUARE = 0.04, 1.2e-5, 1.4e-10, 4.5e-8
# Two inverses of symmetric matrices by Cholesky, in those of a general one.
BOTH_FLANKS_INVERSES = 0.75
# Seconds of marching: at a position each pair of flanks and the square of contact nodes, a step and each of its contact
# rows.
PAIR, NODES_SQUARE, STEP, ROW = 3e-4, 1e-7, 8e-6, 2.5e-7
# A step of rigid flanks, which have a solver of their own.
RIGID_STEP = 1.4e-4
# Seconds that an effect adds to a step: gaps that differ, a torque that varies, openings of both flanks, time steps of
# unequal length.
STEP_OF_EFFECT = {
    "flank_errors": 4e-5, "eccentricity": 2e-5, "torque_ripple": 1e-5, "coast_flanks": 5e-6, "speed_ramp": 1e-5,
}  # fmt: skip
# Mesh cycles that are unlike where a gear is meshed as a whole: those in which a cracked tooth or its neighbours are in
# mesh (measured).
UNLIKE_CYCLES = 5
# For the reference route, seconds: an unknown of a remeshed sector, a step, the cube of its contact rows; matrices of a
# position.
REMESHED_UNKNOWN, REMESHED_STEP, ROW_CUBE, MATRICES_OF_A_POSITION = 1.2e-5, 4e-4, 1.5e-10, 7.0
# Of root stress, seconds: an unknown for each column solved, and a step for each stress
# of a tooth per force on one (measured; several loaded teeth). Bytes for each contact row of a position: matrices from
# its force to forces on the flank nodes of both gears (measured).
SOLVED_UNKNOWN, STEP_STRESS, ON_FLANKS = 1.4e-7, 5e-9, 200.0
# Bytes: the program with its libraries; the same with those that mesh and condense; one number.
PROGRAM, CONDENSING_PROGRAM, BYTES_OF_A_NUMBER = 200e6, 300e6, 8.0
# What a result needs to know of a contact node at a position, numbers, and their copies side by side.
NUMBERS_OF_A_NODE = 2 * 25
# Matrices of a flank's size that are held while its teeth are joined, and the tangential rows' own products (measured).
MATRICES_OF_A_FLANK, OPERATORS_WITH_FRICTION = 10.0, 1.5


@dataclass(frozen=True)
class ExpectedCost:
    """Seconds of condensing (None where nothing is condensed) and of marching, of which `building` make the contact
    operators; unknowns (words, number) of the gears; how bodies over the face are condensed (words, way).

    Bytes: `memory` of all, of which `operators` need not be kept: they are made again each time the mesh cycle comes
    round.
    """

    condensing: float | None
    marching: float
    memory: float
    operators: float = 0.0
    unknowns: tuple[tuple[str, float], ...] = ()
    ways: tuple[tuple[str, str], ...] = ()
    building: float = 0.0

    @property
    def held(self) -> float:
        """Bytes that a run takes at least."""
        return self.memory - self.operators


def too_large(model: Model, cost: ExpectedCost, allowed: float) -> str:
    """Why a run that may take `allowed` bytes does not fit, and what to change; empty where it does."""
    if cost.held <= allowed:
        return ""
    less = "Larger flank elements and fewer mesh cycles"
    if cost.ways:
        less = (
            f"Fewer slices (accuracy.slices, here {model.face.evenly}) and larger elements of the bodies"
            " (accuracy.body_element_size, accuracy.layers)"
        )
    return (
        f"The run would take {cost.held / 1e9:.3g} GB of memory, contact operators apart, and {allowed / 1e9:.3g} GB"
        f" are allowed. Nothing was computed. {less} take less; `--memory` or FENICS_GEARS_MEMORY allow more."
    )


def loaded_pairs(model: Model) -> float:
    """Pairs of flanks in contact windows, on the average over the mesh cycle."""
    coast_flanks = model.scene.coast_flanks is not None
    return pairs_in_windows(model.pair, model.resolution.contact_grid, coast_flanks, model.corner)


def contact_rows(model: Model) -> float:
    """Rows of the contact operator, normal and tangential, on the average over the mesh cycle."""
    return (2 if model.scene.friction is not None else 1) * model.resolution.contact_grid.nodes * loaded_pairs(model)


def operator_bytes(positions: Number, rows: Number, friction: bool) -> Number:
    """Of the contact operators at a number of positions; `rows` count normal and tangential ones."""
    return BYTES_OF_A_NUMBER * positions * rows**2 * (OPERATORS_WITH_FRICTION if friction else 1.0)


def flank_unknowns(gear: Gear, order: int, size: Number) -> Number:
    """Displacements of a flank's nodes; `order` of the element, its `size` in mm."""
    arc = 0.5 * gear.base_radius * (gear.tip_roll_angle**2 - gear.form_roll_angle**2)
    return 2.0 * (order * arc / size + 1.0)


def flank_bytes(unknowns: Number) -> Number:
    """Of a gear that is condensed onto so many displacements of a flank."""
    return BYTES_OF_A_NUMBER * MATRICES_OF_A_FLANK * unknowns**2


def expected_cost(model: Model) -> ExpectedCost:
    """What a run of a scene costs, gears not being in the cache.

    >>> from fenics_gears import load_scene, model_of
    >>> expected_cost(model_of(load_scene("demos/lundvall2004.toml"))).marching < 60.0  # s
    True
    """
    resolution, scene = model.resolution, model.scene
    if scene.tooth_elasticity is None or resolution.element not in SECTOR_UNKNOWNS:
        return ExpectedCost(None, _marching(model, 0.0), PROGRAM + model.stored_bytes)
    gears = [_condensed(model, name) for name in ("pinion", "wheel")]
    if resolution.condensation == EVERY_STEP:
        return _remeshed_cost(model, gears)
    sections = _sections(model, gears)
    if model.face.slices == 1:
        return _with_root_stress(model, gears, sections)
    from .face_cost import face_cost

    return face_cost(model, sections)


@dataclass(frozen=True)
class _Gear:
    """A gear to be condensed: its finite elements' unknowns, dofs of a flank, blocks of its compliance that are
    computed, those that contact copies (the transposes, of teeth behind), dense inverses of a flank's size."""

    words: str
    unknowns: float
    flank_dofs: float
    blocks: float
    copied: float
    inverses: float = 1.0


def _condensed(model: Model, name: str) -> _Gear:
    resolution, reach, gear = model.resolution, model.touching.reach, getattr(model.pair, name)
    body, per_node = SECTOR_UNKNOWNS[resolution.element]
    dofs, meshed = flank_unknowns(gear, resolution.order, resolution.flank_element_size), _meshed(model, name)
    if meshed is not None:
        # Of all teeth, where each has a compliance of its own.
        return _Gear(f"the whole {name}", meshed, dofs, 3.0 * gear.teeth, 1.0, gear.teeth)
    if reach.across is None:
        return _Gear(f"a {name} sector", body + per_node * 0.5 * dofs, dofs, reach.same + 1, reach.same)
    # Half a symmetric sector, for motions of either symmetry.
    half, across = 0.5 * body + per_node * 0.5 * dofs, reach.across[1] - reach.across[0] + 1
    blocks = reach.same + 1 + across
    return _Gear(f"half a {name} sector", half, dofs, blocks, 2 * reach.same, BOTH_FLANKS_INVERSES)


def _meshed(model: Model, name: str) -> int | None:
    """Unknowns of a gear with a mesh of its own; None for a ring of sectors."""
    given = model.scene.body_meshes
    if given is None:
        return None
    from fenics_gears.effects.body_meshes import unknowns_of

    return unknowns_of(given, model, name)


def _positions(model: Model) -> int:
    """Positions of the run that have contact operators of their own."""
    teeth = [getattr(model.pair, name).teeth for name in ("pinion", "wheel") if _meshed(model, name) is not None]
    unlike = min(lcm(*teeth), UNLIKE_CYCLES ** len(teeth))
    return min(unlike * model.resolution.steps_per_mesh_cycle, model.steps + 2)


def _marching(model: Model, rows: float) -> float:
    step = STEP if model.scene.tooth_elasticity is not None else RIGID_STEP
    step += sum(STEP_OF_EFFECT.get(effect.section, 0.0) for effect in effects_on(model.scene))
    return _building(model, rows) + model.steps * (step + ROW * rows)


def _building(model: Model, rows: float) -> float:
    nodes = rows / (2 if model.scene.friction is not None else 1)
    return _positions(model) * (PAIR * loaded_pairs(model) + NODES_SQUARE * nodes**2)


def _sections(model: Model, gears: list[_Gear]) -> ExpectedCost:
    """Of gears condensed once in the plane, and of marching on them."""
    rows, positions, friction = contact_rows(model), _positions(model), model.scene.friction is not None
    condensing = sum(
        GEAR
        + UNKNOWN * gear.unknowns
        + gear.inverses * FLANK_CUBE * gear.flank_dofs**3
        + gear.blocks * FLANK_SQUARE * gear.flank_dofs**2
        for gear in gears
    )
    nodes = positions * rows / (2 if friction else 1)
    held = BYTES_OF_A_NUMBER * NUMBERS_OF_A_NODE * nodes + sum(
        flank_bytes(gear.flank_dofs) + BYTES_OF_A_NUMBER * (gear.blocks + gear.copied) * gear.flank_dofs**2
        for gear in gears
    )
    marching, operators = _marching(model, rows), operator_bytes(positions, rows, friction)
    return ExpectedCost(
        condensing,
        marching,
        CONDENSING_PROGRAM + model.stored_bytes + held + operators,
        operators,
        tuple((gear.words, gear.unknowns) for gear in gears),
        building=_building(model, rows),
    )


def _with_root_stress(model: Model, gears: list[_Gear], sections: ExpectedCost) -> ExpectedCost:
    if not model.scene.output.root_stress:
        return sections
    held, seconds, step = ON_FLANKS * _positions(model) * contact_rows(model), 0.0, 0.0
    for gear in gears:
        own = root_stress_cost(model, gear.unknowns, (UNKNOWN, SOLVED_UNKNOWN), gear.flank_dofs)
        seconds, held, step = seconds + own[0], held + own[1], step + own[2]
    return replace(
        sections,
        condensing=sections.condensing + seconds,
        marching=sections.marching + model.steps * step,
        memory=sections.memory + held,
    )


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


def _remeshed_cost(model: Model, gears: list[_Gear]) -> ExpectedCost:
    """Of a run where every loaded sector is meshed anew at every position."""
    resolution, pairs = model.resolution, loaded_pairs(model)
    positions = resolution.steps_per_mesh_cycle
    rows = 2.0 * pairs * (resolution.order * (resolution.contact_grid.nodes - 1) + 1)
    return ExpectedCost(
        positions * pairs * REMESHED_UNKNOWN * sum(gear.unknowns for gear in gears),
        model.steps * (REMESHED_STEP + ROW_CUBE * rows**3),
        CONDENSING_PROGRAM + model.stored_bytes + BYTES_OF_A_NUMBER * positions * MATRICES_OF_A_POSITION * rows**2,
        unknowns=tuple((gear.words, gear.unknowns) for gear in gears),
    )
