"""The stored mesh cycles for ParaView: a .vtu file for each step, and the .pvd file that lists them with their
times."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import xarray as xr

from fenics_gears.show.stress_animation import frame_steps
from fenics_gears.show.stress_grid import save_vtu
from fenics_gears.simulation.run_stresses import RunStresses


def save_series(runs: RunStresses, dataset: xr.Dataset, collection: Path, report: Callable[[int, int], None]) -> None:
    """Write a .pvd file and the .vtu files that it lists, beside it and named after it; `report(done, all)` is called
    for each.

    The steps are those of the moving picture, their times in s as the run has them. Raises what `save_vtu` raises.
    """
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
