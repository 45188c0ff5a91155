"""Shafts that bend in the result: what their deflection does to the axes, the bearings' loads, and deflection lines."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.elastic_shaft import MOTIONS, NUMBERS, SeatedGear
from fenics_gears.dynamics.frequencies import vibrations
from fenics_gears.dynamics.shaft_elements import SIX, carried
from fenics_gears.dynamics.shaft_system import ShaftSystem
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.model import Model
from fenics_gears.model.storage import SHAFT_POINTS

from .face_variables import AlongTheFace
from .numbers import mean_where_positive
from .side_by_side import SideBySide

MICROMETRES = 1e3
# Gauss points of a slice, in parts of its width from its middle: loads are even over a slice.
GAUSS = 0.5 / np.sqrt(3.0)
# What MOTIONS are called in the result.
OF_GEARS = ("centre_x", "centre_y", "axial_position", "tilt_x", "tilt_y")
DEPARTURES = tuple(
    f"axis_{kind}_{plane}" for kind in ("inclination", "offset") for plane in ("in_plane", "out_of_plane")
)
LOADS = ("bearing_force_x", "bearing_force_y", "bearing_force_z", "bearing_moment_x", "bearing_moment_y")


def along_face(model: Model, cycle: Cycle) -> AlongTheFace:
    """The further results of a mesh cycle over a face."""
    if model.drivetrain.elastic:
        return BentShafts(cycle, model)
    shafts = model.scene.shafts
    in_train = shafts is not None and shafts.in_train and shafts.sections is not None
    return MovedAxes(cycle, model) if in_train else AlongTheFace(cycle)


class MovedAxes(AlongTheFace):
    """What the result of a face has where shafts let the gears move: departures of the axes by the load."""

    def __init__(self, cycle: Cycle, model: Model):
        super().__init__(cycle)
        self.model = model
        self.drivetrain = model.drivetrain
        # Motions of the gears' axes by loads of their teeth, and by coordinates of their faces.
        self._teeth = {}
        self._apart = []
        for seat in self.drivetrain.seats:
            heights = self._heights(seat.gear)
            by_slices = seat.compliance(heights).reshape(len(heights), SIX, 2, -1, SIX).mean(axis=2)
            self._teeth[seat.gear] = self._nearest(by_slices, seat.gear)
            if seat.of_face:
                self._apart.append((seat, self._nearest(seat.follows(heights), seat.gear)))

    def curves(self, curves: Mapping[str, np.ndarray], nodes: SideBySide) -> dict[str, np.ndarray]:
        """Departures of the axes in the middle of the common face, um."""
        motions = self._motions(nodes.steps.states[:, 0])
        for gear, of_teeth in self._teeth.items():
            motions[:, GEARS.index(gear)] += np.tensordot(self._loads(nodes, gear), of_teeth, ((1, 2), (1, 2)))
        for seat, of_face in self._apart:
            apart = self.drivetrain.values(nodes.steps.states[:, 0], seat.of_face)
            motions[:, GEARS.index(seat.gear)] += apart @ of_face.T
        return super().curves(curves, nodes) | self._departures(motions)

    def numbers(self, counted: xr.Dataset, known: Mapping[str, Any]) -> dict[str, float | str]:
        """Of the settled steps of a result, means of the axes' departures too."""
        means = {f"mean_{name}": float(counted[name].mean()) for name in DEPARTURES}
        return super().numbers(counted, known) | means

    def _departures(self, motions: np.ndarray) -> dict[str, np.ndarray]:
        """By motions (steps, gears, 5) of the middles of pinion and wheel."""
        x, y, _, tilt_x, tilt_y = np.moveaxis(motions, -1, 0)
        heights = np.array(self.pair.gear_middles)
        leaning = tilt_y, -tilt_x
        offset = x - heights * tilt_y, y + heights * tilt_x
        width = MICROMETRES * self.pair.face_width
        of = [
            *(width * np.diff(each)[:, 0] for each in leaning),
            *(MICROMETRES * np.diff(each)[:, 0] for each in offset),
        ]
        return dict(zip(DEPARTURES, of))

    def _motions(self, states: np.ndarray) -> np.ndarray:
        """Motions (steps, gears, 5) of the middles of pinion and wheel."""
        both = [self.drivetrain.values(states, [f"{name}{each}" for name in MOTIONS]) for each in NUMBERS.values()]
        return np.stack(both, axis=1)

    def _heights(self, gear: str) -> np.ndarray:
        """Heights (2 S,) from the gear's middle of which two stand for a load that is even over a slice."""
        z = self._slices(gear)
        return np.concatenate([z - GAUSS * self.face.widths, z + GAUSS * self.face.widths])

    def _slices(self, gear: str) -> np.ndarray:
        return self.face.positions - self.pair.gear_middles[GEARS.index(gear)]

    def _nearest(self, teeth: np.ndarray, gear: str) -> np.ndarray:
        """Motions (5, ...) in the gear's middle of the straight axis that is nearest over the common face to teeth that
        move by (2 S, 6, ...)."""
        z = self._slices(gear)
        slices = teeth.reshape(2, len(z), *teeth.shape[1:]).mean(axis=0)
        straight = np.stack([np.ones_like(z), z], axis=1)
        nearest = np.linalg.solve((straight.T * self.face.widths) @ straight, straight.T * self.face.widths)
        moved = np.zeros((len(MOTIONS), *teeth.shape[2:]))
        # A positive tilt about x moves what lies further along the axis to negative y.
        for axis, rows, sense in ((0, [0, 4], 1.0), (1, [1, 3], -1.0)):
            moved[rows] = np.tensordot(np.diag([1.0, sense]) @ nearest, slices[:, axis], 1)
        return moved

    def _loads(self, nodes: SideBySide, gear: str) -> np.ndarray:
        """Loads (steps, S, 6) of the teeth on a gear in the slices of the face, at their own heights, over MOTIONS and
        the twist."""
        number = GEARS.index(gear)
        loaded = np.flatnonzero(nodes.normal)
        rows = np.array([0, 1, 6, 7, 8, 2]) + 3 * number
        place = nodes.step[loaded] * self.face.slices + nodes.of("slice")[loaded]
        forces = nodes.of("rows_of_normals")[rows][:, loaded] * nodes.normal[loaded]
        if nodes.tangential is not None:
            forces += nodes.of("rows_of_tangents")[rows][:, loaded] * nodes.tangential[loaded]
        size = len(nodes.steps) * self.face.slices
        loads = np.stack([np.bincount(place, each, minlength=size) for each in forces], axis=1)
        loads = loads.reshape(-1, self.face.slices, SIX)
        heights = self.face.positions - self.pair.gear_middles[number]
        return np.einsum("szi,zij->szj", loads, [carried(-each) for each in heights])


class BentShafts(MovedAxes):
    """What the result of a face has on shafts that bend: also what is recovered from the motions of the gears' middles,
    of which it is a linear function."""

    def __init__(self, cycle: Cycle, model: Model):
        super().__init__(cycle, model)
        self._lines = {}
        self._seats = {}
        for system in self.drivetrain.systems:
            for shaft, seat in system.seated:
                self._lines[seat.gear] = system.deflection(shaft, self.points(shaft.length))
                if seat.yields_within:
                    self._seats[seat.gear] = self._seat(system, seat)

    @staticmethod
    def points(length: float) -> np.ndarray:
        """Where the deflection of a shaft is given, mm from its left end."""
        return np.linspace(0.0, length, SHAFT_POINTS)

    def curves(self, curves: Mapping[str, np.ndarray], nodes: SideBySide) -> dict[str, np.ndarray]:
        """The same, and loads of the bearings (steps, bearings)."""
        on_bearings = self.drivetrain.bearing_loads(nodes.steps.states[:, 0])
        loads_of_bearings = dict(zip(LOADS, np.moveaxis(on_bearings, -1, 0)))
        return super().curves(curves, nodes) | loads_of_bearings

    def fields(self, nodes: SideBySide) -> dict[str, np.ndarray]:
        """Deflection of both shafts (steps, gears, points), mm; not a number where a shaft has no sections."""
        states = nodes.steps.states[:, 0]
        deflection = np.full((2, len(states), len(NUMBERS), SHAFT_POINTS), np.nan)
        for system in self.drivetrain.systems:
            values = self.drivetrain.values(states, system.coordinates)
            for _, each in system.seated:
                lines = np.einsum("pmn,sn->msp", self._lines[each.gear][:, :2], values)
                if each.gear in self._seats:
                    line = self._seats[each.gear][:, :2]
                    lines += np.einsum("pmzi,szi->msp", line, self._loads(nodes, each.gear), optimize=True)
                deflection[:, :, GEARS.index(each.gear)] = lines
        return super().fields(nodes) | {"shaft_deflection_x": deflection[0], "shaft_deflection_y": deflection[1]}

    def coordinates(self) -> dict[str, tuple]:
        """Where bearings and points of the shafts are."""
        elastic = self.drivetrain.elastic
        names = [f"{each.name} {number + 1}" for each in elastic for number in range(len(each.bearings))]
        places = [bearing.at for each in elastic for bearing in each.bearings]
        points = np.full((len(NUMBERS), SHAFT_POINTS), np.nan)
        for each in elastic:
            points[GEARS.index(each.name)] = self.points(each.length)
        from_end = {"units": "mm", "long_name": "distance from the left end of the shaft"}
        return super().coordinates() | {
            "bearing": ("bearing", names, {"long_name": "bearing of a shaft with sections"}),
            "bearing_place": ("bearing", places, from_end),
            "shaft_place": (("gear", "shaft_point"), points, from_end),
        }

    def numbers(self, counted: xr.Dataset, known: Mapping[str, Any]) -> dict[str, float | str]:
        """Of the settled steps of a result: means of the axes' departures, the largest force of a bearing, and natural
        frequencies."""
        forces = np.sqrt(sum(counted[name] ** 2 for name in LOADS[:3]))
        numbers = {"largest_bearing_force": float(forces.max())}
        return super().numbers(counted, known) | numbers | self._rolling_elements(counted) | self._vibrations(counted)

    def _seat(self, system: ShaftSystem, seat: SeatedGear) -> np.ndarray:
        """Motions (p, 5, S, 6) of the shaft's line by loads in the slices of the face, at their own heights."""
        line = system.bent_by_seat(seat, self._heights(seat.gear), self.points(system.shaft_of(seat).length))
        return line.reshape(*line.shape[:2], 2, -1, SIX).mean(axis=2)

    def _vibrations(self, counted: xr.Dataset) -> dict[str, str]:
        """Natural frequencies with the mesh as it was, a line each; nothing without inertia or contact."""
        if self.drivetrain.mass is None or "mesh_stiffness_tangent" not in counted:
            return {}
        stiffness = mean_where_positive(counted["mesh_stiffness_tangent"].values)
        if not np.isfinite(stiffness):
            return {}
        modes = vibrations(self.drivetrain, stiffness, self.model.scene.friction is not None)
        lines = (f"{each.frequency:.6g} {each.motion}".rstrip() for each in modes)
        return {"natural_frequencies": "\n".join(lines)}

    def _rolling_elements(self, counted: xr.Dataset) -> dict[str, float]:
        """Under the mean motions of the gears, which shafts and bearings follow at rest."""
        rolling = self.drivetrain.rolling
        drivetrain = self.drivetrain
        if rolling is None:
            return {}
        if any(seat.of_face for seat in drivetrain.seats):
            # The gears' motions are not all that moves shafts in their bearings.
            loads = np.stack([counted[name].mean("time").values for name in LOADS], axis=1)
            return {"largest_rolling_element_force": rolling.largest_under(loads)}
        coordinates = rolling.reference.copy()
        for gear, number in NUMBERS.items():
            for name, of in zip(MOTIONS, OF_GEARS):
                if f"{name}{number}" in drivetrain.coordinates:
                    place = drivetrain.coordinates.index(f"{name}{number}")
                    coordinates[place] = counted[of].sel(gear=gear).mean() * drivetrain.radii[place]
        settled = rolling.settled(drivetrain.stiffness, np.zeros(len(coordinates)), coordinates)
        return {"largest_rolling_element_force": rolling.largest_force(settled)}
