"""The stored mesh cycles as a moving picture: GIF, or MP4 where ffmpeg is installed. For ParaView: a .vtu file for each
step, and the .pvd file that lists them."""

import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from fenics_gears.errors import ComputationError, SceneError
from fenics_gears.results.pairs import contact_times
from fenics_gears.simulation.run_stresses import RunStresses

from .stress_grid import save_vtu
from .stress_heading import COLOURS
from .stress_picture import frames

FRAMES_PER_CYCLE = 24
MOST_FRAMES = 120
FRAMES_PER_SECOND = 12
SUFFIXES = (".gif", ".mp4")
# A scale is looked for, and the colours are fixed, on so many of the frames.
SAMPLED = 8
STRESS_COLOURS = 208


def check_suffix(path: Path) -> None:
    """Say before anything is computed that a moving picture cannot be written. Raises SceneError."""
    if path.suffix not in SUFFIXES:
        raise SceneError(f"{path}: a moving picture is a .gif or a .mp4 file; give --output such a name")
    if path.suffix == ".mp4" and shutil.which("ffmpeg") is None:
        raise SceneError(
            f"{path}: there is no ffmpeg on PATH, which writes .mp4 files. Install it (Debian: ffmpeg), or name a .gif"
            " file."
        )


def animate(runs, dataset: xr.Dataset, path: Path, scale: float | None, report: Callable[[int, int], None]) -> None:
    """Write the moving picture of a run's stresses; `report(done, all)` is called for every frame.

    scale: of the displacements, None for a suitable one. The last stored step is left out, as it is where the first one
    is in the mesh.
    """
    steps = frame_steps(dataset)
    drawn = frames(dataset, scale, [runs.at(index) for index in steps[:: max(1, len(steps) // SAMPLED)]])
    images = []
    for done, index in enumerate(steps):
        report(done, len(steps))
        images.append(_image(drawn(runs.at(index))))
    report(len(steps), len(steps))
    (_write_gif if path.suffix == ".gif" else _write_mp4)(images, path)


def frame_steps(dataset: xr.Dataset) -> list[int]:
    """The stored steps that are drawn, evenly spaced in the mesh phase."""
    phases = contact_times(dataset)["contact_mesh_phase"].values
    cycles = float(phases[-1] - phases[0])
    count = int(min(MOST_FRAMES, max(1, round(cycles * FRAMES_PER_CYCLE)), max(1, len(phases) - 1)))
    return sorted({int(round(place)) for place in np.linspace(0, len(phases) - 1, count, endpoint=False)})


def _image(figure: Figure) -> np.ndarray:
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()


def _write_gif(frames: list[np.ndarray], path: Path) -> None:
    from PIL import Image

    # One palette for all frames, or flat colours would flicker. It is made of the colours of stress and greys: one made
    # from the frames would mostly have colours of the pale bodies.
    greys = np.linspace(0.0, 1.0, 256 - STRESS_COLOURS)[:, None] * np.ones(3)
    colours = np.vstack([COLOURS(np.linspace(0.0, 1.0, STRESS_COLOURS))[:, :3], greys])
    palette = Image.new("P", (1, 1))
    palette.putpalette(np.round(255.0 * colours).astype(np.uint8).tobytes())
    images = [Image.fromarray(frame) for frame in frames]
    first, *others = (image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images)
    duration = round(1000 / FRAMES_PER_SECOND)
    first.save(path, save_all=True, append_images=others, duration=duration, loop=0, optimize=False)


def _write_mp4(frames: list[np.ndarray], path: Path) -> None:
    height, width = (size // 2 * 2 for size in frames[0].shape[:2])  # the coder wants even numbers
    command = [
        "ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}",
        "-r", str(FRAMES_PER_SECOND), "-i", "-", "-pix_fmt", "yuv420p", "-f", "mp4", str(path),
    ]  # fmt: skip
    content = b"".join(frame[:height, :width].tobytes() for frame in frames)
    done = subprocess.run(command, input=content, capture_output=True)
    if done.returncode:
        raise ComputationError(
            f"{path}: ffmpeg could not write the moving picture: {done.stderr.decode(errors='replace').strip()}"
        )


def save_series(runs: RunStresses, dataset: xr.Dataset, collection: Path, report: Callable[[int, int], None]) -> None:
    """Write a .pvd file and, in its folder and named after it, the .vtu files that it lists, of the moving picture's
    steps; `report(done, all)` is called for each. Raises what `save_vtu` raises."""
    root = ElementTree.Element("VTKFile", {"type": "Collection", "version": "0.1"})
    listed = ElementTree.SubElement(root, "Collection")
    steps = frame_steps(dataset)
    for done, index in enumerate(steps):
        report(done, len(steps))
        file = collection.with_name(f"{collection.stem}_{done:04d}.vtu")
        mesh = runs.at(index)
        # To look at; files of half the size.
        save_vtu(mesh, file, precision=np.float32)
        ElementTree.SubElement(listed, "DataSet", {"timestep": repr(mesh.time), "part": "0", "file": file.name})
    report(len(steps), len(steps))
    ElementTree.indent(root)
    ElementTree.ElementTree(root).write(collection, encoding="utf-8", xml_declaration=True)
