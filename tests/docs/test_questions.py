"""Thirty questions of somebody new: each is answered on a page that docs/index.md leads to in one or two clicks."""

import re

import pytest
from tests.docs.blocks import ROOT

INDEX = ROOT / "docs" / "index.md"
# The question; the words of the link on the index, and of that on the page it leads to, where a second click is needed;
# what the page, or the section that was linked to, says.
QUESTIONS = [
    ("How do I install it?", "Start", "", "installs what is missing"),
    ("How does it run in Docker?", "Docker", "", "docker build"),
    ("How do I use it with my own Python?", "Wheel", "", "pip install"),
    ("How do I enter my own pair?", "from a drawing", "", "centre_distance"),
    ("How do I read gear data of another program?", "from REXS", "", "gears import"),
    ("Which units may I write?", "units", "", "kg m^2"),
    ("How do I switch on friction?", "Effects", "", "[friction]"),
    ("How do I add a tip relief?", "Effects", "", "[tip_relief]"),
    ("How do I run at a speed, with inertia?", "Effects", "", "[inertia]"),
    ("How do I run up through a resonance?", "Effects", "", "[speed_ramp]"),
    ("How stiff are my bearings?", "Effects", "", "[bearings]"),
    ("How do I make the gears helical?", "The third dimension", "", "helix_angle"),
    ("What does misalignment do?", "The third dimension", "", "[misalignment]"),
    ("How do I compute a gearbox of several stages?", "Gear trains", "", "[stages."),
    ("And planets?", "planetary sets", "", "planets ="),
    ("And a ring gear?", "Internal gears", "", "internal"),
    ("How loud is it?", "noise figures", "", "--spectrum"),
    ("How much power is lost?", "Numbers of the result", "", "friction_loss"),
    ("Does it hold, by the standard?", "Load capacity", "", "ISO 6336"),
    ("How do I vary the load?", "Studies", "", "[sweep]"),
    ("What do tolerances do?", "tolerances", "", "distribution"),
    ("Which relief is best?", "optimisation", "", "gears optimize"),
    ("How do I use a cluster?", "on a cluster", "", "mpirun"),
    ("How do I move a slider and see?", "Live", "", "gears live"),
    ("How do I use it from Python, in a notebook?", "Python", "", "simulate"),
    ("How do I see the stresses?", "stress pictures", "", "gears picture"),
    ("How do I make a report with our logo?", "for a customer", "", "logo ="),
    ("How exact is it, and how long does it take?", "Accuracy", "", "target"),
    ("How much memory does it need?", "memory", "", "GB"),
    ("What does a cracked tooth change?", "Demonstrations", "demos/cracked_tooth", "crack"),
    ("What does this error message mean?", "Troubleshooting", "", "## The scene is refused"),
]


def followed(page, words):
    """The page that a link leads to, and its text from the linked heading to the next that is as high."""
    text = page.read_text(encoding="utf-8")
    links = dict(re.findall(r"\[([^]\[]+)\]\(([^)]+)\)", text))
    assert words in links, f"{page.name} has no link {words!r}"
    file, _, anchor = links[words].partition("#")
    found = (page.parent / file).resolve() if file else page
    said = found.read_text(encoding="utf-8")
    if anchor:
        for section in re.finditer(r"^(#+) (.+)\n(?s:(.*?))(?=^#{1,3} |\Z)", said, re.M):
            if re.sub(r"[^\w -]", "", section[2].lower()).replace(" ", "-") == anchor:
                return found, section[0]
        raise AssertionError(f"{found.name} has no heading {anchor!r}")
    return found, said


@pytest.mark.parametrize(("question", "first", "second", "phrase"), QUESTIONS, ids=[each[0] for each in QUESTIONS])
def test_a_question_takes_two_clicks(question, first, second, phrase):
    """Links by the words that they show, and the page's own words."""
    page, said = followed(INDEX, first)
    if second:
        page, said = followed(page, second)
    assert phrase in said, f"{page.name} does not say {phrase!r}"
