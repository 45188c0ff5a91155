"""Expected size of a gear's body in three dimensions, and the memory that its condensation takes: nothing is meshed for
it."""

from __future__ import annotations

from functools import lru_cache

from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.elasticity.sector_boundary import sector_boundary
from fenics_gears.geometry.gear import Gear
from fenics_gears.system.memory import usual_memory

# Nodes of a section by those of its outline, within 15 % for 16 to 80 teeth and sections of 0.15 to 0.4 modules.
NODES, POWER = 0.37, 1.7
# Bytes, measured on the paper's wheel with 6 and 12 layers: libraries, for each unknown by MUMPS and by conjugate
# gradients, for each entry of the condensed stiffness.
LIBRARIES, PER_UNKNOWN, PER_UNKNOWN_ITERATIVE, PER_ENTRY = 0.2e9, 6.3e3, 4e3, 19.0
# The same of a sector that is not folded.
WHOLE_UNKNOWN, WHOLE_ENTRY = 12e3, 40.0


# Each of many runs of the same gears asks for it.
@lru_cache(maxsize=64)
def expected_size(gear: Gear, face: FaceDiscretisation, both_flanks: bool = False) -> tuple[int, int]:
    """Unknowns of a gear's sector, and those that it is condensed onto: flank or flanks, and cuts."""
    if gear.web is not None:
        # Imported here: gears without web have none of it.
        from fenics_gears.elasticity.face.web import webbed_size

        unknowns, of_flank, of_cut = webbed_size(
            gear.of_module_one, face.in_modules_of(gear), lambda points: NODES * points**POWER
        )
        return round(unknowns), (2 if both_flanks else 1) * of_flank + 2 * of_cut
    boundary = sector_boundary(gear.of_module_one, face.in_modules_of(gear).sizes)[0]
    flank, cut, hub = (2 * len(boundary.part(name)) - 1 for name in ("flank", "lower cut", "hub"))
    of_height = 3 * len(face.sweep.heights)
    nodes = NODES * len(boundary.points) ** POWER - hub
    return round(of_height * nodes), of_height * ((2 if both_flanks else 1) * flank + 2 * (cut - 1))


def expected_memory(
    unknowns: int, condensed_unknowns: int, iterative: bool = False, ranks: int = 1, halves: bool = True
) -> float:
    """Bytes that a process takes at most while it condenses a sector, by MUMPS or by conjugate gradients, and joins the
    ring; `halves`: of a sector that is folded (`fold`), a whole one is rank 0's alone."""
    if not halves:
        return LIBRARIES + WHOLE_UNKNOWN * unknowns + WHOLE_ENTRY * condensed_unknowns**2
    # Two ranks have a half each, which is what one has at a time; more share out its heights.
    sparse = (PER_UNKNOWN_ITERATIVE if iterative else PER_UNKNOWN) * unknowns / max(ranks / 2, 1.0)
    return LIBRARIES + sparse + PER_ENTRY * condensed_unknowns**2


def is_iterative(unknowns: int, condensed_unknowns: int, ranks: int = 1) -> bool:
    """Whether conjugate gradients condense a sector: where the memory that the user names, or else the machine's, holds
    them, and not MUMPS's factor. They are for folded sectors alone."""
    gradients, factor = (expected_memory(unknowns, condensed_unknowns, iterative, ranks) for iterative in (True, False))
    return gradients <= usual_memory() < factor
