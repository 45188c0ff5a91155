"""Which folders may import which: imports point one way only, those inside functions too; and that a plane run loads
nothing of the third dimension."""

import re
from pathlib import Path

import pytest
from tests.programs import python

ROOT = Path(__file__).parents[1]


def test_imports_point_one_way(monkeypatch):
    """Authority: the contracts of import-linter in pyproject.toml. Where import-linter is not installed `.ci/run`
    checks them."""
    cli = pytest.importorskip("importlinter.cli")
    monkeypatch.chdir(ROOT)
    assert cli.lint_imports(no_cache=True) == 0


# What a scene may have, how it is read and refused; effects say for themselves what they import. And slices, of which
# the plane is one.
DECLARED = {"contact.face", "effects.lead_modifications", "effects.misalignment", "scene.face_rules"}
PLANE_RUN = """
import sys
from fenics_gears.commands.cli import main
if main(["run", sys.argv[1], "-o", sys.argv[2], "--quiet"]):
    raise SystemExit("the run failed")
print(*sorted(sys.modules), file=sys.stderr)
"""


def test_a_plane_run_with_its_pictures_loads_nothing_of_the_third_dimension(tmp_path):
    """Authority: house rule; what a scene does not name is not imported: of the face, the helix, slices, tilts and
    their pictures."""
    from tests.effects.examples import text_of

    scene = tmp_path / "plane.toml"
    scene.write_text(text_of("tooth_elasticity", "friction", "bearings"), encoding="utf-8")
    done = python("-P", "-c", PLANE_RUN, scene, tmp_path / "run")
    own = {name.removeprefix("fenics_gears.") for name in done.stderr.split() if name.startswith("fenics_gears.")}
    assert "contact.mesh_cycle" in own and "show.plots" in own
    assert {
        name
        for name in own
        if re.search(r"face|helix|lead_mod|misalign|slice|tilting|wobble|line_load|contact_pattern", name)
    } <= DECLARED
