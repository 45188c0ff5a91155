"""Transmission error of a helical pair without friction, by this program and by CalculiX, side by side, with times.

    apt-get install calculix-ccx                                   # CalculiX 2.20 of Debian 12
    python -m tests.benchmarks.against_calculix [--size FACTOR]    # four minutes of a core; FACTOR: on element sizes

CalculiX is given gears in fifteen-node wedges: sections that have nothing of this program but the outline of the teeth,
without teeth far from the loaded ones, swept along the helix. It finds contact itself, by surfaces and a penalty, and
solves for all unknowns at once. At these positions no tip edge touches: there contact is on the line of action, as
this program takes it by default.
"""

import argparse
import resource
import tempfile
from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
from tests.benchmarks.third_dimension.pairs import scene_of, standard_pair
from tests.corner_contact_reference.calculix import couples
from tests.corner_contact_reference.gear_mesh import GearMesh, rotation
from tests.face_reference.cases import Sizes, bands, touching_pairs
from tests.face_reference.contact_points import Position
from tests.face_reference.section_mesh import Section, SectionSizes, section_mesh

from fenics_gears import GearPair, Scene, gear_pair, simulate
from fenics_gears.elasticity.cache import Cache
from fenics_gears.scene.data import Accuracy

FACE_WIDTH, HELIX_ANGLE, LINE_LOAD, STEPS = 7.5, radians(20.0), 400.0, 20
PHASES = (0.3, 0.8)
SECTION, SCALED = SectionSizes(0.2, 0.2, 1.4, 2.8, 8.0, 0.8, 1), ("band", "depth", "fillet", "tooth", "body")
# Of half the face from the end face inwards, mm.
LAYERS = (0.75, 1.25, 1.75)
# Two rotations so far about this program's answer; the line between them gives the one of the torque.
APART = 0.01


def seconds_of_processor() -> float:
    """Processor time so far of this process and of those that it started and that have ended, s."""
    return sum(
        used.ru_utime + used.ru_stime
        for used in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    )


def by_this_program(scene: Scene) -> tuple[np.ndarray, float]:
    """Rotations of the wheel (phases,), rad, and seconds of all positions, gears condensed anew."""
    for _ in range(2):  # the first run loads what is compiled
        with tempfile.TemporaryDirectory() as empty:
            begun = seconds_of_processor()
            run = simulate(scene, cache=Cache(Path(empty)))
            seconds = seconds_of_processor() - begun
    places = [int(np.argmin(np.abs(run.mesh_phase.values - phase))) for phase in PHASES]
    return run.transmission_error.values[places], seconds


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


def meshes(pair: GearPair, phase: float, size: float) -> tuple[GearMesh, GearMesh]:
    """Pinion and wheel, fine where they touch at a phase; `size`: factor on all element sizes."""
    position = Position(pair, pair.slope, phase)
    section = replace(SECTION, **{name: size * getattr(SECTION, name) for name in SCALED})
    count = len(LAYERS)
    ends = np.linspace(0.0, count, max(round(count / size), 1) + 1)
    half = np.interp(ends, range(count + 1), np.cumsum([0.0, *LAYERS]))
    sizes = Sizes(section, tuple(np.diff(half)), 0.05, 0.2)
    loaded = bands(position, touching_pairs(position, sizes), sizes)
    return tuple(
        swept(section_mesh(gear, band, section), sizes.heights[::2], twist)
        for gear, band, twist in zip((pair.pinion, pair.wheel), loaded, position.twists)
    )


def by_calculix(scene: Scene, pair: GearPair, phase: float, guess: float, size: float) -> tuple[float, float, float]:
    """Rotation of the wheel (rad), the pinion's couple over the wheel's times the ratio of teeth, and seconds."""
    rotations = guess * np.array([1.0 - APART, 1.0 + APART])
    begun = seconds_of_processor()
    with tempfile.TemporaryDirectory() as folder:
        both = meshes(pair, phase, size)
        print(f"  {3 * sum(len(mesh.points) for mesh in both)} unknowns", flush=True)
        found = couples(pair, scene.gears.material, both, phase, rotations, Path(folder))
    seconds = seconds_of_processor() - begun
    torques = found[:, 1]
    rotation_there = rotations[0] + (scene.load.wheel_torque - torques[0]) * np.diff(rotations)[0] / np.diff(torques)[0]
    return rotation_there, np.mean(found[:, 0] / torques) * pair.wheel.teeth / pair.pinion.teeth, seconds


def main() -> None:
    """Print both side by side."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.benchmarks.against_calculix", description=__doc__.splitlines()[0]
    )
    parser.add_argument("--size", type=float, default=1.0, help="factor on CalculiX's element sizes")
    size = parser.parse_args().size
    gears = standard_pair(FACE_WIDTH, HELIX_ANGLE)
    scene, pair = scene_of(gears, Accuracy(steps_per_mesh_cycle=STEPS), LINE_LOAD), gear_pair(gears)
    own, seconds = by_this_program(scene)
    print("mesh phase   this program, urad   CalculiX, urad   difference   CalculiX: balance of couples, s", flush=True)
    spent = []
    for phase, mine in zip(PHASES, own):
        other, balance, taken = by_calculix(scene, pair, phase, mine, size)
        spent.append(taken)
        line = f"{phase:<12} {mine * 1e6:<20.2f} {other * 1e6:<16.2f} {mine / other - 1.0:<+12.2%}"
        print(line + f" {balance:.4f}, {taken:.0f}", flush=True)
    print(
        f"this program: {seconds:.1f} s for {STEPS} positions from nothing; CalculiX: {np.mean(spent):.0f} s a position"
    )
    print(f"ratio of times for as many positions: {np.mean(spent) * STEPS / seconds:.0f}")


if __name__ == "__main__":
    main()
