"""Transmission error of a helical pair without friction, by this program and by CalculiX (Debian's calculix-ccx):
`python -m tests.evidence calculix`, four minutes of a core.

CalculiX is given gears in fifteen-node wedges: sections that have nothing of this program but the outline of the teeth,
without teeth far from the loaded ones, swept along the helix. It finds contact itself, by surfaces and a penalty. At
the second position the tip edge of the next pair touches at one end of the face, before its path of contact begins.
"""

import tempfile
from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
from tests.benchmarks.third_dimension.pairs import standard_pair
from tests.corner_contact_reference.calculix import couples
from tests.corner_contact_reference.gear_mesh import GearMesh, rotation
from tests.face_reference import steep
from tests.face_reference.cases import Sizes, bands, touching_pairs
from tests.face_reference.contact_points import Position
from tests.face_reference.section_mesh import Section, SectionSizes, section_mesh

from fenics_gears import GearPair, Scene, gear_pair, simulate

FACE_WIDTH, HELIX_ANGLE, LINE_LOAD, STEPS = 7.5, radians(20.0), 400.0, 20
PHASES = (0.3, 0.8)
SECTION = SectionSizes(0.2, 0.2, 1.4, 2.8, 8.0, 0.8, 1)
# Of half the face from the end face inwards, mm.
LAYERS = (0.75, 1.25, 1.75)
# Of flanks that may touch, from the line of action, mm: a tip edge does so before and after its path of contact.
REACH = 0.7
# Of the resolved model: all teeth, or one on either side of those loaded.
ALL_TEETH = (9, 14)
ONE_BESIDE = (1, 1)
RESOLVED = steep.Sizes(band=0.1, depth=0.2, growth=0.5, layers=32, heights=12)
# Two rotations so far about this program's answer; the line between them gives the one of the torque.
APART = 0.01


def by_this_program(scene: Scene) -> np.ndarray:
    """Rotations of the wheel (phases,), rad."""
    run = simulate(scene)
    places = [int(np.argmin(np.abs(run.mesh_phase.values - phase))) for phase in PHASES]
    return run.transmission_error.values[places]


def swept(section: Section, heights: np.ndarray, twist: float) -> GearMesh:
    """Fifteen-node wedges between heights (layers + 1,), mm, of a section that turns by `twist`, rad/mm."""
    levels = np.insert(heights, np.arange(1, len(heights)), 0.5 * (heights[1:] + heights[:-1]))
    turned = [
        np.column_stack([section.points @ rotation(twist * z).T, np.full(len(section.points), z)]) for z in levels
    ]
    count, corners, middles = len(section.points), section.cells[:, :3], section.cells[:, 3:]
    cells = []
    for first in 2 * count * np.arange(len(heights) - 1):
        ends = np.hstack([corners, corners + 2 * count, middles, middles + 2 * count, corners + count])
        cells.append(first + ends)
    used, numbers = np.unique(np.vstack(cells), return_inverse=True)
    hub = np.flatnonzero(np.isin(used % count, section.held))
    middle = {node: place for place, node in np.ndenumerate(middles)}
    edges = np.array([middle[node] for _, nodes in section.flanks.values() for node in nodes[1::2]])
    contact = [edges + [layer * len(corners), 0] for layer in range(len(heights) - 1)]
    return GearMesh(np.vstack(turned)[used], numbers.reshape(-1, 15), hub, np.vstack(contact))


def meshes(
    pair: GearPair, phase: float, section: SectionSizes = SECTION, layers: tuple[float, ...] = LAYERS
) -> tuple[GearMesh, GearMesh]:
    position = Position(pair, pair.slope, phase)
    sizes = Sizes(section, layers, 0.05, REACH)
    loaded = bands(position, touching_pairs(position, sizes), sizes)
    return tuple(
        swept(section_mesh(gear, band, section), sizes.heights[::2], twist)
        for gear, band, twist in zip((pair.pinion, pair.wheel), loaded, position.twists)
    )


def by_calculix(scene: Scene, pair: GearPair, phase: float, guess: float, both=None, slave: int = 0) -> float:
    """Rotation of the wheel (rad); of `meshes`, those of the defaults unless given. slave: as of `couples`."""
    both = both or meshes(pair, phase)
    rotations = guess * np.array([1.0 - APART, 1.0 + APART])
    with tempfile.TemporaryDirectory() as folder:
        torques = couples(pair, scene.gears.material, both, phase, rotations, Path(folder), slave)[:, 1]
    return rotations[0] + (scene.load.wheel_torque - torques[0]) * np.diff(rotations)[0] / np.diff(torques)[0]


def by_resolved_model(
    pair: GearPair, phase: float, teeth_beside: tuple[int, int] = ALL_TEETH, tooth_pairs: tuple[int, ...] | None = None
) -> float:
    """Rotation of the wheel (rad); `tooth_pairs` alone touch, all unless given."""
    position = Position(pair, pair.slope, phase)
    load = LINE_LOAD * FACE_WIDTH / position.cosine
    found = steep.resolved(position, load, replace(RESOLVED, teeth_beside=teeth_beside), tooth_pairs)
    loads = {index: float(np.trapz(line, found.heights)) for index, line in found.line_loads.items()}
    print(f"  tooth pairs carry {loads} N", flush=True)
    return 1e-3 * found.approach / pair.wheel.base_radius


def main() -> None:
    """Print rotations, in microradians, of the resolved model: whole; of one tooth pair alone; and of that with few
    teeth."""
    pair = gear_pair(standard_pair(FACE_WIDTH, HELIX_ANGLE))
    for phase, more in ((PHASES[0], {}), (PHASES[1], {}), (PHASES[1], {"tooth_pairs": (0,)}),
                        (PHASES[1], {"tooth_pairs": (0,), "teeth_beside": ONE_BESIDE})):  # fmt: skip
        print(phase, more, f"{1e6 * by_resolved_model(pair, phase, **more):.2f}", flush=True)


if __name__ == "__main__":
    main()
