"""What pictures of stress in the plane and over the face have in common: their colours and their heading."""

import textwrap

import numpy as np
import xarray as xr
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure

from fenics_gears.simulation.run_stresses import GearsInMesh

from .panels import DARK, WARNING
from .run import ShownRun, conditions

# Pale where nothing happens, so that the bodies stay in the background; steps closer at the lower end, where the roots
# are.
COLOURS = LinearSegmentedColormap.from_list("stress", [
    (0.0, "#F1F3F5"), (0.1, "#B4D0E8"), (0.24, "#539FD0"), (0.4, "#35A388"), (0.58, "#F0D24A"), (0.79, "#EB7A2F"),
    (1.0, "#A90E18"),
])  # fmt: skip
# Letters that fit the picture's width, of its title and of the smaller lines below.
LETTERS_OF_TITLE = 110
LETTERS_OF_LINE = 150


def rounded_up(stress: float) -> float:
    """A stress (MPa) rounded up to two digits; 1 where there is none."""
    if stress <= 0.0:
        return 1.0
    step = 10.0 ** (np.floor(np.log10(stress)) - 1.0)
    return float(np.ceil(stress / step - 1e-9) * step)


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
    coloured = ScalarMappable(Normalize(0.0, limit), colours)
    extend = "max" if beyond else "neither"
    figure.colorbar(coloured, cax=axes, extend=extend).set_label(words, labelpad=8.0)
    axes.grid(False)


def heading(figure: Figure, mesh: GearsInMesh, dataset: xr.Dataset) -> None:
    """Title of the run, its conditions, and the time of the picture."""
    run = ShownRun(dataset)
    scene = run.scene
    look = {"color": DARK if run.complete else WARNING, "parse_math": False}
    title = textwrap.shorten(f"Stress in the gears: {run.title}", LETTERS_OF_TITLE, placeholder=" …")
    figure.text(0.015, 0.959, title, fontsize=18, **look)
    timed = f", time {_time(mesh.time)}" if scene is None or scene.motion.speed_given else ""
    instant = f"mesh phase {mesh.mesh_phase:.3f} (mesh cycles since the start){timed}"
    told = [] if scene is None else textwrap.wrap(conditions(scene), LETTERS_OF_LINE, max_lines=2, placeholder=" …")
    lines = [*told, instant if run.complete else f"{instant}  ·  INCOMPLETE RUN"]
    figure.text(0.015, 0.947, "\n".join(lines), fontsize=13 if len(lines) < 3 else 10, va="top", **look)


def _time(seconds: float) -> str:
    return f"{1e3 * seconds:.4g} ms" if abs(seconds) < 1.0 else f"{seconds:.6g} s"
