"""How meshes over the face in which one gear stands feel each other through its body.

Flanks of it that different mates load, on one side of its teeth or on either, feel each other through its body alone,
by few motions of theirs (`elasticity.face.between_mates`): averaged over slices as the body's compliance is, and seen
by contact nodes along their directions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import permutations, product
from typing import NamedTuple

import numpy as np
from scipy import sparse

from fenics_gears.elasticity.face_compliance_data import BetweenMates, FaceCompliance, SharedCompliance
from fenics_gears.elasticity.slice_averages import oblique_averages
from fenics_gears.errors import ComputationError
from fenics_gears.geometry.gear_train import SharedGear

from .face import Face
from .face_pairing import FacePair, contact_axes, rises_of
from .fine_sections import together
from .idler import Part
from .joined_rows import Coupling
from .mesh_cycle import Cycle, in_common


@dataclass(frozen=True)
class MeshOfGear:
    """A mesh of a gear: its number, what the gear is in it, the pinion (0) or the wheel (1), and how it counts the
    gear's teeth, None as the gear's first mesh does."""

    number: int
    gear: int
    counted: SharedGear | None = None

    @property
    def kind(self) -> int:
        """Which flanks of the gear it loads: 0 as its first mesh does, 1 the opposite ones."""
        return int(self.counted is not None and self.counted.mirrored)

    def flank(self, tooth: int, flank: int) -> tuple[int, int]:
        """A flank as the gear's first mesh counts teeth and flanks."""
        return (tooth, flank) if self.counted is None else self.counted.flank(1, (tooth, flank))


class OnBody(NamedTuple):
    """Contact nodes (n,) of a mesh on a gear: how motions of its body move them (d, n, r), along directions; its
    `flanks` there, (T, 2), tooth and kind, and the place among these of that on which each node is."""

    moved: np.ndarray
    flanks: np.ndarray
    flank: np.ndarray

    def by(self, motions: np.ndarray) -> np.ndarray:
        """How joint motions of its flanks (T, r, s) move the nodes, (d, n, s)."""
        found = np.empty((*self.moved.shape[:2], motions.shape[2]))
        for number, of_flank in enumerate(motions):
            nodes = np.flatnonzero(self.flank == number)
            found[:, nodes] = self.moved[:, nodes] @ of_flank
        return found


class MotionsInSlices(dict[tuple[int, int], np.ndarray]):
    """By gear and kind of drive flank, motions in slices of meshes that pass the same places."""


class MovedNodes(dict[tuple[int, int, float], np.ndarray]):
    """The same of contact nodes, by the place in the mesh cycle too."""


# Of the largest, singular values of what meshes feel of each other that are left out.
LEAST_SHARED = 1e-8


@dataclass(frozen=True, eq=False)
class GearOverFace:
    """A gear of so many `teeth` in several `meshes`, what is `between` its flanks, and in slices the `motions`
    (F S n, 3, r) of the F kinds that each mesh loads, its drive flanks first. It is a `joined_meshes.CouplingGear`."""

    teeth: int
    meshes: tuple[MeshOfGear, ...]
    between: BetweenMates
    motions: tuple[np.ndarray, ...]
    # By the flanks of all meshes that touch, joint motions of these.
    _shared: dict[tuple[bytes, ...], tuple] = field(default_factory=dict)

    def couplings(
        self, cycles: Sequence[Cycle], parts: Sequence[Part], steps: float
    ) -> tuple[list[Coupling], list[Coupling]]:
        there = [(cycles[mesh.number], parts[mesh.number]) for mesh in self.meshes]
        pairs = [part.position.operator.pairs for _, part in there]
        tangential = any(cycle.tangential for cycle in cycles)
        seen = partial(self._seen, [cycle for cycle, _ in there], tangential)
        now = seen(pairs, indices=[part.position.index for _, part in there])
        if not tangential:
            return self._coupled(now, now), []
        before = seen([part.before for _, part in there])
        # The tangents of its nodes as they were a step before.
        turned = seen(pairs, steps)
        return self._coupled(now, now), self._coupled(before, turned)

    def response(self, kinds: tuple[int, int], teeth: np.ndarray, others: np.ndarray) -> np.ndarray:
        """What displaces flanks of one kind, of teeth (T,), by motions of the body, of those of another kind, of other
        teeth (U,): (T, U, r, r')."""
        if kinds not in self.between.known:
            return self.response(kinds[::-1], others, teeth).transpose(1, 0, 3, 2)
        first, known = self.between.known[kinds]
        ahead = teeth[:, None] - others
        behind = np.zeros(ahead.shape, dtype=bool)
        if kinds[0] == kinds[1]:
            ahead = ahead % self.teeth
            behind = 2 * ahead > self.teeth
            ahead = np.where(behind, self.teeth - ahead, ahead) - first
        else:
            ahead = (ahead - first) % self.teeth
        if ahead.size and not 0 <= ahead.min() <= ahead.max() < len(known):
            raise ComputationError(
                "compliance over the face: flanks of a gear in several meshes touch that are further apart than its"
                " body's compliance is known; ask shared_compliance for a larger reach"
            )
        found = known[ahead]
        return np.where(behind[:, :, None, None], found.swapaxes(2, 3), found) if behind.any() else found

    def _seen(
        self,
        cycles: Sequence[Cycle],
        tangential: bool,
        pairs_of: Sequence[Sequence[FacePair]],
        steps: float | None = None,
        indices: Sequence[float] | None = None,
    ) -> list[OnBody]:
        """Contact nodes of each mesh on the gear; `steps`: their tangents as they were so many steps before;
        `indices`: places in mesh cycles at which all that pass them move alike."""
        found = []
        places = indices or [None] * len(cycles)
        for mesh, motions, cycle, pairs, index in zip(self.meshes, self.motions, cycles, pairs_of, places):
            turned = None if steps is None else cycle.pair.sides[mesh.gear].turn * steps / cycle.steps
            flanks = [mesh.flank(pair.place.teeth[mesh.gear], pair.place.flank) for pair in pairs]
            numbered = np.array(flanks, dtype=np.int64).reshape(-1, 2)
            counts = [len(pair.offsets) for pair in pairs]
            known, key = _known_at(mesh, cycle, index)
            if key not in known:
                known[key] = _moved(motions, mesh.gear, cycle, pairs, (tangential, turned))
            moved = known[key]
            different, own = np.unique(np.repeat(numbered, counts, axis=0), axis=0, return_inverse=True)
            found.append(OnBody(moved, different, own.ravel()))
        return found

    def _coupled(self, rows: list[OnBody], columns: list[OnBody]) -> list[Coupling]:
        """Each two meshes of the gear, one by forces on the other, by the joint motions of their teeth that matter."""
        flanks = tuple(each.flanks.tobytes() for each in (*rows, *columns))
        if flanks not in self._shared:
            self._shared[flanks] = self._shared_motions(rows, columns)
        motions, motions_of_loaded, between = self._shared[flanks]
        moved = [each.by(own) for each, own in zip(rows, motions)]
        same = rows is columns
        moved_of_loaded = moved if same else [each.by(own) for each, own in zip(columns, motions_of_loaded)]
        return [
            Coupling(self.meshes[one].number, self.meshes[other].number, moved[one], moved_of_loaded[other], each)
            for (one, other), each in between.items()
        ]

    def _shared_motions(
        self, rows: list[OnBody], columns: list[OnBody]
    ) -> tuple[list[np.ndarray], list[np.ndarray], dict[tuple[int, int], np.ndarray]]:
        """Joint motions (T, r, s) of the flanks of each mesh that others feel, as it responds and as it is loaded; and
        by two meshes what is between those, (s, s')."""
        pairs = list(permutations(range(len(self.meshes)), 2))
        known = {}
        for one, other in pairs:
            found = self._responses(rows[one].flanks, columns[other].flanks)
            known[one, other] = found.transpose(0, 2, 1, 3).reshape(found.shape[0] * found.shape[2], -1)
        numbers = range(len(self.meshes))
        own = [_felt([known[pair] for pair in pairs if pair[0] == each]) for each in numbers]
        loaded = own
        if rows is not columns:
            loaded = [_felt([known[pair].T for pair in pairs if pair[1] == each]) for each in numbers]
        between = {(one, other): own[one].T @ known[one, other] @ loaded[other] for one, other in pairs}
        return _by_flanks(own, rows), _by_flanks(loaded, columns), between

    def _responses(self, flanks: np.ndarray, others: np.ndarray) -> np.ndarray:
        """As of `response`, of flanks (T, 2) by others (U, 2) of any kinds."""
        motions = self.motions[0].shape[2]
        found = np.empty((len(flanks), len(others), motions, motions))
        for kinds in product(range(2), repeat=2):
            own, loaded = (np.flatnonzero(each[:, 1] == kind) for each, kind in zip((flanks, others), kinds))
            if len(own) and len(loaded):
                found[np.ix_(own, loaded)] = self.response(kinds, flanks[own, 0], others[loaded, 0])
        return found


def _by_flanks(motions: list[np.ndarray], seen: list[OnBody]) -> list[np.ndarray]:
    """Joint motions of the flanks of each mesh, (T, r, s)."""
    return [each.reshape(len(on.flanks), on.moved.shape[2], each.shape[1]) for each, on in zip(motions, seen)]


def _felt(blocks: list[np.ndarray]) -> np.ndarray:
    """Orthonormal motions (T r, s) of a mesh of which its response (T r, U r') to each other mesh is made."""
    found, sizes, _ = np.linalg.svd(np.hstack(blocks), full_matrices=False)
    return np.ascontiguousarray(found[:, sizes > LEAST_SHARED * sizes.max(initial=0.0)])


def gear_over_face(
    teeth: int, meshes: tuple[MeshOfGear, ...], body: SharedCompliance, cycles: Sequence[Cycle]
) -> GearOverFace:
    """A gear with its body; `cycles` of all meshes of the train."""
    motions = []
    between = _of_as_many(body.between)
    for mesh in meshes:
        cycle = cycles[mesh.number]
        known = cycle.true_place(0)[0].shared(MotionsInSlices)
        key = mesh.gear, mesh.kind
        if key not in known:
            kinds = (mesh.kind, 1 - mesh.kind)[: 1 + cycle.coast_flanks]
            loaded = [between.motions[kind] for kind in kinds]
            known[key] = _in_slices(body.flanks[mesh.kind], loaded, mesh.gear, cycle)
        motions.append(known[key])
    return GearOverFace(teeth, meshes, between, tuple(motions))


def _of_as_many(between: BetweenMates) -> BetweenMates:
    """The same with as many motions of flanks of either kind: those that are added are none."""
    most = max(each.shape[1] for each in between.motions)

    def filled(array: np.ndarray, axes: int) -> np.ndarray:
        missing = [(0, most - size) for size in array.shape[-axes:]]
        return np.pad(array, [(0, 0)] * (array.ndim - axes) + missing)

    known = {kinds: (first, filled(each, 2)) for kinds, (first, each) in between.known.items()}
    return BetweenMates(tuple(filled(each, 1) for each in between.motions), known)


def _known_at(
    mesh: MeshOfGear, cycle: Cycle, index: float | None
) -> tuple[dict[tuple[int, int, float], np.ndarray], tuple[int, int, float]]:
    """What is known of how the nodes of meshes move that pass a place, and its key; nothing at no place in common."""
    origin, place = cycle.true_place(index or 0.0)
    known = origin.shared(MovedNodes) if index is not None and in_common(place) else {}
    return known, (mesh.gear, mesh.kind, place)


def _in_slices(body: FaceCompliance, motions: Sequence[np.ndarray], gear: int, cycle: Cycle) -> np.ndarray:
    """Motions (f, r) of the nodes of drive flanks, and of coast flanks, averaged over slices along lines of contact:
    (F S n, 3, r)."""
    face: Face = cycle.face
    positions = face.positions - face.middles[gear]
    found = []
    for rise, own in zip(rises_of(face, cycle.pair.sides[gear]), motions):
        along = oblique_averages(body.heights, positions, face.widths, body.roll_angle, rise)
        averaged = along @ own.reshape(along.shape[1], -1)
        found.append(averaged.reshape(along.shape[0], 3, -1))
    return np.concatenate(found)


def _moved(
    motions: np.ndarray, gear: int, cycle: Cycle, pairs: Sequence[FacePair], along_axes: tuple[bool, float | None]
) -> np.ndarray:
    """How contact nodes of a mesh move (d, n, r), along their directions, by motions of its pinion's (0) or its wheel's
    (1) body in slices; `along_axes`: `tangential` and `turned` as of `contact_axes`."""
    counts = [len(pair.offsets) for pair in pairs]
    first, near, _ = together([pair.coarse for pair in pairs])
    slices = cycle.face.slices
    in_slice = len(motions) // (slices * (1 + cycle.coast_flanks))
    places = [in_slice * (pair.place.slice + slices * pair.place.flank) for pair in pairs]
    begins = np.repeat(places, counts).astype(np.int64)
    weights = near[gear]
    # Narrow interpolations are as wide as the others, with weights of zero.
    columns = np.minimum(begins[:, None] + first[gear][:, None] + np.arange(weights.shape[1]), len(motions) - 1)
    ends = weights.shape[1] * np.arange(len(weights) + 1)
    seen = sparse.csr_matrix((weights.ravel(), columns.ravel(), ends), shape=(len(weights), len(motions)))
    along = (seen @ motions.reshape(len(motions), -1)).reshape(len(weights), 3, -1)
    axes = contact_axes(cycle.face, cycle.pair.sides[gear], pairs, *along_axes)
    return np.einsum("ndc,ncr->dnr", np.repeat(axes[:, :, :3], counts, axis=0), along)
