"""Expected size of a gear's body in three dimensions, and the memory that its condensation takes."""

from functools import lru_cache

from fenics_gears.geometry.gear import Gear

from ..sector_boundary import sector_boundary
from .discretisation import FaceDiscretisation

# Nodes of a section by those of its outline, within 15 % for 16 to 80 teeth and sections of 0.15 to 0.4 modules.
NODES, POWER = 0.37, 1.7
# Bytes, measured: libraries, for each entry of the condensed stiffness; of a sector that is not folded for each
# unknown, by MUMPS, and each entry.
LIBRARIES, PER_ENTRY = 0.2e9, 24.0
WHOLE_UNKNOWN, WHOLE_ENTRY = 12e3, 40.0


# Each of many runs of the same gears asks for it.
@lru_cache(maxsize=64)
def expected_size(gear: Gear, face: FaceDiscretisation, both_flanks: bool = False) -> tuple[int, int]:
    """Unknowns of a gear's sector, and those that it is condensed onto: flank or flanks, and cuts."""
    if gear.web is not None:
        # Imported here: gears without web have none of it.
        from .web import webbed_size

        unknowns, of_flank, of_cut = webbed_size(
            gear.of_module_one, face.in_modules_of(gear), lambda points: NODES * points**POWER
        )
        return round(unknowns), (2 if both_flanks else 1) * of_flank + 2 * of_cut
    boundary = sector_boundary(gear.of_module_one, face.in_modules_of(gear).sizes)[0]
    flank, cut, hub = (2 * len(boundary.part(name)) - 1 for name in ("flank", "lower cut", "hub"))
    of_height = 3 * len(face.sweep.heights)
    nodes = NODES * len(boundary.points) ** POWER - hub
    return round(of_height * nodes), of_height * ((2 if both_flanks else 1) * flank + 2 * (cut - 1))


def expected_memory(unknowns: int, condensed_unknowns: int, halves: bool = True) -> float:
    """Bytes that a process takes at most while it condenses a sector and joins the ring; `halves`: of a folded
    sector."""
    of_unknown, of_entry = (0.0, PER_ENTRY) if halves else (WHOLE_UNKNOWN, WHOLE_ENTRY)
    return LIBRARIES + of_unknown * unknowns + of_entry * condensed_unknowns**2
