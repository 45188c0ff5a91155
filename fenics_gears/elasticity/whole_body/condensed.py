"""Flank compliance of a gear meshed as a whole: each tooth's part is condensed by PETSc, the parts are joined exactly.

F are the flank dofs of part t, I the interface dofs of all parts. Block inversion gives the compliance between flanks,
``A[s, t] = d_st S_FF[t]^-1 + X_s J^-1 X_t^T``, with ``X_t = S_FF^-1 S_FI`` of part t. ``J = sum_t (S_II - S_IF S_FF^-1
S_FI)`` is the stiffness of the interfaces. For a gear of equal sectors that is `elasticity.ring` without its Fourier
transform.
"""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from hashlib import sha256
from time import perf_counter

import numpy as np
from scipy import sparse

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import Material
from fenics_gears.geometry.outline import rotation
from fenics_gears.numbers_version import NUMBERS_VERSION

from ..cache import Cache, kept
from ..condensation import by_radius, condense
from ..element_nodes import dofs_of, node_roll_angles
from ..elements import Element, element_named
from ..mesh_data import BodyMesh
from ..mumps import Factor
from ..ring import definite_inverse
from .compliance import WholeBodyCompliance
from .parts import DividedBody, Part, divided_body


def whole_body_compliance(
    mesh: BodyMesh,
    gear: Gear,
    material: Material,
    *,
    element: str = "P2",
    tooth_offsets: int,
    cache: Cache | None = None,
) -> WholeBodyCompliance:
    """Flank compliance of every tooth of a meshed gear (`whole_body.outline`), from the cache or computed.
    tooth_offsets: largest distance, in pitches, of teeth whose interaction is wanted. Raises ComputationError when a
    stage fails."""
    chosen = element_named(element)
    tooth_offsets = min(tooth_offsets, gear.teeth - 1)
    inputs = {
        "version": NUMBERS_VERSION,
        "whole body": _digest(mesh),
        "gear": asdict(gear),
        "poissons_ratio": material.poissons_ratio,
        "element": chosen.name,
        "tooth_offsets": tooth_offsets,
    }
    arrays, timings = kept(cache, inputs, lambda: _computed(mesh, gear, material.poissons_ratio, chosen, tooth_offsets))
    teeth = range(gear.teeth)
    modulus = material.youngs_modulus
    return WholeBodyCompliance(
        roll_angles=tuple(arrays[f"roll_angle_{tooth}"] for tooth in teeth),
        element_order=chosen.order,
        blocks=tuple(
            tuple(arrays[_block_name(tooth, ahead)] / modulus for ahead in range(tooth_offsets + 1)) for tooth in teeth
        ),
        openings={tooth: arrays[f"opening_{tooth}"] / modulus for tooth in teeth if f"opening_{tooth}" in arrays},
        timings=timings,
    )


def _digest(mesh: BodyMesh) -> str:
    """Of bytes: as text the mesh would take megabytes."""
    return sha256(mesh.points.tobytes() + mesh.cells.astype(np.int64).tobytes()).hexdigest()


def _block_name(tooth: int, ahead: int) -> str:
    return f"block_{tooth}_{ahead}"


@dataclass(frozen=True)
class _CondensedPart:
    """A part of the body, Young's modulus 1 MPa, by its surface F and its interface I.

    The surface is the flank (`flank` dofs), then the faces of cracks, all in the tooth's frame. own: (F, F), S_FF^-1.
    to_interface: (F, I), X. link: (I, I), stiffness of the interface, the surface free. dofs: (I,), the interface's
    among the dofs of all parts.
    """

    own: np.ndarray
    to_interface: np.ndarray
    link: np.ndarray
    dofs: np.ndarray
    flank: int
    compiling: float


def _computed(mesh: BodyMesh, gear: Gear, poissons_ratio: float, element: Element, tooth_offsets: int):
    clock = perf_counter()
    body = divided_body(mesh, gear, element)
    parts = [
        _condensed(part, body, element, poissons_ratio, tooth * gear.angular_pitch)
        for tooth, part in enumerate(body.parts)
    ]
    arrays = _blocks(gear, body, parts, tooth_offsets)
    for tooth in range(gear.teeth):
        corners = by_radius(mesh.points[mesh.edge_points(f"flank {tooth}")])
        arrays[f"roll_angle_{tooth}"] = node_roll_angles(gear, corners, element.order)
    compiling = sum(part.compiling for part in parts)
    return arrays, {"time_mesh": 0.0, "time_compile": compiling, "time_condense": perf_counter() - clock - compiling}


def _condensed(part: Part, body: DividedBody, element: Element, poissons_ratio: float, angle: float) -> _CondensedPart:
    """A part whose tooth is turned by an angle (rad)."""
    groups = {name: body.nodes.points[getattr(part, name)] for name in ("flank", "faces", "interface", "hub")}
    condensed = condense(part.mesh, element, poissons_ratio, groups, cells_of={"faces": part.face_cells})
    surface = np.concatenate([condensed.dofs("flank"), condensed.dofs("faces")])
    interface = condensed.dofs("interface")
    stiffness = _in_frame(_in_frame(condensed.stiffness[np.ix_(surface, surface)], angle).T, angle)
    coupling = _in_frame(condensed.stiffness[np.ix_(surface, interface)], angle)
    own = definite_inverse(0.5 * (stiffness + stiffness.T), "a tooth's flank")
    to_interface = own @ coupling
    link = condensed.between("interface", "interface") - coupling.T @ to_interface
    dofs = dofs_of(np.searchsorted(body.interface, part.interface))
    return _CondensedPart(
        own, to_interface, 0.5 * (link + link.T), dofs, 2 * len(part.flank), condensed.timings["time_compile"]
    )


def _in_frame(rows: np.ndarray, angle: float) -> np.ndarray:
    """Rows (2 k, m), interleaved x, y, by their components in a frame turned by an angle (rad)."""
    return np.einsum("xa,kxm->kam", rotation(angle), rows.reshape(-1, 2, rows.shape[1])).reshape(rows.shape)


def _blocks(gear: Gear, body: DividedBody, parts: list[_CondensedPart], tooth_offsets: int) -> dict[str, np.ndarray]:
    """Compliance blocks in the teeth's own frames, and how flank forces open the cracks, by name."""
    size = 2 * len(body.interface)
    links = [part.link for part in parts]
    factor = joined_factor(links, [part.dofs for part in parts], size, "the interfaces of a gear's teeth")
    blocks = {}

    def opened(by: int, at: int, motion: np.ndarray) -> None:
        """Add how far apart a force on the flank of a tooth moves the faces of cracks in the part at a tooth, from
        their motion (2 c, 2 f)."""
        if len(motion):
            rows = blocks.setdefault(f"opening_{by}", np.zeros((len(body.cracks.one), motion.shape[1])))
            _add_openings(rows, body, at, motion, rotation(at * gear.angular_pitch))

    try:
        for tooth, part in enumerate(parts):
            loads = np.zeros((size, len(part.dofs)))
            loads[part.dofs, np.arange(len(part.dofs))] = 1.0
            response = factor.solve(loads)
            for ahead in range(tooth_offsets + 1):
                beside = (tooth + ahead) % gear.teeth
                other = parts[beside]
                block = other.to_interface @ response[other.dofs] @ part.to_interface.T
                if ahead == 0:
                    block = part.own + 0.5 * (block + block.T)
                blocks[_block_name(tooth, ahead)] = np.ascontiguousarray(block[: other.flank, : part.flank])
                opened(tooth, beside, block[other.flank :, : part.flank])
                if ahead:
                    # By reciprocity.
                    opened(beside, tooth, block[: other.flank, part.flank :].T)
    finally:
        factor.close()
    return blocks


def joined_factor(links: Sequence[np.ndarray], dofs: Sequence[np.ndarray], size: int, what: str) -> Factor:
    """The factor of interfaces of so many dofs between parts, each of which has a stiffness (k, k) at some dofs (k,) of
    them. `what`: for the message where it is not definite."""
    places = np.hstack([[np.repeat(own, len(own)), np.tile(own, len(own))] for own in dofs])
    entries = np.concatenate([link.ravel() for link in links])
    return Factor(sparse.coo_matrix((entries, places), shape=(size, size)).tocsr(), what)


def _add_openings(rows: np.ndarray, body: DividedBody, part: int, motion: np.ndarray, frame: np.ndarray) -> None:
    """Add to the openings (k, 2 f) what a part's faces contribute: their motion (2 c, 2 f) in a turned frame, its axes
    in the columns of `frame`."""
    faces = body.parts[part].faces
    cracks = body.cracks
    motion = motion.reshape(len(faces), 2, -1)
    for nodes, sense in ((cracks.one, -1.0), (cracks.other, 1.0)):
        place = np.searchsorted(faces, nodes)
        here = np.flatnonzero(faces[np.minimum(place, len(faces) - 1)] == nodes)
        rows[here] += sense * np.einsum("kx,kxf->kf", cracks.normals[here] @ frame, motion[place[here]])
