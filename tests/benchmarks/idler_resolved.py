"""Lag of the last gear of a row of three, in the plane without friction, by this program and by finite elements on the
whole gears (tests/simulation/test_idler_resolved.py), a minute of a core for each position.

Three whole gears in six-node triangles have nothing of this program but the outline of the teeth; both meshes are
loaded at once, and contact is found on the surfaces as they move (`plain_contact.py`). Where the idler and the last
gear stand follows from their outlines alone, not from the program's law of phases. The idler's bore turns freely: its
rotation is the one at which no couple is on it.
"""

from dataclasses import dataclass, replace
from math import pi
from pathlib import Path

import numpy as np
from tests.benchmarks.plain_contact import couples_of, surface
from tests.corner_contact_reference.calculix import Placed, placed, wheel_centre
from tests.corner_contact_reference.gear_mesh import GearMesh, MeshSizes, gear_mesh, rotation

from fenics_gears import GearPair, simulate_train
from fenics_gears.geometry.outline import centreline_angle
from fenics_gears.scene.train import TrainScene
from fenics_gears.scene.train_mesh import layout_of

SCENE = Path(__file__).parents[2] / "demos" / "gear_trains" / "idler.toml"
SIZES = MeshSizes(flank=0.12, tip=0.12, fillet=0.3, coarse=0.8, body=3.0)
MIRROR = np.array([[1.0, 0.0], [0.0, -1.0]])
# Rotations are changed by so much of themselves to find how the couples change, and are that close in the end.
CHANGED, CLOSE_ENOUGH = 0.01, 1e-5
MESHES = ((0, 1), (1, 2))
# The idler turns clockwise, so that it lags counter-clockwise; the last gear the other way.
SENSE = np.array([1.0, -1.0])


@dataclass(frozen=True)
class Position:
    """Three gears at a phase of the first mesh; the phase of the second one, and how far (rad) its frame is turned."""

    pairs: tuple[GearPair, GearPair]
    phase: float
    turned: float

    @property
    def of_idler(self) -> float:
        """Rotation (rad) of the idler's body in the frame of the first mesh."""
        first = self.pairs[0]
        along = first.path_start + self.phase * first.base_pitch
        return pi + (first.line_of_action_length - along) / first.wheel.base_radius

    @property
    def second(self) -> tuple[int, float]:
        """The idler's tooth that is in contact for the shortest time in the second mesh, and the phase there. In the
        mirror image of that mesh the idler drives as a pinion, by the other flanks of its teeth."""
        pair = self.pairs[1]
        gear = pair.pinion
        # A tooth k stands at of_idler + middle + k pitch, its image's tooth at turned - rotation - middle.
        start = pair.path_start / gear.base_radius
        free = self.turned - 2.0 * centreline_angle(gear) - self.of_idler - start
        tooth = int(np.floor(free / gear.angular_pitch))
        return tooth, (free - tooth * gear.angular_pitch) * gear.base_radius / pair.base_pitch


def position(train: TrainScene, phase: float) -> Position:
    """The gears of a row of three; raises ValueError for another train."""
    if layout_of(train.meshes).graph.shared != [1] or len(train.meshes) != 2:
        raise ValueError("a row of three gears is needed")
    first, second = train.meshes
    towards = np.angle(complex(*wheel_centre(first.pair))) + second.direction - first.direction
    own = np.angle(complex(*(MIRROR @ wheel_centre(second.pair))))
    return Position((first.pair, second.pair), phase, float(towards - own))


def bodies(at: Position, sizes: MeshSizes) -> list[Placed]:
    """The gears where they stand, in the frame of the first mesh."""
    first, second = at.pairs
    tooth, phase = at.second
    near = [(0, 1) if each < 0.75 else (-1, 0) for each in (at.phase, phase)]
    idler = gear_mesh(first.wheel, sizes, 0.0, tuple(-k for k in near[0]), tuple(tooth - k for k in near[1]))
    meshes = gear_mesh(first.pinion, sizes, 0.0, near[0]), idler
    found = [
        Placed(mesh, points, centre)
        for mesh, points, centre in zip(meshes, placed(first, meshes, at.phase), (np.zeros(2), wheel_centre(first)))
    ]
    last = gear_mesh(second.wheel, sizes, 0.0, tuple(-k for k in near[1]))
    turn = rotation(at.turned)
    beyond = placed(second, (idler, last), phase)[1] @ MIRROR @ turn.T + wheel_centre(first)
    centre = turn @ MIRROR @ wheel_centre(second) + wheel_centre(first)
    return [*found, Placed(_turned_over(last), beyond, centre)]


def _turned_over(mesh: GearMesh) -> GearMesh:
    """The mesh of a mirror image: nodes of a triangle count counter-clockwise again."""
    contact = mesh.contact.copy()
    contact[:, 1] = 2 - contact[:, 1]
    return replace(mesh, cells=mesh.cells[:, [0, 2, 1, 5, 4, 3]], contact=contact)


def by_finite_elements(train: TrainScene, at: Position, guess: np.ndarray, sizes: MeshSizes) -> np.ndarray:
    """Rotations (rad) by which the idler and the last gear lag under the train's torque."""
    surfaces = [surface(body, train.meshes[0].scene.gears.material) for body in bodies(at, sizes)]
    wanted = np.array([0.0, train.output_torque / at.pairs[1].face_width])
    for _ in range(8):
        rows = guess * np.array([[1.0, 1.0], [1.0 + CHANGED, 1.0], [1.0, 1.0 + CHANGED]])
        found = np.array([couples_of(surfaces, MESHES, np.append(0.0, lags * SENSE)) for lags in rows])[:, 1:] * SENSE
        slopes = (found[1:] - found[0]).T / (CHANGED * guess)
        change = np.linalg.solve(slopes, wanted - found[0])
        guess = guess + change
        if np.abs(change).max() < CLOSE_ENOUGH * np.abs(guess).max():
            return guess
    raise RuntimeError(f"the lags {guess} rad have not settled")


def by_this_program(train: TrainScene, positions: list[Position]) -> np.ndarray:
    """Of the idler and the last gear (n, 2). Raises ValueError where its phases are not those of the outlines."""
    run = simulate_train(train)
    phases = run.mesh_phase.values[:, 0]
    begun = layout_of(train.meshes).phases[1]
    found = []
    for at in positions:
        step = int(np.argmin(np.abs(phases - at.phase)))
        apart = phases[step] - at.phase, (phases[step] + begun - at.second[1] + 0.5) % 1.0 - 0.5
        if np.abs(apart).max() > 1e-9:
            raise ValueError(f"the phases of the run are {apart} from those of the outlines")
        lags = run.transmission_error.values[step]
        idler = lags[0]
        found.append((idler, lags[1] + idler * at.pairs[1].rotation_ratio))
    return np.array(found)
