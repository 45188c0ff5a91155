"""The report on a study: its cases as a table and as curves, what failed, and the cases that stand out in detail."""

from collections import Counter
from pathlib import Path

import numpy as np
import xarray as xr

from fenics_gears import OVERALL
from fenics_gears.charts import PALETTE, Chart, Curve
from fenics_gears.many_runs import Progress, SilentProgress
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
    scene_section,
    sentence,
    version_section,
)
from fenics_gears.shown import (
    LISTED_CASES,
    OF_THE_WHOLE,
    PEAK_TO_PEAK,
    STATES,
    Cases,
    digits,
    effort_charts,
    result_charts,
)

# A browser sorts and lays out this many rows at once.
MOST_ROWS = 2000
MOST_FAILURES = 200
NO_RESULT = "No case has a result yet."
STATE_WORDS = dict(zip(STATES, ("done without warnings", "done with warnings", "failed", "not computed yet")))


def study_page(dataset: xr.Dataset, file: Path, output: Path, progress: Progress | None = None) -> Page:
    """The page of a study's dataset, read from `file`; links are from `output` on."""
    progress = progress or SilentProgress()
    progress.stage("sections")
    cases = Cases(dataset, file, output)
    attributes = dataset.attrs
    sections = [make(cases) for make in (_summary, _failures, _warnings, _results, _standing_out, _table, _effort)]
    sections += [
        version_section(attributes, file), scene_section(str(attributes.get("study", "")), "Study", "study"),
        scene_section(str(attributes.get("scene", "")), "Base scene"),
    ]  # fmt: skip
    title = " ".join(str(attributes.get("title", "")).split()) or file.parent.name
    random = [field.name for field in cases.fields if "sample" in dataset[field.name].dims]
    listed = [field for field in cases.fields if field.name not in random]
    values = {field.called: len(set(map(str, field.values.tolist()))) for field in listed}
    swept = [f"{name} ({counted(count, 'value')})" for name, count in values.items()]
    if random:
        swept.append(f"{counted(dataset.sizes['sample'], 'sample')} of {counted(len(random), 'random field')}")
    subtitle = f"{counted(cases.count, 'case')} over {', '.join(swept)}"
    subject = f"Gear {'train' if cases.of_trains else 'pair'}: report on a study"
    return Page(subject, title, subtitle, sections, made_by(), _alarm(cases))


def _alarm(cases: Cases) -> str:
    counts = Counter(cases.states)
    parts = ", ".join(f"{counts[state]} {STATE_WORDS[state]}" for state in STATES[2:] if counts[state])
    return f"INCOMPLETE STUDY: of {cases.count} cases {parts}. Run the study again for these." if parts else ""


def _summary(cases: Cases) -> PageSection:
    counts = Counter(cases.states)
    states = ", ".join(f"{counts[state]:,} {words}" for state, words in STATE_WORDS.items() if counts[state])
    tiles = [Tile("Cases", f"{cases.count:,}", "", states)]
    for values, unit, name in cases.measures.values():
        far_off = cases.far_off(values)
        known = values[np.isfinite(values) & ~far_off]
        if len(known):
            least = digits(known.min())
            largest = digits(known.max())
            notes = [f"median {digits(np.median(known))} {unit}"] if least != largest else []
            shown = f"{least} – {largest}" if notes else least
            if far_off.any():
                notes.append(f"without {counted(int(far_off.sum()), 'case')} of no meaning")
            tiles.append(Tile(name, shown, unit, ", ".join(notes)))
    rows = []
    for field in cases.fields:
        values = list(dict.fromkeys(field.words(case) for case in range(cases.count)))
        shown = ", ".join(values) if len(values) <= 8 else f"{', '.join(values[:3])}, … {values[-1]}"
        rows.append((field.called, f"{shown} {field.unit if field.numeric else ''}".strip(), ""))
    return PageSection("summary", "Summary", [Tiles(tiles), Facts(rows, "Swept fields")])


def _failures(cases: Cases) -> PageSection:
    failed = [case for case, state in enumerate(cases.states) if state == STATES[2]]
    if not failed:
        return sentence("failures", "Failures", "None.")
    reasons = cases.texts("failure")
    rows = [(str(case), cases.words(case), Cell(reasons[case], warns=True)) for case in failed[:MOST_FAILURES]]
    blocks: list[Block] = [Table(("Case", "Values", "Why"), rows, numbers=9)]
    more = f" The first {MOST_FAILURES} of {len(failed)} are listed." if len(failed) > MOST_FAILURES else ""
    blocks.append(
        Words(f"The files `cases/*.failed.txt` have the scenes of these cases; `gears study` tries them again.{more}")
    )
    return PageSection("failures", "Failures", blocks)


def _warnings(cases: Cases) -> PageSection:
    """Each kind of warning once, with its cases; numbers in it are of the first case."""
    said: dict[str, list[tuple[int, str]]] = {}
    for case, text in enumerate(cases.texts("warnings")):
        for line in text.splitlines():
            kind = "".join(each for each in line if not each.isdigit() and each not in ".+-e")
            said.setdefault(kind, []).append((case, line))
    blocks = []
    for cases_of_kind in sorted(said.values(), key=len, reverse=True):
        of = f"In all {cases.count} cases"
        if len(cases_of_kind) < cases.count:
            listed = [str(case) for case, _ in cases_of_kind[:LISTED_CASES]] + ["…"] * (
                len(cases_of_kind) > LISTED_CASES
            )
            of = f"In {len(cases_of_kind)} of {cases.count} cases ({', '.join(listed)})"
        others = " (numbers of the first)" if len({line for _, line in cases_of_kind}) > 1 else ""
        blocks.append(Words(f"{of}: {cases_of_kind[0][1]}{others}", warns=True))
    return PageSection(
        "warnings", "Warnings", blocks or [Words("None: every run stayed within what the model assumes.")]
    )


def _results(cases: Cases) -> PageSection:
    charts = list(result_charts(cases).values())
    return PageSection("results", "Results over the parameters", charts or [Words(NO_RESULT, warns=True)])


def _standing_out(cases: Cases) -> PageSection:
    heading, scale, unit = "Cases that stand out", *cases.error_scale
    runs = ((case, why, cases.run(case)) for case, why in standing_out(cases).items())
    chosen = [(case, why, run) for case, why, run in runs if run is not None and run.sizes.get("time", 0)]
    if not chosen:
        return sentence("outstanding", heading, "There is no file of a case to show one from.")
    curves = []
    links = []
    for (case, why, run), colour in zip(chosen, PALETTE):
        phase, error = _of_the_whole(run) if cases.of_trains else (run["mesh_phase"].values, run["transmission_error"])
        error = np.asarray(error) * scale
        curves.append(Curve(f"case {case}", phase - np.floor(phase[0]), error, colour))
        file = Cell(cases.texts("case_file")[case], link=cases.link(case))
        links.append((str(case), cases.words(case), ", ".join(why), file))
    title = "Time (mesh cycles since the first recorded one)"
    what = "Transmission error"
    if cases.of_trains:
        title, what = "Time (cycles of the first mesh)", "Overall transmission error"
    drawn = Chart(what, curves, title, f"{what} ({unit})", height=360)
    said = Table(("Case", "Values", "Has the", "File"), links, numbers=9)
    command = Words("`gears report DIR/cases/FILE.nc` makes a report on a case; the table of cases then leads to it.")
    return PageSection("outstanding", heading, [said, drawn, command])


def _of_the_whole(run: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Cycles of the first mesh, and the lag of the last shaft, rad."""
    cycles_in_a_second = float(run["mesh_phase"][1, 0] / run["time_of_mesh"][1, 0])
    return run["time"].values * cycles_in_a_second, run[OVERALL].values


def standing_out(cases: Cases) -> dict[int, list[str]]:
    """Cases that are worth a look, each with what it is distinguished by."""
    errors, _, _ = cases.measures[OF_THE_WHOLE if cases.of_trains else PEAK_TO_PEAK]
    forces = cases.numbers("max_normal_force")
    known = np.flatnonzero(np.isfinite(errors))
    if not len(known):
        return {}
    by_error = known[np.argsort(errors[known], kind="stable")]
    marks = [
        (by_error[0], "least transmission error"), (by_error[len(by_error) // 2], "median transmission error"),
        (by_error[-1], "largest transmission error"),
    ]  # fmt: skip
    if np.isfinite(forces[known]).any():
        marks.append((known[np.nanargmax(forces[known])], "largest mesh force"))
    reasons: dict[int, list[str]] = {}
    for case, why in marks:
        reasons.setdefault(int(case), []).append(why)
    return reasons


def _table(cases: Cases) -> PageSection:
    measures = [(values, unit) for values, unit, _ in cases.measures.values()]
    measures.append((cases.numbers("wall_time"), "s"))
    of_meshes = [f"T_EPP of {mesh}" for mesh in cases.meshes] if cases.of_trains else ["Largest force"]
    names = ("T_EPP", "Mean error", *of_meshes, "Wall time")
    measured = [f"{name} ({unit})" for name, (_, unit) in zip(names, measures)]
    headings = ["Case", *(field.title for field in cases.fields), "State", *measured, "Newton iterations"]
    rows = []
    states = cases.states
    iterations = cases.numbers("newton_iterations")
    for case in range(min(cases.count, MOST_ROWS)):
        swept = [
            Cell(field.words(case), float(field.values[case]) if field.numeric else None) for field in cases.fields
        ]
        state = Cell(states[case], warns=states[case] in STATES[1:3])
        numbers = [
            Cell(f"{values[case]:#.4g}".rstrip(".") if np.isfinite(values[case]) else "", float(values[case]))
            for values, _ in measures
        ]
        count = Cell(f"{iterations[case]:.0f}" if np.isfinite(iterations[case]) else "", float(iterations[case]))
        rows.append([Cell(str(case), float(case), cases.link(case)), *swept, state, *numbers, count])
    blocks: list[Block] = [
        Words(
            "A click on a heading sorts by it. T_EPP: transmission error, peak to peak. Case numbers lead to the case's"
            " report where there is one, else to its file, in the study's directory: sent alone, this page has all"
            " numbers, and these links lead nowhere."
        )
    ]
    if cases.count > MOST_ROWS:
        fewer = f"The first {MOST_ROWS:,} of {cases.count:,} cases; the file {cases.file.name} has all."
        blocks.append(Words(fewer, warns=True))
    blocks.append(Table(headings, rows, sortable=True, numbers=len(cases.fields) + 2))
    return PageSection("cases", "Table of cases", blocks)


def _effort(cases: Cases) -> PageSection:
    times = cases.numbers("wall_time")
    iterations = cases.numbers("newton_iterations")
    if not np.isfinite(times).any():
        return sentence("effort", "Solver and effort", NO_RESULT, True)
    steps = cases.numbers("steps_per_mesh_cycle")
    known = steps[np.isfinite(steps)]
    rows = [
        ("wall time of all cases, one after the other", f"{np.nansum(times):.4g}", "s"),
        ("of a case", f"{np.nanmedian(times):.3g} (median), {np.nanmax(times):.3g} at most", "s"),
        ("Newton iterations of all cases", f"{np.nansum(iterations):,.0f}", ""),
    ]  # fmt: skip
    if len(known):
        span = f"{known.min():.0f}" + (f" to {known.max():.0f}" if np.ptp(known) else "")
        rows.append(("steps per mesh cycle", span, ""))
    return PageSection("effort", "Solver and effort", [Facts(rows), *effort_charts(cases)])
