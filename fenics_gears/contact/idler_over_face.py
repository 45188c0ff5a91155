"""How meshes over the face on either side of an idler feel each other through its body.

The flanks of an idler that its two mates load are on opposite sides of its teeth. They feel each other through its body
alone, by few motions of their flanks (`elasticity.face.idler_ring`): averaged over slices as the body's compliance is,
and seen by contact nodes along their directions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fenics_gears.elasticity.face_compliance_data import AcrossFlanks, IdlerCompliance
from fenics_gears.elasticity.slice_averages import oblique_averages
from fenics_gears.errors import ComputationError
from fenics_gears.geometry.side import Side

from .face import Face
from .face_pairing import FacePair, contact_axes, rises_of
from .fine_sections import together
from .idler import BetweenMeshes, Part
from .joined_rows import Coupling
from .mesh_cycle import Cycle


@dataclass(frozen=True, eq=False)
class IdlerOverFace(BetweenMeshes):
    """An idler with what is `across` its body, and its `motions` (S n, 3, r) in slices: of a drive flank in the first
    mesh, of a coast flank in the second. It is a `joined_meshes.CouplingGear`."""

    across: AcrossFlanks
    motions: tuple[np.ndarray, np.ndarray]

    def couplings(
        self, cycles: Sequence[Cycle], parts: Sequence[Part], steps: float
    ) -> tuple[list[Coupling], list[Coupling]]:
        meshes = [(gear, cycles[mesh], parts[mesh]) for gear, mesh in zip(self.gear.sides, self.meshes)]
        seen = [_seen(self, gear, cycle, part.position.operator.pairs) for gear, cycle, part in meshes]
        now = _coupled(self, seen, seen)
        if not cycles[0].tangential:
            return now, []
        before = [_seen(self, gear, cycle, part.before) for gear, cycle, part in meshes]
        turned = [_turned(self, gear, cycle, part, steps) for gear, cycle, part in meshes]
        return now, _coupled(self, before, turned)

    def between(self, teeth: np.ndarray, others: np.ndarray, gear: int) -> np.ndarray:
        """What displaces the teeth (T,) by motions of the body, of those of other teeth (U,): (T, U, r, r'); `gear`:
        what the idler is in the mesh of the former."""
        drive, coast = (teeth[:, None], others) if gear == 1 else (others, teeth[:, None])
        ahead = self.ahead(drive, coast, self.across.first) - self.across.first
        if ahead.max(initial=0) >= len(self.across.between):
            raise ComputationError(
                "compliance over the face: flanks of an idler touch that are further apart than its body's compliance"
                " is known; ask idler_compliance for a larger reach"
            )
        found = self.across.between[ahead]
        return found if gear == 1 else found.swapaxes(2, 3)


def idler_over_face(place: BetweenMeshes, body: IdlerCompliance, meshes: Sequence[tuple[Side, Face]]) -> IdlerOverFace:
    """An idler with its body; `meshes`: its side of both, and the slices of these."""
    drive, coast = (
        _in_slices(solid, flank, *mesh)
        for solid, flank, mesh in zip((body.drive, body.coast), (body.across.drive, body.across.coast), meshes)
    )
    return IdlerOverFace(place.teeth, place.gear, body.across, (drive, coast))


def _in_slices(body, motions: np.ndarray, side: Side, face: Face) -> np.ndarray:
    """Motions (f, r) of a flank's nodes, averaged over slices along lines of contact: (S n, 3, r)."""
    positions = face.positions - face.middles[side.number]
    along = oblique_averages(body.heights, positions, face.widths, body.roll_angle, rises_of(face, side)[0])
    averaged = along @ motions.reshape(along.shape[1], -1)
    return averaged.reshape(along.shape[0], 3, -1)


@dataclass(frozen=True)
class _OnIdler:
    """Contact nodes of a mesh on an idler: `moved` (d, n, r), along directions, by motions of its body, and the tooth
    (n,) that each is on."""

    moved: np.ndarray
    tooth: np.ndarray


def _turned(idler: IdlerOverFace, gear: int, cycle: Cycle, part: Part, steps: float) -> _OnIdler:
    """The tangents of a mesh's nodes as they were a step before."""
    back = cycle.pair.sides[gear].turn * steps / cycle.steps
    return _seen(idler, gear, cycle, part.position.operator.pairs, back)


def _seen(
    idler: IdlerOverFace, gear: int, cycle: Cycle, pairs: Sequence[FacePair], turned: float | None = None
) -> _OnIdler:
    """Contact nodes of a mesh in which the idler is the driving (0) or the driven gear (1), with `turned` as of
    `contact_axes`."""
    motions = idler.motions[1 - gear]
    counts = [len(pair.offsets) for pair in pairs]
    first, near, _ = together([pair.coarse for pair in pairs])
    in_slice = len(motions) // cycle.face.slices
    begins = np.repeat([in_slice * pair.place.slice for pair in pairs], counts).astype(np.int64)
    weights = near[gear]
    # Narrow interpolations are as wide as the others, with weights of zero.
    columns = np.minimum(begins[:, None] + first[gear][:, None] + np.arange(weights.shape[1]), len(motions) - 1)
    ends = weights.shape[1] * np.arange(len(weights) + 1)
    seen = sparse.csr_matrix((weights.ravel(), columns.ravel(), ends), shape=(len(weights), len(motions)))
    along = (seen @ motions.reshape(len(motions), -1)).reshape(len(weights), 3, -1)
    axes = contact_axes(cycle.face, cycle.pair.sides[gear], pairs, cycle.tangential, turned)
    moved = np.einsum("ndc,ncr->dnr", np.repeat(axes[:, :, :3], counts, axis=0), along)
    teeth = [idler.gear.flank(1 - gear, (pair.place.teeth[gear], pair.place.flank))[0] for pair in pairs]
    return _OnIdler(moved, np.repeat(teeth, counts).astype(np.int64))


def _coupled(idler: IdlerOverFace, rows: list[_OnIdler], columns: list[_OnIdler]) -> list[Coupling]:
    """Both meshes of an idler by forces on the other one."""
    found = []
    for number, (gear, own, other) in enumerate(zip(idler.gear.sides, rows, reversed(columns))):
        teeth, places = np.unique(own.tooth, return_inverse=True)
        others, other_places = np.unique(other.tooth, return_inverse=True)
        between = idler.between(teeth, others, gear)
        by_forces = np.zeros((len(teeth), len(other.moved), other.moved.shape[1], own.moved.shape[2]))
        for at in range(len(others)):
            loaded = other_places == at
            by_forces[:, :, loaded] = np.einsum("trs,ens->tenr", between[:, at], other.moved[:, loaded], optimize=True)
        found.append(Coupling(idler.meshes[number], idler.meshes[1 - number], own.moved, places, by_forces))
    return found
