"""Two gears in mesh where they are drawn, and as a file that ParaView opens.

Pictures have the line of centres upright, the pinion above; files have the frame of the line of action.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from fenics_gears.elasticity.ring import rotation
from fenics_gears.errors import ComputationError
from fenics_gears.geometry.pair import GearPair
from fenics_gears.simulation.run_stresses import GearInSpace, GearsInMesh

# VTK's numbers of cell types, by corners.
VTK_CELL = {3: 5, 4: 9}
# Mesh cycles: whole ones may be written a little less.
ROUNDING = 1e-9
MIRROR = np.array([-1.0, 1.0])


def upright(pair: GearPair, points: np.ndarray, coast: bool = False) -> np.ndarray:
    """Points or vectors (..., 2) in the frame of the line of action as the picture has them, with the line of centres
    upright.

    coast: on the line of action of the coast flanks, which is the mirror image at the line of centres.
    """
    shown = np.asarray(points) @ rotation(-pair.operating_pressure_angle).T
    return shown * MIRROR if coast else shown


def shown_points(mesh: GearsInMesh, gear: int, scale: float) -> np.ndarray:
    """Nodes (n, 2), mm, of a gear in the picture, their displacement `scale` times as large as it is.

    The hubs stay on their nominal centres and either gear turns by half of the approach of the flanks, which their
    teeth give way to: so flanks that touch are drawn touching at any scale.
    """
    body = mesh.gears[gear]
    radius = (mesh.pair.pinion, mesh.pair.wheel)[gear].base_radius
    arm = body.points - body.centre
    arc = -0.5 * mesh.approach if mesh.coast else 0.5 * mesh.approach
    turned = arc / radius * np.column_stack([-arm[:, 1], arm[:, 0]])
    return upright(mesh.pair, body.points + scale * (body.elastic + turned))


def largest_movement(mesh: GearsInMesh) -> float:
    """Largest displacement (mm) among those drawn at scale 1."""
    return max(
        float(np.linalg.norm(shown_points(mesh, gear, 1.0) - shown_points(mesh, gear, 0.0), axis=1).max())
        for gear in (0, 1)
    )


def save_vtu(mesh: GearsInMesh, path: Path, *, precision: type = np.float64) -> None:
    """Both gears' displacement (mm) and stress (MPa) as a .vtu file, in the frame of the line of action.

    Its points are the same material points at every stored time; ``precision`` is that of what is written. Raises
    ComputationError without pyvista.
    """
    try:
        import pyvista
    except ImportError as error:
        raise ComputationError("a .vtu file needs pyvista, which is not installed") from error
    bodies, gears = [in_tooth_order(mesh, gear) for gear in (0, 1)], (mesh.pair.pinion, mesh.pair.wheel)

    def in_space(name: str) -> np.ndarray:
        plane = np.vstack([getattr(body, name) for body in bodies])
        return np.column_stack([plane, np.zeros(len(plane))]).astype(precision)

    cells = np.vstack([bodies[0].cells, bodies[1].cells + len(bodies[0].points)])
    grid = pyvista.UnstructuredGrid({VTK_CELL[cells.shape[1]]: cells}, in_space("points"))
    data = {"displacement": in_space("displacement"), "elastic_displacement": in_space("elastic")}
    data |= dict(
        zip(
            ("stress_xx", "stress_yy", "stress_xy", "stress_zz"),
            np.vstack([body.stress for body in bodies]).T.astype(precision),
        )
    )
    data["von_mises_stress"] = np.concatenate([body.von_mises for body in bodies]).astype(precision)
    data["gear"] = np.repeat([1, 2], [len(body.points) for body in bodies]).astype(np.int32)
    data["tooth"] = np.concatenate(
        [np.repeat(np.arange(gear.teeth), len(body.points) // gear.teeth) for gear, body in zip(gears, bodies)]
    ).astype(np.int32)
    for name, values in data.items():
        grid.point_data[name] = values
    grid.save(str(path))


def in_tooth_order(mesh: GearsInMesh, gear: int) -> GearInSpace:
    """A gear whose sectors stand in the order of its teeth, which turn with it: tooth j is the one that tooth pair j
    loads.

    The sectors of a `GearInSpace` begin anew in each mesh cycle, with the tooth that last reached the start of contact.
    """
    teeth, cycles = (mesh.pair.pinion, mesh.pair.wheel)[gear].teeth, int(np.floor(mesh.mesh_phase + ROUNDING))
    # Sectors are counted counterclockwise; so turns the pinion.
    sectors = (cycles - np.arange(teeth)) * (1 if gear == 0 else -1) % teeth
    body = mesh.gears[gear]

    def ordered(values: np.ndarray) -> np.ndarray:
        return values.reshape(teeth, -1, values.shape[1])[sectors].reshape(values.shape)

    return replace(
        body, **{name: ordered(getattr(body, name)) for name in ("points", "elastic", "displacement", "stress")}
    )
