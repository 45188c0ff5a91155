"""The sections of the report that are charts: motion, spectra, forces, contact pressure."""

from dataclasses import replace

from fenics_gears import spectrum
from fenics_gears.pages import Block, PageSection, Table, Words, sentence
from fenics_gears.shown import (
    FORCE,
    MOST_POINTS,
    TOO_FEW,
    ShownRun,
    force_charts,
    has_pressure,
    largest_pressures,
    mesh_order_chart,
    motion_charts,
    order_spectrum,
    orders_by_cycle,
    pressure_maps,
    run_spectrum,
    signals_of,
)

LISTED_ORDERS = 10


def motion(run: ShownRun) -> PageSection:
    """Curves of all motions; first, which of the result's cycles are drawn in this section and the next ones."""
    section = _section("motion", "Transmission error and motion", run, motion_charts)
    return replace(section, blocks=[*_cycles_shown(run), *section.blocks]) if run.has_curves else section


def forces(run: ShownRun) -> PageSection:
    """Curves of all forces that the result has."""
    return _section("forces", "Forces", run, force_charts)


def pressure(run: ShownRun) -> PageSection:
    """Largest pressure at every step, and the map of the mesh cycles shown."""
    section = _section("pressure", "Contact pressure", run, lambda run: [*largest_pressures(run), *pressure_maps(run)])
    if has_pressure(run) or not run.has_curves:
        return section
    none = "There is none: this run's flanks are rigid or its mesh is one of springs."
    if run.scene is not None and run.scene.resolves_contact:
        none = "There is no map over the flank: the run has stored no contact fields (`[output] contact_fields`)."
    return replace(section, blocks=[*section.blocks, Words(none)])


def _section(name: str, heading: str, run: ShownRun, charts) -> PageSection:
    return PageSection(name, heading, list(charts(run))) if run.has_curves else sentence(name, heading, TOO_FEW, True)


def _cycles_shown(run: ShownRun) -> list[Block]:
    first, last = run.window
    part = (
        f"Charts over time show mesh cycles {first:g} to {last:g}. On screen, a double click shows all cycles, from"
        f" {run.phase[0]:g} to {last:g}; charts of single tooth pairs have none before {first:g}."
    )
    fewer = (
        f"The run has {run.steps:,} steps, more than a chart draws: they are cut into {MOST_POINTS // 2:,} parts, and"
        " of each the smallest and the largest value are drawn, so that every peak is there."
    )
    return [] if run.shows_all else [Words(part + (f" {fewer}" if run.steps > MOST_POINTS else ""))]


def spectra(run: ShownRun) -> PageSection:
    """Amplitudes over orders, their table, and how they change from cycle to cycle in long records."""
    heading = "Spectra by mesh order"
    run = run.settled
    if not run.has_curves or run.cycles < 1.0 - 1e-9:
        short = "Less than one mesh cycle is stored; its harmonics cannot be separated."
        return sentence("spectra", heading, short, not run.complete)
    signals = signals_of(run)
    spectra = {name: run_spectrum(run, values) for name, (values, _) in signals.items()}
    followed = orders_by_cycle(run, signals)
    blocks: list[Block] = []
    if run.scene is not None and run.scene.speed_ramp is not None:
        where = "See" if followed else "Records of 8 mesh cycles and more have"
        said = "The mesh frequency changes through the record: orders stay in place, resonances pass through them."
        blocks.append(Words(f"{said} {where} the orders cycle by cycle."))
    blocks += [mesh_order_chart(run, name, unit, spectra[name]) for name, (_, unit) in signals.items()]
    if FORCE not in signals:
        blocks.append(Words("The force of the mesh does not vary: nothing but a constant torque acts on it."))
    by_turns = order_spectrum(run)
    blocks += [by_turns] if by_turns is not None else []
    table = _table(signals, [each.lines for each in spectra.values()])
    return PageSection("spectra", heading, [*blocks, table, *followed])


def _table(signals: dict, lines: list[spectrum.OrderLines]) -> Table:
    headings = ["Mesh order", *(f"{name} ({unit})" for name, (_, unit) in signals.items())]
    highest = int(min(LISTED_ORDERS, max(each.orders[-1] for each in lines)))
    rows = [[str(order), *(f"{each.at(order):.4g}" for each in lines)] for order in range(1, highest + 1)]
    return Table(headings, rows, "Amplitudes of the mesh orders")
