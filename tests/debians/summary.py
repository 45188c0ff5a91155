"""One table of all trials."""

from tests.debians.trial import RANKS, SUITES, Counts, Trial

VERSIONS = ("Python", "DOLFINx", "PETSc", "numpy", "VTK", "pyvista", "gmsh")


def table(trials: list[Trial]) -> str:
    """A column for each Debian, in Markdown; what was not come to is a dash."""
    rows = [["", *(SUITES[trial.suite] for trial in trials)]]
    rows += [[name, *(trial.versions.get(name, "-") for trial in trials)] for name in VERSIONS]
    rows += [
        [
            f"set-up of the {what}, s",
            *(f"{trial.set_up_seconds[what]:.0f}" if what in trial.set_up_seconds else "-" for trial in trials),
        ]
        for what in ("program", "tests")
    ]
    rows.append(["README's first command", *(_ended(trial.calls.get("first command")) for trial in trials)])
    rows.append(["Dockerfile's container", *(_ended(trial.calls.get("container")) for trial in trials)])
    for ranks in (1, *RANKS):
        few = "a few of " if any(trial.quick for trial in trials) else ""
        name = f"{few}the suite" if ranks == 1 else f"{few}finite elements, mpirun -n {ranks}"
        rows.append([f"{name}: passed, failed, skipped", *(_outcome(trial.tests.get(ranks)) for trial in trials)])
        rows.append(
            [f"{name}, s", *(f"{trial.tests[ranks].seconds:.0f}" if ranks in trial.tests else "-" for trial in trials)]
        )
    rows.append(["all green", *("yes" if trial.is_green else "NO" for trial in trials)])
    return "\n\n".join([_aligned(rows), *_skipped(trials)])


def _ended(call):
    return "-" if call is None else "done" if call.is_green else f"FAILED ({call.exit_code})"


def _outcome(counts: Counts | None):
    if counts is None:
        return "-"
    text = f"{counts.passed}, {counts.failed}, {counts.skipped}"
    return text if counts.complete else f"{text}, BROKEN OFF"


def _skipped(trials):
    """A line for each Debian on which tests were skipped, with their reasons."""
    for trial in trials:
        reasons = sorted({reason for counts in trial.tests.values() for reason in counts.reasons})
        if reasons:
            yield f"Skipped on {SUITES[trial.suite]}: {'; '.join(reasons)}."


def _aligned(rows):
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) + " |" for row in rows
    ]
    rule = "|" + "|".join("-" * (width + 2) for width in widths) + "|"
    return "\n".join([lines[0], rule, *lines[1:]])
