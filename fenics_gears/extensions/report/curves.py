"""The sections of the report that are charts over time: motion, forces, contact pressure."""

from dataclasses import replace

from fenics_gears.pages import Block, PageSection, Words, sentence
from fenics_gears.shown import (
    MOST_POINTS,
    TOO_FEW,
    ShownRun,
    force_charts,
    has_pressure,
    largest_pressures,
    motion_charts,
    pressure_maps,
)


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
