"""What `gears study` prints when a study ends."""

from fenics_gears.results.layout import OVERALL, in_microradians
from fenics_gears.results.summary import MICROMETRES
from fenics_gears.results.validity import NO_MEANING

from .quantiles import quantile_rows
from .run_study import Outcome

MOST_FAILURES = 5
PEAK_TO_PEAK = f"peak_to_peak_{OVERALL}"


def summary_rows(outcome: Outcome) -> list[tuple[str, str, str]]:
    """What a study has come to, as rows of name, value and unit."""
    records = outcome.records.values()
    rows = [("cases", f"{len(outcome.study.cases)}", ""), *outcome.spent.rows(outcome.kept)]
    if outcome.failures:
        rows.append(("failed", f"{len(outcome.failures)}", ""))
    if records:
        rows.append(_transmission_errors(outcome))
        rows += quantile_rows(outcome.study, outcome.records)
        warned = sum(bool(record.warnings) for record in records)
        if warned:
            rows.append(("cases with warnings", f"{warned}, see the variable warnings", ""))
        without_meaning = sum(NO_MEANING in record.warnings for record in records)
        if without_meaning:
            rows.append(("cases without meaning", f"{without_meaning}, see the variable meaningless", ""))
    return rows


def _transmission_errors(outcome: Outcome) -> tuple[str, str, str]:
    """Smallest and largest of all cases, as lengths at the wheel's base circle and as angles of the wheel; of trains
    as angles of the last shaft."""
    overall = [each.numbers[PEAK_TO_PEAK] for each in outcome.records.values() if each.of_train]
    if overall:
        said = f"{in_microradians(min(overall))} to {in_microradians(max(overall))}"
        return "overall transmission error, peak to peak", said, "urad"
    angles = {index: record.numbers["peak_to_peak_transmission_error"] for index, record in outcome.records.items()}
    lengths = [angle * outcome.records[index].base_radius * MICROMETRES for index, angle in angles.items()]
    least, most = min(angles.values()), max(angles.values())
    said = f"{min(lengths):.4g} to {max(lengths):.4g} um = {least:.4g} to {most:.4g} rad"
    return "transmission error, peak to peak", said, ""


def last_words(outcome: Outcome, again: str = "the study") -> str:
    """What is not as it should be: failures, an interruption; empty where all is well. again: what is to be run
    again."""
    lines = []
    if outcome.failures:
        lines.append(
            f"{len(outcome.failures)} of {len(outcome.study.cases)} cases failed; run {again} again to try them again."
            " Why, and their scenes:"
        )
        shown = list(outcome.failures)[:MOST_FAILURES]
        if outcome.study.asked is None:
            folder = outcome.file.parent / "cases"
            lines += [f"  {folder / outcome.study.cases[index].name}.failed.txt" for index in shown]
        else:
            lines += [f"  {outcome.study.cases[index]}: {outcome.failures[index]}" for index in shown]
        lines += ["  ..."] if len(outcome.failures) > MOST_FAILURES else []
    if outcome.interrupted:
        missing = len(outcome.study.cases) - len(outcome.records)
        lines.append(
            f"Interrupted. What was done is kept; run {again} again for the missing {missing} of"
            f" {len(outcome.study.cases)} cases."
        )
    return "\n".join(lines)
