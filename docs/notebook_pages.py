"""Notebooks as pages of the site: their words, code and kept outputs as Markdown."""

import json

from myst_parser.parsers.sphinx_ import MystParser

SUFFIX = ".ipynb"


def markdown_of(notebook: dict) -> str:
    """The Markdown of a notebook in format 4."""
    return "\n\n".join(part for cell in notebook["cells"] for part in _parts(cell))


def _parts(cell):
    source = "".join(cell["source"])
    if cell["cell_type"] == "markdown":
        yield source
        return
    yield f"```python\n{source}\n```"
    for output in cell.get("outputs", ()):
        data = output.get("data", {})
        text = output.get("text") if output.get("name") == "stdout" else None
        if "image/png" in data:
            picture = "".join(data["image/png"]).replace("\n", "")
            yield f'<img alt="Picture of the cell above" src="data:image/png;base64,{picture}">'
        elif "text/html" in data:
            # A blank line would end the block.
            yield "\n".join(line for line in "".join(data["text/html"]).splitlines() if line.strip())
        elif text is not None:
            yield f"```text\n{''.join(text).rstrip()}\n```"


class NotebookParser(MystParser):
    """A notebook, read as the Markdown that it stands for."""

    supported = ("notebook",)

    def parse(self, inputstring: str, document) -> None:
        super().parse(markdown_of(json.loads(inputstring)), document)
