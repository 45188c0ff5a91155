"""Which folders may import which, and what a plane run loads."""

import re
from pathlib import Path

import pytest
from tests.programs import python

ROOT = Path(__file__).parents[1]


def test_imports_point_one_way(monkeypatch):
    """The contracts of import-linter in pyproject.toml; without import-linter `.ci/run` checks them."""
    cli = pytest.importorskip("importlinter.cli")
    monkeypatch.chdir(ROOT)
    assert cli.lint_imports(no_cache=True) == 0


PHYSICS = ("geometry", "elasticity", "contact", "dynamics")
# Bearings and shafts are still declared among the effects.
NOT_YET = {"bearings", "shafts", "rolling_bearings"}


def test_physics_owns_its_data():
    """House rule: physics knows neither effects nor scenes, not even for annotations, which import-linter leaves
    out."""
    known = {
        (kind, name)
        for folder in PHYSICS
        for path in (ROOT / "fenics_gears" / folder).rglob("*.py")
        for line in path.read_text(encoding="utf-8").splitlines()
        for kind, name in re.findall(r"^ *(?:from|import) fenics_gears\.(effects|scene)\.?(\w*)", line)
    }
    assert known <= {("effects", name) for name in NOT_YET}


PLANE_RUN = """
import sys
from fenics_gears.commands.cli import main
if main(["run", sys.argv[1], "-o", sys.argv[2], "--quiet"]):
    raise SystemExit("the run failed")
print(*sorted(sys.modules), file=sys.stderr)
# Its lists of properties take a quarter of matplotlib's time: they are not made, and what makes them is there again.
from matplotlib import artist, lines
assert "linewidth" in artist.kwdoc(lines.Line2D) and "linewidth" not in lines.Line2D.set.__doc__
assert "linewidth" in str(lines.Line2D.set.__signature__)
"""


EFFECTS = {"tooth_elasticity", "shafts", "bearings", "inertia", "damping", "friction"}
# Those of condensing apart, which a run with gears from the cache does not load. Inertia, damping, bearings and shafts
# are two modules each: the data, which the drivetrain takes, and the effect.
MOST_MODULES = 149


@pytest.fixture(scope="module")
def loaded(tmp_path_factory):
    from tests.effects.examples import text_of

    folder = tmp_path_factory.mktemp("plane")
    scene = folder / "plane.toml"
    scene.write_text(text_of(*EFFECTS))
    done = python("-P", "-c", PLANE_RUN, scene, folder / "run")
    return {name.removeprefix("fenics_gears.") for name in done.stderr.split() if name.startswith("fenics_gears")}


def test_a_plane_run_loads_nothing_slow_of_the_third_dimension(loaded):
    """House rule 9: neither its effects nor contact over the face, whose compiled functions take 30 ms to load."""
    assert "contact.mesh_cycle" in loaded and "show.plots" in loaded
    slow = r"effects\..*(lead_mod|misalign|wobble)|contact\.(face_|formed_rows|fine_sections|factored)"
    assert not [name for name in loaded if re.search(slow, name)]


def test_a_run_loads_what_its_scene_and_its_call_name(loaded):
    """House rule. The number of modules is today's: lower it where a run loads fewer."""
    commands = {name for name in loaded if name.startswith(("commands.", "extensions", "command_line"))}
    work = {"commands.work", *(f"commands.work.{name}" for name in ("kept_run", "run", "scenes", "shared"))}
    assert commands == work | {f"commands.{name}" for name in ("cli", "registry", "run", "shared")}
    # ISO 6336-1 gives the stiffness by which modes of a scene with inertia are told.
    assert not [name for name in loaded if re.search("spring|stiffness_table|flank_gaps", name)]
    # Shafts that bend, faces, root stress, measured thicknesses, formulas of friction, and words for mistakes.
    unnamed = (
        r"elastic_shaft|shaft_|bent_shafts|over_face|line_load|face_rules|face_cost|face_resolution|solids|lead_|"
        r"load_factors|root_stress|second_process|thickness|formulas|remedies|mistakes|elasticity\.face"
    )
    assert not [name for name in loaded if re.search(unnamed, name)]
    effects = {name.removeprefix("effects.") for name in loaded if name.startswith("effects.")}
    assert effects == {"effect", *EFFECTS}
    assert 90 < len([name for name in loaded if not name.startswith("elasticity")]) <= MOST_MODULES


def test_a_run_over_the_face_with_kept_gears_loads_no_finite_elements():
    """`elasticity.face.compliance`: gears from the cache need neither gmsh nor DOLFINx, which take 0.4 s to load; nor
    does the expected cost, which every run asks for."""
    modules = (
        "commands.work.kept_run",
        "simulation.solids",
        "simulation.elastic_route",
        "contact.face_mesh",
        "show.over_face",
    )
    asked = "\n".join(f"import fenics_gears.{name}" for name in modules)
    done = python("-P", "-c", f"{asked}\nimport sys; print(*sys.modules)")
    loaded = {name.partition(".")[0] for name in done.stdout.split()}
    assert "numba" in loaded and not loaded & {"dolfinx", "ufl", "petsc4py", "mpi4py", "gmsh"}
