"""Pictures of a planetary set: the set drawn to scale, load shares and pin forces over the mesh cycle, orbits of
floating members."""

from __future__ import annotations

from cmath import rect
from collections.abc import Iterator
from math import degrees

import numpy as np
import xarray as xr

from fenics_gears.results.planetary import POINT, RING_DEFLECTION
from fenics_gears.results.sets_in_train import set_runs
from fenics_gears.scene.carrier import Carrier
from fenics_gears.scene.train import TrainScene
from fenics_gears.scene.train_layout import centres
from fenics_gears.scene.train_mesh import gear_names

from .chart import LEAST_SHARE, MARKERS, WORDS, Chart, Curve
from .gears_of_train import outline_of
from .pair_drawing import FILLS
from .panels import DARK, PALETTE

CIRCLE_POINTS = 361
KILO = 1e-3
# Points beyond these are drawn without a name.
LISTED = 12
MICRO = 1e3


def carrier_of(scene: TrainScene) -> Carrier:
    """The carrier of a train that is a planetary set."""
    assert scene.shafts.carrier is not None
    return scene.shafts.carrier


def sets_of(scene: TrainScene, dataset: xr.Dataset) -> Iterator[tuple[str, TrainScene, xr.Dataset]]:
    """The planetary sets of a train, each with words that stand before captions, and with its result."""
    parts = [part for part in scene.parts if part.shafts.carrier is not None]
    for part, own in zip(parts, set_runs(dataset)):
        yield f"{part.title}: " if scene.joined else "", part, own


def set_drawing(scene: TrainScene) -> Chart:
    """All teeth of the set to scale, as the run begins, and the names of the planets."""
    carrier = carrier_of(scene)
    layout = scene.layout
    at = centres(layout)
    names = gear_names(scene.meshes)
    curves = []
    # From the ring inwards: what lies within is drawn over it.
    inwards = sorted(range(len(names)), key=lambda each: (layout.gear(each).sign, -abs(layout.gear(each).tip_radius)))
    for number in inwards:
        gear = layout.gear(number)
        centre = at[layout.graph.shafts[number]]
        teeth = outline_of(gear, layout.tooth_angle(number), centre)
        around = _circle(gear.bore_radius, centre)
        first, second = (around, teeth) if gear.internal else (teeth, around)
        words = f"{names[number].rpartition('.')[2]}, {gear.tooth_count} teeth"
        curves.append(_closed(words, first, FILLS[int(carrier.planet_of(names[number]) is not None)]))
        curves.append(_closed(words, second, "white", listed=False))
    middles = np.array([at[layout.graph.shafts[names.index(each)]] for each in carrier.planets])
    said = [each.rpartition(" ")[2] for each in carrier.planets]
    curves.append(Curve("planets", middles.real, middles.imag, DARK, mode=WORDS, listed=False, words=said, beside=""))
    own = carrier.set
    caption = (
        f"To scale, as the run begins; {own.fixed} fixed, {own.input} drives, {own.output} loaded,"
        f" {scene.ratio:.5g} turns of the input in one of the output"
    )
    return Chart(caption, curves, "x (mm)", "y (mm)", height=620, equal=True)


def _circle(radius: float, centre: complex) -> np.ndarray:
    points = np.array([centre + rect(abs(radius), each) for each in np.linspace(0.0, 2.0 * np.pi, CIRCLE_POINTS)])
    return np.column_stack([points.real, points.imag])


def _closed(name: str, points: np.ndarray, fill: str, listed: bool = True) -> Curve:
    return Curve(name, points[:, 0], points[:, 1], DARK, width=0.8, fill=fill, listed=listed)


def shares(scene: TrainScene, dataset: xr.Dataset) -> list[Chart]:
    """Load share and pin force of each planet over the run's last mesh cycle, or where cycles differ over the run;
    nothing of other trains."""
    return [chart for own in sets_of(scene, dataset) for chart in _shares(*own)]


def _shares(of_set: str, scene: TrainScene, dataset: xr.Dataset) -> list[Chart]:
    phase, last = _last_period(scene, dataset)
    axis = "Time (mesh cycles)"
    charts = []
    for name, words, factor in (
        ("planet_load_share", "sun", "load_sharing_factor"),
        ("planet_load_share_ring", "ring", "load_sharing_factor_ring"),
    ):
        curves = _of_planets(scene, phase, np.asarray(dataset[name])[last])
        largest = f"largest {dataset.attrs[factor]:.5g} (K_gamma)"
        caption = f"{of_set}Forces between {words} and planets over their mean: {largest}"
        charts.append(Chart(caption, curves, axis, "Load share", least=LEAST_SHARE, height=300))
    forces = KILO * np.linalg.norm(np.asarray(dataset["pin_force"])[last], axis=-1)
    caption = f"{of_set}Forces of the planets on their pins: largest {KILO * dataset.attrs['largest_pin_force']:.5g} kN"
    least = LEAST_SHARE * float(forces.max())
    charts.append(Chart(caption, _of_planets(scene, phase, forces), axis, "Pin force (kN)", least=least, height=300))
    return charts


def _of_planets(scene: TrainScene, phase: np.ndarray, values: np.ndarray) -> list[Curve]:
    angles = carrier_of(scene).set.angles
    return [
        Curve(f"planet {number + 1}, at {degrees(angle):.5g}°", phase, own, PALETTE[number % len(PALETTE)])
        for number, (angle, own) in enumerate(zip(angles, values.T))
    ]


def _last_period(scene: TrainScene, dataset: xr.Dataset) -> tuple[np.ndarray, slice]:
    """Phases of the last mesh cycle, or those after which all meshes of stepped planets are where they were, with both
    ends, and where they are among the steps; of gears with errors or a ring on points, whose cycles differ, of the
    whole run."""
    carrier = carrier_of(scene)
    steps = int(dataset["steps_per_mesh_cycle"][0]) * carrier.set.cycles[0]
    unlike = carrier.run_outs or carrier.pitches or POINT in dataset.dims
    last = slice(None) if unlike else slice(-1 - steps, None)
    return np.asarray(dataset["mesh_phase"])[last, 0], last


def points_of_ring(scene: TrainScene, dataset: xr.Dataset) -> list[Chart]:
    """Forces of the points that hold a ring, and how far it moves there; nothing of rings that are held otherwise."""
    return [chart for own in sets_of(scene, dataset) if POINT in own[2].dims for chart in _points(*own)]


def _points(of_set: str, scene: TrainScene, dataset: xr.Dataset) -> list[Chart]:
    phase, last = _last_period(scene, dataset)
    charts = []
    for name, words, quantity, factor in (
        ("ring_support_radial", "Radial forces of points on the ring, outwards", "Force (kN)", KILO),
        ("ring_support_tangential", "Tangential forces of points on the ring, as it is driven", "Force (kN)", KILO),
        (RING_DEFLECTION, "Radial motion of the ring at its points, outwards", "Motion (µm)", MICRO),
    ):
        values = factor * np.asarray(dataset[name])[last]
        curves = [
            Curve(f"point {number + 1}", phase, own, PALETTE[number % len(PALETTE)], listed=number < LISTED)
            for number, own in enumerate(values.T)
        ]
        caption = f"{of_set}{words}: {values.min():.4g} to {values.max():.4g}"
        least = LEAST_SHARE * float(np.abs(values).max())
        charts.append(Chart(caption, curves, "Time (mesh cycles)", quantity, least=least, height=300))
    return charts


def orbits(scene: TrainScene, dataset: xr.Dataset) -> list[Chart]:
    """The paths of the centres of floating members over a mesh cycle; nothing where none floats."""
    return [chart for own in sets_of(scene, dataset) for chart in _orbits(*own)]


def _orbits(of_set: str, scene: TrainScene, dataset: xr.Dataset) -> list[Chart]:
    cycles = carrier_of(scene).set.cycles[0]
    over = "a mesh cycle" if cycles == 1 else f"{cycles} mesh cycles with the sun"
    _, last = _last_period(scene, dataset)
    if last == slice(None):
        over = "the run"
    charts = []
    for number, member in enumerate(carrier_of(scene).moving):
        place = carrier_of(scene).set.members.index(member)
        x, y = (MICRO * np.asarray(dataset[f"member_{axis}"])[last, place] for axis in "xy")
        colour = PALETTE[number % len(PALETTE)]
        curves = [
            Curve(f"centre of the {member}", x, y, colour),
            Curve("as it begins", x[:1], y[:1], colour, mode=MARKERS),
        ]
        farthest = f"{np.hypot(x, y).max():.4g} µm at most from its place"
        caption = f"{of_set}Orbit of the {member} over {over}, {farthest}"
        charts.append(Chart(caption, curves, "x (µm)", "y (µm)", height=460, equal=True))
    return charts
