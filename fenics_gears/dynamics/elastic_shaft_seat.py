"""A gear that is cut into its elastic shaft, or whose hub gives way with it: what does so within the face.

All of shaft and bearings is C, motions of places within the face per load there. With R, the motions of these places as
parts of a rigid gear, C = R K^-1 R^T + D: K = (R^T C^-1 R)^-1 is the stiffness of a seat that is rigid over its width,
which the drivetrain has in any case, and D >= 0 what is left (Schur's complement the other way round). Under D the gear
moves so that what holds it beside the face feels neither force nor moment of it in sum; the split is exact.

D is what the face does between its ends, both held, which is alike in all directions and joins the compliance of the
flanks, and what it does as these move apart: coordinates. Where all that holds the shaft is on one side of the face,
the other end is free, and both join the flanks.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .beam import beams, properties
from .elastic_shaft_hub import hub_flexibility
from .shaft_elements import SIX, Assembly, carried, motions_of

if TYPE_CHECKING:
    from .elastic_shaft import ElasticShaft, SeatedGear

NOWHERE = np.empty(0)
MIDDLE = np.zeros(1)


class YieldingSeat(NamedTuple):
    """What a seat does under loads of the teeth (h, 6) within its face, over six motions: the `compliance` D
    (h, 6, h, 6), motions of the shaft's `axis` (a, 6, h, 6) there, and of its `ends` (2, 6, h, 6), left and right of
    the face, as motions of the gear's middle."""

    compliance: np.ndarray
    axis: np.ndarray
    ends: np.ndarray


@dataclass(frozen=True, eq=False)
class Seat:
    """The seat of a gear on its shaft, held at both ends of its face by a stiffness of its `supports` (12, 12) over the
    motions of the left and the right end, each as one of the gear's middle."""

    shaft: ElasticShaft
    gear: SeatedGear
    supports: np.ndarray

    @cached_property
    def apart(self) -> np.ndarray:
        """Motions (12, 6) of both ends per motion of the right one against the left one, under which what holds the
        face feels neither force nor moment in sum."""
        both = np.concatenate([np.eye(SIX)] * 2)
        summed = both.T @ self.supports
        share = np.linalg.solve(summed @ both, summed[:, SIX:])
        return np.concatenate([-share, np.eye(SIX) - share])

    @property
    def stiffness_of_face(self) -> np.ndarray:
        """Of the face (6, 6) against this motion."""
        return self._to_end.T @ np.linalg.solve(self._within(MIDDLE, NOWHERE)[-1, :, -1], self._to_end)

    def follows(self, heights: np.ndarray) -> np.ndarray:
        """Motions (h, 6, 6) of the teeth at `heights` (h,), mm from the gear's middle, per such motion."""
        return self._follows(self._within(heights, NOWHERE), heights)

    def axis_follows(self, heights: np.ndarray) -> np.ndarray:
        """The same (h, 6, 6) of the shaft's axis."""
        free = self._within(MIDDLE, heights)[len(MIDDLE) :, :, len(MIDDLE) :]
        return self._follows(free, heights)

    def under(self, heights: np.ndarray, axis: np.ndarray = NOWHERE) -> YieldingSeat:
        """What it does where loaded at `heights` (h,), mm from the gear's middle; `axis` (a,): heights within the face
        at which the shaft is asked for. Where the ends' motions apart are coordinates, they are held."""
        free = self._within(heights, axis)
        places = np.concatenate([heights, axis])
        size = SIX * len(places)
        whole = free.reshape(size + SIX, -1)
        to_end = np.linalg.solve(whole[-SIX:, -SIX:], whole[-SIX:, :size])
        compliance = whole[:size, :size] - whole[:size, -SIX:] @ to_end
        ends = np.zeros((2 * SIX, SIX * len(heights)))
        if not self.shaft.of_face(self.gear):
            follows = self._follows(free, places).reshape(size, SIX)
            moved = np.linalg.solve(self.stiffness_apart, follows.T)
            compliance += follows @ moved
            ends = self.apart @ moved[:, : SIX * len(heights)]
        count = len(heights)
        symmetric = 0.5 * (compliance + compliance.T)
        by_height = symmetric.reshape(len(places), SIX, len(places), SIX)[:, :, :count]
        return YieldingSeat(by_height[:count], by_height[count:], ends.reshape(2, SIX, count, SIX))

    def whole(self, heights: np.ndarray) -> np.ndarray:
        """D (h, 6, h, 6) with what the ends' motions apart do, also where these are coordinates."""
        compliance = self.under(heights).compliance
        if self.shaft.of_face(self.gear):
            follows = self.follows(heights)
            moved = np.linalg.solve(self.stiffness_apart, follows.reshape(-1, SIX).T)
            compliance = compliance + (follows.reshape(-1, SIX) @ moved).reshape(compliance.shape)
        return compliance

    @property
    def stiffness_apart(self) -> np.ndarray:
        """Of face and all that holds it (6, 6) against the ends' motion apart."""
        return self.apart.T @ self.supports @ self.apart + self.stiffness_of_face

    @property
    def _to_end(self) -> np.ndarray:
        return carried(0.5 * self.gear.width)

    def _follows(self, free: np.ndarray, places: np.ndarray) -> np.ndarray:
        """The same by motions `free` (p + 1, 6, p + 1, 6) of the face with its left end held."""
        by_right = np.linalg.solve(free[-1, :, -1], self._to_end)
        left = np.array([carried(each) for each in places]).reshape(-1, SIX, SIX) @ self.apart[:SIX]
        return left + free[:-1, :, -1] @ by_right

    def _within(self, heights: np.ndarray, axis: np.ndarray) -> np.ndarray:
        """Motions (h + a + 1, 6, h + a + 1, 6) of places within the face, the last ones of the shaft's `axis`, and of
        its right end, per load there, with its left end held."""
        shaft = self.shaft
        gear = self.gear
        if gear.hub is not None:
            return hub_flexibility(gear.hub, heights, axis)
        begin, end = gear.ends
        places = np.array([*(gear.at + heights), *(gear.at + axis), end])
        nodes = np.unique(np.append(places, begin))
        along = properties(shaft.sections, shaft.material, nodes)
        face = Assembly(beams(shaft.name, range(len(nodes)), nodes, along))
        held = face.held(motions_of(shaft.name, 0))
        own = (SIX * np.searchsorted(nodes, places)[:, None] + np.arange(SIX)).ravel()
        return held.flexibility[np.ix_(own, own)].reshape(len(places), SIX, len(places), SIX)
