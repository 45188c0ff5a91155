"""The dataset of a train's map over loads and speeds, from its studies, and its pictures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import xarray as xr

import fenics_gears
from fenics_gears import MICRORADIANS, OVERALL, SceneError, carried_train, load, overall_orders
from fenics_gears.charts import DARK, GREY, MARKED_LINES, PALETTE, Chart, Curve, shades, span, words_apart
from fenics_gears.many_runs import Outcome, kinds_of_meshes, load_combined

from .train_map import LOADS_OF_TRAIN, TrainMap

DYNAMIC = "dynamic_"
OF_THE_WHOLE = (f"peak_to_peak_{OVERALL}", f"mean_{OVERALL}", "friction_loss")
OF_MESHES = (
    "peak_to_peak_transmission_error", "mean_transmission_error", "mean_mesh_stiffness", "peak_contact_pressure",
    "largest_pair_force", "max_normal_force", "face_load_factor",
)  # fmt: skip
OF_LAST = "Peak to peak (µrad)"
# Harmonics of each mesh that lines are drawn of.
DRAWN = 3
Columns = dict[str, tuple[tuple[str, ...], np.ndarray, dict[str, str]]]


def train_map_dataset(wanted: TrainMap, at_rest: Outcome, over_speed: Outcome | None) -> xr.Dataset:
    """Everything of a map over `load` (N m or kW), with speeds also over `input_speed` (rpm); of meshes over `mesh`,
    amplitudes over `order`, events in a turn of the first shaft. Angles are urad of the last shaft, of a mesh urad of
    its wheel. A case without a result has not a number."""
    unit, words = LOADS_OF_TRAIN[wanted.given]
    dataset = xr.Dataset(coords={"load": ("load", np.array(wanted.numbers), {"units": unit, "long_name": words})})
    dataset = dataset.assign(_taken(at_rest, ("load",), ""))
    outcomes: dict[tuple[str, tuple[str, ...]], Outcome] = {("", ("load",)): at_rest}
    if over_speed is not None:
        of_speed = {"units": "rpm", "long_name": "speed of the first shaft"}
        dataset = dataset.assign_coords(input_speed=("input_speed", np.array(wanted.rpm), of_speed))
        dataset = dataset.assign(_taken(over_speed, ("load", "input_speed"), DYNAMIC))
        outcomes[DYNAMIC, ("load", "input_speed")] = over_speed
        modes = over_speed.study.cases[0].model.rows[0].vibrations
        note = {"units": "Hz", "long_name": "natural frequency with one tooth pair in each mesh, about"}
        dataset["natural_frequency"] = (("mode",), np.array([each.frequency for each in modes]), note)
    dataset = dataset.assign(_amplitudes(outcomes, dataset.sizes["load"]))
    return dataset.assign_attrs(
        title=wanted.scene.title, scene=wanted.scene.text, fenics_gears_version=fenics_gears.__version__
    )


def _taken(outcome: Outcome, dimensions: tuple[str, ...], prefix: str) -> Columns:
    """Numbers of the whole and of each mesh that a study has."""
    study = load_combined(outcome.file)
    found: Columns = {"mesh": (("mesh",), study["mesh"].values, {"long_name": "mesh"})}
    for names, over in ((OF_THE_WHOLE, dimensions), (OF_MESHES, (*dimensions, "mesh"))):
        for name in (each for each in names if each in study and study[each].ndim == len(over)):
            labels = {key: study[name].attrs[key] for key in ("units", "long_name")}
            angle = labels["units"] == "rad"
            found[prefix + name] = (
                over,
                study[name].values * (MICRORADIANS if angle else 1.0),
                {**labels, "units": "urad"} if angle else labels,
            )
    return found


def _amplitudes(outcomes: dict[tuple[str, tuple[str, ...]], Outcome], loads: int) -> Columns:
    """Amplitudes of the overall transmission error by its orders, of all studies over the same ones; by prefix and
    dimensions of each."""
    known: dict[tuple[int, int], Any] = {}
    every = []
    for outcome in outcomes.values():
        values: dict[tuple[int, int], np.ndarray] = {}
        for index in outcome.records:
            run = load(outcome.file.parent / "cases" / f"{outcome.study.cases[index].name}.nc")
            for each in _orders_of(run):
                key = each.place, each.harmonic
                known.setdefault(key, each)
                values.setdefault(key, np.full(len(outcome.study.cases), np.nan))[index] = each.amplitude
        every.append(values)
    keys = sorted(known, key=lambda key: (known[key].order, key))
    labels = {"units": "urad", "long_name": "amplitude of the lag of the last shaft"}
    found: Columns = {}
    for ((prefix, dimensions), outcome), values in zip(outcomes.items(), every):
        cases = len(outcome.study.cases)
        shape = (loads, cases // loads)[: len(dimensions)]
        nothing = np.full(cases, np.nan)
        amplitudes = MICRORADIANS * np.array([values.get(key, nothing) for key in keys])
        found[f"{prefix}{OVERALL}_amplitude"] = (
            (*dimensions, "order"),
            amplitudes.T.reshape(*shape, len(keys)),
            labels,
        )
    names = np.array([known[key].meshes for key in keys], dtype=object)
    turns = np.array([known[key].order for key in keys])
    over = ("order",)
    return found | {
        "order": (over, turns, {"units": "1", "long_name": "events in a turn of the first shaft"}),
        "meshes_of_order": (over, names, {"long_name": "meshes that have an order"}),
        "place": (over, np.array([key[0] for key in keys]), {"long_name": "place of the first of them in the train"}),
        "harmonic": (over, np.array([key[1] for key in keys]), {"long_name": "multiple of the mesh frequency"}),
    }


def _orders_of(run: xr.Dataset) -> list[Any]:
    """Of a run; none where its warnings say why."""
    try:
        return overall_orders(run, carried_train(run))
    except SceneError:
        return []


def train_map_pictures(found: xr.Dataset) -> dict[str, tuple[str, list[Chart]]]:
    """Subject and charts of each picture for which a map has data, by file name."""
    pictures: dict[str, tuple[str, list[Chart]]] = {}
    axis = f"{found['load'].attrs['long_name'].capitalize()} ({found['load'].attrs['units']})"
    found = found.sortby("load")
    if found.sizes["load"] > 1:
        pictures["over_load.png"] = ("Quasi-static, over the load", list(_over(found, "load", axis, "")))
    if "input_speed" in found.coords:
        found = found.sortby("input_speed")
        speed = "Speed of the first shaft (rpm)"
        if found.sizes["input_speed"] > 1:
            highest = found.isel(load=-1)
            charts = [_of_loads(found, speed), *list(_over(highest, "input_speed", speed, DYNAMIC))[1:]]
            pictures["over_speed.png"] = ("Steady speeds", charts)
        if found.sizes["order"]:
            pictures["campbell.png"] = ("Campbell diagram", [_campbell(found, speed)])
    return pictures


def _over(found: xr.Dataset, over: str, axis: str, prefix: str) -> Iterator[Chart]:
    """The overall transmission error, its orders, and those of all meshes over an axis."""
    places = found[over].values
    whole = f"{prefix}peak_to_peak_{OVERALL}"
    yield _chart({"": found[whole].values}, places, axis, "Overall transmission error, peak to peak", OF_LAST)
    at = f" at {float(found['load']):g} {found['load'].attrs['units']}" if over != "load" else ""
    amplitudes = found[f"{prefix}{OVERALL}_amplitude"]
    curves = {
        f"{int(found['harmonic'][number])} × {found['meshes_of_order'].values[number]}": amplitudes[..., number].values
        for number in _drawn_orders(found)
    }
    if any(np.isfinite(each).any() for each in curves.values()):
        yield _chart(curves, places, axis, f"Its orders{at}", "Amplitude (µrad)")
    errors = found[f"{prefix}peak_to_peak_transmission_error"]
    yield _chart(
        _of_kinds(errors),
        places,
        axis,
        f"Transmission error of each mesh, peak to peak{at}",
        "Peak to peak (µrad of its wheel)",
    )
    if f"{prefix}largest_pair_force" in found:
        forces = _of_kinds(found[f"{prefix}largest_pair_force"])
        yield _chart(forces, places, axis, f"Largest force of a tooth pair{at}", "Force (N)")


def _of_kinds(numbers: xr.DataArray) -> dict[str, np.ndarray]:
    """Numbers of meshes by what is said of these, the largest of all planets."""
    kinds = kinds_of_meshes([str(name) for name in numbers["mesh"].values])
    return {name: numbers.isel(mesh=places).max("mesh").values for name, places in kinds.items()}


def _drawn_orders(found: xr.Dataset) -> np.ndarray:
    """Places of the lowest harmonics, meshes in the order of the train."""
    drawn = np.flatnonzero(found["harmonic"].values <= DRAWN)
    return drawn[np.argsort(found["place"].values[drawn], kind="stable")]


def _of_loads(found: xr.Dataset, axis: str) -> Chart:
    unit = found["load"].attrs["units"]
    errors = found[f"{DYNAMIC}peak_to_peak_{OVERALL}"]
    curves = {f"{each:g} {unit}": errors.sel(load=each).values for each in found["load"].values}
    speeds = found["input_speed"].values
    return _chart(curves, speeds, axis, "Overall transmission error, peak to peak", OF_LAST, shades(len(curves)))


def _chart(
    curves: dict[str, np.ndarray], x: np.ndarray, axis: str, caption: str, title: str,
    colours: Sequence[str] = (*PALETTE, *PALETTE),
) -> Chart:  # fmt: skip
    drawn = [
        Curve(name, x, values, colour, mode=MARKED_LINES) for (name, values), colour in zip(curves.items(), colours)
    ]
    return Chart(caption, drawn, axis, title, height=270, least=span([(each.name, each.y, "") for each in drawn]))


def _campbell(found: xr.Dataset, axis: str) -> Chart:
    """Frequencies of all mesh orders over the speed, and the natural frequencies."""
    fastest = float(found["input_speed"].max())
    drawn = _drawn_orders(found)
    meshes = list(dict.fromkeys(found["meshes_of_order"].values[drawn]))
    ends = np.array([0.0, fastest])
    curves = []
    said: dict[float, list[str]] = {}
    for number in drawn:
        name = found["meshes_of_order"].values[number]
        order = float(found["order"][number])
        harmonic = int(found["harmonic"][number])
        colour = (*PALETTE, DARK)[meshes.index(name) % (len(PALETTE) + 1)]
        curves.append(Curve(name, ends, order / 60.0 * ends, colour, listed=harmonic == 1))
        said.setdefault(round(order, 6), []).append(f"{harmonic} × {name if len(meshes) > 1 else 'mesh'}")
    top = max(said) / 60.0 * fastest
    shown = found["natural_frequency"].values
    shown = shown[shown < top]
    for place, frequency in enumerate(shown):
        level = np.full(2, frequency)
        curves.append(Curve("natural frequencies", ends, level, GREY, dash="dash", listed=place == 0))
    places = [(fastest, order / 60.0 * fastest, ", ".join(words)) for order, words in said.items()]
    places += [(0.0, frequency, f"{frequency:.0f} Hz") for frequency in shown]
    curves.append(words_apart(places, 0.035 * top, "top right"))
    ranges = {"x_range": (0.0, 1.3 * fastest), "y_range": (0.0, 1.06 * top)}
    return Chart("", curves, axis, "Frequency (Hz)", height=560, **ranges)
