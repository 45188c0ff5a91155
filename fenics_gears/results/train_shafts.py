"""Shafts of a train that bend, in its result: loads of all bearings, and the lines in which the shafts bend."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.elastic_shaft import FIVE, ElasticShaft
from fenics_gears.dynamics.shaft_system import ShaftSystem
from fenics_gears.dynamics.train_shafts import SPACE, BentShafts, turned_motions
from fenics_gears.model.storage import SHAFT_POINTS

from .bent_shafts import LOADS

IN_SPACE = (
    "force of the shaft on its bearing to the right, as directions of stages are counted",
    "force of the shaft on its bearing upwards",
    "axial force of the shaft on its bearing, towards the end from which the first gear turns counter-clockwise",
    "moment of the shaft on its bearing about the direction to the right",
    "moment of the shaft on its bearing about the direction upwards",
)
Variables = dict[str, tuple]


@dataclass(frozen=True)
class ResultOfShafts:
    """Variables and coordinates, as dimensions, values and labels, and numbers of the whole train."""

    variables: Variables
    coordinates: Variables
    numbers: dict[str, Any]


class ShaftsOfTrain:
    """What the states (steps, k) of a train say of its shafts that bend."""

    def __init__(self, drivetrain: Drivetrain, bent: BentShafts, states: np.ndarray):
        self._drivetrain = drivetrain
        self._bent = bent
        self._states = states

    def result(self, recorded: int) -> ResultOfShafts:
        """Loads of all bearings at all steps, and means over the last so many steps of how all shafts bend; 0 for
        all."""
        loads = self._bearing_loads(self._states)
        units = ("N", "N", "N", "N mm", "N mm")
        variables: Variables = {
            name: (("time", "bearing"), of, {"units": unit, "long_name": words})
            for name, of, unit, words in zip(LOADS, np.moveaxis(loads, -1, 0), units, IN_SPACE)
        }
        mean = self._states[-recorded:].mean(axis=0)
        for axis, of, where in zip("xy", self._deflections(mean), ("to the right", "upwards")):
            words = {"units": "mm", "long_name": f"displacement of the shaft's axis {where}, mean"}
            variables[f"shaft_deflection_{axis}"] = (("shaft", "shaft_point"), of, words)
        forces = np.linalg.norm(loads[-recorded:, :, :3], axis=-1)
        numbers = {"largest_bearing_force": float(forces.max())}
        if self._drivetrain.rolling is not None:
            numbers["largest_rolling_element_force"] = self._drivetrain.rolling.largest_force(mean)
        return ResultOfShafts(variables, self.coordinates(), numbers)

    def coordinates(self) -> Variables:
        """Where bearings and points of the shafts are."""
        from_end = {"units": "mm", "long_name": "distance from the left end of the shaft"}
        bearings = list(self._bearings())
        names = [f"{shaft} {number}" for shaft, number, _ in bearings]
        return {
            "bearing": ("bearing", names, {"long_name": "bearing of a shaft, by its place in the scene"}),
            "bearing_place": ("bearing", [at for _, _, at in bearings], from_end),
            "shaft": ("shaft", list(self._bent.names), {"long_name": "shaft that bends"}),
            "shaft_place": (("shaft", "shaft_point"), np.array(self._points), from_end),
        }

    @cached_property
    def _shafts(self) -> list[tuple[ShaftSystem, ElasticShaft]]:
        return [(system, shaft) for system in self._bent.systems for shaft in system.shafts]

    def _bearings(self) -> Iterator[tuple[str, int, float]]:
        """Shaft, number there from left to right, and place (mm) of each bearing."""
        for _, shaft in self._shafts:
            for number, place in enumerate(np.sort([each.at for each in shaft.bearings]), 1):
                yield shaft.name, number, float(place)

    @cached_property
    def _points(self) -> list[np.ndarray]:
        """Places (p,), mm, on each shaft at which its deflection is given."""
        return [np.linspace(0.0, shaft.length, SHAFT_POINTS) for _, shaft in self._shafts]

    def _bearing_loads(self, states: np.ndarray) -> np.ndarray:
        """Loads (steps, bearings, 5), in space."""
        loads = self._drivetrain.bearing_loads(states)
        first = 0
        found = []
        for _, shaft in self._shafts:
            order = np.argsort([each.at for each in shaft.bearings], kind="stable")
            turn = turned_motions(self._bent.axes[shaft.name], SPACE)[:FIVE, :FIVE]
            own = loads[:, first : first + len(order)] @ turn.T
            first += len(order)
            found.append(own[:, order])
        return np.concatenate(found, axis=1)

    def _deflections(self, state: np.ndarray) -> np.ndarray:
        """Displacements (2, shafts, points) of the shafts' axes, mm, in a state (k,)."""
        lines = []
        for (system, shaft), points in zip(self._shafts, self._points):
            turn = turned_motions(self._bent.axes[shaft.name], SPACE)[:2, :FIVE]
            moved = self._drivetrain.values(state, system.coordinates)
            lines.append(turn @ (system.deflection(shaft, points) @ moved).T)
        return np.stack(lines, axis=1)
