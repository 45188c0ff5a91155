"""Subsets of a scene's effects."""

import csv
import re
from dataclasses import replace

import numpy as np
import pytest
from tests.effects.examples import scene_of, text_of

from fenics_gears import SceneError, model_of, scene_from_text, simulate
from fenics_gears.commands.cli import main
from fenics_gears.effects import SECTIONS
from fenics_gears.extensions.measuring.effect_costs import measured, table
from fenics_gears.extensions.measuring.effect_costs.subsets import ALONE, BARE, LEFT_OUT, EffectsOfPair, subsets_of
from fenics_gears.runs import one_run
from fenics_gears.simulation.simulate import solved

TEETH = "tooth_elasticity"
PAPER = (TEETH, "shafts", "bearings", "inertia", "damping", "friction")


def subsets(scene):
    return {subset.name: subset for subset in subsets_of(EffectsOfPair(scene))[0]}


def test_the_papers_scene_is_run_bare_with_each_effect_and_without_each():
    """Each effect alone, all, all but one; damping is inertia's, friction the elastic teeth's."""
    found = subsets(scene_of(*PAPER))
    assert {name: subset.sections for name, subset in found.items()} == {
        "rigid flanks, no effect": set(),
        "bare": {TEETH},
        "+ shafts": {TEETH, "shafts"},
        "+ bearings": {TEETH, "bearings"},
        "+ inertia": {TEETH, "inertia"},
        "+ damping, inertia": {TEETH, "inertia", "damping"},
        "+ friction": {TEETH, "friction"},
        "all - tooth_elasticity, friction": {"shafts", "bearings", "inertia", "damping"},
        "all - shafts": {*PAPER} - {"shafts"},
        "all - bearings": {*PAPER} - {"bearings"},
        "all - inertia, damping": {TEETH, "shafts", "bearings", "friction"},
        "all - damping": {*PAPER} - {"damping"},
        "all - friction": {*PAPER} - {"friction"},
        "all": {*PAPER},
    }
    assert found["+ damping, inertia"].note == "damping needs inertia"
    assert found["all - inertia, damping"].note == "damping cannot be without inertia"


def test_the_scenes_own_rules_decide_what_a_subset_may_be():
    """The rule of [damping]: damping by stiffness needs a spring."""
    text = text_of(*PAPER).replace('mass_proportional = "0.5e-3 1/s"', 'mass_proportional = "0 1/s"')
    found = subsets(scene_from_text(text))
    assert found["+ damping, shafts, inertia"].sections == {TEETH, "shafts", "inertia", "damping"}
    assert "all - shafts" in found and "all - bearings" in found


def test_a_subset_that_no_neighbour_makes_valid_is_skipped_with_the_rules_reason():
    """The rule of [coast_flanks]."""
    text = text_of(TEETH, "shafts", "coast_flanks").replace('"437 N m"', '"-437 N m"')
    run, skipped = subsets_of(EffectsOfPair(scene_from_text(text)))
    assert {subset.name for subset in run} == {"+ coast_flanks", "all - tooth_elasticity", "all"}
    assert {each.name for each in skipped} == {"rigid flanks, no effect", "bare", "all - coast_flanks"}
    assert all("is negative" in each.reason for each in skipped)


@pytest.fixture(scope="module")
def report():
    return measured.measure(scene_of(*PAPER), rounds=3)


def test_every_row_answers_as_the_scene_itself_does(report):
    """Identity with `gears run`."""
    rows = [(BARE, "", {TEETH}), (ALONE, "friction", {TEETH, "friction"}), (LEFT_OUT, "shafts", {*PAPER} - {"shafts"})]
    for kind, section, sections in rows:
        row = report.row(kind, section)
        run = simulate(scene_of(*(each for each in SECTIONS if each in sections)))
        error = run.attrs["peak_to_peak_transmission_error"] * run.attrs["base_radius_wheel"]
        assert row.transmission_error == pytest.approx(error, rel=1e-9)
        assert row.peak_force == pytest.approx(float(run.normal_force.max()), rel=1e-9)
        assert row.closed_nodes == pytest.approx(float(run.closed_nodes.mean()))
        assert row.iterations == pytest.approx(run.attrs["newton_iterations_total"] / run.attrs["steps"])


def test_the_unknowns_are_those_that_the_sections_free(report):
    """model.md, section 4: one rotation; two more with shafts, four with bearings; friction doubles the contact
    rows."""
    counted = {row.subset.name: row.coordinates for row in report.rows}
    assert [counted[name] for name in ("bare", "+ shafts", "+ bearings", "+ inertia", "+ friction", "all")] == [
        1,
        3,
        5,
        1,
        1,
        7,
    ]
    bare, frictional = report.row(BARE), report.row(ALONE, "friction")
    assert frictional.contact_rows == 2 * bare.contact_rows
    assert 26 <= bare.contact_rows <= 52


def test_times_are_medians_of_rounds_and_gears_are_condensed_for_elastic_teeth_only(report):
    """At least three repeats each; rigid flanks condense nothing."""
    for row in report.rows:
        assert len(row.step_times) == 3 and row.step_time == np.median(row.step_times) > 0.0
        assert (row.condense > 0.0) == (TEETH in row.subset.sections)
    assert len(report.ratios) == 3


def test_all_accuracy_is_that_of_the_whole_scene():
    """Identity."""
    text = re.sub(r"\[accuracy\].*?\n\n", "", text_of(TEETH, "inertia", "shafts"), flags=re.S)
    assert "[accuracy]" not in text and "[gears.material]" in text
    scene = measured.at_one_accuracy(scene_from_text(text))
    # What these leave out is the same in every scene of the same gears.
    alike = ("body_element_size", "interpolation", "elastic_teeth", "model", "target", "slices", "layers")
    assert None not in [value for name, value in vars(scene.accuracy).items() if name not in alike]
    assert {subset.scene.accuracy for subset in subsets_of(EffectsOfPair(scene))[0]} == {scene.accuracy}


def test_remeshing_at_every_step_is_refused_with_the_remedy():
    """House rule: no option is silently ignored."""
    scene = scene_of(TEETH)
    with pytest.raises(SceneError, match='Take "once"'):
        measured.measure(replace(scene, accuracy=replace(scene.accuracy, condensation="every step")))


def test_csv_holds_every_row_with_units_in_its_names(report, tmp_path):
    """Identity."""
    table.write_csv(report, tmp_path / "effects.csv")
    with open(tmp_path / "effects.csv", newline="") as file:
        reader = csv.DictReader(file)
        lines = list(reader)
    assert tuple(reader.fieldnames) == table.CSV_COLUMNS  # by which the report knows the file
    assert [line["effects"] for line in lines] == [row.subset.name for row in report.rows]
    assert all(float(line["step_time_s"]) == row.step_time for line, row in zip(lines, report.rows))
    assert all(None not in line and None not in line.values() for line in lines)
    by_name = {line["effects"]: line for line in lines}
    assert by_name["+ friction"]["compared_with"] == "bare" and by_name["all - friction"]["compared_with"] == "all"


def test_the_command_prints_and_writes_table_and_picture(report, tmp_path, monkeypatch, capsys):
    """A table on the terminal, DIR/effects.csv and DIR/effects.png."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(measured, "measure", lambda scene, progress: report)
    (tmp_path / "small.toml").write_text(text_of(*PAPER))
    assert main(["effects", "small.toml", "--output", "there"]) == 0
    output = capsys.readouterr().out
    assert sorted(file.name for file in (tmp_path / "there").iterdir()) == ["effects.csv", "effects.png"]
    assert (tmp_path / "there" / "effects.png").read_bytes().startswith(b"\x89PNG")
    lines = [line.split() for line in output.splitlines()]
    assert any(line[:3] == ["bare", "1", "+"] for line in lines) and any(
        line[:3] == ["all", "7", "+"] for line in lines
    )
    assert any(line[:2] == ["ratio", "measured"] for line in lines)


def test_a_subset_that_fails_is_a_line_with_its_reason(monkeypatch):
    """House rule."""
    from fenics_gears.errors import ComputationError

    def fails_with_friction(model, **options):
        if model.scene.friction is not None and model.scene.shafts is None:
            raise ComputationError("no solution at step 3\nand a history")
        return solved(model, **options)

    monkeypatch.setattr(one_run, "solved", fails_with_friction)
    report = measured.measure(scene_of(TEETH, "shafts", "friction"), rounds=1)
    assert {(each.name, each.reason) for each in report.skipped} == {("+ friction", "no solution at step 3")}
    assert report.row(ALONE, "shafts") is not None


OVER_FACE = """
[lead_modifications.pinion]
crowning = "6 um"
end_relief = { depth = "10 um", length = "4 mm" }
[misalignment]
in_plane = "12 um"
[bearings]
stiffness = "0.155e6 N/mm"
axial_stiffness = "0.1e6 N/mm"
places = { pinion = ["-40 mm", "60 mm"] }
"""


def test_parts_of_effects_over_the_face_are_left_out_one_at_a_time():
    """Definition; without all of them it is a plane scene."""
    whole = scene_from_text(text_of(TEETH).replace("[accuracy]", "[accuracy]\nslices = 7") + OVER_FACE)
    assert whole.three_dimensional
    found = subsets(whole)
    bare, crowned = found["bare"].scene, found["all - crowning"].scene
    assert not bare.three_dimensional and model_of(bare).face.slices == 1
    assert crowned.lead_modifications.pinion == replace(whole.lead_modifications.pinion, crowning=0.0)
    assert replace(crowned, lead_modifications=whole.lead_modifications) == whole
    assert (
        found["all - end_relief"].scene.lead_modifications.pinion.end_relief is None
        and "all - helix_slope" not in found
    )
    assert found["all - tilting and axial motion"].scene.bearings.places is None
    held = found["all - axial motion"].scene.bearings
    assert held.places == whole.bearings.places and held.axial("pinion") is None
    assert all(
        each.kind == LEFT_OUT
        for name, each in found.items()
        if each.sections == found["all"].sections and name != "all"
    )
