"""The line load over face and time: of all tooth pairs together, of one pair while it is in mesh, and over the face."""

import numpy as np

from fenics_gears.results.face_ends import inner_face, slice_ends
from fenics_gears.results.load_factors import at_edges, mean_line_load, passing
from fenics_gears.results.pairs import carrying_side

from .chart import MESH_CYCLES, TIME, Chart, Curve, Field
from .contact_pattern import ACROSS
from .panels import DARK, PALETTE, in_unit
from .pressure import COLOURS
from .run import ShownRun

TITLE = "Line load (N/mm)"
# The factors of a run, behind the curve that they are of.
FACTORS = {
    "face_load_factor": " (face load factor {:.3f})",
    "largest_line_load_factor": " ({:.3f} of even load)",
    "edge_line_load_factor": " ({:.3f} of even load at edges)",
}


def line_loads(run: ShownRun) -> list[Chart]:
    """Line load of the flanks that carry, in the last cycles whose contact fields are stored; nothing without load."""
    side = carrying_side(run.dataset)
    name = f"{side}line_load"
    if name not in run.dataset or run.dataset.sizes["contact_time"] < 2 or run.pair is None:
        return []
    part = run.last_fields
    loads = in_unit(part[name].transpose("contact_time", "slot", "face_position"), "N/mm")
    phase = part["contact_mesh_phase"].values
    if not loads.any():
        return []
    slices = slice_ends(run.dataset)
    z = part["face_position"].values
    mesh = _of_mesh(side, loads, phase, slices)
    pair = _of_pair(run, side, loads, phase, slices)
    return [mesh, pair, _over_face(run, side, loads, z)]


def _of_mesh(side: str, loads: np.ndarray, phase: np.ndarray, slices: np.ndarray) -> Chart:
    total = loads.sum(axis=1)
    return Chart(
        f"Line load of the mesh{' on its coast flanks' if side else ''}: tooth pairs summed", [], MESH_CYCLES,
        "Place on the face (mm)", x_range=(float(phase[0]), float(phase[-1])),
        y_range=(float(slices[0]), float(slices[-1])), field=_field(phase, slices, total), height=300, linked=TIME,
        note="Along the contact normal, per mm of face width; places along the axes from the middle of the common "
            "face.",
    )  # fmt: skip


def _of_pair(run: ShownRun, side: str, loads: np.ndarray, phase: np.ndarray, slices: np.ndarray) -> Chart:
    """Line load from the start to the end of contact, put together of all pairs, of unlike ones the largest."""
    pair = run.pair
    numbers = run.last_fields["contact_pair_number"]
    entered = numbers.values - numbers.attrs["number_at_phase_0"]
    step = float(np.diff(phase).min())
    since = np.rint((phase[:, None] - entered) / step).astype(int)
    known = (numbers.values > 0) & (loads.max(axis=2) > 0.0)
    first = int(since[known].min())
    own = np.zeros((int(since[known].max()) - first + 1, loads.shape[2]))
    np.maximum.at(own, since[known] - first, loads[known])
    # Phases of the steps are whole steps before that of the last one.
    positions = pair.path_start, pair.pitch_point, pair.path_end
    start, pitch, end = sorted(passing(pair, position, side) for position in positions)
    last = float(phase[-1]) - step * round(float(phase[-1]) / step)
    places = step * (first + np.arange(len(own))) + last - (start - pair.path_start) / pair.base_pitch
    ends = np.array([slices[0], slices[-1]])
    lines = []
    for words, position, dash in (
        ("start and end of contact", start, "dash"), ("pitch point", pitch, "dot"), ("", end, "dash"),
    ):  # fmt: skip
        at = (position - start - pair.slope * ends) / pair.base_pitch
        lines.append(Curve(words, at, ends, DARK, dash, 1.0, listed=position < end))
    return Chart(
        "Line load of a tooth pair from the start to the end of its contact", lines,
        "Time (mesh cycles since contact starts in the middle of the face)",
        "Place on the face (mm)", x_range=(float(places[0]) - 0.5 * step, float(places[-1]) + 0.5 * step),
        y_range=(float(ends[0]), float(ends[1])),
        field=_field(places, slices, own), height=300,
        note="Put together of all pairs, the largest of unlike ones. Lines: of rigid gears without modifications.",
    )  # fmt: skip


def _over_face(run: ShownRun, side: str, loads: np.ndarray, z: np.ndarray) -> Chart:
    part = run.last_fields
    total = loads.sum(axis=1)
    mean = mean_line_load(part, side)
    away = np.where(at_edges(part, run.pair, side), 0.0, loads).max(axis=(0, 1))
    curves = {
        "mesh, its tooth pairs summed: mean over the mesh cycle" + _factor(run, "face_load_factor"): total.mean(axis=0)
        if mean is None
        else mean,
        "one tooth pair: largest at any time" + _factor(run, "edge_line_load_factor"): loads.max(axis=(0, 1)),
    }
    if away.any():
        words = "one tooth pair: largest at any time, away from edges" + _factor(run, "largest_line_load_factor")
        curves[words] = np.where(away > 0.0, away, np.nan)
    # The third lies on the second but at edges, and is drawn within it.
    looks = zip(PALETTE, (1.6, 4.5, 1.6))
    drawn = [
        Curve(words, z, values, colour, width=width) for (words, values), (colour, width) in zip(curves.items(), looks)
    ]
    if "proposed_line_load" in run.dataset:
        corrected = run.dataset["proposed_line_load"].values
        curves["corrected"] = corrected
        drawn.append(Curve(_correction(run.dataset.attrs), z, corrected, PALETTE[0], "dash"))
    highest = 1.08 * float(max(np.nanmax(values) for values in curves.values()))
    upright = np.array([0.0, highest])
    low, high = (np.full(2, place) for place in inner_face(run.pair))
    ends = [
        Curve("edge zone at either end", low, upright, DARK, "dot", 1.0),
        Curve("", high, upright, DARK, "dot", 1.0, listed=False),
    ]
    return Chart(
        "Line load along the face", drawn + ends, ACROSS, TITLE,
        x_range=run.pair.common_face, y_range=(0.0, highest),
        note="Face load factor: largest over mean along the face. Even load: of rigid gears when their lines of"
        " contact are shortest. Edges: the ends of the face, and tips and form circles where a line of contact ends."
        " The factors away from edges are of means over half a module.",
    )  # fmt: skip


def _correction(numbers) -> str:
    slope = numbers["proposed_helix_slope"]
    crowning = numbers["proposed_crowning"]
    factor = FACTORS["face_load_factor"].format(numbers["proposed_face_load_factor"])
    return f"mesh, as proposed: pinion's helix slope {slope:.1f} µm, crowning {crowning:.1f} µm{factor}"


def _factor(run: ShownRun, name: str) -> str:
    return FACTORS[name].format(run.dataset.attrs[name]) if name in run.dataset.attrs else ""


def _field(x: np.ndarray, slices: np.ndarray, loads: np.ndarray) -> Field:
    """Line loads (step, slice) in cells half-way to the steps before and after."""
    middle = 0.5 * (x[1:] + x[:-1])
    edges = np.concatenate([x[:1], middle, x[-1:]])
    values = np.where(loads.T > 0.0, loads.T, np.nan)
    return Field(edges, slices, values, TITLE, float(loads.max()) or 1.0, COLOURS)
