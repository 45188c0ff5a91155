"""The overall transmission error of a train by its orders: each mesh repeats with its own mesh cycle and reaches the
last shaft through the ratios behind it. Amplitudes are of the last shaft, rad; order 1 is a turn of the first shaft.

Where stages move together, the lag of the last shaft has harmonics of all mesh frequencies: they are fitted to it, by
least squares over the recorded cycles, which are whole ones of the slowest mesh alone. Where these are too few for
harmonics that are near each other, any amplitudes would do, and none are told."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from fenics_gears.effects import gear_differs
from fenics_gears.errors import SceneError
from fenics_gears.inputs.problem import NOTHING_DONE
from fenics_gears.inputs.tree import GEARS
from fenics_gears.scene.train import TrainScene

from .planetary import kinds_of_meshes
from .sets_in_train import LAG_OF_SET, SET

HARMONICS = 10
# Of a turn of a shaft.
OF_A_TURN = 3
# Smallest singular value of a fit over the largest: by its inverse what no harmonic fits goes into the amplitudes. Of
# whole cycles of all harmonics it is 0.7.
LEAST_CONDITION = 0.05
# Cycles of the slowest mesh that are tried for those that would be enough.
TRIED = (2, 3, 4, 6, 8, 12, 16, 24, 32, 48)


@dataclass(frozen=True, eq=False)
class CycleOfMesh:
    """What a mesh adds to the lag of the last shaft: `values` (n,), rad, over one mesh cycle, and its mesh `frequency`,
    Hz; `order`: mesh cycles in a turn of the first shaft."""

    name: str
    values: np.ndarray
    frequency: float
    order: float


@dataclass(frozen=True)
class OverallOrder:
    """A harmonic of meshes that have one mesh frequency: their names, place of the first of them in the train,
    harmonic, order of the first shaft, amplitude. Or `of_turn` of a gear that runs out or has errors, by its name."""

    meshes: str
    place: int
    harmonic: int
    order: float
    frequency: float
    amplitude: float
    of_turn: bool = False


def cycles_of_meshes(result: xr.Dataset, train: TrainScene) -> list[CycleOfMesh]:
    """What each mesh of a result adds to the lag of the last shaft: `name`, `values` (rad) over its mesh cycle, mesh
    `frequency` (Hz), and `order`, its mesh cycles in a turn of the first shaft.

    >>> from pathlib import Path
    >>> from fenics_gears import simulate_train, train_from_text
    >>> coarse = "[accuracy]\\nsteps_per_mesh_cycle = 20\\nflank_element_size = '0.2 mm'"
    >>> train = train_from_text(Path("demos/gear_trains/idler.toml").read_text() + coarse)
    >>> [round(each.order, 9) for each in cycles_of_meshes(simulate_train(train), train)]
    [24.0, 24.0]
    """
    return _cycles_and_turns(result, train, turns=False)[0]


def _cycles_and_turns(
    result: xr.Dataset, train: TrainScene, turns: bool
) -> tuple[list[CycleOfMesh], list[OverallOrder]]:
    """As `cycles_of_meshes`; with `turns` also the orders of turns."""
    if train.shafts.ramp is not None:
        raise SceneError(
            "speed_ramp: orders of the whole run are of a steady speed. Allowed: without [speed_ramp], or the report,"
            f" which has them over the speed. {NOTHING_DONE}"
        )
    moving = train.shafts.moving
    fitted, of_turns = _fitted(result, train) if moving or turns else ([], [])
    return fitted if moving else _by_themselves(result, train), of_turns if turns else []


def _by_themselves(result: xr.Dataset, train: TrainScene) -> list[CycleOfMesh]:
    """What each mesh adds where its row runs by itself."""
    found = []
    behind = train.turns_of_last
    for link in train.links:
        behind /= link.turns
        steps = link.cycles * int(result["steps_per_mesh_cycle"][link.mesh])
        lags = result[LAG_OF_SET].sel({SET: link.name}) if link.of_set else result["transmission_error"][:, link.mesh]
        error = lags.values[np.isfinite(lags.values)]
        # Of run-outs within sets the mean is left: orders are harmonics of mesh frequencies.
        values = behind * error[-1 - steps : -1].reshape(link.cycles, -1).mean(axis=0)
        frequency = link.cycles * link.frequency
        found.append(CycleOfMesh(link.name, values, frequency, frequency / train.input_speed))
    return found


def _fitted(result: xr.Dataset, train: TrainScene) -> tuple[list[CycleOfMesh], list[OverallOrder]]:
    """All harmonics in the overall transmission error together: of mesh frequencies, those that several meshes have as
    the first one's; and of turns of the gears that run out or whose teeth differ."""
    steps = result["steps_per_mesh_cycle"].values.astype(int)
    turns = _of_turns(train)
    if not (train.shafts.moving or turns):
        return [], []
    meshes = _of_meshes(result, train)
    frequencies = [mesh.scene.motion.mesh_frequency for mesh in train.meshes]
    last = slice(-1 - train.recorded_cycles * int(steps.max()) if train.shafts.moving else 0, -1)
    every = [n * frequencies[mesh] for mesh, n in meshes] + [n * frequency for _, _, n, frequency in turns]
    cycles = np.outer(result["time"].values[last], every)
    if not told_apart(cycles):
        raise SceneError(_too_few_cycles(train, np.array(every), int(steps.max())))
    fitted = harmonics(cycles, result["overall_transmission_error"].values[last]).T
    found = []
    for number, (frequency, named) in enumerate(zip(frequencies, train.meshes)):
        phase = 2.0 * np.pi * np.arange(steps[number]) / steps[number]
        values = np.zeros(steps[number])
        for (own, n), (cosine, sine) in zip(meshes, fitted):
            if own == number:
                values += cosine * np.cos(n * phase) + sine * np.sin(n * phase)
        found.append(CycleOfMesh(named.name, values, frequency, frequency / train.input_speed))
    of_turns = [
        OverallOrder(name, mesh, n, n * own / train.input_speed, n * own, float(np.hypot(*each)), of_turn=True)
        for (name, mesh, n, own), each in zip(turns, fitted[len(meshes) :])
    ]
    return found, of_turns


def harmonics(cycles: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Cosines and sines (2, n, ...) in values (s, ...) beside their mean, by least squares; `cycles` (s, n): of each
    harmonic since the start."""
    return np.linalg.lstsq(_columns(cycles), values, rcond=None)[0][1:].reshape(2, -1, *values.shape[1:])


def told_apart(cycles: np.ndarray) -> bool:
    """Whether steps are enough for the amplitudes of harmonics; `cycles`: as of `harmonics`."""
    columns = _columns(cycles)
    sizes = np.linalg.svd(columns, compute_uv=False)
    return len(sizes) == columns.shape[1] and bool(sizes[-1] > LEAST_CONDITION * sizes[0])


def _columns(cycles: np.ndarray) -> np.ndarray:
    angles = 2.0 * np.pi * cycles
    return np.hstack([np.ones((len(cycles), 1)), np.cos(angles), np.sin(angles)])


def _too_few_cycles(train: TrainScene, frequencies: np.ndarray, steps: int) -> str:
    """Why there are no orders; `frequencies` (n,), Hz: of all harmonics. `steps`: of a cycle of the slowest mesh."""
    rates = frequencies / min(mesh.scene.motion.mesh_frequency for mesh in train.meshes)
    enough = (each for each in TRIED if told_apart(np.outer(np.arange(each * steps) / steps, rates)))
    near = np.sort(frequencies / train.input_speed)
    place = int(np.argmin(np.diff(near)))
    count = next(enough, None)
    allowed = f"more than {TRIED[-1]}" if count is None else f"{count} or more"
    return (
        "orders of the overall transmission error: the recorded cycles of the slowest mesh are too few to tell order"
        f" {near[place]:.5g} of the first shaft from order {near[place + 1]:.5g}; there are none. Allowed: {allowed},"
        " by motion.mesh_cycles and recorded_cycles"
    )


def why_no_orders(result: xr.Dataset, train: TrainScene) -> str:
    """Why the orders of a train's result are not known, empty where they are; of a speed ramp not asked."""
    try:
        if train.shafts.ramp is None:
            _fitted(result, train)
    except SceneError as error:
        return str(error)
    return ""


def _of_meshes(result: xr.Dataset, train: TrainScene) -> list[tuple[int, int]]:
    """Mesh and harmonic of each frequency, within half of the steps of its cycle; of several the first one."""
    steps = result["steps_per_mesh_cycle"].values.astype(int)
    frequencies = [mesh.scene.motion.mesh_frequency for mesh in train.meshes]
    distinct: dict[float, tuple[int, int]] = {}
    for mesh, own in enumerate(steps):
        for n in range(1, min(HARMONICS, own // 2 - 1) + 1):
            distinct.setdefault(round(n * frequencies[mesh] / frequencies[0], 9), (mesh, n))
    return list(distinct.values())


def _of_turns(train: TrainScene) -> list[tuple[str, int, int, float]]:
    """Name, mesh, harmonic and frequency (Hz) of turns of the gears that run out or whose teeth differ; those of one
    shaft once."""
    found: dict[float, tuple[str, int, float]] = {}
    for number, mesh in enumerate(train.meshes):
        for side, name, gear in zip(mesh.pair.sides, mesh.gears, GEARS):
            frequency = mesh.scene.motion.mesh_frequency / side.gear.tooth_count
            if mesh.of_set is None and gear_differs(mesh.scene, gear):
                found.setdefault(round(frequency / train.input_speed, 9), (name, number, frequency))
    return [(name, mesh, n, frequency) for name, mesh, frequency in found.values() for n in range(1, OF_A_TURN + 1)]


def overall_orders(result: xr.Dataset, train: TrainScene, *, turns: bool = False) -> list[OverallOrder]:
    """The first harmonics of each mesh frequency in the overall transmission error of a train's result, by their order;
    of meshes that have the same one, which an idler couples, the sum. Each has the `meshes`, the `harmonic`, the
    `order` of the first shaft, the `frequency` (Hz) and the `amplitude` of the last shaft (rad). With `turns` also
    those of turns of the gears that run out or whose teeth differ. Raises SceneError where the recorded cycles are too
    few to tell them apart.

    >>> from pathlib import Path
    >>> from fenics_gears import simulate_train, train_from_text
    >>> coarse = "[accuracy]\\nsteps_per_mesh_cycle = 20\\nflank_element_size = '0.2 mm'"
    >>> train = train_from_text(Path("demos/gear_trains/idler.toml").read_text() + coarse)
    >>> [round(each.order) for each in overall_orders(simulate_train(train), train)][:3]
    [24, 48, 72]
    """
    alike: list[list[CycleOfMesh]] = []
    cycles, of_turns = _cycles_and_turns(result, train, turns)
    for each in cycles:
        known = next((group for group in alike if abs(group[0].order / each.order - 1.0) < 1e-9), None)
        if known is None:
            alike.append([each])
        else:
            known.append(each)
    found = []
    for group in alike:
        names = ", ".join(kinds_of_meshes([each.name for each in group]))
        spectra = [np.fft.rfft(each.values)[1 : HARMONICS + 1] * (2.0 / len(each.values)) for each in group]
        most = min(map(len, spectra))
        amplitudes = np.abs(sum(each[:most] for each in spectra))
        first = group[0]
        found += [
            OverallOrder(names, cycles.index(first), n, n * first.order, n * first.frequency, float(amplitude))
            for n, amplitude in enumerate(amplitudes, 1)
        ]
    return sorted([*found, *of_turns], key=lambda each: each.order)


# Of each mesh, and mesh cycles of the slowest one in which they are taken, where the speed changes.
ON_A_RAMP = 3
WINDOW_CYCLES = 2


@dataclass(frozen=True, eq=False)
class RampOrder:
    """A harmonic of a mesh, named as the first that has this frequency: `order` of the first shaft; `amplitudes` (w,),
    rad of the last shaft, at the mean `speeds` (w,) of the first shaft, turns in a second."""

    mesh: str
    harmonic: int
    order: float
    speeds: np.ndarray
    amplitudes: np.ndarray


def ramp_orders(result: xr.Dataset, train: TrainScene) -> list[RampOrder]:
    """The first harmonics of each mesh frequency, window by window of a run with a speed ramp; of those that several
    meshes have, the first mesh's.

    They are fitted over the phases of the meshes, in which steps are equal whatever the speed. Raises SceneError where
    a window is too short to tell them apart."""
    steps = result["steps_per_mesh_cycle"].values.astype(int)
    turned = [mesh.scene.motion.mesh_frequency / train.input_speed for mesh in train.meshes]
    orders: dict[float, tuple[int, int]] = {}
    for mesh, order in enumerate(turned):
        for n in range(1, min(ON_A_RAMP, steps[mesh] // 2 - 1) + 1):
            orders.setdefault(round(n * order, 9), (mesh, n))
    lag = result["overall_transmission_error"].values
    speed = result["mesh_frequency"].isel(mesh=0).values / turned[0]
    width = min(WINDOW_CYCLES * steps.max(), len(lag) - 1)
    starts = range(0, len(lag) - width, width)
    # Mesh cycles of all harmonics at the steps of a window, from its start on.
    cycles = np.outer(np.arange(width), [n / steps[mesh] for mesh, n in orders.values()])
    if not told_apart(cycles):
        raise SceneError(f"orders over the speed: {WINDOW_CYCLES} cycles of the slowest mesh do not tell them apart")
    windows = np.array([lag[start : start + width] for start in starts]).reshape(-1, width)
    speeds = np.array([speed[start : start + width].mean() for start in starts])
    amplitudes = np.hypot(*harmonics(cycles, windows.T))
    return [
        RampOrder(train.meshes[mesh].name, n, order, speeds, own)
        for (order, (mesh, n)), own in zip(orders.items(), amplitudes)
    ]
