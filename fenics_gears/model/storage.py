"""The arrays of a result and their sizes: one list, by which the recorder keeps them and their memory is counted; and
their values in memory, of all steps of a march or, of some arrays, of the last."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import prod
from typing import Protocol

import numpy as np

from fenics_gears.effects import result_variables
from fenics_gears.scene.data import Scene

# Stress points of either fillet of a tooth, `elasticity.fillet_points`; the last is the one at the 30 degree tangent.
FILLET_POINTS = 24
FILLET_POINTS_OVER_FACE = 12
# Points of a shaft at which its deflection is given.
SHAFT_POINTS = 41
# Of an array that is compressed; measured: 0.13 to 0.3.
PACKED = 0.1
ROOT_STRESS = {
    "root_stress": ("contact_time", "gear", "slot", "fillet_point"),
    "root_stress_maximum": ("time", "gear", "slot"),
    "root_stress_at_30_degrees": ("time", "gear", "slot", "fillet"),
}
ROOT_STRESS_OVER_FACE = ROOT_STRESS | {
    "root_stress": ("contact_time", "gear", "slot", "fillet_point", "face_position"),
    "root_stress_over_face": ("contact_time", "gear", "slot", "fillet", "face_position"),
}
COORDINATES = {"time": ("time",), "mesh_phase": ("time",), "pair_number": ("time", "slot")}
CONTACT_COORDINATES = {
    "contact_time": ("contact_time",),
    "contact_mesh_phase": ("contact_time",),
    "contact_pair_number": ("contact_time", "slot"),
}

Arrays = Mapping[str, tuple[tuple[str, ...], np.dtype]]


def fillet_points(slices: int) -> int:
    return FILLET_POINTS if slices == 1 else FILLET_POINTS_OVER_FACE


def sizes(
    steps: int, contact_steps: int, slots: int, nodes: int, slices: int = 1, bearings: int = 0, points: int = 0
) -> dict[str, int]:
    """Length of each dimension of a result with so many steps, of which the contact fields of so many are stored."""
    return {
        "face_position": slices,
        "bearing": bearings, "support": points, "shaft_point": SHAFT_POINTS,
        "time": steps, "contact_time": contact_steps, "slot": slots, "contact_node": nodes,
        "gear": 2, "fillet": 2, "fillet_point": 2 * fillet_points(slices),
    }  # fmt: skip


def support_points(scene: Scene) -> int:
    """Number of points that hold the wheel."""
    return 0 if scene.wheel_points is None else len(scene.wheel_points.places)


def stored_arrays(scene: Scene, size: Mapping[str, int]) -> Arrays:
    """Dimensions and type of every array of a scene's result that grows with its steps; contact fields only where there
    are steps of them."""
    arrays = {variable.name: variable.dims for variable in result_variables(scene)} | COORDINATES
    if scene.output.root_stress and scene.resolves_contact:
        arrays |= ROOT_STRESS_OVER_FACE if scene.three_dimensional else ROOT_STRESS
    arrays |= CONTACT_COORDINATES
    whole = {"newton_iterations": np.int64, "closed_nodes": np.int64}
    whole |= dict.fromkeys(("pair_number", "contact_pair_number"), np.int32)
    return {
        name: (dims, np.dtype(whole.get(name, float)))
        for name, dims in arrays.items()
        if "time" in dims or ("contact_time" in dims and size["contact_time"])
    }


def counted_bytes(arrays: Arrays, size: Mapping[str, int]) -> int:
    return sum(kind.itemsize * prod(size[each] for each in dims) for dims, kind in arrays.values())


def packed_bytes(arrays: Arrays, size: Mapping[str, int]) -> int:
    """Of a file at least: curves are not compressed, other arrays to PACKED of their size at best."""
    curves = counted_bytes({name: each for name, each in arrays.items() if len(each[0]) == 1}, size)
    return int(curves + PACKED * (counted_bytes(arrays, size) - curves))


Values = Mapping[str, np.ndarray]


@dataclass(frozen=True)
class Kind:
    """One step's value of a variable: its type and shape, and of how many last steps it is kept; 0: of all."""

    type: np.dtype
    shape: tuple[int, ...]
    last: int = 0

    @classmethod
    def of(cls, name: str, values: np.ndarray, stored: Arrays, steps: int, last: int) -> Kind:
        """That of `values` (s, ...), by the list of stored arrays or, where it does not name them, as they are; a run
        has so many `steps` at most."""
        dims, kind = stored.get(name, (("time",), values.dtype))
        return cls(kind, values.shape[1:], last if dims[0] == "contact_time" and last < steps else 0)

    def places(self, first: int, end: int) -> np.ndarray | slice:
        """Where the values of the steps from `first` to before `end` lie."""
        return np.arange(first, end) % self.last if self.last else slice(first, end)

    def kept_from(self, steps: int) -> int:
        """The first of so many steps that is kept."""
        return max(steps - self.last, 0) if self.last else 0


class KeptArrays(Protocol):
    """Values that have been kept, or read from a journal."""

    def get(self, name: str, steps: int) -> np.ndarray:
        """The values of the first so many steps, in the order of time."""


class ArraysInMemory:
    """Keeps the values of at most so many `steps`, of contact fields those of the `last`; `stored`: the arrays with a
    type of their own."""

    def __init__(self, stored: Arrays, steps: int, last: int):
        self.stored = stored
        self.steps = steps
        self.last = last
        self.kinds: dict[str, Kind] = {}
        self._arrays: dict[str, np.ndarray] = {}

    def put(self, first: int, values: Values) -> None:
        """Keep the values (s, ...) of the steps from `first` on, by name."""
        for name, own in values.items():
            if name not in self.kinds:
                kind = self.kinds[name] = Kind.of(name, own, self.stored, self.steps, self.last)
                self._arrays[name] = np.empty((kind.last or self.steps, *kind.shape), kind.type)
            kind = self.kinds[name]
            end = first + len(own)
            begin = max(first, kind.kept_from(end))
            self._arrays[name][kind.places(begin, end)] = own[begin - first :]

    def get(self, name: str, steps: int) -> np.ndarray:
        """The values of the first so many steps, which all have been put, in the order of time."""
        kind = self.kinds[name]
        return self._arrays[name][kind.places(kind.kept_from(steps), steps)]
