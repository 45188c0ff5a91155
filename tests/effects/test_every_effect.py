"""What must hold of every effect in the list."""

import ast
import contextlib
import inspect
import io
import itertools
import json
import re
import sys
import tempfile
from functools import cache
from pathlib import Path

import pytest
from tests.effects.examples import EXAMPLES, scene_of, text_of, with_needs
from tests.programs import python

from fenics_gears import simulate
from fenics_gears.commands.cli import main
from fenics_gears.effects import SECTIONS, effect_named, effects_on, result_variables

CHECKOUT = Path(__file__).parents[2]
TEETH = "tooth_elasticity"
RUN_HOOKS = ("removal", "gaps", "load", "clock", "results")

# What computes those effects that the march itself knows of; the others' hooks import what computes them.
METHODS = {
    "friction": {"fenics_gears.contact.uniqueness"},
    "corner_contact": {"fenics_gears.contact.corner", "fenics_gears.geometry.tip_edge"},
    "body_meshes": {"fenics_gears.elasticity.whole_body.condensed", "fenics_gears.contact.whole_body_mesh"},
    "wheel_points": {"fenics_gears.elasticity.whole_body.ring_on_points", "fenics_gears.contact.whole_body_mesh"},
    "lead_modifications": {"fenics_gears.geometry.face", "fenics_gears.contact.face_mesh"},
    "misalignment": {"fenics_gears.geometry.face", "fenics_gears.contact.face_mesh"},
    TEETH: {"fenics_gears.elasticity.gear_compliance"},
}
# What only some cases of them load: the start of a fast mesh, the stepping of unsampled vibrations,
# the last of the fallbacks.
RARE = {"inertia": {"fenics_gears.dynamics.mean_equilibrium"}, "friction": {"fenics_gears.contact.tresca"}}


def may_stand_together(sections):
    return not set(sections) & {other for section in sections for other in effect_named(section).excludes}


def alone():
    """Nothing, and every effect, on rigid flanks where it can be."""
    return list(dict.fromkeys([(), *(with_needs(section) for section in SECTIONS)]))


def pairs():
    """Every pair of effects that may stand together on elastic teeth, and every one of them."""
    each = itertools.combinations_with_replacement(SECTIONS, 2)
    return list(filter(may_stand_together, dict.fromkeys(with_needs(*pair, TEETH) for pair in each)))


def crowds():
    """Scenes of many effects, so that every pair of them is in one."""
    found = []
    for crowd in pairs():
        if not any(set(crowd) <= set(other) for other in found):
            for section in SECTIONS:
                more = with_needs(*crowd, section)
                crowd = more if may_stand_together(more) else crowd
            found.append(crowd)
    return found


def test_every_effect_has_an_example():
    """House rule."""
    assert set(EXAMPLES) == set(SECTIONS)


def of(scenes, marks=()):
    return [pytest.param(sections, id="+".join(sections) or "nothing", marks=marks) for sections in scenes]


@pytest.mark.parametrize(
    "sections", [*of(alone()), *of(crowds()), *of(sorted({*pairs()} - {*alone()}), pytest.mark.nightly)]
)
def test_effects_run_together_and_the_result_has_their_variables_and_no_others(sections):
    """House rule 9 and the list: exactly those variables."""
    scene = scene_of(*sections)
    assert tuple(each.section for each in effects_on(scene)) == sections
    result = simulate(scene)
    assert result.attrs["complete"] == 1 and result.attrs["steps"] == 20
    proposed = {"proposed_line_load"} if "proposed_helix_slope" in result.attrs else set()
    assert set(result.data_vars) == {variable.name for variable in result_variables(scene)} | proposed


@cache
def checked(sections):
    """What `gears check` says of effects."""
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as said:
        file = Path(folder) / "scene.toml"
        file.write_text(text_of(*sections))
        assert main(["check", str(file)]) == 0
    return said.getvalue().partition("\nEffects\n")[2].splitlines()


@pytest.mark.parametrize("section", SECTIONS)
def test_check_names_it_on_with_what_it_adds_and_off_with_what_is_without_it(section):
    """docs/promises.md on `gears check`."""
    told = {"on": checked(with_needs(section)), "off": checked(())}
    lines = {state: next(line for line in each if line.split()[:1] == [section]) for state, each in told.items()}
    assert lines["on"].split()[1] == "on" and lines["off"].split()[1] == "off"
    assert effect_named(section).absent in lines["off"]
    there = {variable.name for variable in result_variables(scene_of(*with_needs(section)))}
    own = {variable.name for variable in effect_named(section).variables}
    added = [*effect_named(section).unknowns, *effect_named(section).terms, *(own & there)]
    assert added and all(words in lines["on"] for words in (effect_named(section).description, *added))
    assert not any(name in lines["on"].replace(",", " ").split() for name in own - there)


def imports_of_hooks(section):
    """Modules that an effect's own module imports inside the functions a run calls."""
    tree = ast.parse(inspect.getsource(sys.modules[f"fenics_gears.effects.{section}"]))
    hooks = [getattr(effect_named(section), name) for name in RUN_HOOKS]
    called = {hook.__name__ for hook in hooks if hook is not None}
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef) and node.name in called]
    found = {node.module for function in functions for node in ast.walk(function) if isinstance(node, ast.ImportFrom)}
    return {name for name in found if name.startswith("fenics_gears.")}


def physics_at_the_top(section):
    """Modules of physics, which declare an effect's data, that its own module imports."""
    tree = ast.parse(inspect.getsource(sys.modules[f"fenics_gears.effects.{section}"]))
    found = {node.module for node in tree.body if isinstance(node, ast.ImportFrom)}
    return {name for name in found if name.split(".")[1:2] and name.split(".")[1] in PHYSICS}


PHYSICS = ("geometry", "contact", "dynamics")
PROGRAM = """
import json, sys
from fenics_gears.scene.read import scene_from_text
from fenics_gears.runs.simulate import simulate
loaded = []
for text in json.load(sys.stdin):
    simulate(scene_from_text(text))
    loaded.append(sorted(sys.modules))
print(json.dumps(loaded))
"""


BARE = {"nothing": (), TEETH: (TEETH,)}


def modules_after(runs):
    """Modules loaded after runs (name: sections) one after another in one process."""
    texts = json.dumps([text_of(*sections) for sections in runs.values()])
    run = python("-c", PROGRAM, given=texts)
    return {name: set(modules) for name, modules in zip(runs, json.loads(run.stdout.splitlines()[-1]))}


@pytest.fixture(scope="module")
def loaded():
    return modules_after(BARE | {section: with_needs(section, TEETH) for section in SECTIONS if section != TEETH})


@pytest.mark.nightly
@pytest.mark.parametrize("section", SECTIONS)
def test_what_computes_it_is_loaded_by_a_scene_that_names_it_and_by_no_bare_one(section, loaded):
    """House rule 9."""
    own = (imports_of_hooks(section) | METHODS.get(section, set())) - RARE.get(section, set())
    hooks = [getattr(effect_named(section), name) for name in RUN_HOOKS]
    # What declares its data is there with the section's own module.
    assert own or not any(hooks) or physics_at_the_top(section)
    bare = loaded["nothing"] if section == TEETH else loaded[TEETH]
    assert not bare & (own | RARE.get(section, set()))
    assert own <= loaded[section]


@pytest.mark.nightly
def test_a_bare_scene_loads_no_second_solver_no_other_model_and_no_finite_elements_for_rigid_flanks(loaded):
    """House rule 9, for what several effects share, and for the cheaper models of the mesh."""
    assert not [
        name for name in loaded[TEETH] if name.startswith("fenics_gears.") and re.search("spring|stiffness_table", name)
    ]
    assert not METHODS["corner_contact"] & loaded[TEETH]
    assert not {"dolfinx", "gmsh", "petsc4py", "fenics_gears.elasticity.ring"} & loaded["nothing"]
    # Otherwise nothing could be said of what was not loaded.
    assert "fenics_gears.contact.newton" in loaded[TEETH] and "fenics_gears.contact.rigid_mesh" in loaded["nothing"]
