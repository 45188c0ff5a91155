"""What the defaults of ten helical pairs err by: each size made finer alone, down to four times as fine, and all
together twice as fine.

Each run is a process of its own, whose bodies are kept in the cache. Runs whose slices would take more than MOST_MEMORY
are left out; a size that was made twice or three times as fine tells what four times would, by order 2. Cuts between
sectors have all their nodes where they are finer.
"""

import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import cos, isnan, nan, radians
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from tests.benchmarks.third_dimension.one_run import NUMBERS
from tests.benchmarks.third_dimension.table import PICTURES, Row, read_rows, table, write_rows

from fenics_gears import Scene, scene_from_text
from fenics_gears.model.cost import expected_cost
from fenics_gears.model.model import Model, model_of
from fenics_gears.runs.settings.setting import own_setting
from fenics_gears.scene.write import text_of

NAME = "defaults"
ROOT = Path(__file__).parents[3]
# Module, face width (mm), helix angle (deg), teeth, torque of the pinion (N m).
PAIRS = (
    (1.6, 32.0, 28.0, 23, 67, 200.0),
    (1.6, 22.0, 28.0, 23, 67, 140.0),
    (1.6, 40.0, 32.0, 25, 71, 250.0),
    (2.0, 40.0, 25.0, 24, 73, 400.0),
    (1.25, 25.0, 30.0, 29, 83, 120.0),
    (1.5, 30.0, 33.0, 31, 93, 250.0),
    (3.0, 60.0, 15.0, 21, 65, 1000.0),
    (5.0, 100.0, 12.0, 23, 89, 5000.0),
    (8.0, 180.0, 21.7, 20, 39, 20000.0),
    (2.5, 28.0, 20.0, 20, 60, 250.0),
)
STEPS = 40
MOST_MEMORY = 7e9
MEAN, SPAN = NUMBERS[:2]


@dataclass(frozen=True)
class Finer:
    """How many times as fine each size is as by default, and the steps of a mesh cycle."""

    slices: float = 1
    layers: float = 1
    flank: float = 1
    body: float = 1
    cuts: float = 1
    steps: int = STEPS


# Of a cut with all of its nodes.
WHOLE_CUTS = 2
RUNS = (
    Finer(),
    Finer(slices=2),
    Finer(cuts=WHOLE_CUTS),
    Finer(flank=2),
    Finer(body=2),
    Finer(layers=2),
    Finer(slices=3),
    Finer(slices=4),
    Finer(slices=2, layers=2, flank=2, body=2, cuts=WHOLE_CUTS),
    Finer(slices=0.5),
    Finer(flank=0.5),
    Finer(layers=0.5),
    Finer(body=0.5),
    Finer(steps=100),
    Finer(flank=4),
    Finer(layers=4),
)


# Slices and layers of the first pair, by which the others are not divisible.
ODD = tuple(Finer(slices=slices / 38, layers=layers / 8) for slices, layers in ((36, 12), (40, 12), (60, 12), (60, 20)))


def pair(module: float, width: float, helix: float, teeth: int, mate: int, torque: float) -> Scene:
    """A pair with bores of 0.4 of the reference circle, without backlash, quasi-static, frictionless."""
    gears = "".join(
        f'[gears.{name}]\nteeth = {count}\nprofile_shift = {shift}\nbore_diameter = "'
        f'{0.4 * module * count / cos(radians(helix)):.3f} mm"\n'
        for name, count, shift in (("pinion", teeth, 0.2), ("wheel", mate, 0.0))
    )
    return scene_from_text(
        f'[gears]\nmodule = "{module} mm"\npressure_angle = "20 deg"\nhelix_angle = "{helix} deg"\nface_width ='
        f' "{width} mm"\n{gears}[gears.material]\nyoungs_modulus = "206 GPa"\npoissons_ratio = 0.3\n[load]\n'
        f'pinion_torque = "{torque} N m"\n'
    )


def finer_model(scene: Scene, finer: Finer) -> Model:
    own = own_setting(scene)
    setting = replace(
        own,
        flank=own.flank / finer.flank,
        spacing=own.spacing / finer.flank,
        body=own.body / finer.body,
        slices=round(own.slices * finer.slices),
        layers=round(own.layers * finer.layers),
    )
    accuracy = replace(
        scene.accuracy,
        steps_per_mesh_cycle=finer.steps,
        slices=setting.slices,
        layers=setting.layers,
        flank_element_size=setting.flank if finer.flank != 1 else None,
        body_element_size=setting.accuracy(scene.gears.module).body_element_size if finer.body != 1 else None,
    )
    return model_of(replace(scene, accuracy=accuracy))


def measure(
    most_memory: float = MOST_MEMORY, runs: Sequence[Finer] = (*RUNS, *ODD), pairs: Sequence[int] = range(len(PAIRS))
) -> list[Row]:
    """Run what the file does not have yet; `pairs` by their numbers."""
    rows = read_rows(NAME) if (PICTURES / f"{NAME}.csv").exists() else []
    done = {_key(row["pair"], row) for row in rows}
    for finer in runs:
        for number in pairs if finer in RUNS else (0,):
            model = finer_model(pair(*PAIRS[number]), finer)
            if _key(number, vars(finer)) in done or expected_cost(model).memory > most_memory:
                continue
            slices, layers = model.slices_and_layers
            found = numbers_of(text_of(model.scene), most_memory, whole_cuts=finer.cuts == WHOLE_CUTS)
            taken = {"slices_taken": slices, "layers_taken": layers, **found}
            rows.append({"pair": number, **vars(finer), **taken})
            print(rows[-1], flush=True)
            write_rows(NAME, sorted(rows, key=lambda row: row["pair"]))
    return rows


def _key(number: float, sizes: Mapping[str, float]) -> tuple[float, ...]:
    """Of a run; the file has eight digits."""
    return number, *(round(sizes[name], 6) for name in vars(Finer()))


def numbers_of(
    text: str, memory: float = MOST_MEMORY, checkout: Path = ROOT, cache: Path | None = None, whole_cuts: bool = False
) -> Row:
    """Of a scene by a checkout, in a process of its own on one thread; `cache`: a folder in place of the user's. With
    `whole_cuts` bodies keep all nodes of their cuts, and none is taken from the cache, which does not know of that."""
    environment = {**os.environ, "PYTHONPATH": str(checkout), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    environment["FENICS_GEARS_MEMORY"] = f"{1.2e-9 * memory:g} GB"
    called = [sys.executable, "-P", str(Path(__file__).with_name("one_run.py"))]
    with TemporaryDirectory() as empty:
        if whole_cuts:
            called.append("--whole-cuts")
            cache = Path(empty)
        if cache is not None:
            environment["FENICS_GEARS_CACHE"] = str(cache)
        answered = subprocess.run(called, check=True, input=text, stdout=subprocess.PIPE, text=True, env=environment)
    return json.loads(answered.stdout.splitlines()[-1])


SIZES = {
    "slices": "slices",
    "flank": "flank elements and contact nodes",
    "layers": "layers",
    "body": "body elements",
    "cuts": "nodes of cuts",
}


# Of the errors by size; of the mean by slices 1.0 and 1.3, where slices were made twice and four times as fine.
ORDER = 2.0
ORDER_OF_MEAN_BY_SLICES = 1.0


def part(rows: list[Row], size: str, name: str) -> float:
    """Relative error of the defaults in a number by one size, against four times as fine: from the finest run of that
    size, or from one half as fine; T_EPP in parts of the mean. `rows`: a pair's."""
    known = {_key(0, row): row for row in rows}
    times = max((row[size] for row in rows if alone(row, size) and row[size] != 1), default=None)
    if times is None:
        return nan
    own, finest = (known[_key(0, vars(finer))] for finer in (Finer(), Finer(**{size: times})))
    scale = finest[MEAN] if name == SPAN else finest[name]
    order = ORDER_OF_MEAN_BY_SLICES if (size, name) == ("slices", MEAN) else ORDER
    return (own[name] - finest[name]) / scale * (1.0 - 4.0**-order) / (1.0 - times**-order)


def alone(row: Row, size: str) -> bool:
    """Whether nothing but a size is finer, or nothing at all."""
    return row["steps"] == STEPS and all(row[each] == 1 for each in SIZES if each != size)


def section() -> str:
    """Errors of each pair that was measured, and by size the largest of all of them."""
    kept = read_rows(NAME)
    numbers = sorted({int(row["pair"]) for row in kept})
    of_pairs = [[row for row in kept if row["pair"] == number] for number in numbers]
    found = [{size: {name: part(rows, size, name) for name in NUMBERS} for size in SIZES} for rows in of_pairs]
    lines = []
    for (module, width, helix, teeth, mate, _), rows, errors in zip([PAIRS[each] for each in numbers], of_pairs, found):
        own = next(row for row in rows if all(row[each] == 1 for each in SIZES) and row["steps"] == STEPS)
        total = {
            name: sum(each for each in (errors[size][name] for size in SIZES) if not isnan(each)) for name in NUMBERS
        }
        lines.append([
            f"{module:g}, {width:g}, {helix:g}, {teeth}/{mate}", f"{own['slices_taken']:g}, {own['layers_taken']:g}",
            f"{own[MEAN]:.2f}", f"{own[SPAN]:.3f}", *(f"{100.0 * each:+.2f}" for each in total.values()),
            f"{100.0 * total[SPAN] * own[MEAN] / own[SPAN]:+.1f}",
        ])  # fmt: skip
    headings = [
        "m_n, face, helix, teeth", "slices, layers", "mean T_E, µm", "T_EPP, µm", "off: mean T_E, %",
        "T_EPP, % of the mean", "K_Hβ, %", "largest line load, %", "peak pressure, %", "T_EPP, % of itself",
    ]  # fmt: skip
    by_size = [
        [
            f"{words} ({sum(not isnan(errors[size][MEAN]) for errors in found)} pairs)",
            *(f"{100.0 * np.nanmax([abs(errors[size][name]) for errors in found]):.2f}" for name in NUMBERS),
        ]
        for size, words in SIZES.items()
        if not all(isnan(errors[size][MEAN]) for errors in found)
    ]
    names = ["largest of all pairs by", "mean T_E, %", "T_EPP, % of the mean", *headings[6:9]]
    return "\n".join([*table(headings, lines), "", *table(names, by_size), "", *_odd(of_pairs[0])])


def _odd(rows: list[Row]) -> list[str]:
    """The first pair's numbers with slices and layers of any ratio."""
    known = {_key(0, row): row for row in rows}
    shown = [known[key] for finer in (Finer(), *ODD, Finer(slices=2)) if (key := _key(0, vars(finer))) in known]
    lines = [
        [f"{row['slices_taken']:g} on {row['layers_taken']:g}", *(f"{row[name]:.4g}" for name in NUMBERS)]
        for row in shown
    ]
    headings = ["first pair: slices on layers", "mean T_E, µm", "T_EPP, µm", "K_Hβ", "largest line load, factor"]
    return table([*headings, "peak pressure, MPa"], lines)
