"""Expected size of a gear's body in three dimensions, and the memory that its condensation takes: nothing is meshed for it."""

from __future__ import annotations

from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.elasticity.sector_boundary import sector_boundary
from fenics_gears.geometry.gear import Gear

# Nodes of a section by those of its outline, within 15 % for 16 to 80 teeth and sections of 0.15 to 0.4 modules.
NODES, POWER = 0.37, 1.7
# Bytes, measured on pinion and wheel of the paper with 6 and 12 layers: libraries, for each unknown, for each entry of the condensed stiffness.
LIBRARIES, PER_UNKNOWN, PER_ENTRY = 0.1e9, 17e3, 33.0


def expected_size(gear: Gear, face: FaceDiscretisation) -> tuple[int, int]:
    """Unknowns of a gear's sector, and those that each of its two halves is condensed onto: a flank and a cut."""
    boundary = sector_boundary(gear.of_module_one, face.in_modules_of(gear).sizes)[0]
    flank, cut, hub = (2 * len(boundary.part(name)) - 1 for name in ("flank", "lower cut", "hub"))
    of_height = 3 * (2 * face.layers + 1)
    nodes = NODES * len(boundary.points) ** POWER - hub
    return round(of_height * nodes), of_height * (flank + cut - 1)


def expected_memory(unknowns: int, condensed_unknowns: int) -> float:
    """Bytes that a process takes at most while it condenses a sector and joins the ring."""
    return LIBRARIES + PER_UNKNOWN * unknowns + PER_ENTRY * condensed_unknowns**2
