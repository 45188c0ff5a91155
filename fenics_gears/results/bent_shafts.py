"""Shafts that bend in the result: what their deflection does to the axes, the bearings' loads, and deflection lines."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.dynamics.elastic_shaft import MOTIONS, NUMBERS
from fenics_gears.model.model import Model
from fenics_gears.model.storage import SHAFT_POINTS

from .face_variables import AlongTheFace
from .numbers import mean_where_positive
from .side_by_side import SideBySide

MICROMETRES = 1e3
# What MOTIONS are called in the result.
OF_GEARS = ("centre_x", "centre_y", "axial_position", "tilt_x", "tilt_y")
LOADS = ("bearing_force_x", "bearing_force_y", "bearing_force_z", "bearing_moment_x", "bearing_moment_y")


class BentShafts(AlongTheFace):
    """What the result of a face has on shafts that bend: also what is recovered from the motions of the gears' middles,
    of which it is a linear function."""

    def __init__(self, cycle: Cycle, model: Model):
        super().__init__(cycle)
        self.model, self.drivetrain = model, model.drivetrain
        self._lines = {each.gear: each.deflection(self.points(each.length)) for each in self.drivetrain.elastic}

    @staticmethod
    def points(length: float) -> np.ndarray:
        """Where the deflection of a shaft is given, mm from its left end."""
        return np.linspace(0.0, length, SHAFT_POINTS)

    def curves(self, curves: Mapping[str, np.ndarray], nodes: SideBySide) -> dict[str, np.ndarray]:
        """Departures of the axes in the middle of the common face, um, and loads of the bearings (steps, bearings)."""
        states = nodes.steps.states[:, 0]
        x, y, _, tilt_x, tilt_y = np.moveaxis(self._motions(states), -1, 0)
        heights = np.array(self.pair.gear_middles)
        leaning = {"in_plane": tilt_y, "out_of_plane": -tilt_x}
        offset = {"in_plane": x - heights * tilt_y, "out_of_plane": y + heights * tilt_x}
        width = MICROMETRES * self.pair.face_width
        departures = {f"axis_inclination_{name}": width * np.diff(of)[:, 0] for name, of in leaning.items()}
        departures |= {f"axis_offset_{name}": MICROMETRES * np.diff(of)[:, 0] for name, of in offset.items()}
        loads = [
            (each.motions(self.drivetrain, states) @ each.bearing_loads.T).reshape(len(states), -1, len(MOTIONS))
            for each in self.drivetrain.elastic
        ]
        return (
            super().curves(curves, nodes)
            | departures
            | dict(zip(LOADS, np.moveaxis(np.concatenate(loads, axis=1), -1, 0)))
        )

    def fields(self, nodes: SideBySide) -> dict[str, np.ndarray]:
        """Deflection of both shafts (steps, gears, points), mm; not a number where a shaft has no sections."""
        states = nodes.steps.states[:, 0]
        found = np.full((2, len(states), len(NUMBERS), SHAFT_POINTS), np.nan)
        for each in self.drivetrain.elastic:
            lines = np.einsum("pmn,sn->mps", self._lines[each.gear][:, :2], each.motions(self.drivetrain, states))
            found[:, :, list(NUMBERS).index(each.gear)] = np.moveaxis(lines, 2, 1)
        return super().fields(nodes) | {"shaft_deflection_x": found[0], "shaft_deflection_y": found[1]}

    def coordinates(self) -> dict[str, tuple]:
        """Where bearings and points of the shafts are."""
        elastic = self.drivetrain.elastic
        names = [f"{each.gear} {number + 1}" for each in elastic for number in range(len(each.bearings))]
        places = [bearing.at for each in elastic for bearing in each.bearings]
        points = np.full((len(NUMBERS), SHAFT_POINTS), np.nan)
        for each in elastic:
            points[list(NUMBERS).index(each.gear)] = self.points(each.length)
        from_end = {"units": "mm", "long_name": "distance from the left end of the shaft"}
        return super().coordinates() | {
            "bearing": ("bearing", names, {"long_name": "bearing of a shaft with sections"}),
            "bearing_place": ("bearing", places, from_end),
            "shaft_place": (("gear", "shaft_point"), points, from_end),
        }

    def numbers(self, counted: xr.Dataset) -> dict[str, float | str]:
        """Of the settled steps of a result: means of the axes' departures, the largest force of a bearing, and natural
        frequencies."""
        named = [f"axis_{kind}_{plane}" for kind in ("inclination", "offset") for plane in ("in_plane", "out_of_plane")]
        found: dict[str, float | str] = {f"mean_{name}": float(counted[name].mean()) for name in named}
        forces = np.sqrt(sum(counted[name] ** 2 for name in LOADS[:3]))
        found |= {"largest_bearing_force": float(forces.max())}
        return super().numbers(counted) | found | self._rolling_elements(counted) | self._vibrations(counted)

    def _vibrations(self, counted: xr.Dataset) -> dict[str, str]:
        """Natural frequencies with the mesh as it was, a line each; nothing without inertia or contact."""
        if self.drivetrain.mass is None or "mesh_stiffness_tangent" not in counted:
            return {}
        from fenics_gears.dynamics.frequencies import vibrations

        stiffness = mean_where_positive(counted["mesh_stiffness_tangent"].values)
        if not np.isfinite(stiffness):
            return {}
        found = vibrations(self.drivetrain, stiffness, self.model.scene.friction is not None)
        lines = (f"{each.frequency:.6g} {each.motion}".rstrip() for each in found)
        return {"natural_frequencies": "\n".join(lines)}

    def _rolling_elements(self, counted: xr.Dataset) -> dict[str, float]:
        if not self.drivetrain.on_rolling_bearings:
            return {}
        from fenics_gears.dynamics.shaft_at_work import largest_force

        means = {name: counted[of].mean("time") for name, of in zip(MOTIONS, OF_GEARS)}
        found = (
            largest_force(each, np.array([float(means[name].sel(gear=each.gear)) for name in MOTIONS]))
            for each in self.drivetrain.elastic
        )
        return {"largest_rolling_element_force": max(found)}

    def _motions(self, states: np.ndarray) -> np.ndarray:
        """Motions (steps, gears, 5) of the middles of pinion and wheel."""
        both = [[self.drivetrain.value(states, f"{name}{number}") for name in MOTIONS] for number in NUMBERS.values()]
        return np.moveaxis(np.array(both), 2, 0)
