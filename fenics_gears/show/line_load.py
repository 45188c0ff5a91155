"""The line load over face and time: of all tooth pairs together, of one pair while it is in mesh, and over the face."""

from __future__ import annotations

import numpy as np

from fenics_gears.results.load_factors import at_pitch_cylinder, passing
from fenics_gears.results.pairs import carrying_side
from fenics_gears.show.chart import MESH_CYCLES, TIME, Chart, Curve, Field
from fenics_gears.show.contact_pattern import ACROSS, slice_ends
from fenics_gears.show.panels import DARK, PALETTE
from fenics_gears.show.pressure import COLOURS
from fenics_gears.show.run import Run
from fenics_gears.show.units import in_unit

TITLE = "Line load (N/mm)"


def line_loads(run: Run) -> list[Chart]:
    """Line load of the flanks that carry, in the last cycles whose contact fields are stored; nothing without load."""
    side = carrying_side(run.dataset)
    name = f"{side}line_load"
    if name not in run.dataset or run.dataset.sizes["contact_time"] < 2 or run.pair is None:
        return []
    part = run.last_fields
    loads, phase = in_unit(part[name].transpose("contact_time", "slot", "face_position"), "N/mm"), part["contact_mesh_phase"].values
    if not loads.any():
        return []
    slices, z = slice_ends(run.dataset, run.pair), part["face_position"].values
    return [_of_mesh(side, loads, phase, slices), _of_pair(run, side, loads, phase, slices), _over_face(run, side, loads, z)]


def _of_mesh(side: str, loads: np.ndarray, phase: np.ndarray, slices: np.ndarray) -> Chart:
    total = loads.sum(axis=1)
    return Chart(
        f"Line load of the mesh{' on its coast flanks' if side else ''}: tooth pairs summed", [], MESH_CYCLES, "Place on the face (mm)", x_range=(float(phase[0]), float(phase[-1])),
        y_range=(float(slices[0]), float(slices[-1])), field=_field(phase, slices, total), height=300, linked=TIME,
        note="Along the contact normal, per mm of face width; places along the axes from the middle of the common face.",
    )  # fmt: skip


def _of_pair(run: Run, side: str, loads: np.ndarray, phase: np.ndarray, slices: np.ndarray) -> Chart:
    """Line load from the start to the end of contact, put together of all pairs, so that a single mesh cycle is enough; of unlike pairs the largest."""
    pair, numbers = run.pair, run.last_fields["contact_pair_number"]
    entered = numbers.values - numbers.attrs["number_at_phase_0"]
    step = float(np.diff(phase).min())
    since = np.rint((phase[:, None] - entered) / step).astype(int)
    known = (numbers.values > 0) & (loads.max(axis=2) > 0.0)
    first = int(since[known].min())
    own = np.zeros((int(since[known].max()) - first + 1, loads.shape[2]))
    np.maximum.at(own, since[known] - first, loads[known])
    # Phases of the steps are those of the last one and whole steps before it.
    start, pitch, end = sorted(passing(pair, position, side) for position in (pair.path_start, pair.pitch_point, pair.path_end))
    places = step * (first + np.arange(len(own))) + float(phase[-1]) - step * round(float(phase[-1]) / step) - (start - pair.path_start) / pair.base_pitch
    ends = np.array([slices[0], slices[-1]])
    lines = [
        Curve(words, (position - start - pair.slope * ends) / pair.base_pitch, ends, DARK, dash, 1.0, listed=position < end)
        for words, position, dash in (("start and end of contact", start, "dash"), ("pitch point", pitch, "dot"), ("", end, "dash"))
    ]
    return Chart(
        "Line load of a tooth pair from the start to the end of its contact", lines, "Time (mesh cycles since contact starts in the middle of the face)",
        "Place on the face (mm)", x_range=(float(places[0]) - 0.5 * step, float(places[-1]) + 0.5 * step), y_range=(float(ends[0]), float(ends[1])),
        field=_field(places, slices, own), height=300,
        note="Put together of all pairs, the largest of unlike ones. Lines: of rigid gears without modifications.",
    )  # fmt: skip


def _over_face(run: Run, side: str, loads: np.ndarray, z: np.ndarray) -> Chart:
    total, pitch = loads.sum(axis=1), at_pitch_cylinder(run.last_fields, run.pair, side)
    worst = total.max(axis=1).argmax()
    phase = run.last_fields["contact_mesh_phase"].values[worst]
    curves = [(f"mesh at cycle {phase:.3g}", total[worst]), ("mesh, mean", total.mean(axis=0)), ("pair, largest", loads.max(axis=(0, 1)))]
    curves += [("pair at pitch cylinder", pitch[pitch.max(axis=1).argmax()])] if len(pitch) else []
    drawn = [Curve(words, z, values, colour) for (words, values), colour in zip(curves, PALETTE)]
    highest = 1.08 * float(max(values.max() for _, values in curves))
    return Chart(
        f"Line load along the face{_factors(run)}", drawn, ACROSS, TITLE, x_range=run.pair.common_face, y_range=(0.0, highest),
        note="Of the mesh, its tooth pairs summed: when it is largest, and the mean over time. Of a tooth pair: the largest at each place, and when contact there passes the pitch point.",
    )  # fmt: skip


def _factors(run: Run) -> str:
    """The load factors of the settled run."""
    names = {"face_load_factor": "face load factor", "face_load_factor_at_pitch_cylinder": "along the pitch cylinder"}
    found = [f"{words} {run.dataset.attrs[name]:.3f}" for name, words in names.items() if name in run.dataset.attrs]
    return f": {', '.join(found)}" if found else ""


def _field(x: np.ndarray, slices: np.ndarray, loads: np.ndarray) -> Field:
    """Line loads (step, slice) in cells half-way to the steps before and after."""
    middle = 0.5 * (x[1:] + x[:-1])
    edges = np.concatenate([x[:1], middle, x[-1:]])
    values = np.where(loads.T > 0.0, loads.T, np.nan)
    return Field(edges, slices, values, TITLE, float(loads.max()) or 1.0, COLOURS)
