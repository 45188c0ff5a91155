"""The pictures of a train's run: the train drawn to scale; transmission errors of the whole and of its meshes; orders
of the whole; line loads of its meshes over the face."""

from __future__ import annotations

from dataclasses import replace
from math import cos
from pathlib import Path

import numpy as np
import xarray as xr

from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.pair import GearPair
from fenics_gears.model.train import train_model_of
from fenics_gears.results.layout import MICRORADIANS, OF_OUTPUTS
from fenics_gears.results.mesh_of_train import carried_train
from fenics_gears.results.overall_orders import overall_orders, ramp_orders
from fenics_gears.scene.train import TrainScene
from fenics_gears.scene.train_layout import centres
from fenics_gears.scene.train_mesh import gear_names

from . import TRAIN_PICTURE_FILES
from .chart import BARS, LEAST_SHARE, Chart, Curve, Flag
from .drawing import picture
from .line_load import line_loads
from .panels import GREY, PALETTE, digits
from .planetary import orbits, points_of_ring, set_drawing, shares
from .plots import heading, save_figures
from .run import shown_mesh
from .train_shafts import deflections

POINTS_OF_A_CIRCLE = 181
# Between drawings beside each other, as part of the next one.
GAP = 0.08
HARMONICS_SHOWN = 4
# Part of the largest amplitude below which a bar has no words.
LEAST_FLAGGED = 0.1
ORDERS_NOTE = (
    "Every tooth is like the others, so that nothing repeats with a turn of a shaft: all orders are harmonics of mesh"
    " frequencies."
)


def draw_train(dataset: xr.Dataset, directory: Path) -> list[Path]:
    """Draw the pictures of a train's run, as PNG, and return the files. Raises SceneError where the train in it is none
    of this version."""
    scene = carried_train(dataset)
    figures = {
        name: picture(heading(subject, scene.title), charts)
        for name, (subject, charts) in zip(
            TRAIN_PICTURE_FILES, [(_drawn(scene), [drawing_of(scene)]), *subjects_of(scene, dataset)]
        )
        if charts
    }
    return save_figures(figures, directory)


def subjects_of(scene: TrainScene, dataset: xr.Dataset) -> list[tuple[str, list[Chart]]]:
    """Subjects and charts of the pictures of a train behind its drawing; without charts where it has no such thing."""
    return [
        ("Transmission error", errors(scene, dataset)),
        ("Orders of the overall transmission error", _known_orders(scene, dataset)),
        ("Line load along the face", loads_along_face(scene, dataset)),
        ("Shafts under load", bent_shafts_of(scene, dataset)),
        ("Load sharing of the planets", shares(scene, dataset)),
        ("Orbits of floating members", orbits(scene, dataset)),
        ("Points that hold the ring", points_of_ring(scene, dataset)),
    ]


def _drawn(scene: TrainScene) -> str:
    return "Gear train" if scene.shafts.carrier is None else "Planetary set"


def drawing_of(scene: TrainScene) -> Chart:
    """All gears seen along their axes: tip circles, and dashed pitch circles. Gears on one shaft have one centre. A
    planetary set has its teeth. Parts in series stand beside each other."""
    if scene.joined:
        return _beside_each_other(scene)
    if scene.shafts.carrier is not None:
        return set_drawing(scene)
    at = centres(scene.layout)
    graph = scene.graph
    curves = []
    for number, (sides, name) in enumerate(zip(graph.sides, gear_names(scene.meshes))):
        # A gear of several meshes is drawn in its first one.
        mesh, side = sides[0]
        pair = scene.meshes[mesh].pair
        gear = pair.gears[side]
        stage, _, own = name.rpartition(".")
        words = f"{stage}: {f'gear {own}' if own.isdigit() else own}, {gear.teeth} teeth"
        curves += _circles(at[graph.shafts[number]], gear, pair, words, _colour(number))
    speeds = "turns of the first shaft in one of the last"
    caption = f"Tip and pitch circles (dashed), to scale; {scene.ratio:.5g} {speeds}"
    return Chart(caption, curves, "x (mm)", "y (mm)", height=520, equal=True)


def _beside_each_other(scene: TrainScene) -> Chart:
    """The drawings of all parts from left to right, in the order of the power."""
    curves: list[Curve] = []
    end = 0.0
    for part in scene.parts:
        own = drawing_of(part).curves
        around = [each.x for each in own if len(each.x)]
        left, right = (float(limit([limit(x) for x in around])) for limit in (np.min, np.max))
        gap = GAP * (right - left) if curves else 0.0
        known = f"{part.title}: "
        for each in own:
            name = each.name if each.name.startswith(known) else known + each.name
            curves.append(replace(each, name=name, x=np.asarray(each.x) + end + gap - left))
        end += gap + right - left
    caption = f"Parts in the order of the power, to scale; {scene.ratio:.6g} turns of the input in one of the output"
    return Chart(caption, curves, "x (mm)", "y (mm)", height=520, equal=True)


def _circles(centre: complex, gear: Gear, pair: GearPair, name: str, colour: str) -> list[Curve]:
    angles = np.linspace(0.0, 2.0 * np.pi, POINTS_OF_A_CIRCLE)

    def circle(radius: float, **options) -> Curve:
        return Curve(
            name, centre.real + radius * np.cos(angles), centre.imag + radius * np.sin(angles), colour, **options
        )

    return [
        circle(gear.tip_radius),
        circle(gear.base_radius / cos(pair.operating_pressure_angle), dash="dash", listed=False, width=1.0),
    ]


def errors(scene: TrainScene, dataset: xr.Dataset) -> list[Chart]:
    """Of the whole over time, and of each mesh over its own mesh cycles; of a planetary set of the first planet."""
    times, words = _times(scene, dataset)
    overall = MICRORADIANS * np.asarray(dataset["overall_transmission_error"])
    # Of the last cycles where stages vibrate.
    span = dataset.attrs["peak_to_peak_overall_transmission_error"]
    charts = [
        Chart(
            f"Overall transmission error: peak to peak {digits(MICRORADIANS * span)} µrad",
            [Curve("overall transmission error", times, overall)],
            words,
            f"Lag of the {'last shaft' if scene.shafts.carrier is None else 'output'} (µrad)",
            least=LEAST_SHARE * float(np.abs(overall).max(initial=0.0)),
            height=320,
        )
    ]
    if OF_OUTPUTS in dataset:
        charts.append(_of_outputs(dataset, times, words))
    for number, mesh in enumerate(scene.meshes):
        if mesh.like is not None:
            continue
        error, phase, span = (
            dataset[name].values[..., number]
            for name in ("transmission_error", "mesh_phase", "peak_to_peak_transmission_error")
        )
        # That of an internal gear is negative.
        radius = 1e3 * abs(mesh.pair.wheel.base_radius)
        values = radius * error
        known = np.isfinite(values)
        charts.append(
            Chart(
                f"{mesh.name}: peak to peak {digits(radius * span)} µm on the wheel's base circle",
                [Curve(mesh.name, phase[known], values[known], _colour(number))],
                f"Time (cycles of mesh {mesh.name})",
                "Transmission error (µm)",
                least=LEAST_SHARE * float(np.abs(values[known]).max(initial=0.0)),
                height=240,
            )
        )
    return charts


def _times(scene: TrainScene, dataset: xr.Dataset) -> tuple[np.ndarray, str]:
    """The times of the steps, and what they are: cycles of the first mesh, of a speed ramp seconds."""
    times = np.asarray(dataset["time"])
    if scene.shafts.ramp is not None:
        return times, "Time (s)"
    return scene.meshes[0].scene.motion.mesh_frequency * times, "Time (cycles of the first mesh)"


def _of_outputs(dataset: xr.Dataset, times: np.ndarray, along: str) -> Chart:
    """Lags of all shafts that drive no gear, each without its mean."""
    curves = []
    for number, own in enumerate(dataset[OF_OUTPUTS].transpose("output", "time")):
        values = MICRORADIANS * np.asarray(own)
        curves.append(Curve(f"shaft of {own['output'].item()}", times, values - values.mean(), _colour(number)))
    words = "Lag of the shaft (µrad)"
    return Chart("Outputs, each without its mean", curves, along, words, height=280)


def _known_orders(scene: TrainScene, dataset: xr.Dataset) -> list[Chart]:
    """None where the result's warnings say why."""
    try:
        return orders(scene, dataset)
    except SceneError:
        return []


def orders(scene: TrainScene, dataset: xr.Dataset) -> list[Chart]:
    """Of a speed ramp the orders over the speed and a Campbell diagram, else the spectrum of the whole run. Raises
    SceneError where the run is too short for them."""
    if scene.shafts.ramp is None:
        return [_spectrum(scene, dataset)]
    found = ramp_orders(dataset, scene)
    rpm = 60.0 * found[0].speeds
    names = [mesh.name for mesh in scene.meshes]
    named = [(f"{each.mesh}, harmonic {each.harmonic}", _colour(names.index(each.mesh)), each) for each in found]
    dashes = {1: "solid", 2: "dash", 3: "dot"}
    amplitudes = [
        Curve(words, rpm, MICRORADIANS * each.amplitudes, colour, dash=dashes[each.harmonic])
        for words, colour, each in named
    ]
    excited = [
        Curve(words, rpm, each.order * each.speeds, colour, dash=dashes[each.harmonic]) for words, colour, each in named
    ]
    (row,) = train_model_of(scene).rows
    highest = max(float((each.order * each.speeds).max()) for each in found)
    natural = [
        Curve("natural frequencies", rpm, np.full(len(rpm), own.frequency), GREY, width=1.0, listed=not number)
        for number, own in enumerate(row.vibrations)
        if own.frequency <= highest
    ]
    speed = "Speed of the first shaft (rpm)"
    note = "Amplitudes of the harmonics in windows of two cycles of the slowest mesh."
    return [
        Chart("Orders over the speed", amplitudes, speed, "Amplitude of the last shaft (µrad)", note, height=360),
        Chart(
            "Campbell diagram", [*natural, *excited], speed, "Frequency (Hz)",
            "Natural frequencies are about those with one tooth pair in each mesh.", height=360,
        ),
    ]  # fmt: skip


def _spectrum(scene: TrainScene, dataset: xr.Dataset) -> Chart:
    """Amplitudes of the overall transmission error over orders of the first shaft, by the meshes that make them."""
    first, last = ("first shaft", "last shaft") if scene.shafts.carrier is None else ("input", "output")
    found = overall_orders(dataset, scene, turns=True)
    highest = max(each.order for each in found if each.harmonic <= HARMONICS_SHOWN)
    shown = [each for each in found if each.order <= highest * (1.0 + 1e-9)]
    curves = []
    flags = []
    top = MICRORADIANS * max(each.amplitude for each in shown)
    # The meshes in the order of the train.
    for number, meshes in enumerate(dict.fromkeys(each.meshes for each in sorted(found, key=lambda each: each.place))):
        own = [each for each in shown if each.meshes == meshes]
        places = np.array([each.order for each in own])
        heights = MICRORADIANS * np.array([each.amplitude for each in own])
        curves.append(Curve(meshes, places, heights, _colour(number), width=0.012 * highest, mode=BARS))
        flags += [
            Flag(place, height, f"{each.harmonic} × {'turn' if each.of_turn else 'mesh'}", _colour(number))
            for each, place, height in zip(own, places, heights)
            if height > LEAST_FLAGGED * top
        ]
    note = "" if any(each.of_turn for each in found) else ORDERS_NOTE
    return Chart(
        f"Harmonics of the meshes, as they reach the {last}", curves, f"Order (events a turn of the {first})",
        f"Amplitude of the {last} (µrad)", note, height=420, x_range=(0.0, 1.12 * highest), flags=flags,
    )  # fmt: skip


def loads_along_face(scene: TrainScene, dataset: xr.Dataset) -> list[Chart]:
    """Line load along the face of each mesh over the face; of a planetary set of the first planet."""
    charts = []
    for number, mesh in enumerate(scene.meshes):
        if not mesh.scene.three_dimensional or mesh.like is not None:
            continue
        run = shown_mesh(dataset, scene, number)
        drawn = line_loads(run)[-1:] if run.over_face else []
        charts += [replace(each, caption=f"{mesh.name}: {each.caption.lower()}") for each in drawn]
    return charts


def bent_shafts_of(scene: TrainScene, dataset: xr.Dataset) -> list[Chart]:
    """How the shafts of the train bend; nothing where none does."""
    if "shaft" not in dataset.dims:
        return []
    return deflections(scene, dataset)


def _colour(number: int) -> str:
    return PALETTE[number % len(PALETTE)]
