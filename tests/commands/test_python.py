"""``gears python``."""

import json
import os
import sys

from fenics_gears.commands.python import offer_kernel


def test_notebooks_run_in_this_python(tmp_path, monkeypatch):
    """Jupyter's own search: JUPYTER_PATH first, the kernel's name, what starts it."""
    monkeypatch.setenv("JUPYTER_PATH", "/elsewhere")
    offer_kernel(tmp_path)
    assert os.environ["JUPYTER_PATH"].split(os.pathsep) == [str(tmp_path), "/elsewhere"]
    kernel = json.loads((tmp_path / "kernels" / "python3" / "kernel.json").read_text())
    assert kernel["argv"][0] == sys.executable and "{connection_file}" in kernel["argv"]


def test_a_folder_that_cannot_be_written_leaves_jupyter_as_it_is(tmp_path, monkeypatch):
    """A file stands where the folder would be."""
    monkeypatch.delenv("JUPYTER_PATH", raising=False)
    (tmp_path / "file").write_text("")
    offer_kernel(tmp_path / "file")
    assert "JUPYTER_PATH" not in os.environ
