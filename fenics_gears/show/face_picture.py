"""The gears of a run over the face in mesh in three dimensions, and the teeth of either gear alone, coloured by
stress."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from fenics_gears.errors import ComputationError
from fenics_gears.inputs.tree import GEARS
from fenics_gears.results.pairs import contact_times
from fenics_gears.simulation.run_stresses import GearInSpace, GearsInMesh
from fenics_gears.system.virtual_display import ensure_display

from .chart import MARKED_LINES, Chart, Curve
from .contact_pattern import ACROSS
from .flank_pressure import PressedTiles, pressed_tiles
from .loaded_contact import stored_place
from .panels import DARK, GREY, PALETTE, framed, styled
from .pressure import COLOURS as PRESSURE_COLOURS
from .stress_grid import surface
from .stress_heading import COLOURS, colour_bar, heading, rounded_up

UNLOADED = "#E4E7EA"
EDGES = "#5A6068"
PIXELS = 150  # an inch
# Dots an inch of the figure, and of one in a moving picture.
DPI = 100.0
DPI_OF_FRAMES = 60.0
LIGHT = {"ambient": 0.55, "diffuse": 0.5, "specular": 0.0}
CAPTION = (
    "On the flanks that carry: the run's contact pressure. Elsewhere: von Mises stress of the bodies' mesh, which"
    " resolves the roots but not what lies just below the contact.\nGrey: teeth further away, whose stress was not"
    " recovered."
)
FLANK = "#F7F7F5"
PRESSURES = LinearSegmentedColormap.from_list("pressure", list(PRESSURE_COLOURS))


@dataclass(frozen=True)
class Sight:
    """A panel: title, place (left, bottom, width, height) in the figure, gears shown, and camera: what it looks at,
    from which direction, half height, mm."""

    title: str
    place: tuple[float, float, float, float]
    gears: tuple[int, ...]
    focus: np.ndarray
    direction: np.ndarray
    half: float


@styled
def face_picture(
    mesh: GearsInMesh, dataset: xr.Dataset, scale: float, limit: float, beyond: bool, dpi: float
) -> Figure:
    """Both gears in mesh, and the loaded teeth of each alone; `scale`: of the displacements of the teeth from the hubs.
    limit, beyond: as in `stress_picture`. Raises ComputationError without pyvista."""
    figure = Figure(figsize=(16.0, 9.0), dpi=dpi)
    tiles = [pressed_tiles(mesh, dataset, gear, scale) for gear in (0, 1)]
    highest = rounded_up(dataset.attrs.get("peak_contact_pressure", 0.0) or float(tiles[0].pressure.max(initial=0.0)))
    for sight in sights(mesh):
        axes = figure.add_axes(sight.place, xticks=[], yticks=[])
        axes.imshow(_rendered(mesh, sight, scale, limit, tiles, highest), aspect="auto")
        axes.set_title(sight.title)
        framed(axes)
    colour_bar(figure, limit, beyond, place=(0.08, 0.33))
    above = bool((tiles[0].pressure > highest).any())
    colour_bar(figure, highest, above, "contact pressure (MPa)", (0.49, 0.33), PRESSURES)
    heading(figure, mesh, dataset)
    _words(figure, mesh, dataset, scale)
    return figure


def sights(mesh: GearsInMesh) -> tuple[Sight, Sight, Sight]:
    """The whole pair, and the loaded teeth of pinion and wheel from the side of their loaded flanks."""
    pair = mesh.pair
    across, along = _upright(pair)
    pitch = np.array([pair.pitch_point, -pair.pinion.base_radius, 0.0])
    # From the middle of both gears; and from before the flank that carries: the pinion's drive flank looks along the
    # line of action.
    low, high = -pair.centre_distance - pair.wheel.tip_radius, pair.pinion.tip_radius
    if pair.wheel.internal:
        # As wide as it is high, in a panel that is not.
        low, high = (-pair.centre_distance + side * pair.wheel.bore_radius for side in (1.2, -1.2))
    middle = 0.5 * (low + high) * along
    half = 0.5 * (high - low) + 0.15 * pair.face_width
    side = (-1.0 if mesh.coast else 1.0) * across
    axis = np.array([0.0, 0.0, 1.0])
    close = 0.45 * pair.face_width + 2.6 * pair.pinion.module
    deep = 0.9 * pair.pinion.module * along
    from_above = 0.45 * across + 0.25 * along + 0.9 * axis
    # Over the opposite teeth of an internal gear.
    over = (1.4 if pair.wheel.internal else 0.45) * axis
    places = [(left, 0.12, 0.265, 0.74) for left in (0.385, 0.66)]
    return (
        Sight("The pair in mesh", (0.015, 0.12, 0.36, 0.74), (0, 1), middle, from_above, 1.01 * half),
        Sight("Pinion alone", places[0], (0,), pitch + deep, 0.7 * side - 0.7 * along + 0.45 * axis, close),
        Sight("Wheel alone", places[1], (1,), pitch - deep, -0.7 * side + 0.7 * along + over, close),
    )


def root_tension(mesh: GearsInMesh) -> Chart:
    """Largest tension in the roots of either gear's loaded teeth at each place of its face."""
    curves = []
    for name, gear, colour in zip(GEARS, mesh.gears, PALETTE):
        tension = gear.principal[..., gear.in_root].max(axis=(0, 2))
        curves.append(Curve(name, gear.points[0, :, 0, 2], tension, colour, mode=MARKED_LINES))
    return Chart(
        f"Largest tension in the roots along the face at mesh phase {mesh.mesh_phase:.3f}", curves, ACROSS,
        "Largest principal stress (MPa)",
        y_range=(0.0, 1.08 * max(float(curve.y.max()) for curve in curves) or 1.0),
        note="At the nodes of the bodies' mesh, the loaded teeth and their neighbours.",
    )  # fmt: skip


def _upright(pair) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors (3,) across the line of centres, in the sense of the line of action, and along it from the pitch
    point to the pinion's centre."""
    centre = np.array([pair.line_of_action_length, -(pair.pinion.base_radius + pair.wheel.base_radius)])
    along = -centre / pair.centre_distance
    return np.array([along[1], -along[0], 0.0]), np.append(along, 0.0)


def _rendered(
    mesh: GearsInMesh, sight: Sight, scale: float, limit: float, tiles: Sequence[PressedTiles], highest: float
) -> np.ndarray:
    try:
        import pyvista
    except ImportError as error:
        raise ComputationError("a picture in three dimensions needs pyvista, which is not installed") from error
    # pyvista's own start_xvfb waits three seconds and leaves the server running.
    ensure_display(pyvista.vtk_version_info)
    if hasattr(pyvista, "vtk_verbosity"):
        # Without a display VTK warns before it draws in memory; versions before 0.45 of pyvista leave it to its own.
        pyvista.vtk_verbosity("off")
    size = [round(part * PIXELS * inches) for part, inches in zip(sight.place[2:], (16.0, 9.0))]
    plotter = pyvista.Plotter(off_screen=True, window_size=size)
    try:
        plotter.set_background("white")
        plotter.enable_anti_aliasing("ssaa")
        for number in sight.gears:
            _add_gear(plotter, mesh.gears[number], scale, limit, tiles[number], highest)
        direction = sight.direction / np.linalg.norm(sight.direction)
        plotter.camera.parallel_projection = True
        plotter.camera.focal_point = sight.focus
        plotter.camera.position = sight.focus + 10.0 * sight.half * direction
        plotter.camera.up = _upright(mesh.pair)[1]
        alone = len(sight.gears) == 1
        plotter.camera.parallel_scale = sight.half * (max(1.0, size[1] / size[0]) if alone else 1.0)
        plotter.reset_camera_clipping_range()
        return plotter.screenshot(return_img=True)
    finally:
        plotter.close()


def _add_gear(plotter, gear: GearInSpace, scale: float, limit: float, tiles: PressedTiles, highest: float) -> None:
    """One gear: stress on its recovered teeth, the contact pressure on their flanks that carry; the other teeth, all
    edges."""
    from pyvista import PolyData

    moved = gear.points + scale * gear.elastic
    points = moved.reshape(-1, 3)
    sides = surface(moved, gear)
    flank = np.tile(gear.on_flank, moved[..., 0, 0].size)[sides].all(axis=1)
    stressed = PolyData.from_regular_faces(points, sides[~flank])
    stressed.point_data["stress"] = gear.von_mises.ravel()
    plotter.add_mesh(stressed, scalars="stress", cmap=COLOURS, clim=(0.0, limit), show_scalar_bar=False, **LIGHT)
    plotter.add_mesh(PolyData.from_regular_faces(points, sides[flank]), color=FLANK, **LIGHT)
    if count := len(tiles.pressure):
        pressed = PolyData.from_regular_faces(tiles.corners.reshape(-1, 3), np.arange(4 * count).reshape(-1, 4))
        pressed.cell_data["pressure"] = tiles.pressure
        colours = {"scalars": "pressure", "cmap": PRESSURES, "clim": (0.0, highest)}
        plotter.add_mesh(pressed, show_scalar_bar=False, lighting=False, **colours)
    drawn = [PolyData.from_regular_faces(points, sides)]
    if len(gear.others):
        drawn.append(PolyData.from_regular_faces(gear.others.reshape(-1, 3), surface(gear.others, gear)))
        plotter.add_mesh(drawn[-1], color=UNLOADED, **LIGHT)
    smooth = dict.fromkeys(("boundary_edges", "manifold_edges", "non_manifold_edges"), False)
    for each in drawn:
        plotter.add_mesh(each.clean().extract_feature_edges(40.0, **smooth), color=EDGES, line_width=1.5)


def _words(figure: Figure, mesh: GearsInMesh, dataset: xr.Dataset, scale: float) -> None:
    force = contact_times(dataset)["coast_normal_force" if mesh.coast else "normal_force"].values
    roots = [f"{name} {_largest_tension(gear)}" for name, gear in zip(GEARS, mesh.gears)]
    words = (
        f"Displacements × {scale:g}. Mesh force {float(force[stored_place(mesh, dataset)]):.0f} N. Largest tension in"
        f" the roots: {', '.join(roots)}."
    )
    figure.text(0.015, 0.073, words, fontsize=12, color=DARK)
    figure.text(0.015, 0.018, CAPTION, fontsize=11, color=GREY, linespacing=1.4)


def _largest_tension(gear) -> str:
    tension = gear.principal[..., gear.in_root]
    sector, height, _ = np.unravel_index(tension.argmax(), tension.shape)
    return f"{tension.max():.0f} MPa at z = {gear.points[sector, height, 0, 2]:.1f} mm"
