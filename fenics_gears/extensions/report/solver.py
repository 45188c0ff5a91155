"""How the run was computed: model, accuracy, natural frequencies, solver statistics, times."""

from fenics_gears import GearsError
from fenics_gears.charts import PALETTE
from fenics_gears.pages import Beside, Block, Facts, PageSection, Table, Words
from fenics_gears.shown import RUNG, ShownRun, describe, over_time, solver_rows, stage_rows

# What `gears check` says of a scene that is not said elsewhere on the page.
DESCRIBED = ("Model", "Accuracy", "Natural frequencies")


def solver(run: ShownRun) -> PageSection:
    """Settings and statistics."""
    blocks: list[Block] = [_described(run)]
    attributes = run.dataset.attrs
    methods = [(name.removeprefix(RUNG), int(count)) for name, count in attributes.items() if name.startswith(RUNG)]
    of_run = {"steps": "steps of the whole run", "newton_iterations_total": "Newton iterations of the whole run"}
    rows = _extent(run) + solver_rows(run.dataset)
    rows += [(words, f"{attributes[name]:,}", "") for name, words in of_run.items() if name in attributes]
    statistics: list[Block] = [Facts(rows, "The run"), Facts(stage_rows(run.dataset), "Wall time by stage")]
    if methods:
        every = sum(count for _, count in methods)
        cells = [(name, f"{count:,}", f"{100.0 * count / every:.4g}") for name, count in methods]
        statistics.append(Table(("Method", "Steps", "Share (%)"), cells, "Steps by the method that solved them"))
    blocks.append(Beside(statistics))
    if run.has_curves:
        counts = {
            "newton_iterations": ("Newton iterations of each step", "Iterations"),
            "closed_nodes": ("Closed contact nodes", "Nodes"),
        }
        for (name, (caption, y_title)), colour in zip(counts.items(), (PALETTE[0], PALETTE[2])):
            curves = [(y_title, run.dataset[name].values.astype(float), colour)]
            blocks.append(over_time(run, caption, y_title, curves, least=2.0, height=240))
    return PageSection("solver", "Model and solver", blocks)


def _extent(run: ShownRun) -> list[tuple[str, str, str]]:
    if not run.steps:
        return []
    timed = run.scene is None or run.scene.motion.speed_given
    seconds = ", {:.4g} s to {:.4g} s".format(*run.dataset["time"].values[[0, -1]]) if timed else ""
    return [("stored", f"mesh cycles {run.phase[0]:.4g} to {run.phase[-1]:.4g}{seconds}, {run.steps:,} steps", "")]


def _described(run: ShownRun) -> Block:
    """Model, accuracy and natural frequencies; why not, where files of the scene are missing."""
    try:
        sections = () if run.scene is None else describe(run.scene)
    except GearsError as error:
        missing = "Model and accuracy cannot be described without the files that the scene was run with"
        return Words(f"{missing}: {str(error).splitlines()[0]}")
    return Beside([Facts(rows, heading) for heading, rows in sections if heading.startswith(DESCRIBED)])
