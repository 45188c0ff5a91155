"""The pinion's teeth in space as plotly's browser library draws them, the largest pressure on the flank of one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from math import isfinite
from typing import Any

import numpy as np
import xarray as xr

from fenics_gears import Gear, GearPair, tooth_outline
from fenics_gears.charts import Chart, Field, tooth_points
from fenics_gears.shown import ShownRun

TEETH = 5
ROWS = 40
FACE_POINTS = 13
# The coloured flank stands off the tooth by this part of a module, so that it is not hidden by it.
STAND_OFF = 0.01
_LIGHT = {"ambient": 0.55, "diffuse": 0.7, "specular": 0.15}


def pinion_in_space(result: xr.Dataset, pair: GearPair, charts: Mapping[str, Sequence[Chart]]) -> dict[str, Any] | None:
    """Some teeth of the pinion, the largest pressure while it is in mesh on the middle one; None without contact
    fields. `charts` of the result by subject."""
    run = ShownRun(result)
    field = _field(run, pair, charts)
    if field is None:
        return None
    flank, pressure = _flank(pair.pinion, field, _twist(pair), run.on_coast_flanks)
    scale = [[place / (len(field.colours) - 1), colour] for place, colour in enumerate(field.colours)]
    bar = {"title": {"text": field.title, "side": "right"}, "thickness": 14, "len": 0.8}
    pressed = {"surfacecolor": pressure, "colorscale": scale, "cmin": 0.0, "cmax": field.limit, "colorbar": bar}
    data = [
        {"type": "surface", "lighting": _LIGHT} | own
        for own in (_body(pair), _points(flank) | {name: _listed(each) for name, each in pressed.items()})
    ]
    axis = {
        "showbackground": False,
        "showgrid": False,
        "zeroline": False,
        "showticklabels": False,
        "title": {"text": ""},
    }
    scene: dict[str, Any] = {"xaxis": axis, "yaxis": axis, "zaxis": axis}
    # From the side of the flank that carries.
    side = float(np.sign(flank[0].mean()))
    scene |= {"aspectmode": "data", "camera": {"eye": {"x": 1.9 * side, "y": -1.2, "z": 1.1}}, "dragmode": "turntable"}
    return {"data": data, "layout": {"scene": scene, "margin": {"l": 0, "r": 0, "t": 0, "b": 0}}}


@lru_cache(maxsize=2)
def _body(pair: GearPair) -> dict[str, Any]:
    """The teeth, which are alike after each move that leaves the gears."""
    half = 0.5 * pair.face_width
    body = _swept(_teeth(pair.pinion), np.linspace(-half, half, FACE_POINTS), _twist(pair))
    grey = [[0.0, "#C9D1D9"], [1.0, "#C9D1D9"]]
    look = {"colorscale": grey, "showscale": False, "hoverinfo": "skip"}
    return _points(body) | look | {"surfacecolor": _listed(np.zeros(body[0].shape))}


def _twist(pair: GearPair) -> float:
    """Turn of the pinion's teeth along the face, rad/mm."""
    return pair.slope / pair.pinion.base_radius


def _field(run: ShownRun, pair: GearPair, charts: Mapping[str, Sequence[Chart]]) -> Field | None:
    """The largest pressure over face and diameter of the pinion; in the plane it is alike all over the face."""
    drawn = charts.get("Contact pattern" if run.over_face else "Contact pressure on the flanks")
    field = drawn[0].field if drawn else None
    if field is None or run.over_face:
        return field
    values = np.nan_to_num(field.values, nan=-np.inf).max(axis=1)
    diameters = 2.0 * pair.pinion.radius(np.radians(field.y))
    half = 0.5 * pair.face_width
    alike = np.where(np.isfinite(values), values, np.nan)[:, None]
    return Field(np.array([-half, half]), diameters, alike, field.title, field.limit, field.colours)


def _teeth(gear: Gear) -> np.ndarray:
    """Outline (n, 2), mm, of some teeth, the middle one upright."""
    tooth = _upright(gear, tooth_points(gear))
    turned = gear.angular_pitch * (np.arange(TEETH) - TEETH // 2)
    return np.vstack([_turned(tooth, angle) for angle in turned])


def _upright(gear: Gear, points: np.ndarray) -> np.ndarray:
    return _turned(points, 0.5 * np.pi - tooth_outline(gear, 3).centreline_angle)


def _turned(points: np.ndarray, angle: Any) -> np.ndarray:
    cosine = np.cos(angle)
    sine = np.sin(angle)
    x, y = np.moveaxis(points, -1, 0)
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=-1)


def _swept(points: np.ndarray, places: np.ndarray, twist: float) -> np.ndarray:
    """Surface (3, n, m), mm: points (n, 2) at places (m,) along the face, turned by the helix."""
    turned = _turned(points[:, None, :], twist * places)
    along = np.broadcast_to(places, turned.shape[:2])
    return np.stack([turned[..., 0], along, turned[..., 1]])


def _flank(gear: Gear, field: Field, twist: float, coast: bool) -> tuple[np.ndarray, np.ndarray]:
    """The surface (3, r, m) of the middle tooth's flank that carries, and the pressure (r, m) on it."""
    rows = np.linspace(max(0.5 * field.y[0], gear.form_radius), min(0.5 * field.y[-1], gear.tip_form_radius), ROWS)
    outline = tooth_outline(gear, 3)
    points = outline.involute(gear.roll_angle(rows))
    points = _upright(gear, outline.coast(points) if coast else points)
    outwards = np.sign(points[:, 0].mean()) * STAND_OFF * gear.module
    surface = _swept(points + np.array([outwards, 0.0]), field.x, twist)
    inner = np.clip(np.searchsorted(field.y, 2.0 * rows) - 1, 0, len(field.y) - 2)
    of_cells = np.nan_to_num(field.values[inner], nan=0.0)
    # Values of cells at the edges between them.
    columns = np.hstack([of_cells[:, :1], 0.5 * (of_cells[:, 1:] + of_cells[:, :-1]), of_cells[:, -1:]])
    return surface, columns


def _points(surface: np.ndarray) -> dict[str, Any]:
    return {name: _listed(values) for name, values in zip("xyz", surface)}


def _listed(values: Any) -> Any:
    if not isinstance(values, np.ndarray):
        return values
    return [[float(f"{each:.5g}") if isfinite(each) else None for each in row] for row in values.tolist()]
