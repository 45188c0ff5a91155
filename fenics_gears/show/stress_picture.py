"""The gears of a run in mesh at one time, deformed and coloured by von Mises stress, in the plane; over the face by
`face_picture`."""

from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import TriMesh
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation

from fenics_gears.results.pairs import contact_times
from fenics_gears.simulation.run_stresses import GearsInMesh

from .chart import Chart
from .drawn_scale import automatic_scale
from .face_picture import DPI, DPI_OF_FRAMES, face_picture, root_tension
from .loaded_contact import LoadedContact, loaded_contact, stored_place
from .panels import DARK, framed, styled
from .picture_marks import frame_in, length_bar, line_of_action, name_gears
from .stress_grid import View, fitted, shown_points, teeth_view, whole_view
from .stress_heading import COLOURS, colour_bar, heading, rounded_up

# Triangles of a gear in a panel, at least: with fewer their edges are visible in the colours.
LEAST_TRIANGLES = 20_000
# The colours end at this multiple of the largest stress in the fillets: what touches would else leave no colour for the
# roots.
ROOTS_IN_COLOURS = 3.0
# In millimetres of flank around the most loaded contact, in Hertz half-widths.
CLOSE_UP_HALF_WIDTHS = 5.0
# What a picture names of the pressure at its time.
PRESSURES = {
    "largest_contact_pressure": "largest contact pressure",
    "largest_edge_pressure": "pressure at an edge",
    "largest_kink_pressure": "pressure at a kink of relief",
}
# Inches at 100 dots of a frame of a moving picture.
FRAME_WIDTH = 9.6


def colour_limit(meshes: list[GearsInMesh]) -> float:
    """Stress (MPa) at which the colours end: the largest or, where contact exceeds it by far, a multiple of the largest
    in the fillets. Over the face it is the largest in the roots."""
    roots = max(_stress_of_roots(mesh) for mesh in meshes)
    if meshes[0].over_face:
        return rounded_up(roots)
    peak = max(float(body.von_mises.max()) for mesh in meshes for body in mesh.gears)
    return rounded_up(min(peak, ROOTS_IN_COLOURS * roots) if roots > 0.0 else peak)


def _stress_of_roots(mesh: GearsInMesh) -> float:
    return max(float(body.von_mises[..., body.in_root].max(initial=0.0)) for body in mesh.gears)


def still(mesh: GearsInMesh, dataset: xr.Dataset, scale: float | None = None) -> Figure:
    """The picture of one time; `scale` of the displacements: unless given the largest suitable one, over the face 1."""
    return frames(dataset, scale, [mesh], moving=False)(mesh)


def charts_of(mesh: GearsInMesh) -> tuple[str, list[Chart]]:
    """What the picture of one time shows, in words, and the charts next to it."""
    if not mesh.over_face:
        return "Von Mises stress", []
    return "Contact pressure and von Mises stress", [root_tension(mesh)]


def frames(
    dataset: xr.Dataset, scale: float | None, sampled: list[GearsInMesh], moving: bool = True
) -> Callable[[GearsInMesh], Figure]:
    """What draws the pictures of a run, with the colours and the scale that suit some of its meshes; `moving`: as
    frames, smaller and without the single contact."""
    limit = colour_limit(sampled)
    beyond = any(exceeds(mesh, limit) for mesh in sampled)
    if sampled[0].over_face:
        dots = DPI_OF_FRAMES if moving else DPI
        scale = 1.0 if scale is None else scale
        return lambda mesh: face_picture(mesh, dataset, scale, limit, beyond, dots)
    scale = automatic_scale(sampled) if scale is None else scale
    size = {"close_up": False, "width": FRAME_WIDTH} if moving else {}
    return lambda mesh: stress_picture(mesh, dataset, scale=scale, limit=limit, beyond=beyond, **size)


@styled
def stress_picture(
    mesh: GearsInMesh,
    dataset: xr.Dataset,
    *,
    scale: float,
    limit: float,
    close_up: bool = True,
    width: float = 16.0,
    beyond: bool = False,
) -> Figure:
    """Both gears, their teeth in contact enlarged, and with `close_up` the most loaded contact itself.

    scale: of the displacement. limit: MPa, where the colours end; `beyond`: the colour bar has an arrow there in any
    case. width: inches of a figure 16 to 9.
    """
    figure = Figure(figsize=(16.0, 9.0), dpi=100.0 * width / 16.0)
    loaded = loaded_contact(mesh, dataset)
    coast = mesh.coast
    enlarged = close_up and loaded is not None
    bottom = 0.06
    high = 0.79
    wide = 0.40 if enlarged else 0.585
    left = _panel(figure, (0.015, bottom, 0.30, high), whole_view(mesh), mesh, scale, limit)
    middle = _panel(figure, (0.325, bottom, wide, high), teeth_view(mesh, coast), mesh, scale, limit)
    left.set_title(f"The pair, displacements × {scale:g}")
    middle.set_title(f"Teeth in contact, displacements × {scale:g}")
    name_gears(left, mesh, driving=1 if coast else 0)
    for axes in (left, middle):
        line_of_action(axes, mesh, coast, labelled=axes is middle)
    frame_in(left, middle)
    if enlarged:
        right = _panel(figure, (0.735, 0.36, 0.19, 0.49), contact_view(loaded), mesh, 1.0, limit)
        right.set_title("Most loaded contact, displacements × 1")
        frame_in(middle, right, moved=_moved(mesh, loaded.point, scale))
        length_bar(right)
        _numbers(figure, mesh, dataset, (0.735, 0.30))
    colour_bar(figure, limit, beyond or exceeds(mesh, limit), "von Mises stress (MPa), plane strain")
    heading(figure, mesh, dataset)
    return figure


def contact_view(contact: LoadedContact) -> View:
    """A contact with some Hertz half-widths around it."""
    return View(contact.point, CLOSE_UP_HALF_WIDTHS * contact.half_width * np.ones(2))


def _moved(mesh: GearsInMesh, point: np.ndarray, scale: float) -> np.ndarray:
    """How far the bodies at a point of the picture are drawn from where they are at scale 1."""
    nearest = [np.argmin(((shown_points(mesh, gear, 0.0) - point) ** 2).sum(axis=1)) for gear in (0, 1)]
    drawn, true = ([shown_points(mesh, gear, each)[node] for gear, node in enumerate(nearest)] for each in (scale, 1.0))
    return np.mean(np.subtract(drawn, true), axis=0)


def _panel(figure: Figure, place, wanted: View, mesh: GearsInMesh, scale: float, limit: float) -> Axes:
    axes = figure.add_axes(place, xticks=[], yticks=[])
    view = fitted(wanted, place[2] * 16.0, place[3] * 9.0)
    for gear, body in enumerate(mesh.gears):
        points = shown_points(mesh, gear, scale)
        cells, sides = (_in_view(points, body.of_sectors(part), view) for part in (body.section.subcells, body.outline))
        if len(cells):
            x, y, stress = _triangles(points, cells, body.von_mises.ravel()).reshape(-1, 3).T
            # `tripcolor` does the same and takes three times as long, for the edges of all triangles.
            triangles = Triangulation(x, y, np.arange(len(x)).reshape(-1, 3))
            coloured = TriMesh(triangles, array=stress, cmap=COLOURS, norm=Normalize(0.0, limit))
            axes.add_collection(coloured, autolim=False)
            # Sides apart from each other in one line.
            x, y = np.insert(points[sides], 2, np.nan, axis=1).reshape(-1, 2).T
            axes.plot(x, y, color=DARK, linewidth=0.9, solid_capstyle="round")
    axes.set_xlim(view.extent[:2])
    axes.set_ylim(view.extent[2:])
    framed(axes)
    return axes


def _triangles(points: np.ndarray, cells: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Cells as triangles (k, 3, 3), at each corner x, y and value; divided until their edges are not visible in the
    colours."""
    # Four corners are two triangles.
    triangles = np.vstack([cells[:, [0, second, second + 1]] for second in range(1, cells.shape[1] - 1)])
    corners = np.column_stack([points, values])[triangles]
    while len(corners) < LEAST_TRIANGLES:
        a, b, c = corners.transpose(1, 0, 2)
        ab = 0.5 * (a + b)
        bc = 0.5 * (b + c)
        ca = 0.5 * (c + a)
        corners = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3, 3)
    return corners


def _in_view(points: np.ndarray, parts: np.ndarray, view: View) -> np.ndarray:
    left, right, bottom, top = view.extent
    x = points[parts, 0]
    y = points[parts, 1]
    return parts[(x.max(axis=1) > left) & (x.min(axis=1) < right) & (y.max(axis=1) > bottom) & (y.min(axis=1) < top)]


def _numbers(figure: Figure, mesh: GearsInMesh, dataset: xr.Dataset, place) -> None:
    index = stored_place(mesh, dataset)
    dataset = contact_times(dataset)
    names = ("normal_force", "coast_normal_force", *PRESSURES)
    values = {name: float(dataset[name].values[index]) for name in names if name in dataset}
    peaks = [float(body.von_mises.max()) for body in mesh.gears]
    lines = [
        f"mesh force {max(values['normal_force'], values.get('coast_normal_force', 0.0)):.0f} N",
        *(f"{words} {values[name]:.0f} MPa" for name, words in PRESSURES.items() if values.get(name)),
        f"largest von Mises stress {max(peaks):.0f} MPa",
        f"largest in the fillets {_stress_of_roots(mesh):.0f} MPa",
        f"{'approach and backlash' if mesh.coast else 'approach of the flanks'} {1e3 * mesh.approach:.1f} µm",
    ]
    figure.text(*place, "\n".join(lines), fontsize=11.5, color=DARK, va="top", linespacing=1.45)


def exceeds(mesh: GearsInMesh, limit: float) -> bool:
    """Whether there is more stress than the colours go to; over the face on other surfaces than the flanks that
    carry."""
    drawn = (body.von_mises[..., ~body.on_flank] if mesh.over_face else body.von_mises for body in mesh.gears)
    return max(float(each.max()) for each in drawn) > limit * (1.0 + 1e-9)


def save_picture(figure: Figure, path: Path | BinaryIO) -> None:
    """Save the picture as PNG, in the pixels it was drawn in."""
    FigureCanvasAgg(figure).print_png(path, metadata={"Software": None})
