"""Contact on gears whose faces bend by coordinates of their own (`elastic_shaft_seat`): what these move at the contact
nodes, by the motions of the gears' middles that move a slice alike."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.contact.tooth_pair import per_node

from .elastic_shaft import NUMBERS, SeatedGear
from .shaft_elements import SIX, carried

if TYPE_CHECKING:
    from fenics_gears.contact.mesh import Mesh
    from fenics_gears.contact.operator import ContactOperator, Position

    from .drivetrain import Drivetrain
    from .seat_of_mesh import SeatOfMesh


# Gauss points of a slice, in parts of its width from its middle.
GAUSS = 0.5 / np.sqrt(3.0)


@dataclass(frozen=True, eq=False)
class BendingFace:
    """Of one gear: `columns` (6,) of its middle in the contact equations, and `motions` (S, 6, 6) over these that move
    the slices of the face as the coordinates of the face do."""

    columns: np.ndarray
    motions: np.ndarray


def bending_face(drivetrain: Drivetrain, seat: SeatOfMesh, middles: np.ndarray, widths: np.ndarray) -> BendingFace:
    """The face of a gear, whose slices have such middles (S,), mm from the gear's, and widths (S,), mm."""
    names = (*SeatedGear(seat.gear, 0.0).of_gear, f"rotation_{NUMBERS[seat.gear]}")
    columns = [drivetrain.coordinates.index(name) for name in names]
    own = [drivetrain.coordinates.index(name) for name in seat.of_face]
    # The mean over a slice, exact for a cylinder's.
    ends = np.stack([middles - GAUSS * widths, middles + GAUSS * widths])
    follows = seat.follows(ends.ravel()).reshape(2, len(middles), SIX, SIX).mean(axis=0)
    of_middle = np.array([carried(-each) for each in middles]) @ follows
    return BendingFace(np.array(columns), drivetrain.radii[columns][:, None] * of_middle / drivetrain.radii[own])


class CycleOfBendingFaces(Cycle):
    """A cycle whose contact equations have the columns of `faces` that bend, after those of the gears."""

    def __init__(self, mesh: Mesh, steps: int, coordinates: list[int], tangential: bool, faces: Sequence[BendingFace]):
        super().__init__(mesh, steps, coordinates, tangential)
        self._faces = faces

    def frictionless(self, coordinates: list[int]) -> Cycle:
        return CycleOfBendingFaces(self.mesh, self.steps, coordinates, False, self._faces)

    def _built_of(self, mesh: Mesh, steps: list[tuple[float, float]]) -> list[Position]:
        positions = super()._built_of(mesh, steps)
        for position in positions:
            self._widen(position.operator)
        return positions

    def _widen(self, operator: ContactOperator) -> None:
        slices = per_node(operator.pairs, np.array([pair.place.slice for pair in operator.pairs], dtype=int))
        jacobian, before = operator.stored_jacobians
        kinds = len(jacobian) // len(slices) if len(slices) else 1
        object.__setattr__(operator, "jacobian", self._with_faces(jacobian, np.tile(slices, kinds)))
        if before is not None:
            object.__setattr__(operator, "previous_jacobian", self._with_faces(before, slices))

    def _with_faces(self, rows: np.ndarray, slices: np.ndarray) -> np.ndarray:
        more = [np.einsum("ni,nij->nj", rows[:, each.columns], each.motions[slices]) for each in self._faces]
        return np.ascontiguousarray(np.concatenate([rows, *more], axis=1))
