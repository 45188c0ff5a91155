"""A pair of gears at one position as an input file of CalculiX, and the couples from what it prints. Pinion's centre
at the origin, line of action y = -rb1. The pinion's bore is held, the wheel's is turned. Six-node triangles in plane
strain, 1 mm thick, or fifteen-node wedges over the face."""

import re
import subprocess
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
    points = placed(pair, meshes, phase)
    deck = input_file(pair, material, meshes, points, rotations, slave, penalty)
    (folder / "pair.inp").write_text(deck)
    done = subprocess.run(["ccx", "-i", "pair"], cwd=folder, capture_output=True, text=True)
    (folder / "pair.log").write_text(done.stdout + done.stderr)
    printed = re.findall(FORCES, (folder / "pair.dat").read_text())
    # A step that CalculiX had to divide prints at times between, too.
    found = [(name, block) for name, time, block in printed if abs(float(time) - round(float(time))) < 1e-6]
    if len(found) != 2 * len(rotations):
        raise CalculixFailed(
            f"CalculiX gave {len(found)} sets of forces instead of {2 * len(rotations)}; see {folder}/pair.log"
        )
    first = {"PINIONHUB": 0, "WHEELHUB": len(points[0])}
    gear = {"PINIONHUB": 0, "WHEELHUB": 1}
    centres, result = (np.zeros(2), wheel_centre(pair)), []
    for name, block in found:
        rows = np.array([line.split()[:3] for line in block.strip().splitlines()], dtype=float)
        arm = points[gear[name]][rows[:, 0].astype(int) - 1 - first[name], :2] - centres[gear[name]]
        result.append((gear[name], np.sum(arm[:, 0] * rows[:, 2] - arm[:, 1] * rows[:, 1])))
    return np.array([[value for which, value in result if which == side] for side in (0, 1)]).T


def input_file(pair, material, meshes, points, rotations, slave, penalty) -> str:
    """One static step for each rotation (rad) of the wheel."""
    dimensions, (cell_type, first_side) = points[0].shape[1], CELLS[meshes[0].cells.shape[1]]
    lines = ["*NODE, NSET=ALL"] + [
        ", ".join([str(i + 1), *(f"{each:.15g}" for each in point)] + ["0."] * (dimensions == 2))
        for i, point in enumerate(np.vstack(points))
    ]
    first_cell = 0
    surfaces = []
    for name, mesh, first_node in zip(("PINION", "WHEEL"), meshes, (0, len(points[0]))):
        lines.append(f"*ELEMENT, TYPE={cell_type}, ELSET={name}")
        lines += [
            ", ".join(str(v) for v in (i + 1 + first_cell, *(cell + 1 + first_node)))
            for i, cell in enumerate(mesh.cells)
        ]
        surfaces += [f"*SURFACE, NAME={name}SURFACE, TYPE=ELEMENT"]
        surfaces += [f"{cell + 1 + first_cell}, S{side + first_side}" for cell, side in mesh.contact]
        surfaces += [f"*NSET, NSET={name}HUB"] + [f"{node + 1 + first_node}," for node in mesh.hub]
        first_cell += len(mesh.cells)
    lines += surfaces
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{material.youngs_modulus}, {material.poissons_ratio}"]
    for name in ("PINION", "WHEEL"):
        lines += [f"*SOLID SECTION, ELSET={name}, MATERIAL=STEEL"] + ["1."] * (dimensions == 2)
    names = ("PINIONSURFACE", "WHEELSURFACE")
    lines += [
        "*SURFACE INTERACTION, NAME=FRICTIONLESS", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{penalty:g}",
        "*CONTACT PAIR, INTERACTION=FRICTIONLESS, TYPE=SURFACE TO SURFACE", f"{names[slave]}, {names[1 - slave]}",
        "*BOUNDARY", f"PINIONHUB, 1, {dimensions}, 0.", *["WHEELHUB, 3, 3, 0."] * (dimensions == 3),
    ]  # fmt: skip
    centre, first_node = wheel_centre(pair), len(points[0])
    for angle in rotations:
        lines += ["*STEP, INC=1000", "*STATIC, DIRECT", "1., 1.", "*BOUNDARY"]
        for node in meshes[1].hub:
            arm = points[1][node, :2] - centre
            move = rotation(angle) @ arm - arm
            lines += [f"{node + 1 + first_node}, {axis + 1}, {axis + 1}, {move[axis]:.12g}" for axis in (0, 1)]
        lines += ["*NODE PRINT, NSET=PINIONHUB", "RF", "*NODE PRINT, NSET=WHEELHUB", "RF", "*END STEP"]
    return "\n".join(lines) + "\n"
