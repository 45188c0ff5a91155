"""The page of an optimisation."""

from pathlib import Path

from fenics_gears.command_line import write_whole
from fenics_gears.pages import (
    Block,
    Cell,
    Facts,
    Page,
    PageSection,
    Table,
    Tile,
    Tiles,
    Words,
    counted,
    made_by,
    rendered,
    scene_section,
)
from fenics_gears.scene_text import is_train

from . import charts
from .optimize import PAGE, SearchOutcome
from .result import BEST, TABLE, best_scene

MOST_ROWS = 50


def write_page(outcome: SearchOutcome) -> Path:
    """Write the page next to the result and return its file."""
    text = rendered(optimization_page(outcome))
    return write_whole(outcome.directory / PAGE, lambda path: path.write_text(text, encoding="utf-8"))


def optimization_page(outcome: SearchOutcome) -> Page:
    design = outcome.design
    maps: list[Block] = [*charts.harris_charts(outcome)] or [Words("A run of the Harris maps failed.", warns=True)]
    over = "transmission error over two mesh cycles"
    if is_train(design.tree):
        over = "overall transmission error over a cycle of the slowest mesh"
    sections = [
        _summary(outcome),
        PageSection(
            "harris", "Harris maps before and after", [Words(f"Quasi-static {over}, a curve for each torque."), *maps]
        ),
        PageSection(
            "variables",
            "Each variable alone",
            [charts.variable_chart(outcome, variable, goal) for variable in design.variables for goal in design.goals],
        ),
        _designs(outcome),
    ]
    if design.tolerances.scatters:
        sections.append(_tolerances(outcome))
    sections += [
        scene_section(best_scene(outcome), f"Chosen design ({BEST})"),
        scene_section(design.text, "Design file", "design"),
    ]
    designs = counted(len(outcome.tried), "design")
    points = counted(len(design.loads.points), "operating point")
    subtitle = f"{designs} of {counted(len(design.variables), 'variable')} at {points}"
    subject = f"Gear {'train' if is_train(design.tree) else 'pair'}: optimisation"
    return Page(subject, design.title, subtitle, sections, made_by(), charts.no_gain(outcome))


def _summary(outcome: SearchOutcome) -> PageSection:
    tiles = []
    goals = outcome.design.goals
    for goal in goals:
        value = f"{outcome.chosen.goals[goal.name]:.4g}"
        unit = charts.in_symbols(goal.unit).removeprefix("1")
        note = f"before: {charts.goal_words(outcome, goal, outcome.before)}"
        tiles.append(Tile(charts.sentence(charts.called(goal.name)), value, unit, note))
    rows = charts.summary_rows(outcome)
    if not outcome.design.tolerances.scatters:
        # Goals before and after are on the tiles; with tolerances the rows have more of them.
        said = {f"{charts.called(goal.name)}, {words}" for goal in goals for words in (charts.BEFORE, charts.BEST)}
        rows = [row for row in rows if row[0] not in said]
    return PageSection("summary", "Summary", [Tiles(tiles), Facts(rows)])


def _designs(outcome: SearchOutcome) -> PageSection:
    design = outcome.design
    blocks: list[Block] = [charts.search_chart(outcome, goal) for goal in design.goals]
    allowed = (place for place, each in enumerate(outcome.tried) if each.allowed)
    listed = sorted(allowed, key=lambda place: outcome.tried[place].goals[design.goals[0].name])
    words = "best"
    if len(design.goals) > 1:
        blocks.insert(0, charts.front_chart(outcome))
        listed = [place for place in listed if place in outcome.front]
        words = "designs of the Pareto front"
    headings = [
        "Design",
        *(
            f"{charts.called(each.name)} ({each.unit})" if each.unit else charts.called(each.name)
            for each in design.variables
        ),
        *(f"{charts.called(goal.name)} ({goal.unit})" for goal in design.goals),
    ]
    rows = []
    for place in listed[:MOST_ROWS]:
        tried = outcome.tried[place]
        numbers = [
            *(tried.values[each.name] for each in design.variables),
            *(tried.goals[goal.name] for goal in design.goals),
        ]
        cells = (Cell(each) if isinstance(each, str) else Cell(f"{each:.4g}", each) for each in numbers)
        rows.append([Cell(f"{place}{' (chosen)' if place == outcome.best else ''}", float(place)), *cells])
    blocks += [Words(f"The {len(rows)} {words}; `{TABLE}` has all designs."), Table(headings, rows, sortable=True)]
    failed = ((place, each.failure) for place, each in enumerate(outcome.tried) if each.failure)
    if failures := [(f"{place}", Cell(why, warns=True)) for place, why in failed]:
        table = Table(("Design", "Why"), failures[:MOST_ROWS], numbers=9)
        blocks += [Words(f"{len(failures)} designs failed."), table]
    return PageSection("designs", "Designs", blocks)


def _tolerances(outcome: SearchOutcome) -> PageSection:
    blocks: list[Block] = []
    heads = ("Tolerance", "Limit", "At the lower limit", "Without scatter", "At the upper limit")
    for goal in outcome.design.goals:
        caption = f"{charts.sentence(charts.called(goal.name))} ({charts.in_symbols(goal.unit)}) of the chosen design"
        blocks.append(Table(heads, charts.tolerance_rows(outcome, goal), caption))
    words = "One deviation at its limit, all others zero; the largest change first."
    if not outcome.limits:
        words = "A run with a deviation at its limit failed."
    return PageSection("tolerances", "Each tolerance alone", [Words(words, warns=not outcome.limits), *blocks])
