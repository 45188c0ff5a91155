"""The result of a train: the variables of a pair over steps and meshes, the numbers of each mesh as variables over the
meshes, and the transmission error of the whole over time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

import fenics_gears
from fenics_gears.model.row_model import RowModel
from fenics_gears.model.train import TrainModel
from fenics_gears.numbers_version import NUMBERS_VERSION
from fenics_gears.scene.train_scene import Link

from .attributes import RESULT_ATTRIBUTES
from .carried_scene import files_of
from .dataset import RunResult
from .layout import OF_OUTPUTS, OVERALL
from .mesh_of_train import SHARED, over_meshes
from .overall_orders import why_no_orders
from .path_shares import path_shares
from .sets_in_train import MESH, side_by_side
from .validity import of_each_kind, worst_first

if TYPE_CHECKING:
    from .train_shafts import ResultOfShafts

# Of a mesh of a row by itself they would leave out what it does through the bodies of its neighbours.
OF_ENERGY = ("energy", "work_")
# What a result tells in words of its whole run.
OF_THE_WHOLE = (
    "title", "scene", "scene_name", "scene_folder", "scene_files", "fenics_gears_version", "numbers_version",
    "complete", "failed_afterwards", "stopped", "warnings",
)  # fmt: skip


@dataclass(frozen=True)
class MeshResult:
    """A mesh of a train: its variables, as dimensions, values and labels, its numbers, also those in words, and its
    warnings. `shafts`: of the first mesh of a train, that of its shafts that bend, or of its planetary set."""

    name: str
    variables: dict[str, tuple]
    numbers: dict[str, Any]
    warnings: Sequence[str] = ()
    # s, of its march and of its numbers.
    seconds: tuple[float, float] = (0.0, 0.0)
    shafts: ResultOfShafts | None = None

    def lag(self, link: Link) -> np.ndarray:
        """Transmission error (rad) at the steps of its last mesh cycle, or that of its set until it repeats."""
        steps = link.cycles * int(self.numbers["steps_per_mesh_cycle"])
        known = self.variables["transmission_error"]
        if link.of_set and self.shafts is not None:
            known = self.shafts.variables[OVERALL]
        return np.asarray(known[1])[-1 - steps : -1]


def mesh_result(name: str, result: RunResult) -> MeshResult:
    """That of a stage which was run as a pair."""
    dataset = result.dataset
    own = {
        str(each): (of.dims, of.values, of.attrs)
        for each, of in dataset.variables.items()
        if not str(each).startswith(OF_ENERGY)
    }
    numbers: dict[str, float | str] = {
        each.name: float(dataset.attrs[each.name])
        for each in RESULT_ATTRIBUTES
        if each.units and not each.name.startswith("time_") and isinstance(dataset.attrs.get(each.name), float | int)
    }
    texts = [each.name for each in RESULT_ATTRIBUTES if not each.units and each.name not in OF_THE_WHOLE]
    numbers |= {name: said for name in texts if isinstance(said := dataset.attrs.get(name), str)}
    seconds = dataset.attrs["time_march"], result.seconds
    return MeshResult(name, own, numbers, dataset.attrs["warnings"].splitlines(), seconds)


def dataset_of(model: TrainModel, meshes: Sequence[MeshResult]) -> xr.Dataset:
    """All meshes side by side, and the lag of the last shaft."""
    times, overall = overall_error(model, meshes)
    variables = dict(over_meshes([each.variables for each in meshes]))
    variables[OVERALL] = (
        "time",
        overall,
        {"units": "rad", "long_name": "lag of the last shaft behind the nominal motion of the first"},
    )
    variables |= _frequencies(model)
    variables |= _numbers_of_meshes([each.numbers for each in meshes])
    if not model.scene.joined:
        variables |= of_outputs(model, meshes)
        variables |= path_shares(model, meshes)
    most = {name: max((each for each in meshes), key=lambda each: _size(each, name)) for name in SHARED}
    coordinates = {name: widest.variables[name] for name, widest in most.items() if name in widest.variables}
    coordinates |= {
        "time": ("time", times, {"units": "s", "long_name": "time"}),
        MESH: (MESH, [each.name for each in meshes], {"long_name": "mesh"}),
    }
    shafts = _of_shafts(model, meshes)
    if shafts is not None:
        variables |= shafts.variables
        coordinates |= shafts.coordinates
    found = xr.Dataset(variables, coords=coordinates)
    found.attrs = _attributes(model, meshes, overall) | ({} if shafts is None else shafts.numbers)
    if said := why_no_orders(found, model.scene):
        found.attrs["warnings"] = "\n".join([*found.attrs["warnings"].splitlines(), said])
    return found


def _of_shafts(model: TrainModel, meshes: Sequence[MeshResult]) -> ResultOfShafts | None:
    """What the shafts that bend say, or the planetary sets."""
    if not model.scene.joined:
        return meshes[0].shafts
    firsts = [(link.name, meshes[link.mesh].shafts) for link in model.scene.links if link.of_set]
    return side_by_side([(name, shafts) for name, shafts in firsts if shafts is not None])


def _frequencies(model: TrainModel) -> dict[str, tuple]:
    """Mesh frequencies over the steps of a speed ramp."""
    ramp = model.rows[0].ramp
    if ramp is None:
        return {}
    steps = range(model.rows[0].steps + 1)
    speeds = np.array([ramp.mesh_frequency(step) for step in steps]) / ramp.start
    values = np.outer(speeds, [each.scene.motion.mesh_frequency for each in model.models])
    return {"mesh_frequency": (("step", MESH), values, {"units": "Hz", "long_name": "mesh frequency"})}


def overall_error(model: TrainModel, meshes: Sequence[MeshResult]) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) over a cycle of the slowest mesh, or the longest period of gears that run out or have errors, at the
    steps of the fastest; and the lag (rad) of the last shaft there: of each row that of its last gear, through the
    ratios behind it. Between steps it is linear.

    Where all meshes move together, at all steps: the rotation of the last gear, and of the first one through the
    ratios."""
    if model.scene.shafts.moving:
        last = model.scene.graph.last
        return np.asarray(meshes[0].variables["time"][1]), lag_of_output(model, meshes, last)
    links = model.scene.links
    curves = [meshes[link.mesh].lag(link) for link in links]
    steps = [link.frequency * len(curve) for link, curve in zip(links, curves)]
    whole = [1.0 / link.frequency for link in links]
    if not model.scene.joined:
        motions = [own.scene.motion for own in model.models]
        whole += [own.mesh_cycles / own.mesh_frequency for own in motions]
    # Of a whole number round-off makes no step more.
    times = np.arange(int(np.ceil(max(whole) * max(steps) - 1e-9)) + 1) / max(steps)
    cycles_of = [(times * link.frequency, curve) for link, curve in zip(links, curves)]
    lags = (
        np.interp(phase * len(curve), np.arange(len(curve)), curve, period=len(curve)) for phase, curve in cycles_of
    )
    return times, of_last_shaft(model, lags)


def of_last_shaft(model: TrainModel, lags: Iterable[Any]) -> Any:
    """Lag (rad) of the last shaft, of what the output of each link lags: each through the ratios behind it, and the
    shafts between parts that twist."""
    whole: Any = 0.0
    for link, lag in zip(model.scene.links, lags):
        whole = whole * link.turns + lag + link.twist
    return whole


def _size(mesh: MeshResult, name: str) -> int:
    return len(mesh.variables[name][1]) if name in mesh.variables else 0


def _numbers_of_meshes(numbers: Sequence[Mapping[str, Any]]) -> dict[str, tuple]:
    described = {each.name: each for each in RESULT_ATTRIBUTES}
    found = {}
    for name in dict.fromkeys(name for own in numbers for name in own):
        in_words = not described[name].units
        values = np.array([own.get(name, "" if in_words else np.nan) for own in numbers], object if in_words else float)
        units = {} if in_words else {"units": described[name].units}
        found[name] = ((MESH,), values, units | {"long_name": described[name].meaning})
    return found


def _attributes(model: TrainModel, meshes: Sequence[MeshResult], overall: np.ndarray) -> dict[str, Any]:
    scene = model.scene
    said: list[str] = []
    left_over = iter(meshes)
    for row in model.rows:
        together = [next(left_over) for _ in row.models]
        said += of_each_kind((each.name, warning) for each in together for warning in each.warnings)
    numbers = [_numbers_of(link, meshes) for link in scene.links] if scene.joined else [each.numbers for each in meshes]
    left = 1.0
    for each in numbers:
        left *= 1.0 - each.get("friction_loss", 0.0)
    losses = {"friction_loss": 1.0 - left} if left != 1.0 else {}
    if losses and scene.joined:
        losses["efficiency"] = left
    name = "mean_transmission_error"
    mean = of_last_shaft(model, (each.get(f"mean_{OVERALL}", each.get(name)) for each in numbers))
    if scene.shafts.moving:
        # Shafts twist too.
        overall = overall[-1 - model.rows[0].recorded :]
        mean = float(overall[:-1].mean())
    return {
        "title": scene.title,
        "scene": scene.text,
        "scene_name": scene.name,
        "fenics_gears_version": fenics_gears.__version__,
        "numbers_version": NUMBERS_VERSION,
        "complete": 1,
        **_folder(model),
        "warnings": "\n".join(worst_first(dict.fromkeys([*said, *_of_rows(model)]))),
        "mean_overall_transmission_error": mean,
        "peak_to_peak_overall_transmission_error": float(np.ptp(overall)),
        "newton_iterations_total": _iterations(model, meshes),
        "time_march": sum(each.seconds[0] for each in meshes),
        "time_numbers": sum(each.seconds[1] for each in meshes),
        **losses,
    }


def _numbers_of(link: Link, meshes: Sequence[MeshResult]) -> Mapping[str, Any]:
    """Numbers of a mesh, or of a set as a whole."""
    shafts = meshes[link.mesh].shafts
    return shafts.numbers if shafts is not None and link.of_set else meshes[link.mesh].numbers


def _folder(model: TrainModel) -> dict[str, str]:
    """The folder from which files are looked for, where the train names any."""
    named = any(files_of(each.scene) for each in model.models)
    named = named or any(part.shafts.housed for part in model.scene.parts)
    return {"scene_folder": model.models[0].scene.folder} if named else {}


def _iterations(model: TrainModel, meshes: Sequence[MeshResult]) -> int:
    """Newton iterations of all rows; the meshes of one have the same."""
    counts = [int(each.numbers["newton_iterations_total"]) for each in meshes]
    rows = iter(counts)
    return sum(max(next(rows) for _ in row.models) for row in model.rows)


def _of_rows(model: TrainModel) -> list[str]:
    """Warnings before the run of those meshes that were not run as pairs, which tell their own."""
    coupled: list[RowModel] = [row for row in model.rows if not row.single]
    of_meshes = [said for row in coupled for said in row.warnings_of_meshes]
    return [*of_meshes, *(said for row in coupled for said in row.warnings)]


def lag_of_output(model: TrainModel, meshes: Sequence[MeshResult], shaft: int) -> np.ndarray:
    """Lag (rad) of a shaft that drives no gear behind the nominal motion of the first, at all steps of meshes that
    move together."""
    # The gears that their shafts' clocking does not turn.
    carried = model.scene.shafts.carried
    sides = [mesh.gears for mesh in model.scene.meshes]
    ends = [[both[0] for both in sides].index(carried[0][0]), [both[1] for both in sides].index(carried[shaft][0])]
    first, last = (np.asarray(meshes[number].variables["rotation"][1])[:, side] for side, number in enumerate(ends))
    ratio = model.scene.ratio if shaft == model.scene.graph.last else 1.0 / model.scene.turns[shaft]
    return model.scene.meshes[ends[1]].pair.wheel.sign * last + first / ratio


def of_outputs(model: TrainModel, meshes: Sequence[MeshResult]) -> dict[str, tuple]:
    """Lag of each shaft that drives no gear, where there are several."""
    scene = model.scene
    outputs = scene.graph.outputs
    if len(outputs) == 1:
        return {}
    lags = np.stack([lag_of_output(model, meshes, shaft) for shaft in outputs], axis=1)
    names = [scene.shafts.carried[shaft][0] for shaft in outputs]
    words = "lag of each shaft that drives no gear behind the nominal motion of the first"
    last = slice(-1 - model.rows[0].recorded if model.rows[0].recorded else None, None)
    return {
        f"peak_to_peak_{OF_OUTPUTS}": ("output", np.ptp(lags[last], axis=0), {"units": "rad", "long_name": words}),
        OF_OUTPUTS: (("time", "output"), lags, {"units": "rad", "long_name": words}),
        "output": ("output", names, {"long_name": "first gear of a shaft that drives no gear"}),
    }
