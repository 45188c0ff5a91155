"""Contact over the face: pattern and line load, where the flanks are resolved over it."""

from __future__ import annotations

from fenics_gears.show.contact_pattern import contact_patterns
from fenics_gears.show.line_load import line_loads
from fenics_gears.show.report.page import Section, Words
from fenics_gears.show.run import TOO_FEW, Run

HEADING = "Contact over the face"


def face(run: Run) -> Section:
    """Charts of the stored contact fields; why there are none."""
    if not run.has_curves:
        return Section("face", HEADING, [Words(TOO_FEW, warns=True)])
    charts = [*contact_patterns(run), *line_loads(run)]
    return Section("face", HEADING, charts or [Words("There are none: the run has stored no contact fields (`[output] contact_fields`), or no flank is loaded.")])
