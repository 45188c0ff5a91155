"""Flank compliance of a gear meshed as a whole: each tooth's part is condensed by PETSc, the parts are joined exactly.

With F the flank dofs of part t and I the interface dofs of all parts, block inversion gives the compliance between flanks as
``A[s, t] = d_st S_FF[t]^-1 + X_s J^-1 X_t^T``, where ``X_t = S_FF^-1 S_FI`` of part t and ``J = sum_t (S_II - S_IF S_FF^-1 S_FI)``
is the interfaces' own stiffness. For a gear of equal sectors that is `elasticity.ring` without its Fourier transform.
"""

from __future__ import annotations

from dataclasses import asdict
from hashlib import sha256
from time import perf_counter

import numpy as np
from scipy import sparse

from fenics_gears.elasticity.cache import Cache, kept
from fenics_gears.elasticity.condensation import by_radius, condense, dofs_of
from fenics_gears.elasticity.element_nodes import node_roll_angles
from fenics_gears.elasticity.elements import Element, element_named
from fenics_gears.elasticity.gear_compliance import ALGORITHM_VERSION, COUNTS
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.mumps import Factor
from fenics_gears.elasticity.ring import definite_inverse, rotation
from fenics_gears.elasticity.whole_body.compliance import WholeBodyCompliance
from fenics_gears.elasticity.whole_body.parts import DividedBody, Part, divided_body
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material

# To be raised by one whenever the same inputs give other numbers, or other arrays.
WHOLE_BODY_VERSION = 2


def whole_body_compliance(
    mesh: BodyMesh, gear: Gear, material: Material, *, element: str = "P2", tooth_offsets: int, cache: Cache | None = None
) -> WholeBodyCompliance:
    """Flank compliance of every tooth of a meshed gear (`whole_body.outline`), from the cache or computed.

    tooth_offsets: largest distance, in pitches, of teeth whose interaction is wanted. Raises ComputationError when a stage fails.
    """
    chosen = element_named(element)
    tooth_offsets = min(tooth_offsets, gear.teeth - 1)
    inputs = {
        "version": [ALGORITHM_VERSION, WHOLE_BODY_VERSION],
        "whole body": _digest(mesh),
        "gear": asdict(gear),
        "poissons_ratio": material.poissons_ratio,
        "element": chosen.name,
        "tooth_offsets": tooth_offsets,
    }
    arrays, timings = kept(cache, inputs, lambda: _computed(mesh, gear, material.poissons_ratio, chosen, tooth_offsets))
    return WholeBodyCompliance(
        roll_angles=tuple(arrays[f"roll_angle_{tooth}"] for tooth in range(gear.teeth)),
        element_order=chosen.order,
        blocks=tuple(
            tuple(arrays[_block_name(tooth, ahead)] / material.youngs_modulus for ahead in range(tooth_offsets + 1))
            for tooth in range(gear.teeth)
        ),
        openings={
            tooth: arrays[f"opening_{tooth}"] / material.youngs_modulus for tooth in range(gear.teeth) if f"opening_{tooth}" in arrays
        },
        timings={**timings, **{name: int(arrays[name]) for name in COUNTS}},
    )


def _digest(mesh: BodyMesh) -> str:
    """Hash of points and cells by their bytes: as text the mesh would take megabytes."""
    return sha256(mesh.points.tobytes() + mesh.cells.astype(np.int64).tobytes()).hexdigest()


def _block_name(tooth: int, ahead: int) -> str:
    return f"block_{tooth}_{ahead}"


def _computed(mesh: BodyMesh, gear: Gear, poissons_ratio: float, element: Element, tooth_offsets: int):
    clock, body = perf_counter(), divided_body(mesh, gear, element)
    condensed = [_condensed(part, body, element, poissons_ratio) for part in body.parts]
    own, to_interface = zip(*(_surface_of(each) for each in condensed))
    joined = _Interface(body, condensed, to_interface)
    try:
        arrays = _blocks(gear, body, own, to_interface, joined, tooth_offsets)
    finally:
        joined.close()
    for tooth in range(gear.teeth):
        corners = by_radius(mesh.points[mesh.edge_points(f"flank {tooth}")])
        arrays[f"roll_angle_{tooth}"] = node_roll_angles(gear, corners, element.order)
    arrays["unknowns"] = np.array(2 * len(body.nodes.points))
    arrays["condensed_unknowns"] = np.array(2 * (len(body.interface) + sum(len(part.flank) for part in body.parts)))
    compiling = sum(each.timings["time_compile"] for each in condensed)
    return arrays, {"time_mesh": 0.0, "time_compile": compiling, "time_condense": perf_counter() - clock - compiling}


def _condensed(part: Part, body: DividedBody, element: Element, poissons_ratio: float):
    groups = {name: body.nodes.points[getattr(part, name)] for name in ("flank", "faces", "interface", "hub")}
    return condense(part.mesh, element, poissons_ratio, groups, cells_of={"faces": part.face_cells})


def _surface(part) -> np.ndarray:
    """A condensed part's dofs of its flank and its cracks' faces: F of the formula, so that the motion of the faces comes with it."""
    return np.concatenate([part.dofs("flank"), part.dofs("faces")])


def _surface_of(part) -> tuple[np.ndarray, np.ndarray]:
    """A part's S_FF^-1 and X, its interface and hub held."""
    surface = _surface(part)
    inverse = definite_inverse(part.stiffness[np.ix_(surface, surface)], "a tooth's flank")
    return inverse, inverse @ part.stiffness[np.ix_(surface, part.dofs("interface"))]


class _Interface:
    """The interfaces' stiffness J, factored; `response` between the interface dofs of two parts. Release it by `close`."""

    def __init__(self, body: DividedBody, condensed, to_interface):
        self._dofs = [dofs_of(np.searchsorted(body.interface, part.interface)) for part in body.parts]
        self.size = 2 * len(body.interface)
        entries, rows, columns = [], [], []
        for dofs, part, to in zip(self._dofs, condensed, to_interface):
            stiffness = part.between("interface", "interface") - part.stiffness[np.ix_(part.dofs("interface"), _surface(part))] @ to
            entries.append(0.5 * (stiffness + stiffness.T).ravel())
            rows.append(np.repeat(dofs, len(dofs)))
            columns.append(np.tile(dofs, len(dofs)))
        matrix = sparse.coo_matrix((np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns))), shape=(self.size, self.size))
        self._factor = Factor(matrix.tocsr(), "the interfaces of a gear's teeth")

    def under_unit_loads(self, part: int) -> np.ndarray:
        """Displacement (interface dofs, dofs of the part's interface) under unit forces there."""
        loads = np.zeros((self.size, len(self._dofs[part])))
        loads[self._dofs[part], np.arange(len(self._dofs[part]))] = 1.0
        return self._factor.solve(loads)

    def of_part(self, displacement: np.ndarray, part: int) -> np.ndarray:
        """The rows of a part's interface."""
        return displacement[self._dofs[part]]

    def close(self) -> None:
        """Give the factor's memory back."""
        self._factor.close()


def _blocks(gear: Gear, body: DividedBody, own, to_interface, joined: _Interface, tooth_offsets: int) -> dict[str, np.ndarray]:
    """Compliance blocks in the teeth's own frames, and how flank forces open the cracks; Young's modulus 1 MPa, by name."""
    found, openings = {}, _Openings(body)
    flank = [2 * len(part.flank) for part in body.parts]
    for tooth in range(gear.teeth):
        response = joined.under_unit_loads(tooth)
        for ahead in range(tooth_offsets + 1):
            other = (tooth + ahead) % gear.teeth
            block = to_interface[other] @ joined.of_part(response, other) @ to_interface[tooth].T
            if ahead == 0:
                block = own[tooth] + 0.5 * (block + block.T)
            between_flanks = block[: flank[other], : flank[tooth]]
            found[_block_name(tooth, ahead)] = _in_frames(between_flanks, other * gear.angular_pitch, tooth * gear.angular_pitch)
            openings.add(other, tooth, block[flank[other] :, : flank[tooth]])
            if ahead:
                # By reciprocity.
                openings.add(tooth, other, block[: flank[other], flank[tooth] :].T)
    for tooth, rows in openings.rows.items():
        found[f"opening_{tooth}"] = _columns_in_frame(rows, tooth * gear.angular_pitch)
    return found


class _Openings:
    """How far apart the faces of a body's cracks are moved by forces on flanks: `rows` (k, 2f) by the loaded tooth, in space."""

    def __init__(self, body: DividedBody):
        self.rows: dict[int, np.ndarray] = {}
        self._body = body

    def add(self, part: int, loaded: int, motion: np.ndarray) -> None:
        """Add what the faces in a part contribute: their motion (2c, 2f) under unit forces on the flank of a tooth."""
        faces, cracks = self._body.parts[part].faces, self._body.cracks
        if not len(faces):
            return
        rows = self.rows.setdefault(loaded, np.zeros((len(cracks.one), motion.shape[1])))
        motion = motion.reshape(len(faces), 2, -1)
        for nodes, sense in ((cracks.one, -1.0), (cracks.other, 1.0)):
            place = np.searchsorted(faces, nodes)
            here = np.flatnonzero(faces[np.minimum(place, len(faces) - 1)] == nodes)
            rows[here] += sense * np.einsum("kx,kxf->kf", cracks.normals[here], motion[place[here]])


def _columns_in_frame(rows: np.ndarray, loaded: float) -> np.ndarray:
    """Rows (k, 2f) with their columns in the frame of a tooth that stands turned by an angle (rad)."""
    return np.ascontiguousarray((rows.reshape(len(rows), -1, 2) @ rotation(loaded)).reshape(rows.shape))


def _in_frames(block: np.ndarray, responding: float, loaded: float) -> np.ndarray:
    """A block with its rows and columns in the frames of teeth that stand turned by angles (rad)."""
    rows, columns = block.shape[0] // 2, block.shape[1] // 2
    parts = block.reshape(rows, 2, columns, 2)
    turned = np.einsum("xa,ixjy,yb->iajb", rotation(responding), parts, rotation(loaded), optimize=True)
    return np.ascontiguousarray(turned.reshape(block.shape))
