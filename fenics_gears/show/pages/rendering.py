"""A page as HTML: the template filled, plotly's library and all pictures inside."""

import base64
import gzip
import re
from functools import cache
from importlib import resources
from typing import Any

from fenics_gears.show.chart import Chart
from fenics_gears.show.drawing import still
from fenics_gears.show.interactive import figure, height
from fenics_gears.show.panels import digits

from .page import Beside, Block, Fold, Page

TEMPLATE = "page.html"
COLOURS = "colours.css"
STYLE = "page.css"
SCRIPT = "page.js"


def rendered(page: Page) -> str:
    """The page as one HTML document."""
    from jinja2 import Environment, StrictUndefined
    from markupsafe import Markup

    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters |= {
        "figure": _figure,
        "still": _still,
        "height": height,
        "base64": _base64,
        "number": _number,
        "micro": _micro,
        "code": _with_code,
    }
    environment.filters["kind"] = lambda block: type(block).__name__
    drawn = any(_has_chart(block) for section in page.sections for block in section.blocks)
    return environment.from_string(_own_file(TEMPLATE)).render(
        page=page, style=Markup(colours() + _own_file(STYLE)), script=Markup(_own_file(SCRIPT)),
        library=Markup(plotly_library()) if drawn else "", drawn=drawn,
    )  # fmt: skip


@cache
def plotly_library() -> str:
    """Plotly's browser library, gzip in base64; empty where plotly is not installed: charts stay images then."""
    try:
        from plotly.offline import get_plotlyjs
    except ImportError:
        return ""
    # No time stamp, so that the same run gives the same page.
    return base64.b64encode(gzip.compress(get_plotlyjs().encode(), compresslevel=6, mtime=0)).decode()


def _has_chart(block: Block) -> bool:
    return any(map(_has_chart, block.blocks)) if isinstance(block, Fold | Beside) else isinstance(block, Chart)


def colours() -> str:
    """The colours and the font of pages, CSS of `:root`."""
    return _own_file(COLOURS)


def _own_file(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


def _figure(chart: Chart):
    from jinja2.utils import htmlsafe_json_dumps

    return htmlsafe_json_dumps(figure(chart), separators=(",", ":"))


def _still(chart: Chart) -> str:
    """The same chart as an image, for paper and browsers without scripts."""
    return _base64(still(chart))


def _with_code(text: str):
    """A sentence with words between backticks set as code."""
    from markupsafe import Markup, escape

    return Markup(re.sub(r"`([^`]+)`", r"<code>\1</code>", str(escape(_micro(text)))))


def _number(value: Any) -> str:
    return _micro(str(value)) if isinstance(value, (str, int)) else digits(float(value))


def _micro(text: str) -> str:
    """Text of the terminal with the unit as pages have it."""
    return re.sub(r"\bu(m|rad)\b", r"µ\1", text)


def _base64(content: bytes) -> str:
    return base64.b64encode(content).decode()
