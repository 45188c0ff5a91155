"""The body of a gear as contact and dynamics know it: the compliance of its flanks."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar, Protocol

import numpy as np

from fenics_gears.errors import ComputationError

if TYPE_CHECKING:
    from .face_compliance_data import FaceCompliance

STAGES = ("time_mesh", "time_compile", "time_condense")


@dataclass(frozen=True)
class Reach:
    """Distances, in pitches, between teeth whose flanks interact.

    same: the largest between two drive flanks, or two coast flanks. across: least and largest between a drive and a
    coast flank, positive where the tooth of the drive flank is ahead, counter-clockwise; None where coast flanks are
    not loaded. far: over the face least and largest between like flanks that different mates load, the shorter way
    round the gear; None where no two mates load like flanks. own: over the face, of a gear of several mates, `across`
    of flanks that one of them loads; None where each loads one kind.
    """

    same: int
    across: tuple[int, int] | None = None
    far: tuple[int, int] | None = None
    own: tuple[int, int] | None = None

    @property
    def of_one_mate(self) -> int:
        """The largest, of flanks that one of several mates loads."""
        return max(map(abs, (self.same, *(self.own or ()))))

    @property
    def farthest(self) -> int:
        """The largest, of any flanks."""
        return max(map(abs, (self.same, *(self.across or ()), *(self.far or ()))))

    @property
    def between_mates(self) -> dict[tuple[int, int], tuple[int, int]]:
        """Least and largest distance between flanks that different mates load, by their kinds, 0 drive and 1 coast."""
        kinds = 1 if self.across is None else 2
        found = {} if self.far is None else {(kind, kind): self.far for kind in range(kinds)}
        return found if self.across is None else {**found, (0, 1): self.across}


class BetweenFlanks(Protocol):
    """What line forces on one flank of a gear displace on another, in plane strain; teeth are counted counter-clockwise
    by any whole numbers."""

    def between(self, responding: int, loaded: int, sides: tuple[int, int] = (0, 0)) -> np.ndarray:
        """Displacement (2n', 2n), mm per N/mm, of a flank of one tooth by forces on one of another. `sides`: which
        flank of either, 0 the drive flank, 1 the coast flank. Raises ComputationError where that is not known."""

    def key(self, responding: int, loaded: int) -> Hashable:
        """Teeth with the same key have the same compliance."""


class FlankBody(BetweenFlanks, Protocol):
    """A gear's body in plane strain, as contact knows it.

    `alike`: whether it does not matter from which tooth teeth are counted; `flanks`: how many of a tooth are known;
    `element_order`: 1 or 2, of the displacement along a flank element; `timings`: seconds that it took, by stage.
    """

    @property
    def alike(self) -> bool: ...

    @property
    def flanks(self) -> int: ...

    @property
    def element_order(self) -> int: ...

    @property
    def timings(self) -> dict: ...

    def rolls_of(self, tooth: int) -> np.ndarray:
        """Roll angles (n,), rad, of the flank nodes of a tooth, increasing."""


@dataclass(frozen=True)
class FlankCompliance:
    """Displacement of drive-flank nodes per unit line force on drive-flank nodes, hub ring held.

    roll_angle: (n,), rad, increasing from the form circle to the tip: the nodes of the drive flank, element vertices
    and (second order) the nodes between them. element_order: 1 or 2, of the displacement along a flank element. blocks:
    (offsets + 1, 2n, 2n), mm per N/mm (plane strain, unit thickness). blocks[m] is the displacement of the flank m
    pitches ahead (counter-clockwise) of the loaded one. Dofs are interleaved x0, y0, x1, y1, ..., in each tooth's own
    canonical frame. blocks[0] is symmetric positive definite. alike: all teeth are alike. flanks: 1, or 2 where the
    coast flank is known too. Its 2n dofs then follow the drive flank's. They are in the tooth's frame mirrored at its
    centreline, where the coast flank lies as the drive flank does. timings: time_mesh, time_compile, time_condense (s),
    from_cache and the like.
    """

    roll_angle: np.ndarray
    element_order: int
    blocks: np.ndarray
    timings: dict = field(default_factory=dict, compare=False)
    flanks: int = 1
    alike: ClassVar[bool] = True

    @property
    def nodes(self) -> int:
        """Number of flank nodes."""
        return len(self.roll_angle)

    @property
    def offsets(self) -> int:
        """Largest distance, in pitches, between two teeth whose interaction is known."""
        return len(self.blocks) - 1

    @property
    def farthest(self) -> int:
        """Largest distance, in pitches, between two teeth of which any flanks' interaction is known."""
        return self.offsets

    def block(self, offset: int) -> np.ndarray:
        """Compliance of the flank ``offset`` pitches ahead of the loaded one, (2n, 2n); of one behind, by reciprocity,
        the transpose. Raises ComputationError for a tooth outside ``offsets``."""
        self._check_known(offset, -self.offsets, self.offsets)
        return self.blocks[offset] if offset >= 0 else self.blocks[-offset].T

    @staticmethod
    def _check_known(offset: int, least: int, largest: int) -> None:
        if not least <= offset <= largest:
            raise ComputationError(
                f"flank compliance: tooth offset {offset} was not computed, known are "
                f"{least} to {largest}; ask flank_compliance for a larger reach"
            )

    def rolls_of(self, tooth: int) -> np.ndarray:
        """As of `FlankBody`: all teeth are alike."""
        return self.roll_angle

    def between(self, responding: int, loaded: int, sides: tuple[int, int] = (0, 0)) -> np.ndarray:
        """As of `BetweenFlanks`, (2n, 2n)."""
        dofs = 2 * self.nodes
        rows, columns = (slice(side * dofs, (side + 1) * dofs) for side in sides)
        return self.block(responding - loaded)[rows, columns]

    def key(self, responding: int, loaded: int) -> int:
        """As of `BetweenFlanks`: their distance."""
        return responding - loaded


@dataclass(frozen=True)
class BothFlanksCompliance(FlankCompliance):
    """Compliance of drive and coast flanks. Half of the blocks give the others by symmetry about the tooth's
    centreline: in the mirror a coast flank is a drive flank, and a tooth ahead is one behind.

    blocks: (offsets + 1, 2n, 2n): of the drive flanks alone. across: (k, 2n, 2n), each symmetric: across[m -
    first_across] is the displacement of the drive flank m pitches ahead of a loaded coast flank.
    """

    across: np.ndarray = field(kw_only=True)
    first_across: int = field(kw_only=True)
    flanks: int = 2

    @property
    def farthest(self) -> int:
        """Largest distance, in pitches, between two teeth of which any flanks' interaction is known; drive and coast
        flank of one gap are a pitch further apart."""
        return max(self.offsets, -self.first_across, self.first_across + len(self.across) - 1)

    def block(self, offset: int) -> np.ndarray:
        """Compliance (4n, 4n) over both flanks, put together."""
        return np.block([[self.between(offset, 0, (side, other)) for other in (0, 1)] for side in (0, 1)])

    def between(self, responding: int, loaded: int, sides: tuple[int, int] = (0, 0)) -> np.ndarray:
        """As `FlankCompliance.between`, without assembling the other blocks."""
        ahead = (responding - loaded) * (1 if sides[0] == 0 else -1)
        if sides[0] != sides[1]:
            self._check_known(ahead, self.first_across, self.first_across + len(self.across) - 1)
            return self.across[ahead - self.first_across]
        return super().block(ahead)


@dataclass(frozen=True)
class Body:
    """A gear: the flank compliance of its `section` in plane strain and, where flanks are resolved over the face, of
    its `solid` in three dimensions. timings: seconds that both took, by stage."""

    section: FlankBody
    solid: FaceCompliance | None = None
    timings: dict[str, float] = field(default_factory=dict, compare=False)

    @classmethod
    def of(cls, section: FlankBody, solid: FaceCompliance | None = None) -> Body:
        """The gear of these, with the times of both."""
        parts = [section.timings] if solid is None else [section.timings, solid.timings]
        return cls(section, solid, {name: sum(part[name] for part in parts) for name in STAGES})


Bodies = tuple[Body, Body]
