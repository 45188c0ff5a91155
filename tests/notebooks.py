"""Run the notebooks of demos/notebooks and keep their outputs in them: ``python -m tests.notebooks``."""

import os
from pathlib import Path

from fenics_gears.commands.python import KERNEL, offer_kernel

FOLDER = Path(__file__).parents[1] / "demos" / "notebooks"
LONGEST = 600  # s, of a cell


def executed(file: Path, kernels: Path):
    """The notebook with new outputs, run in its folder by this Python; `kernels`: a folder for Jupyter's."""
    import nbformat
    from nbclient import NotebookClient

    offer_kernel(kernels)
    root = str(FOLDER.parents[1])
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [root, os.environ.get("PYTHONPATH")]))
    notebook = nbformat.read(file, as_version=4)
    for cell in notebook.cells:
        cell.metadata.clear()
    resources = {"metadata": {"path": str(file.parent)}}
    client = NotebookClient(notebook, timeout=LONGEST, kernel_name=KERNEL, resources=resources, record_timing=False)
    client.execute()
    notebook.metadata = {
        "kernelspec": {"name": KERNEL, "display_name": "Python 3", "language": "python"},
        "language_info": {"name": "python"},
    }
    return notebook


def printed(notebook) -> list[str]:
    """What its cells print."""
    return [
        output.text
        for cell in notebook.cells
        for output in cell.get("outputs", ())
        if output.output_type == "stream" and output.name == "stdout"
    ]


if __name__ == "__main__":
    import tempfile

    import nbformat

    for file in sorted(FOLDER.glob("*.ipynb")):
        with tempfile.TemporaryDirectory() as kernels:
            notebook = executed(file, Path(kernels))
        for text in printed(notebook):
            print(text, end="")
        nbformat.write(notebook, file)
        print(file)
