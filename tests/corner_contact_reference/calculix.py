"""Gears at one position as an input file of CalculiX, and the couples from what it prints. Their bores are held or
turned. Of a pair the pinion's centre is at the origin, the line of action is y = -rb1. Six-node triangles in plane
strain, 1 mm thick, or fifteen-node wedges over the face."""

import re
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from tests.corner_contact_reference.gear_mesh import GearMesh, rotation

from fenics_gears import GearPair
from fenics_gears.scene.data import Material

# MPa per mm of overlap. At a pressure of 1500 MPa that is 1.5e-5 mm, 0.04 % of the teeth's deflection.
PENALTY = 1e8
# By the nodes of a cell: CalculiX's name of it, and the number of its side 01.
CELLS = {6: ("CPE6", 1), 15: ("C3D15", 3)}
# What CalculiX prints of a set of nodes: name, total time, a line of node and force for each.
FORCES = r" forces \(fx,fy,fz\) for set (\S+) and time\s+(\S+)\n\n((?:\s+\d+.*\n)+)"


class CalculixFailed(RuntimeError):
    pass


@dataclass(frozen=True)
class Placed:
    """A gear with its points (n, 2 or 3), mm, where they are, and its centre (2,)."""

    mesh: GearMesh
    points: np.ndarray
    centre: np.ndarray


def placed(pair: GearPair, meshes: tuple[GearMesh, GearMesh], phase: float) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 2 or 3), mm, of pinion and wheel, tooth 0 of both touching at `phase` mesh cycles after the path's
    start."""
    xi = pair.path_start + phase * pair.base_pitch
    turns = (xi / pair.pinion.base_radius, np.pi + (pair.line_of_action_length - xi) / pair.wheel.base_radius)
    centres = (np.zeros(2), wheel_centre(pair))
    return tuple(
        np.hstack([centre + mesh.points[:, :2] @ rotation(turn).T, mesh.points[:, 2:]])
        for centre, mesh, turn in zip(centres, meshes, turns)
    )


def wheel_centre(pair: GearPair) -> np.ndarray:
    return np.array([pair.line_of_action_length, -(pair.pinion.base_radius + pair.wheel.base_radius)])


def couples(
    pair: GearPair,
    material: Material,
    meshes: tuple[GearMesh, GearMesh],
    phase: float,
    rotations,
    folder: Path,
    slave: int = 0,
    penalty: float = PENALTY,
) -> np.ndarray:
    """Couples (k, 2), N mm (of triangles per mm), on both bores with the wheel turned by rotations (k,), rad. slave:
    the gear over whose surface contact is integrated. Raises CalculixFailed."""
    centres = np.zeros(2), wheel_centre(pair)
    bodies = [
        Placed(mesh, points, centre) for mesh, points, centre in zip(meshes, placed(pair, meshes, phase), centres)
    ]
    turned = np.column_stack([np.zeros(len(rotations)), rotations])
    return couples_of(bodies, [(slave, 1 - slave)], material, turned, folder, penalty)


def couples_of(
    bodies: Sequence[Placed],
    contacts: Sequence[tuple[int, int]],
    material: Material,
    rotations: np.ndarray,
    folder: Path,
    penalty: float = PENALTY,
) -> np.ndarray:
    """Couples (k, n), N mm (of triangles per mm), on the bores of n gears turned by rotations (k, n), rad; contacts:
    slave and master of each. Raises CalculixFailed."""
    (folder / "gears.inp").write_text(input_file(bodies, contacts, material, rotations, penalty))
    done = subprocess.run(["ccx", "-i", "gears"], cwd=folder, capture_output=True, text=True)
    (folder / "gears.log").write_text(done.stdout + done.stderr)
    printed = re.findall(FORCES, (folder / "gears.dat").read_text())
    # A step that CalculiX had to divide prints at times between, too.
    found = [(name, block) for name, time, block in printed if abs(float(time) - round(float(time))) < 1e-6]
    if len(found) != rotations.size:
        raise CalculixFailed(
            f"CalculiX gave {len(found)} sets of forces instead of {rotations.size}; see {folder}/gears.log"
        )
    result = np.zeros(rotations.size)
    for place, (name, block) in enumerate(found):
        body = int(re.fullmatch(r"GEAR(\d+)HUB", name)[1])
        rows = np.array([line.split()[:3] for line in block.strip().splitlines()], dtype=float)
        first = sum(len(each.points) for each in bodies[:body])
        arm = bodies[body].points[rows[:, 0].astype(int) - 1 - first, :2] - bodies[body].centre
        # All gears of a step are printed before the next step.
        result[place // len(bodies) * len(bodies) + body] = np.sum(arm[:, 0] * rows[:, 2] - arm[:, 1] * rows[:, 1])
    return result.reshape(rotations.shape)


def input_file(bodies, contacts, material, rotations, penalty) -> str:
    """One static step for each row of rotations."""
    dimensions, (cell_type, first_side) = bodies[0].points.shape[1], CELLS[bodies[0].mesh.cells.shape[1]]
    lines = ["*NODE, NSET=ALL"] + [
        ", ".join([str(i + 1), *(f"{each:.15g}" for each in point)] + ["0."] * (dimensions == 2))
        for i, point in enumerate(np.vstack([body.points for body in bodies]))
    ]
    first_cell, first_node = 0, 0
    surfaces, first_nodes = [], []
    for number, body in enumerate(bodies):
        name, mesh = f"GEAR{number}", body.mesh
        lines.append(f"*ELEMENT, TYPE={cell_type}, ELSET={name}")
        lines += [
            ", ".join(str(v) for v in (i + 1 + first_cell, *(cell + 1 + first_node)))
            for i, cell in enumerate(mesh.cells)
        ]
        surfaces += [f"*SURFACE, NAME={name}SURFACE, TYPE=ELEMENT"]
        surfaces += [f"{cell + 1 + first_cell}, S{side + first_side}" for cell, side in mesh.contact]
        surfaces += [f"*NSET, NSET={name}HUB"] + [f"{node + 1 + first_node}," for node in mesh.hub]
        first_nodes.append(first_node)
        first_cell += len(mesh.cells)
        first_node += len(body.points)
    lines += surfaces
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{material.youngs_modulus}, {material.poissons_ratio}"]
    for number in range(len(bodies)):
        lines += [f"*SOLID SECTION, ELSET=GEAR{number}, MATERIAL=STEEL"] + ["1."] * (dimensions == 2)
    lines += [
        "*SURFACE INTERACTION, NAME=FRICTIONLESS", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{penalty:g}",
    ]  # fmt: skip
    for slave, master in contacts:
        lines += ["*CONTACT PAIR, INTERACTION=FRICTIONLESS, TYPE=SURFACE TO SURFACE"]
        lines += [f"GEAR{slave}SURFACE, GEAR{master}SURFACE"]
    held = ~np.any(rotations, axis=0)
    lines.append("*BOUNDARY")
    for number, still in enumerate(held):
        lines += (
            [f"GEAR{number}HUB, 1, {dimensions}, 0."] if still else [f"GEAR{number}HUB, 3, 3, 0."] * (dimensions == 3)
        )
    for turned in rotations:
        lines += ["*STEP, INC=1000", "*STATIC, DIRECT", "1., 1.", "*BOUNDARY"]
        for number in np.flatnonzero(~held):
            body = bodies[number]
            for node in body.mesh.hub:
                arm = body.points[node, :2] - body.centre
                move = rotation(turned[number]) @ arm - arm
                lines += [
                    f"{node + 1 + first_nodes[number]}, {axis + 1}, {axis + 1}, {move[axis]:.12g}" for axis in (0, 1)
                ]
        for number in range(len(bodies)):
            lines += [f"*NODE PRINT, NSET=GEAR{number}HUB", "RF"]
        lines.append("*END STEP")
    return "\n".join(lines) + "\n"
