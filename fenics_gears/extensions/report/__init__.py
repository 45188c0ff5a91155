"""The report: one HTML page on a run or a study that needs no network; see docs/report.md."""
