"""Contact over the face: pattern and line load, where the flanks are resolved over it."""

from fenics_gears.pages import PageSection, Words, sentence
from fenics_gears.shown import TOO_FEW, ShownRun, charts_over_face

HEADING = "Contact over the face"
# The load factors along the face, by their attributes.
FACTORS = {
    "face_load_factor": (
        "Face load factor {:.3f}: averaged over the mesh cycle, the most loaded place of the face, away from its ends,"
        " carries so many times the mean. Compare it with ISO's K_Hβ."
    ),
    "largest_line_load_factor": (
        "Largest line load {:.3f}: at the worst moment, away from edges, a tooth carries so many times the even load."
        " The even load is the mesh force over the length of the lines of contact of rigid gears, when these are"
        " shortest."
    ),
    "edge_line_load_factor": (
        "At edges {:.3f}: the same at the ends of the face, and where a line of contact ends at a tip or form circle."
        " It depends on the slices, and is a reason for chamfers, crowning or relief, not for a rating."
    ),
}


def face(run: ShownRun) -> PageSection | None:
    """Charts of the stored contact fields, or why there are none; no section of a plane run."""
    if not run.over_face:
        return None
    if not run.has_curves:
        return sentence("face", HEADING, TOO_FEW, True)
    charts = [chart for draw in charts_over_face(run).values() for chart in draw(run)]
    numbers = run.dataset.attrs
    said = [Words(words.format(numbers[name])) for name, words in FACTORS.items() if name in numbers]
    if not charts and not said:
        none = "There are none: no contact fields are stored (`[output] contact_fields`), or no flank is loaded."
        return sentence("face", HEADING, none)
    return PageSection("face", HEADING, [*charts, *said])
