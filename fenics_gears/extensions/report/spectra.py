"""The section of spectra by mesh order: transmission error and mesh force, and how orders change from cycle to
cycle."""

from dataclasses import dataclass, replace
from math import lcm

import numpy as np

from fenics_gears import spectrum
from fenics_gears.charts import PALETTE, Chart, Curve
from fenics_gears.pages import Block, PageSection, Table, Words, sentence
from fenics_gears.shown import ShownRun, bars_by_origin, error_values, order_spectrum

MESH_ORDERS = 10.5
FOLLOWED_ORDERS = 4
CYCLES_TO_FOLLOW = 8
LISTED_ORDERS = 10
# Lines below this part of the largest are the solver's tolerance.
LEAST_PART = 1e-5
ERROR = "Transmission error"
FORCE = "Mesh force"


@dataclass(frozen=True)
class Spectrum:
    """Lines over mesh orders, the source of each (n,), and a description of the record."""

    lines: spectrum.OrderLines
    origins: np.ndarray
    record: str


def _signals_of(run: ShownRun) -> dict[str, tuple[np.ndarray, str]]:
    """Values (time,) and units of the analysed curves."""
    signals = {ERROR: error_values(run)}
    force = spectrum.varying_mesh_force(run.dataset)
    if force is not None:
        signals[FORCE] = (force, "N")
    return signals


def spectra(run: ShownRun) -> PageSection:
    """Amplitudes over orders, their table, and how they change from cycle to cycle in long records."""
    heading = "Spectra by mesh order"
    run = run.settled
    if not run.has_curves or run.cycles < 1.0 - 1e-9:
        short = "Less than one mesh cycle is stored; its harmonics cannot be separated."
        return sentence("spectra", heading, short, not run.complete)
    signals = _signals_of(run)
    found = {name: _spectrum(run, values) for name, (values, _) in signals.items()}
    followed = _orders_by_cycle(run, signals)
    blocks: list[Block] = []
    if run.scene is not None and run.scene.speed_ramp is not None:
        where = "See" if followed else "Records of 8 mesh cycles and more have"
        said = "The mesh frequency changes through the record: orders stay in place, resonances pass through them."
        blocks.append(Words(f"{said} {where} the orders cycle by cycle."))
    blocks += [_mesh_order_chart(run, name, unit, found[name]) for name, (_, unit) in signals.items()]
    if FORCE not in signals:
        blocks.append(Words("The force of the mesh does not vary: nothing but a constant torque acts on it."))
    by_turns = order_spectrum(run)
    blocks += [by_turns] if by_turns is not None else []
    table = _table(signals, [each.lines for each in found.values()])
    return PageSection("spectra", heading, [*blocks, table, *followed])


def _table(signals: dict, lines: list[spectrum.OrderLines]) -> Table:
    headings = ["Mesh order", *(f"{name} ({unit})" for name, (_, unit) in signals.items())]
    highest = int(min(LISTED_ORDERS, max(each.orders[-1] for each in lines)))
    rows = [[str(order), *(f"{each.at(order):.4g}" for each in lines)] for order in range(1, highest + 1)]
    return Table(headings, rows, "Amplitudes of the mesh orders")


def _mesh_order_chart(run: ShownRun, name: str, unit: str, found: Spectrum) -> Chart:
    """Amplitudes over mesh orders."""
    lines = found.lines
    shown = (lines.orders <= MESH_ORDERS) & (lines.amplitudes > LEAST_PART * lines.amplitudes.max(initial=0.0))
    spacing = lines.orders[0] if len(lines.orders) else 1.0
    width = min(0.12, 0.8 * spacing)
    both = "coast_normal_force" in run.dataset and name == FORCE
    sides = ", drive flanks positive, coast flanks negative" if both else ""
    note = f"Amplitudes of the harmonics, without the mean{sides}; {found.record}.{_beyond(lines)}"
    curves = bars_by_origin(lines, found.origins, shown, width, width)
    title = "Mesh order (events a mesh cycle)"
    return Chart(name, curves, title, f"Amplitude ({unit})", note, height=320, x_range=(0.0, MESH_ORDERS))


def _spectrum(run: ShownRun, values: np.ndarray) -> Spectrum:
    """The mesh orders of values (time,). Where whole hunting tooth periods are stored at a steady speed, they are
    taken, so that orders of either gear's rotation are separate; else whole mesh cycles."""
    scene = run.scene
    if scene is not None and scene.speed_ramp is None:
        teeth = scene.gears.teeth
        amplitudes = spectrum.order_lines(values, run.cycles, teeth)
        if amplitudes is not None and amplitudes.exact:
            periods = int(run.cycles * (1 + 1e-9)) // lcm(*teeth)
            record = f"of {periods} hunting tooth period{'s' if periods > 1 else ''} ({lcm(*teeth)} mesh cycles each)"
            origins = np.array([spectrum.origin(order, teeth) for order in amplitudes.orders])
            return Spectrum(replace(amplitudes, orders=amplitudes.orders / teeth[0]), origins, record)
    lines = spectrum.order_lines(values, run.cycles, (1, 1))
    origins = np.where(np.abs(lines.orders - np.round(lines.orders)) < 1e-6, spectrum.MESH, spectrum.BETWEEN)
    whole = int(run.cycles * (1 + 1e-9))
    record = f"of {run.cycles:.4g} mesh cycles in Hann's window, where a line spreads over its neighbours"
    if lines.exact:
        record = f"of {whole} whole mesh cycle{'s' if whole > 1 else ''}"
    return Spectrum(lines, origins, record)


def _beyond(lines: spectrum.OrderLines) -> str:
    if not len(lines.orders):
        return ""
    order = lines.orders[np.argmax(lines.amplitudes)]
    if order <= MESH_ORDERS:
        return ""
    return f" The largest of all is at order {order:.4g}, beyond the picture: {lines.amplitudes.max():.4g}."


def _orders_by_cycle(run: ShownRun, signals: dict[str, tuple[np.ndarray, str]]) -> list[Chart]:
    """Amplitudes of the first mesh orders in each mesh cycle of a long record."""
    cycles = run.whole_cycles
    if len(cycles) < CYCLES_TO_FOLLOW or cycles[0].stop - 1 < 2 * FOLLOWED_ORDERS:
        return []
    middle, title = run.cycle_axis
    charts = []
    for name, (values, unit) in signals.items():
        each = [spectrum.order_lines(values[cycle], 1.0, (1, 1)).amplitudes[:FOLLOWED_ORDERS] for cycle in cycles]
        curves = [
            Curve(f"order {order}", middle, part, colour)
            for order, (part, colour) in enumerate(zip(np.array(each).T, PALETTE), 1)
        ]
        charts.append(Chart(f"{name}: mesh orders cycle by cycle", curves, title, f"Amplitude ({unit})"))
    return charts
