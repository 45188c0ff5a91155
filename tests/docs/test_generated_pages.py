"""Pages made from the program are up to date."""

from dataclasses import make_dataclass, replace

import pytest
from tests.coarse import coarse_scene
from tests.docs import commands_page, result_page, scene_page, write

from fenics_gears import simulate
from fenics_gears.inputs.allowed import Allowed
from fenics_gears.inputs.fields import declared, quantity
from fenics_gears.inputs.section import AllowedTables, Section, allowed_in, names_in, section_within
from fenics_gears.results.attributes import RESULT_ATTRIBUTES
from fenics_gears.results.numbers import ESTIMATED, RUNG
from fenics_gears.scene.data import Motion
from fenics_gears.scene.schema import scene_text


@pytest.fixture(scope="module")
def everything():
    return result_page.run_with_everything()


def kept(name):
    return (write.DOCS / name).read_text(encoding="utf-8")


@pytest.mark.parametrize("name, page", [("scene.md", scene_page.page), ("commands.md", commands_page.page)])
def test_the_page_is_up_to_date(name, page):
    """Identity; `python -m tests.docs.write` writes it anew."""
    assert kept(name) == page()


def test_the_page_of_the_result_is_up_to_date(everything):
    """Identity; `python -m tests.docs.write` writes it anew."""
    assert kept("result.md") == result_page.page(everything)


def test_every_field_has_its_line():
    """The schema, walked through by itself."""

    def count(kind):
        found, seen = 0, set()
        for name in names_in(kind):
            part = section_within(kind, name)
            if part is None:
                found, allowed = found + 1, allowed_in(kind, name)
                if not isinstance(allowed, AllowedTables):
                    continue
                part = allowed.section
            # Sections of both gears, which are alike, share their table.
            found += 0 if part in seen else count(part)
            seen.add(part)
        return found

    lines = [line for line in kept("scene.md").splitlines() if line.startswith("| `")]
    assert len(lines) == count(scene_text()) > 50


def test_a_field_without_meaning_is_refused():
    """A field without one is named."""
    with pytest.raises(TypeError, match="meaning"):
        quantity("1 mm to 2 mm", "1 mm")
    silent = make_dataclass("Silent", [("depth", float, declared(Allowed(description="a length")))], bases=(Section,))
    with pytest.raises(scene_page.NoMeaning, match="tip_relief.depth: the field has no meaning"):
        scene_page.fields(silent, "tip_relief")


def undeclared(attributes) -> set[str]:
    declared = {each.name for each in RESULT_ATTRIBUTES}
    return {name for name in attributes if name not in declared and not name.startswith((RUNG, ESTIMATED))}


def test_a_run_has_no_attribute_that_the_list_does_not_know(everything, paper_scene):
    """The list; a run with all effects, and one that loses contact."""
    assert not undeclared(everything.attrs)
    undamped = coarse_scene(replace(paper_scene, damping=None, friction=None))
    # The first torsional mode of the paper's pair is at 213 Hz.
    lost = simulate(replace(undamped, motion=Motion(213.0, 20, 1)))
    assert lost.attrs["contact_loss_count"] > 0
    assert not undeclared(lost.attrs)
    always = {each.name for each in RESULT_ATTRIBUTES if not each.when}
    when_lost = {each.name for each in RESULT_ATTRIBUTES if each.when == "contact was lost"}
    assert always <= set(everything.attrs) and always | when_lost <= set(lost.attrs)


def test_every_variable_and_dimension_of_the_run_is_on_the_page(everything):
    """The run."""
    words = kept("result.md")
    assert all(f"| `{name}` |" in words for name in (*everything.variables, *everything.sizes))
