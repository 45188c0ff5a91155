"""Sizes of the elements over a sector: fine at the flank, growing away from it."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace

import numpy as np

from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear import Gear

from .elements import Element, element_named

# An edge across this angle (rad) cuts less than 0.05 % of its radius off the bore.
HUB_ANGLE = 0.06
# Elements that grow faster than this inwards become slivers.
FASTEST_GROWTH = 0.35


@dataclass(frozen=True)
class ElementSizes:
    """Element sizes of a sector, mm.

    flank: along the working flank, kept down to ``depth`` times itself below it. fillet: along root and fillets. coast:
    along the coast flank and the tip. body: largest size in the tooth and the rim below it; further inside elements go
    on growing. growth: increase of size per distance. both_flanks: the coast flank works too, meshed as the drive
    flank's mirror image. hub_angle: largest angle (rad) of an edge along the bore. mate_tip: roll angles (rad) between
    which the mate's tip edge may press on the flank; there, and near the flank's own tip, elements are finer.
    """

    flank: float
    fillet: float
    coast: float
    body: float
    depth: float = 2.5
    growth: float = 0.35
    both_flanks: bool = False
    hub_angle: float = HUB_ANGLE
    mate_tip: tuple[float, float] | None = None

    def refined(self, factor: float) -> ElementSizes:
        """All sizes but the flank's times `factor`: meshes of several factors are one family, whose error falls with an
        order.

        Growth inwards is limited, and edges along the bore are never made larger, so that elements do not become
        slivers.
        """
        return replace(
            self, fillet=factor * self.fillet, coast=factor * self.coast, body=factor * self.body,
            growth=min(factor * self.growth, max(self.growth, FASTEST_GROWTH)),
            hub_angle=min(factor, 1.0) * self.hub_angle,
        )  # fmt: skip

    def in_modules_of(self, gear: Gear) -> ElementSizes:
        """The sizes as multiples of a gear's module."""
        flank, fillet, coast, body = gear.in_modules(self.flank, self.fillet, self.coast, self.body)
        return replace(self, flank=flank, fillet=fillet, coast=coast, body=body)


# By element order, in modules (the flank's size is always given). Measured with 0.06 mm on the flank: the mean
# compliance under 1 mm of uniform pressure at tip, middle and form circle. It is within 0.05 % (P2, Q2) and 0.3 % (P1,
# Q1) of that of a mesh several times finer everywhere.
DEFAULT_SIZES = {
    1: ElementSizes(flank=np.nan, fillet=0.01, coast=0.02, body=0.08, depth=4.0, growth=0.1),
    2: ElementSizes(flank=np.nan, fillet=0.04, coast=0.08, body=0.3, depth=2.5, growth=0.35),
}


@dataclass(frozen=True)
class Discretisation:
    """How a gear's body is divided into finite elements.

    element: a name of ELEMENTS. flank_element_size, body_element_size: mm, along the working flank and the largest in
    tooth and rim (None: from the module). elastic_teeth: teeth this many pitches apart and further do not interact;
    None: all do. mate_tip: as in ElementSizes.
    """

    element: str
    flank_element_size: float
    body_element_size: float | None = None
    elastic_teeth: int | None = None
    mate_tip: tuple[float, float] | None = None

    def sizes(self, gear: Gear, both_flanks: bool = False) -> ElementSizes:
        """Element sizes (mm) of a gear's sector mesh."""
        sizes = element_sizes(gear, element_named(self.element), self.flank_element_size, self.body_element_size)
        return replace(sizes, both_flanks=both_flanks, mate_tip=self.mate_tip)

    def inputs(self, gear: Gear, both_flanks: bool = False) -> dict:
        """The inputs of a gear's mesh other than the gear, with lengths in modules."""
        sizes = self.sizes(gear, both_flanks).in_modules_of(gear)
        return {"element": element_named(self.element).name, "sizes": asdict(sizes)}


def element_sizes(gear: Gear, element: Element, flank: float, body: float | None = None) -> ElementSizes:
    """Element sizes (mm) of a gear's sector mesh for a wanted size on the flank and, if not None, in the body, which
    scales all others but the flank's. Raises SceneError for a size that is not positive and finite."""
    for name, size in (("flank_element_size", flank), ("body_element_size", body)):
        if size is not None and not (np.isfinite(size) and size > 0.0):
            raise SceneError(f"{name} is {size} mm, must be positive and finite")
    default = DEFAULT_SIZES[element.order]
    fillet, coast, largest = (gear.module * size for size in (default.fillet, default.coast, default.body))
    sizes = replace(default, flank=flank, fillet=fillet, coast=coast, body=largest)
    return sizes if body is None else sizes.refined(body / largest)


@dataclass(frozen=True)
class SizeSource:
    """Curves, points (n, 2) each, around which elements have a size; it grows from ``plateau`` outwards. mm."""

    curves: tuple[np.ndarray, ...]
    size: float
    plateau: float
    growth: float


@dataclass(frozen=True)
class SizeField:
    """The smallest of the sizes of all sources, at most ``largest`` (mm)."""

    sources: tuple[SizeSource, ...]
    largest: float

    def at(self, points) -> np.ndarray:
        """Element size (n,) at points (n, 2), mm."""
        size = np.full(len(points), self.largest)
        distances = {}
        for source in self.sources:
            for curve in source.curves:
                # Sources share curves, and the search takes most of the time.
                if id(curve) not in distances:
                    distances[id(curve)] = _tree(curve).query(points)[0]
            distance = np.min([distances[id(curve)] for curve in source.curves], axis=0)
            size = np.minimum(size, source.size + source.growth * np.maximum(distance - source.plateau, 0.0))
        return size

    def set_background(self, gmsh, points, tags, scale: float) -> None:
        """Make ``scale`` times this field the mesh size of the current gmsh model with points (n, 2) and their tags
        (n,); other points of the sources are ignored."""
        lookup = _tree(points)
        fields = []
        for source in self.sources:
            distance, nearest = lookup.query(np.vstack(source.curves))
            own = np.unique(nearest[distance < 1e-9 * self.largest])
            if not len(own):
                continue
            near = gmsh.model.mesh.field.add("Distance")
            gmsh.model.mesh.field.setNumbers(near, "PointsList", [tags[i] for i in own])
            rise = max(self.largest - source.size, 0.0)
            fields.append(gmsh.model.mesh.field.add("Threshold"))
            for option, value in {
                "InField": near,
                "SizeMin": scale * source.size,
                "SizeMax": scale * (source.size + rise),
                "DistMin": source.plateau,
                "DistMax": source.plateau + max(rise / source.growth, 1e-6 * self.largest),
            }.items():
                gmsh.model.mesh.field.setNumber(fields[-1], option, value)
        smallest = gmsh.model.mesh.field.add("Min")
        gmsh.model.mesh.field.setNumbers(smallest, "FieldsList", fields)
        gmsh.model.mesh.field.setAsBackgroundMesh(smallest)


def arc_lengths(curve: np.ndarray) -> np.ndarray:
    """Lengths (m,) along a finely sampled curve (m, 2) from its first point."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))])


def divided(curve: np.ndarray, size: np.ndarray, fewest: int, multiple: int = 2) -> np.ndarray:
    """Fractions of the arc length of a curve (m, 2) of the nodes for a wanted size (m,), both ends included: a multiple
    of ``multiple`` divisions, at least ``fewest``."""
    length = arc_lengths(curve)
    steps = np.linalg.norm(np.diff(curve, axis=0), axis=1)
    density = np.concatenate([[0.0], np.cumsum(steps * 0.5 * (1.0 / size[1:] + 1.0 / size[:-1]))])
    count = multiple * int(np.ceil(max(density[-1], fewest) / multiple - 1e-9))
    return np.interp(np.linspace(0.0, density[-1], count + 1), density, length) / length[-1]


def along(curve: np.ndarray, fractions: np.ndarray) -> np.ndarray:
    """Points (k, 2) of a finely sampled curve (m, 2) at fractions (k,) of its arc length."""
    length = arc_lengths(curve)
    return np.stack([np.interp(fractions * length[-1], length, curve[:, i]) for i in range(2)], axis=-1)


def _tree(points: np.ndarray):
    # Imported here: a run whose gears are in the cache meshes nothing, and the import takes 0.04 s.
    from scipy.spatial import cKDTree

    return cKDTree(points)
