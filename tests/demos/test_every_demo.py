"""Every demonstration has its script, README, picture, place in docs/demos.md, and test."""

import ast
import os
import re
import subprocess
from pathlib import Path

import pytest
from tests.conftest import DEMOS

FOLDERS = sorted(path.parent.name for path in DEMOS.glob("*/run"))
OVERVIEW = DEMOS.parent / "docs" / "demos.md"


def pictures(page: Path) -> list[Path]:
    return [(page.parent / name).resolve() for name in re.findall(r"!\[[^]]+\]\(([^)]+)\)", page.read_text())]


def test_every_folder_is_a_demonstration():
    """docs/demos.md: a folder with a script."""
    folders = {
        path.name for path in DEMOS.iterdir() if path.is_dir() and any(path.glob("*.*")) and path.name != "__pycache__"
    }
    assert folders == set(FOLDERS)


@pytest.mark.parametrize("demo", FOLDERS)
def test_it_is_tested_and_shown(demo):
    """docs/demos.md."""
    test = Path(__file__).parent / f"test_{demo}.py"
    assert test.is_file(), f"no test runs demos/{demo}: write {test.name}"
    source = test.read_text()
    assert f"demos.{demo}" in source or f'"{demo}"' in source
    assert any(
        isinstance(node, ast.FunctionDef) and node.name.startswith("test_") for node in ast.walk(ast.parse(source))
    )
    readme = DEMOS / demo / "README.md"
    shown = pictures(readme)
    assert shown and all(picture.is_file() for picture in shown)
    assert f"../demos/{demo}/README.md" in OVERVIEW.read_text()
    assert set(shown) & set(pictures(OVERVIEW))


@pytest.mark.parametrize("demo", FOLDERS)
def test_its_script_calls_a_module_that_is_there(demo):
    """The shell: executable, without mistakes in its syntax."""
    script = DEMOS / demo / "run"
    assert os.access(script, os.X_OK)
    assert subprocess.run(["bash", "-n", script], capture_output=True).returncode == 0
    (module,) = re.findall(rf'/launch" demos\.{demo}\.(\w+)', script.read_text())
    assert (DEMOS / demo / f"{module}.py").is_file()


def test_scripts_take_one_argument(capsys):
    """demos/arguments.py."""
    from demos.arguments import output_directory

    assert output_directory("tip_relief", "Words.", []) == Path("results/tip_relief")
    assert output_directory("tip_relief", "Words.", ["elsewhere"]) == Path("elsewhere")
    with pytest.raises(SystemExit):
        output_directory("tip_relief", "Words.", ["one", "two"])
    assert "demos/tip_relief/run: error: unrecognized arguments: two" in capsys.readouterr().err
