"""The notebooks run, and what they show is what they give."""

import re

import pytest
from tests import notebooks

pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")
FILES = sorted(notebooks.FOLDER.glob("*.ipynb"))


def numbers(notebook):
    return [float(each) for text in notebooks.printed(notebook) for each in re.findall(r"-?\d+\.?\d*", text)]


@pytest.mark.nightly
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_a_notebook_prints_what_it_shows(file, tmp_path, monkeypatch):
    """Its kept outputs, with numbers as meshes of other gmsh versions give them; `python -m tests.notebooks` keeps them
    anew."""
    import nbformat

    monkeypatch.setenv("JUPYTER_PATH", "")
    kept = nbformat.read(file, as_version=4)
    assert numbers(notebooks.executed(file, tmp_path)) == pytest.approx(numbers(kept), rel=0.02, abs=0.02)


def test_there_are_four():
    """First pair, relief, shafts, gearbox; each has kept pictures."""
    import nbformat

    for file in FILES:
        outputs = [each for cell in nbformat.read(file, as_version=4).cells for each in cell.get("outputs", ())]
        assert any("image/png" in each.get("data", {}) for each in outputs), file.name
    assert len(FILES) == 4
