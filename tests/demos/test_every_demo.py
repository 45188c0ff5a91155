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
