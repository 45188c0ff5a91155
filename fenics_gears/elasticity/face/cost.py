"""Expected size of a gear's body in three dimensions, and what its condensation takes: sizes of dense matrices are
counted."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.outline import centreline_angle

from ..element_sizes import ElementSizes, SizeField
from ..sector_boundary import SectorBoundary, sector_boundary
from .discretisation import FaceDiscretisation
from .layer_cost import LayerCost, LayeredSize, eliminating
from .near_field import thin_layers

# Nodes of a section by points of its outline, and by its area in squares of its elements' size: within 18 % of 110
# sections from 0.1 to 1.4 modules, of 18 to 110 teeth, with thin rims too.
BY_OUTLINE, BY_AREA = 4.2, 3.9
# Of a section on either side, where its area is measured. Modules from the root circle to a tooth's neck, which is two
# wide.
SAMPLES, NECK = 60, 0.3
# Bytes, measured: for each entry of the condensed stiffness, which the ring takes several of; of a sector that is not
# folded for each unknown, by MUMPS, and each entry.
PER_ENTRY = 24.0
WHOLE_UNKNOWN, WHOLE_ENTRY = 12e3, 40.0
# Part of the motions of flanks by cuts that are told apart, and of those by which far teeth move each other.
SHAPES, FAR = 0.4, 0.1


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
    """What condensing takes beside the program: bytes at most, and multiplications of dense matrices."""

    memory: float
    operations: float


@dataclass(frozen=True)
class _Section:
    """Nodes of a section, second order: of all, of the tooth's part, on half its neck, on the tooth's and the body's
    part of the centreline, on a flank, a cut, the bore; of them in a web's layers alone, all and on a cut."""

    nodes: float
    tooth: float
    neck: float
    middle: tuple[float, float]
    flank: int
    cut: int
    hub: int
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
    rows, (upper, lower) = web + of_hub, rim.middle
    return replace(
        rim, nodes=rim.nodes + rows * rim.hub, middle=(upper, lower + rows), cut=rim.cut + rows,
        web=(web - 1) * rim.hub, web_cut=web - 1,
    )  # fmt: skip


def _of_outline(gear: Gear, boundary: SectorBoundary, field: SizeField) -> _Section:
    flank, cut, hub = (2 * len(boundary.part(name)) - 1 for name in ("flank", "lower cut", "hub"))
    low, high = boundary.points.min(axis=0), boundary.points.max(axis=0)
    steps = (np.arange(SAMPLES) + 0.5) / SAMPLES
    places = np.stack(np.meshgrid(*(low + (high - low) * steps[:, None]).T), axis=-1).reshape(-1, 2)
    places = places[_within(places, boundary.points)]
    squares = np.prod((high - low) / SAMPLES) / field.at(places) ** 2
    neck = gear.root_radius + NECK

    def nodes(least: float) -> float:
        above = [np.linalg.norm(points, axis=1) > least for points in (boundary.points, places)]
        return BY_OUTLINE * float(above[0].sum()) + BY_AREA * float(squares[above[1]].sum())

    def middle(inner: float, outer: float) -> float:
        return (
            2.0 * (outer - inner) * float((1.0 / field.at((inner + (outer - inner) * steps)[:, None] * along)).mean())
        )

    angle = centreline_angle(gear)
    along = np.array([np.cos(angle), np.sin(angle)])
    parts = max(middle(neck, gear.tip_radius), flank), max(middle(gear.bore_radius, neck), cut)
    half_neck = max(2.0 / float(field.at(neck * along[None])[0]), 0.5 * flank)
    return _Section(nodes(0.0), nodes(neck), half_neck, parts, flank, cut, hub)


def _within(places: np.ndarray, outline: np.ndarray) -> np.ndarray:
    """Whether places (n, 2) are within a closed outline (m, 2): a ray from there crosses it an odd number of times."""
    found, (x, y) = np.zeros(len(places), dtype=bool), places.T
    for (x0, y0), (x1, y1) in zip(outline, np.roll(outline, -1, axis=0)):
        crossed = np.flatnonzero((y0 > y) != (y1 > y))
        found[crossed] ^= x[crossed] < x0 + (x1 - x0) * (y[crossed] - y0) / (y1 - y0)
    return found


def expected_size(gear: Gear, face: FaceDiscretisation, both_flanks: bool = False) -> BodySize:
    """Of a gear's sector with its bore held."""
    section, scaled = _section(gear.of_module_one, face.in_modules_of(gear).sizes), face.in_modules_of(gear)
    heights = len(scaled.sweep.heights)
    thin = heights if face.web is None else _heights_of_web(scaled)
    unknowns = 3 * heights * (section.nodes - section.hub - section.web) + 3 * thin * section.web
    cut = 3 * heights * (section.cut - 1 - section.web_cut) + 3 * thin * section.web_cut
    return BodySize(round(unknowns), (2 if both_flanks else 1) * 3 * heights * section.flank, cut)


def near_unknowns(gear: Gear, face: FaceDiscretisation, both_flanks: bool = False) -> float:
    """Of the held teeth whose thin layers tell what a body's layers leave out: one for each run of neighbours, which
    the coast flank has in reverse."""
    scaled = face.in_modules_of(gear)
    thick = [round(each, 9) for each in scaled.sweep.thicknesses.tolist()]
    runs = {tuple(thick[max(number - 1, 0) : number + 2]) for number in range(len(thick))}
    if both_flanks:
        runs |= {run[::-1] for run in runs}
    heights = sum(2 * sum(thin_layers(each) for each in run) + 1 for run in runs)
    return 3.0 * heights * _section(gear.of_module_one, scaled.sizes).tooth


def _heights_of_web(face: FaceDiscretisation) -> int:
    heights = face.sweep.heights
    return int(((heights >= face.web.low) & (heights <= face.web.high)).sum())


def expected_condensing(gear: Gear, face: FaceDiscretisation, farthest: int, both_flanks: bool = False) -> BodyCost:
    """What a process takes while it condenses a sector and joins the ring; teeth feel each other up to `farthest`."""
    size = expected_size(gear, face, both_flanks)
    ring = PER_ENTRY * size.condensed**2
    if not face.sweep.alike:
        memory = WHOLE_UNKNOWN * size.unknowns + WHOLE_ENTRY * size.condensed**2
        # MUMPS condenses, and complex harmonics take four times the operations (measured, of 35 and 61 teeth).
        return BodyCost(memory, 0.8 * size.condensed**3 + 4.0 * _ring(size, gear.teeth, farthest))
    most, operations = 0.0, 0.0
    for part in _parts(_section(gear.of_module_one, face.in_modules_of(gear).sizes)):
        layers = LayerCost.of(part, face.sweep.kinds)
        most = max(most, layers.numbers, 1.5 * layers.size**2)
        operations += layers.operations + 2.0 * eliminating(layers.size / 6.0, layers.size / 3.0)
    return BodyCost(max(8.0 * most, ring), operations + _ring(size, gear.teeth, farthest))


def _parts(section: _Section) -> tuple[LayeredSize, LayeredSize]:
    """Half a section's tooth and body: dofs of a height."""
    tooth, body = 0.5 * section.tooth, 0.5 * (section.nodes - section.tooth - section.hub)
    lines = section.flank + section.neck + section.middle[0], section.cut + section.neck + section.middle[1]
    web, web_lines = 0.5 * section.web, 2.0 * section.web_cut
    of_tooth = LayeredSize(*({True: 3.0 * each, False: 3.0 * each} for each in (max(tooth - lines[0], 0.0), lines[0])))
    inside = {True: 3.0 * max(body - lines[1], 0.0), False: 3.0 * max(body - web - lines[1] + web_lines, 0.0)}
    return of_tooth, LayeredSize(inside, {True: 3.0 * lines[1], False: 3.0 * (lines[1] - web_lines)})


def _ring(size: BodySize, teeth: int, farthest: int) -> float:
    """Multiplications by which sectors are joined, harmonic by harmonic (`half_turn`)."""
    shapes, cut, few = SHAPES * size.flanks, size.cut, 2 * max(farthest, 3) + 1
    whole = cut**3 / 6.0 + 0.5 * cut**2 * shapes + 0.5 * cut * shapes**2
    if few > 0.35 * teeth:
        return (teeth // 2 + 1) * whole
    return (few // 2 + 1) * whole + (teeth // 2 + 1) * (cut**3 / 6.0 + 0.5 * cut**2 * FAR * shapes)
