"""How extensions are found: the guide's example, extensions that fail, and what all of them may use."""

import inspect
import os
import re
import subprocess
import sys

import pytest
from tests.docs.blocks import ROOT, blocks
from tests.programs import DEMO

import fenics_gears
from fenics_gears import gear_pair, load_scene

GUIDE = ROOT / "docs" / "adding_an_extension.md"
MODULE = next(block.code for block in blocks(GUIDE) if block.language == "python")
ENTRY_POINTS = next(block.code for block in blocks(GUIDE) if "entry-points" in block.code)
GROUP = "fenics_gears.extensions"


@pytest.fixture
def install(tmp_path):
    """Puts a module where pip puts a package, with its entry points."""

    def put(name, code, **entry_points):
        (tmp_path / f"{name}.py").write_text(code)
        metadata = tmp_path / f"{name}-1.0.dist-info"
        metadata.mkdir()
        (metadata / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
        lines = [f"[{GROUP}]", *(f"{entry} = {module}" for entry, module in entry_points.items())]
        (metadata / "entry_points.txt").write_text("\n".join(lines) + "\n")
        return tmp_path

    return put


def gears(folder, *arguments):
    return subprocess.run(
        [sys.executable, "-P", "-m", "fenics_gears", *map(str, arguments)],
        env={**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{folder}"},
        capture_output=True,
        text=True,
        timeout=120,
    )


def test_the_guides_extension_runs(install):
    """The guide; the pair's own clearances."""
    entry, module = re.search(rf'entry-points\."{GROUP}"\]\n(\w+) = "(\w+)"', ENTRY_POINTS).groups()
    folder, pair = install(module, MODULE, **{entry: module}), gear_pair(load_scene(DEMO).gears)
    assert "clearances   print backlash" in gears(folder, "--help").stdout
    done = gears(folder, "clearances", DEMO)
    assert (done.returncode, done.stderr) == (0, "")
    numbers = [float(each) for each in re.findall(r"(\d+\.\d+) mm", done.stdout)]
    assert numbers == pytest.approx([pair.backlash, *pair.tip_clearances], abs=5e-4)
    assert gears(folder, "clearances", DEMO, "--least", "9 mm", "--quiet").returncode == 1
    wrong = gears(folder, "clearances", folder / "none.toml")
    assert wrong.returncode == 2 and "there is no such file" in wrong.stderr


def test_one_that_fails_is_left_out_and_named(install):
    """A module that is not there, one without `add`, one whose command's name is taken; the other commands work."""
    taken = "def add(commands, shared):\n    commands.add_parser('map')\n"
    folder = install("taken", taken, absent="no_such_module", fourth="loud", second="taken", third="math")
    # Its command is not called.
    (folder / "loud.py").write_text('"""``gears loud``: fail."""\n\nraise RuntimeError("loaded")\n')
    done = gears(folder, "cache")
    assert done.returncode == 0 and "cache" in done.stdout.lower()
    lines = done.stderr.splitlines()
    said = re.compile(r"The extension (\w+ \(\w+\)) cannot be loaded and is left out: ")
    assert [said.match(each)[1] for each in lines] == ["absent (no_such_module)", "second (taken)", "third (math)"]
    assert "No module named 'no_such_module'" in lines[0] and "conflicting subparser: map" in lines[1]
    assert "has no attribute 'add'" in lines[2]
    assert "loud  " in gears(folder, "--help").stdout
    called = gears(folder, "loud")
    assert called.returncode == 2 and "The extension fourth (loud) cannot be loaded" in called.stderr


@pytest.mark.parametrize("name", [name for name in fenics_gears.__all__ if name != "__version__"])
def test_what_everybody_may_use_is_documented(name):
    """docs/adding_an_extension.md; a constant is documented beside its definition."""
    found = getattr(fenics_gears, name)
    if inspect.ismodule(found):
        names = getattr(found, "__all__", [each for each in vars(found) if not each.startswith("_")])
        inside = [getattr(found, each) for each in names]
        own = [each for each in inside if getattr(each, "__module__", "").startswith("fenics_gears")]
        assert found.__doc__ and own and all(each.__doc__ for each in own)
    elif callable(found):
        assert found.__doc__ and len(found.__doc__) > 30


def test_names_of_the_guide_are_offered():
    """`fenics_gears.__all__` and the modules in it."""
    table = re.search(r"\| for \| take \|\n(.*)", GUIDE.read_text(), re.S)[1]
    for name in re.findall(r"`([\w.]+)`", table):
        first, *rest = name.split(".")
        assert first in fenics_gears.__all__
        found = getattr(fenics_gears, first)
        assert all(hasattr(found, each) for each in rest), name
