"""Expected time and memory of a run, and settings that fit: operations are counted, their times were measured on one
machine.

Seconds are those of one core of the reference machine (Intel Xeon of 2023, 2 cores, Debian 12's OpenBLAS, one thread);
machines differ by a factor of two. `python -m tests.benchmarks.expected_cost` prints what is expected beside what is
measured.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import ceil

from fenics_gears.effects import effects_on
from fenics_gears.elasticity.sector_boundary import flank_roll_angles
from fenics_gears.errors import SceneError
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.accuracy import FEWEST_LAYERS, FEWEST_SLICES, SECTION_SIZE
from fenics_gears.scene.data import Accuracy

from .cost_parts import (
    BYTES_OF_A_NUMBER,
    CONDENSING_PROGRAM,
    NUMBERS_OF_A_NODE,
    ON_FLANKS,
    PAIR_ON_FLANKS,
    PROGRAM,
    Contact,
    ExpectedCost,
    contact_of,
    meshed_unknowns,
    operator_bytes,
    root_stress_cost,
)
from .model import Model, model_of
from .resolution import EVERY_STEP

# Unknowns of a sector mesh: a body part and one part per flank node; fitted to meshes from 0.16 to 0.01 mm of the
# paper's pair.
SECTOR_UNKNOWNS = {"P1": (5200, 35.0), "P2": (2300, 30.0), "Q1": (6500, 31.0), "Q2": (3000, 35.0)}
SECTOR_UNKNOWNS["Q1 incompatible"] = SECTOR_UNKNOWNS["Q1"]
# Seconds of meshing and condensing: an unknown (elements of first order are more, and longer to mesh) or one of
# a mesh that is given, a gear, the cube of a flank's dofs (a dense inverse), their square for each block of compliance.
MESHED_UNKNOWN = {"P1": 3.4e-5, "P2": 1.2e-5, "Q1": 2.2e-5, "Q1 incompatible": 2.8e-5, "Q2": 1.1e-5}
GIVEN_UNKNOWN = 5e-6
GEAR = 0.04
FLANK_CUBE = 7e-11
FLANK_SQUARE = 2.8e-8
# Of each tooth of a gear that is meshed as a whole, in inverses of a flank's size.
INVERSES_OF_A_TOOTH = 0.375
# Seconds of marching: at a position each pair of flanks and the square of contact rows, a step and each of its rows.
PAIR = 2.5e-4
ROWS_SQUARE = 8e-8
STEP = 8e-6
ROW = 1e-6
# Seconds that an effect adds to a step: gaps that differ, a torque that varies, openings of both flanks, time steps of
# unequal length.
STEP_OF_EFFECT = {
    "flank_errors": 4e-5, "eccentricity": 2e-5, "torque_ripple": 1e-5, "coast_flanks": 5e-6, "speed_ramp": 1e-5,
}  # fmt: skip
# For the reference route, seconds: an unknown of a remeshed sector, a step, the cube of its contact rows; matrices of a
# position.
REMESHED_UNKNOWN = 1.2e-5
REMESHED_STEP = 4e-4
ROW_CUBE = 1.5e-10
MATRICES_OF_A_POSITION = 7.0
# Matrices of a flank's size that are held while its teeth are joined (measured).
MATRICES_OF_A_FLANK = 6.0


def flank_unknowns(model: Model, name: str) -> int:
    """Displacements of the nodes of a gear's flank."""
    resolution = model.resolution
    gear = getattr(model.pair, name)
    tip = resolution.mate_tips[GEARS.index(name)]
    elements = len(flank_roll_angles(gear, resolution.flank_element_size, tip)) - 1
    return 2 * (resolution.order * elements + 1)


def expected_cost(model: Model) -> ExpectedCost:
    """What a run of a scene costs, gears not being in the cache.

    >>> from fenics_gears import load_scene, model_of
    >>> expected_cost(model_of(load_scene("demos/lundvall2004.toml"))).marching < 60.0  # s
    True
    """
    resolution = model.resolution
    scene = model.scene
    if scene.tooth_elasticity is None or resolution.element not in SECTOR_UNKNOWNS:
        contact = contact_of(model)
        held = PROGRAM + model.stored_bytes + BYTES_OF_A_NUMBER * NUMBERS_OF_A_NODE * contact.positions * contact.nodes
        return ExpectedCost(None, _marching(model, contact), held)
    gears = [_condensed(model, name) for name in GEARS]
    if resolution.condensation == EVERY_STEP:
        return _remeshed_cost(model, gears)
    sections = _sections(model, gears)
    if model.face.slices == 1:
        return _with_root_stress(model, gears, sections)
    from .face_cost import face_cost

    # Of teeth ahead and behind, between all flanks.
    reach = 2 * model.touching.reach.farthest + 1
    flanks = 2 if scene.coast_flanks is not None else 1
    read = sum(reach * (flanks * gear.flank_dofs) ** 2 for gear in gears)
    return face_cost(model, sections, (_numbers(gears), read))


# Of root stress, seconds: an unknown, and one for each column solved.
UNKNOWN = 1.2e-5
SOLVED_UNKNOWN = 1.4e-7


@dataclass(frozen=True)
class _Gear:
    """A gear to be condensed: its finite elements' unknowns, the seconds of one, dofs of a flank, blocks of its
    compliance that are computed, those that contact copies (the transposes, of teeth behind), dense inverses and the
    dofs of their `joined` flanks."""

    words: str
    unknowns: float
    unknown: float
    flank_dofs: float
    blocks: float
    copied: float
    joined: float
    inverses: float = 1.0


def _condensed(model: Model, name: str) -> _Gear:
    resolution = model.resolution
    reach = model.touching.reach
    gear = getattr(model.pair, name)
    body, per_node = SECTOR_UNKNOWNS[resolution.element]
    dofs = flank_unknowns(model, name)
    meshed = meshed_unknowns(model, name)
    if meshed is not None:
        # Of all teeth, where each has a compliance of its own.
        inverses = INVERSES_OF_A_TOOTH * gear.teeth
        return _Gear(f"the whole {name}", meshed, GIVEN_UNKNOWN, dofs, 1.0 * gear.teeth, 1.0, dofs, inverses)
    unknown = MESHED_UNKNOWN[resolution.element]
    unknowns = body + per_node * dofs
    words = f"a {name} sector"
    if reach.across is None:
        return _Gear(words, unknowns - 0.5 * per_node * dofs, unknown, dofs, reach.same + 1, reach.same, dofs)
    across = reach.across[1] - reach.across[0] + 1
    return _Gear(words, unknowns, unknown, dofs, reach.same + 1 + across, 2 * reach.same, 2.0 * dofs)


def _marching(model: Model, contact: Contact) -> float:
    # Of rigid flanks a step knows the first node that touches: it has no rows.
    step = STEP + (ROW * _rows(model, contact) if model.scene.tooth_elasticity is not None else 0.0)
    step += sum(STEP_OF_EFFECT.get(effect.section, 0.0) for effect in effects_on(model.scene))
    return _building(model, contact) + model.steps * step


def _rows(model: Model, contact: Contact) -> float:
    """Of the contact operator, normal and tangential ones."""
    return (2 if model.scene.friction is not None else 1) * contact.nodes


def _building(model: Model, contact: Contact) -> float:
    elastic = model.scene.tooth_elasticity is not None
    squares = contact.squares * (4.0 if model.scene.friction is not None else 1.0)
    return contact.positions * (PAIR * contact.pairs + (ROWS_SQUARE * squares if elastic else 0.0))


def _sections(model: Model, gears: list[_Gear]) -> ExpectedCost:
    """Of gears condensed once in the plane, and of marching on them."""
    contact = contact_of(model)
    condensing = sum(
        GEAR
        + gear.unknown * gear.unknowns
        + gear.inverses * FLANK_CUBE * gear.joined**3
        + gear.blocks * FLANK_SQUARE * gear.flank_dofs**2
        for gear in gears
    )
    joining = max(MATRICES_OF_A_FLANK * gear.joined**2 for gear in gears)
    nodes = NUMBERS_OF_A_NODE * contact.positions * contact.nodes
    held = BYTES_OF_A_NUMBER * (_numbers(gears) + max(joining, nodes))
    operators = operator_bytes(model, contact)
    return ExpectedCost(
        condensing,
        _marching(model, contact),
        CONDENSING_PROGRAM + model.stored_bytes + held + operators,
        operators,
        tuple((gear.words, gear.unknowns) for gear in gears),
        building=_building(model, contact),
    )


def _numbers(gears: list[_Gear]) -> float:
    """In the compliance of flanks."""
    return sum((gear.blocks + gear.copied) * gear.flank_dofs**2 for gear in gears)


def _with_root_stress(model: Model, gears: list[_Gear], sections: ExpectedCost) -> ExpectedCost:
    if not model.scene.output.root_stress:
        return sections
    contact = contact_of(model)
    held = ON_FLANKS * contact.positions * _rows(model, contact)
    seconds = 0.0
    step = 0.0
    for gear in gears:
        own = root_stress_cost(model, gear.unknowns, (UNKNOWN, SOLVED_UNKNOWN), gear.flank_dofs)
        seconds = seconds + own[0]
        held = held + own[1]
        step = step + own[2]
    return replace(
        sections,
        condensing=sections.condensing + seconds,
        marching=sections.marching + model.steps * step + PAIR_ON_FLANKS * contact.positions * contact.pairs,
        memory=sections.memory + held,
    )


def _remeshed_cost(model: Model, gears: list[_Gear]) -> ExpectedCost:
    """Of a run where every loaded sector is meshed anew at every position."""
    resolution = model.resolution
    pairs = contact_of(model).pairs
    positions = resolution.steps_per_mesh_cycle
    rows = 2.0 * pairs * (resolution.order * (resolution.contact_grid.nodes - 1) + 1)
    return ExpectedCost(
        positions * pairs * REMESHED_UNKNOWN * sum(gear.unknowns for gear in gears),
        model.steps * (REMESHED_STEP + ROW_CUBE * rows**3),
        CONDENSING_PROGRAM + model.stored_bytes + BYTES_OF_A_NUMBER * positions * MATRICES_OF_A_POSITION * rows**2,
        unknowns=tuple((gear.words, gear.unknowns) for gear in gears),
    )


# By how much elements and layers are made coarser from try to try, and how often.
COARSER = 1.2
TRIES = 12


def too_large(model: Model, cost: ExpectedCost, allowed: float) -> str:
    """Why a run that may take `allowed` bytes does not fit, and what to change; empty where it does."""
    if cost.held <= allowed:
        return ""

    def held(accuracy: Accuracy) -> float:
        return expected_cost(model_of(replace(model.scene, accuracy=accuracy))).held

    target = ' In place of settings, target = "5 %" has the run look for some that fit and keep the error;'
    return refused(cost, allowed, settings_that_fit(model, held, allowed), target)


def refused(cost: ExpectedCost, allowed: float, fits: str, target: str = "") -> str:
    """Why a run does not fit, and what to change: settings that fit, in words, if there are any, or a `target`."""
    less = (
        f"It fits with {fits} in [accuracy]" if fits else "Larger elements, fewer mesh cycles or time steps take less"
    )
    return (
        f"The run would take {cost.held / 1e9:.3g} GB of memory, contact operators apart, and {allowed / 1e9:.3g} GB"
        f" are allowed. Nothing was computed. {less}.{target} `--memory` or FENICS_GEARS_MEMORY allow more."
    )


def settings_that_fit(model: Model, held: Callable[[Accuracy], float], allowed: float) -> str:
    """The least coarse ones that are tried, in words; empty where none fits. `held`: bytes of a run with settings."""
    for times in range(1, TRIES + 1):
        accuracy, words = _coarser(model, COARSER**times)
        try:
            if held(accuracy) <= allowed:
                return words
        except SceneError:
            continue
    return ""


def _coarser(model: Model, factor: float) -> tuple[Accuracy, str]:
    """Settings with larger elements: of the flanks, or over a face of the bodies, with fewer layers and slices."""
    asked = model.scene.accuracy
    slices_now, layers_now = model.slices_and_layers
    if slices_now is None or layers_now is None:
        size = _rounded(factor * model.resolution.flank_element_size)
        return replace(asked, flank_element_size=size), f'flank_element_size = "{size:g} mm"'
    size = _rounded(factor * (asked.body_element_size or SECTION_SIZE * model.scene.gears.module))
    layers = max(ceil(layers_now / factor), FEWEST_LAYERS)
    slices = max(ceil(slices_now / factor), FEWEST_SLICES)
    words = f'body_element_size = "{size:g} mm", layers = {layers}, slices = {slices}'
    return replace(asked, body_element_size=size, layers=layers, slices=slices), words


def _rounded(size: float) -> float:
    """To two digits."""
    return float(f"{size:.2g}")
