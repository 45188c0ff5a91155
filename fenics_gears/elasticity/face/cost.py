"""Expected size of a gear's body in three dimensions, and what its condensation takes: sizes of dense matrices are
counted."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from fenics_gears.geometry.gear import Gear

from ..element_sizes import ElementSizes, SizeField
from ..sector_boundary import SectorBoundary, sector_boundary
from .coarse_cuts import boundaries_where_deep, is_deep, narrow_sweep
from .discretisation import FaceDiscretisation

# Nodes of a section by points of its outline, and by its area in squares of its elements' size. They are within 18 %
# for 110 sections from 0.1 to 1.4 modules, of 18 to 110 teeth, with thin rims too.
BY_OUTLINE, BY_AREA = 4.2, 3.9
# Of a section on either side, where its area is measured. Modules from the root circle to a tooth's neck, which is two
# wide.
SAMPLES, NECK = 60, 0.3
# Measured, of sectors of 16,000 to 49,000 unknowns: bytes that MUMPS takes for each unknown, and for each entry of the
# condensed stiffness; multiplications for each square of the unknowns.
BYTES_OF_AN_UNKNOWN = 12e3
BYTES_OF_AN_ENTRY = 26.0
CONDENSING = 90.0
# Motions of a cut, and loads that cause them, in the dofs of a flank.
MOTIONS, LOADS = 0.3, 0.15


class BodySize(NamedTuple):
    """Dofs of a gear's sector, of its flank (or flanks) and of a cut."""

    unknowns: int
    flanks: int
    cut: int

    @property
    def condensed(self) -> int:
        return self.flanks + 2 * self.cut


@dataclass(frozen=True)
class BodyCost:
    """The cost of condensing: bytes at most, not counting the program's own, and multiplications of dense matrices."""

    memory: float
    operations: float


@dataclass(frozen=True)
class _Section:
    """Nodes of a section, second order: all, of the tooth's part, on a flank, a cut, the bore; of the cut's those that
    are deep (`coarse_cuts`), without the bore's. In a web's layers alone: all and on a cut."""

    nodes: float
    tooth: float
    flank: int
    cut: int
    hub: int
    deep: int
    web: float = 0.0
    web_cut: int = 0


# Each of many runs of the same gears asks for it.
@lru_cache(maxsize=64)
def _section(gear: Gear, sizes: ElementSizes) -> _Section:
    """Of a gear of module one."""
    if gear.web is None:
        return _of_outline(gear, *sector_boundary(gear, sizes))
    # Imported here: gears without web have none of it.
    from .web import rim_of, rows_of_web

    rim = _of_outline(rim_of(gear), *sector_boundary(rim_of(gear), sizes))
    web, of_hub = rows_of_web(gear, (rim.hub - 1) // 2)
    rows = web + of_hub
    nodes = rim.nodes + rows * rim.hub
    return replace(rim, nodes=nodes, cut=rim.cut + rows, web=(web - 1) * rim.hub, web_cut=web - 1)


def _of_outline(gear: Gear, boundary: SectorBoundary, field: SizeField) -> _Section:
    flank, cut, hub = (2 * len(boundary.part(name)) - 1 for name in ("flank", "lower cut", "hub"))
    radii = np.sort(gear.sign * np.linalg.norm(boundary.points[np.unique(boundary.part("lower cut"))], axis=1))
    deep = is_deep(np.concatenate([radii[1:], 0.5 * (radii[1:] + radii[:-1])]), gear.teeth)
    low, high = boundary.points.min(axis=0), boundary.points.max(axis=0)
    steps = (np.arange(SAMPLES) + 0.5) / SAMPLES
    places = np.stack(np.meshgrid(*(low + (high - low) * steps[:, None]).T), axis=-1).reshape(-1, 2)
    places = places[_within(places, boundary.points)]
    squares = np.prod((high - low) / SAMPLES) / field.at(places) ** 2
    neck = gear.root_radius + NECK

    def nodes(least: float) -> float:
        above = [gear.sign * np.linalg.norm(points, axis=1) > least for points in (boundary.points, places)]
        return BY_OUTLINE * float(above[0].sum()) + BY_AREA * float(squares[above[1]].sum())

    return _Section(nodes(-np.inf), nodes(neck), flank, cut, hub, int(deep.sum()))


def _within(places: np.ndarray, outline: np.ndarray) -> np.ndarray:
    """Whether places (n, 2) are within a closed outline (m, 2): a ray from there crosses it an odd number of times."""
    inside, (x, y) = np.zeros(len(places), dtype=bool), places.T
    for (x0, y0), (x1, y1) in zip(outline, np.roll(outline, -1, axis=0)):
        crossed = np.flatnonzero((y0 > y) != (y1 > y))
        inside[crossed] ^= x[crossed] < x0 + (x1 - x0) * (y[crossed] - y0) / (y1 - y0)
    return inside


def expected_size(gear: Gear, face: FaceDiscretisation, both_flanks: bool = False) -> BodySize:
    """Of a gear's sector with its bore held."""
    section, scaled = _section(gear.of_module_one, face.in_modules_of(gear).sizes), face.in_modules_of(gear)
    heights = len(scaled.sweep.heights)
    thin = heights if face.web is None else _heights_of_web(scaled)
    unknowns = 3 * heights * (section.nodes - section.hub - section.web) + 3 * thin * section.web
    pitch = gear.of_module_one.root_radius * gear.angular_pitch
    deep = 2 * len(boundaries_where_deep(scaled.sweep, pitch)) - 1 - heights
    cut = 3 * heights * (section.cut - 1 - section.web_cut) + 3 * thin * section.web_cut + 3 * deep * section.deep
    return BodySize(round(unknowns), (2 if both_flanks else 1) * 3 * heights * section.flank, cut)


def held_dofs(gear: Gear, face: FaceDiscretisation) -> float:
    """Of a section of the held tooth whose thin layers tell what a body's layers leave out."""
    return 3.0 * _section(gear.of_module_one, face.in_modules_of(gear).sizes).tooth


def _heights_of_web(face: FaceDiscretisation) -> int:
    heights = face.sweep.heights
    return int(((heights >= face.web.low) & (heights <= face.web.high)).sum())


def expected_condensing(gear: Gear, face: FaceDiscretisation, farthest: int, both_flanks: bool = False) -> BodyCost:
    """What a process takes while it condenses a sector and joins the ring; teeth feel each other up to `farthest`."""
    size = expected_size(gear, face, both_flanks)
    sweep = face.sweep
    narrow = narrow_sweep(sweep, 2.0 * np.pi * gear.root_radius / gear.teeth)
    factorised = size.unknowns * len(narrow.heights) / len(sweep.heights)
    condensing = BYTES_OF_AN_UNKNOWN * factorised + BYTES_OF_AN_ENTRY * size.condensed**2
    multiplications = CONDENSING * factorised**2 + _ring(size, gear.tooth_count, farthest)
    return BodyCost(condensing, multiplications)


def _ring(size: BodySize, teeth: int, farthest: int) -> float:
    """Multiplications by which sectors are joined (`cut_motions`, `ring.joined_blocks`)."""
    motions = MOTIONS * size.flanks
    flanks = size.flanks**3 / 3.0 + 2.0 * size.flanks * size.cut * (size.flanks + size.cut)
    moved = 6.0 * size.cut**3 + 30.0 * size.cut**2 * LOADS * size.flanks
    blocks = (farthest + 1) * 2.0 * motions * size.flanks * (size.flanks + 2.0 * motions)
    return flanks + moved + blocks + 2.0 * (teeth // 2 + 1) * motions**3
