"""The gears of a run in mesh at one time, deformed and coloured by von Mises stress: in the plane here, over the face
in three dimensions by `face_picture`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import BinaryIO

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.collections import TriMesh
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Arc, FancyArrowPatch, Rectangle
from matplotlib.patheffects import withStroke
from matplotlib.tri import Triangulation

from fenics_gears.results.pairs import contact_times
from fenics_gears.show.drawn_scale import automatic_scale
from fenics_gears.show.loaded_contact import LoadedContact, loaded_contact, stored_place
from fenics_gears.show.panels import DARK, WARNING, styled
from fenics_gears.show.run import conditions, scene_of
from fenics_gears.show.stress_grid import shown_points, upright
from fenics_gears.simulation.run_stresses import GearsInMesh

# Pale where nothing happens, so that the bodies stay in the background; steps closer at the lower end, where the roots
# are.
COLOURS = LinearSegmentedColormap.from_list("stress", [
    (0.0, "#F1F3F5"), (0.1, "#B4D0E8"), (0.24, "#539FD0"), (0.4, "#35A388"), (0.58, "#F0D24A"), (0.79, "#EB7A2F"),
    (1.0, "#A90E18"),
])  # fmt: skip
# Triangles of a gear in a panel, at least: with fewer their edges are seen in the colours.
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
# Radii, points: of a bore that a gear's name fits into with its arrow, and of that arrow.
LEAST_BORE, LEAST_ARROW = 28.0, 12.0


@dataclass(frozen=True)
class View:
    """A part of the picture's plane: its centre (x, y) and half its width and height, mm."""

    centre: np.ndarray
    half: np.ndarray

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, bottom, top, mm."""
        (x, y), (w, h) = self.centre, self.half
        return x - w, x + w, y - h, y + h


def colour_limit(meshes: list[GearsInMesh]) -> float:
    """Stress (MPa) at which the colours end: the largest, or a multiple of that in the fillets where contact exceeds it
    by far; over the face, where the pressure has colours of its own, the largest in the roots."""
    roots = max(_stress_of_roots(mesh) for mesh in meshes)
    if meshes[0].over_face:
        return rounded_up(roots)
    peak = max(float(body.von_mises.max()) for mesh in meshes for body in mesh.gears)
    return rounded_up(min(peak, ROOTS_IN_COLOURS * roots) if roots > 0.0 else peak)


def rounded_up(stress: float) -> float:
    """A stress (MPa) rounded up to two digits; 1 where there is none."""
    if stress <= 0.0:
        return 1.0
    step = 10.0 ** (np.floor(np.log10(stress)) - 1.0)
    return float(np.ceil(stress / step - 1e-9) * step)


def _stress_of_roots(mesh: GearsInMesh) -> float:
    return max(float(body.von_mises[..., body.in_root].max(initial=0.0)) for body in mesh.gears)


def still(mesh: GearsInMesh, dataset: xr.Dataset, scale: float | None = None) -> Figure:
    """The picture of one time; `scale` of the displacements: unless given the largest suitable one, in three dimensions
    true."""
    return frames(dataset, scale, [mesh], moving=False)(mesh)


def frames(
    dataset: xr.Dataset, scale: float | None, sampled: list[GearsInMesh], moving: bool = True
) -> Callable[[GearsInMesh], Figure]:
    """What draws the pictures of a run, with the colours and the scale that suit some of its meshes; `moving`: as
    frames, smaller and without the single contact."""
    limit = colour_limit(sampled)
    beyond = any(exceeds(mesh, limit) for mesh in sampled)
    if sampled[0].over_face:
        # Imported here: plane runs have no picture in three dimensions.
        from fenics_gears.show.face_picture import DPI, DPI_OF_FRAMES, face_picture

        dots, scale = DPI_OF_FRAMES if moving else DPI, 1.0 if scale is None else scale
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

    scale: of the displacement. limit: MPa, where the colours end; `beyond`: the colour bar has an arrow there whether
        this mesh exceeds it
    or not. width: inches of a figure 16 to 9.
    """
    figure = Figure(figsize=(16.0, 9.0), dpi=100.0 * width / 16.0)
    loaded = loaded_contact(mesh, dataset)
    coast = mesh.coast
    enlarged = close_up and loaded is not None
    bottom, high, wide = 0.06, 0.79, 0.40 if enlarged else 0.585
    left = _panel(figure, (0.015, bottom, 0.30, high), whole_view(mesh), mesh, scale, limit)
    middle = _panel(figure, (0.325, bottom, wide, high), teeth_view(mesh, coast), mesh, scale, limit)
    left.set_title(f"The pair, displacements × {scale:g}")
    middle.set_title(f"Teeth in contact, displacements × {scale:g}")
    _name_gears(left, mesh, driving=1 if coast else 0)
    for axes in (left, middle):
        _line_of_action(axes, mesh, coast, labelled=axes is middle)
    _frame_in(left, middle)
    if enlarged:
        right = _panel(figure, (0.735, 0.36, 0.19, 0.49), contact_view(loaded), mesh, 1.0, limit)
        right.set_title("Most loaded contact, displacements × 1")
        _frame_in(middle, right, moved=_moved(mesh, loaded.point, scale))
        _length_bar(right)
        _numbers(figure, mesh, dataset, (0.735, 0.30))
    colour_bar(figure, limit, beyond or exceeds(mesh, limit), "von Mises stress (MPa), plane strain")
    heading(figure, mesh, dataset)
    return figure


def whole_view(mesh: GearsInMesh) -> View:
    """Both gears with some room around them."""
    tips = mesh.pair.pinion.tip_radius, mesh.pair.wheel.tip_radius
    low, high = -mesh.pair.centre_distance - tips[1], tips[0]
    half = np.array([max(tips), 0.5 * (high - low)]) * 1.04
    return View(np.array([0.0, 0.5 * (low + high)]), half)


def teeth_view(mesh: GearsInMesh, coast: bool) -> View:
    """The teeth along the path of contact of drive or coast flanks, their roots included."""
    pair = mesh.pair
    middle = 0.5 * (pair.path_start + pair.path_end)
    centre = upright(pair, np.array([middle, -pair.pinion.base_radius]), coast)
    depth = pair.pinion.tip_radius + pair.wheel.tip_radius - pair.centre_distance + 4.0 * pair.pinion.module
    return View(centre, np.array([0.75 * (pair.path_end - pair.path_start), 0.5 * depth]))


def contact_view(contact: LoadedContact) -> View:
    """A contact with some Hertz half-widths around it."""
    return View(contact.point, CLOSE_UP_HALF_WIDTHS * contact.half_width * np.ones(2))


def _moved(mesh: GearsInMesh, point: np.ndarray, scale: float) -> np.ndarray:
    """How far the bodies at a point of the picture are drawn from where they are at scale 1."""
    nearest = [np.argmin(((shown_points(mesh, gear, 0.0) - point) ** 2).sum(axis=1)) for gear in (0, 1)]
    return np.mean(
        [
            shown_points(mesh, gear, scale)[node] - shown_points(mesh, gear, 1.0)[node]
            for gear, node in enumerate(nearest)
        ],
        axis=0,
    )


def fitted(view: View, width: float, height: float) -> View:
    """The view widened one way until it has a panel's shape."""
    half = view.half
    return View(view.centre, np.array([max(half[0], half[1] * width / height), max(half[1], half[0] * height / width)]))


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
            axes.add_collection(
                TriMesh(triangles, array=stress, cmap=COLOURS, norm=Normalize(0.0, limit)), autolim=False
            )
            # Sides apart from each other in one line.
            x, y = np.insert(points[sides], 2, np.nan, axis=1).reshape(-1, 2).T
            axes.plot(x, y, color=DARK, linewidth=0.9, solid_capstyle="round")
    axes.set_xlim(view.extent[:2])
    axes.set_ylim(view.extent[2:])
    axes.grid(False)
    for spine in axes.spines.values():
        spine.set_visible(True)
        spine.set_color("#BBBBBB")
    return axes


def _triangles(points: np.ndarray, cells: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Cells as triangles (k, 3, 3), at each corner x, y and value; divided until there are many, since colours are
    blended between corners."""
    # Four corners are two triangles.
    corners = np.column_stack([points, values])[
        np.vstack([cells[:, [0, second, second + 1]] for second in range(1, cells.shape[1] - 1)])
    ]
    while len(corners) < LEAST_TRIANGLES:
        a, b, c = corners.transpose(1, 0, 2)
        ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
        corners = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3, 3)
    return corners


def _in_view(points: np.ndarray, parts: np.ndarray, view: View) -> np.ndarray:
    """Cells or sides (k, j) that reach into a view."""
    left, right, bottom, top = view.extent
    x, y = points[parts, 0], points[parts, 1]
    return parts[(x.max(axis=1) > left) & (x.min(axis=1) < right) & (y.max(axis=1) > bottom) & (y.min(axis=1) < top)]


def _line_of_action(axes: Axes, mesh: GearsInMesh, coast: bool, labelled: bool) -> None:
    """The line between the base circles, its part that is the path of contact, and the pitch point."""
    pair, frame = mesh.pair, partial(upright, mesh.pair, coast=coast)
    height = -pair.pinion.base_radius
    ends = frame(np.array([[0.0, height], [pair.line_of_action_length, height]]))
    path = frame(np.array([[pair.path_start, height], [pair.path_end, height]]))
    pitch = frame(np.array([pair.pitch_point, height]))
    for colour, wider in (("white", 1.6), (DARK, 0.0)):
        axes.plot(*ends.T, color=colour, linewidth=1.0 + wider, solid_capstyle="butt", linestyle="-")
        axes.plot(*path.T, color=colour, linewidth=2.4 + wider, solid_capstyle="butt")
    axes.plot(
        *pitch,
        "o",
        markersize=8 if labelled else 5,
        markerfacecolor="white",
        markeredgecolor="black",
        markeredgewidth=1.4,
    )
    if labelled:
        side = -1 if coast else 1
        _note(axes, "pitch point", pitch, (side * 14, 16))
        _note(
            axes, "line of action", frame(np.array([pair.path_start - 0.12 * pair.base_pitch, height])), (side * 12, 30)
        )


def _note(axes: Axes, words: str, point, offset) -> None:
    box = {"boxstyle": "round,pad=0.25", "facecolor": "white", "edgecolor": "#BBBBBB", "alpha": 0.92}
    axes.annotate(
        words,
        point,
        xytext=offset,
        textcoords="offset points",
        fontsize=11.5,
        color=DARK,
        bbox=box,
        ha="left" if offset[0] > 0 else "right",
    )


def _name_gears(axes: Axes, mesh: GearsInMesh, driving: int) -> None:
    """Names in the bores, or above or beside too small ones; which gear drives, and the sense in which either turns."""
    (bottom, top), height = axes.get_ylim(), axes.get_position().height * axes.figure.get_figheight() * 72.0
    point = (top - bottom) / height
    for number, (gear, name, turns) in enumerate(((mesh.pair.pinion, "pinion", 1), (mesh.pair.wheel, "wheel", -1))):
        name += "\ndrives" if number == driving else ""
        centre = np.zeros(2) if turns > 0 else np.array([0.0, -mesh.pair.centre_distance])
        place, ha, va = _place_of_name(gear, point)
        axes.text(*(centre + place), name, ha=ha, va=va, fontsize=11.5, color=DARK)
        radius = max(0.78 * gear.bore_radius, LEAST_ARROW * point)
        start, end = 200.0, 340.0
        axes.add_patch(Arc(centre, 2 * radius, 2 * radius, theta1=start, theta2=end, color=DARK, linewidth=1.4))
        tip = np.radians(end if turns > 0 else start)
        head = centre + radius * np.array([np.cos(tip), np.sin(tip)])
        back = centre + radius * np.array([np.cos(tip - turns * 0.06), np.sin(tip - turns * 0.06)])
        axes.add_patch(
            FancyArrowPatch(back, head, arrowstyle="-|>", mutation_scale=14, color=DARK, shrinkA=0, shrinkB=0)
        )


def _place_of_name(gear, point: float) -> tuple[np.ndarray, str, str]:
    """Where a gear's name stands from its centre (mm), with its alignment: in the bore, above it in the body, or left
    of the teeth."""
    if gear.bore_radius >= LEAST_BORE * point:
        return np.zeros(2), "center", "center"
    if gear.root_radius - gear.bore_radius > 2.0 * LEAST_BORE * point:
        return np.array([0.0, gear.bore_radius + 6.0 * point]), "center", "bottom"
    return np.array([-gear.tip_radius - 4.0 * point, 0.0]), "right", "center"


def _frame_in(axes: Axes, enlarged: Axes, moved: np.ndarray | None = None) -> None:
    """Where in one panel another one is."""
    (left, right), (bottom, top) = enlarged.get_xlim(), enlarged.get_ylim()
    x, y = (0.0, 0.0) if moved is None else moved
    for colour, width in (("black", 2.6), ("white", 1.2)):
        axes.add_patch(
            Rectangle((left + x, bottom + y), right - left, top - bottom, fill=False, edgecolor=colour, linewidth=width)
        )


def _length_bar(axes: Axes) -> None:
    """A bar of a round length at the panel's lower edge."""
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    wanted = 0.3 * (right - left)
    power = 10.0 ** np.floor(np.log10(wanted))
    length = max(step * power for step in (1.0, 2.0, 5.0) if step * power <= wanted)
    x, y = left + 0.06 * (right - left), bottom + 0.06 * (top - bottom)
    axes.plot([x, x + length], [y, y], color="black", linewidth=5.0, solid_capstyle="butt")
    axes.plot([x, x + length], [y, y], color="white", linewidth=2.5, solid_capstyle="butt")
    axes.text(
        x,
        y + 0.03 * (top - bottom),
        f"{length:g} mm",
        fontsize=11.0,
        color="black",
        path_effects=[withStroke(linewidth=3.0, foreground="white")],
    )


def _numbers(figure: Figure, mesh: GearsInMesh, dataset: xr.Dataset, place) -> None:
    index, dataset = stored_place(mesh, dataset), contact_times(dataset)
    values = {
        name: float(dataset[name].values[index])
        for name in ("normal_force", "coast_normal_force", *PRESSURES)
        if name in dataset
    }
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


def colour_bar(
    figure: Figure,
    limit: float,
    beyond: bool,
    words: str = "von Mises stress (MPa)",
    place: tuple[float, float] = (0.08, 0.72),
    colours: LinearSegmentedColormap = COLOURS,
) -> None:
    """Colours up to a limit, MPa, with an arrow there where some is `beyond`; `place`: lower end and height in the
    figure."""
    axes = figure.add_axes((0.931, place[0], 0.013, place[1]))
    bar = figure.colorbar(
        ScalarMappable(Normalize(0.0, limit), colours), cax=axes, extend="max" if beyond else "neither"
    )
    bar.set_label(words, labelpad=8.0)
    axes.grid(False)


def heading(figure: Figure, mesh: GearsInMesh, dataset: xr.Dataset) -> None:
    """Title of the run, its conditions, and the time of the picture."""
    title = " ".join(str(dataset.attrs.get("title", "")).split())
    complete = bool(dataset.attrs.get("complete", 1))
    scene = scene_of(dataset)
    figure.text(
        0.015,
        0.955,
        f"Stress in the gears: {title}",
        fontsize=18,
        color=DARK if complete else WARNING,
        parse_math=False,
    )
    timed = f", time {_time(mesh.time)}" if scene is None or scene.motion.speed_given else ""
    said = f"mesh phase {mesh.mesh_phase:.3f} (mesh cycles since the start){timed}"
    words = f"{conditions(scene)}  ·  {said}" if scene is not None else said
    figure.text(
        0.015,
        0.917,
        words if complete else f"{words}  ·  INCOMPLETE RUN",
        fontsize=13,
        color=DARK if complete else WARNING,
        parse_math=False,
    )


def _time(seconds: float) -> str:
    return f"{1e3 * seconds:.4g} ms" if abs(seconds) < 1.0 else f"{seconds:.6g} s"


def save_picture(figure: Figure, path: Path | BinaryIO) -> None:
    """Save the picture as PNG, in the pixels it was drawn in."""
    FigureCanvasAgg(figure).print_png(path, metadata={"Software": None})
