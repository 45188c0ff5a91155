"""How Sphinx makes a site of the repository's Markdown pages; `docs/build` calls it. Works with Sphinx 5.3 to 9 and
MyST 0.18 to 5.

The source is the whole checkout, so that links between pages, to pictures and to files are the same here and on a
forge.
"""

import inspect
import sys
from pathlib import Path

# The page of the Python interface is made from the checkout's own docstrings.
sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parent))

project = "fenics_gears"
project_copyright = "the fenics_gears authors"
root_doc = "docs/index"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax"]

include_patterns = [
    "README.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "docs/*.md",
    "docs/evidence/*.md",
    "demos/*/README.md",
    "demos/notebooks/*.ipynb",
]
# Folders that need not be searched for pages.
exclude_patterns = [
    ".git",
    ".venv",
    ".setup",
    "results",
    "docs/_build",
    "**/__pycache__",
    "fenics_gears",
    "tests",
    "meshes",
]

myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 4
# A link or an anchor that leads nowhere is a warning, and a warning ends the build (docs/build).
nitpicky = True
# Types in signatures are shown, not linked: the documentation of xarray and numpy is elsewhere.
nitpick_ignore_regex = [("py:.*", ".*")]
# Reading docstrings needs no finite elements and starts no MPI.
autodoc_mock_imports = ["basix", "dolfinx", "gmsh", "mpi4py", "petsc4py", "pyvista", "ufl", "vtk"]
default_role = "code"
# Pages whose middle is written by a measurement may begin it a level down.
suppress_warnings = ["myst.header"]

html_theme = "furo"
html_title = "fenics_gears"
html_static_path = ["site/style.css"]
html_css_files = ["style.css"]
html_extra_path = ["site/index.html"]
html_copy_source = False
html_show_sphinx = False
pygments_style = "tango"

# Equations need no network where Debian's MathJax (libjs-mathjax) is: the parts that it takes to draw them come along
# with the site.
MATHJAX = Path("/usr/share/javascript/mathjax")
PARTS = (
    "MathJax.js", "config/TeX-AMS_SVG.js", "extensions/MathEvents.js", "extensions/MathMenu.js",
    "extensions/MathZoom.js", "extensions/TeX",
    "extensions/a11y", "jax/element/mml", "jax/input/TeX", "jax/output/SVG/autoload", "jax/output/SVG/fonts/TeX",
    "jax/output/SVG/config.js",
    "jax/output/SVG/jax.js",
)  # fmt: skip
if MATHJAX.is_dir():
    mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_SVG"
    # Debian's is version 2. MyST marks pages as not to be searched for dollars; what it found itself has the class
    # "math".
    mathjax2_config = {
        "tex2jax": {"processClass": "tex2jax_process|math"},
        "messageStyle": "none",
        "SVG": {"linebreaks": {"automatic": True}},
    }
    myst_update_mathjax = False


def copy_mathjax(app, failure):
    """Put MathJax beside the pages."""
    import shutil

    if failure is not None or app.builder.format != "html" or not MATHJAX.is_dir():
        return
    target = Path(app.outdir) / "_static" / "mathjax"
    for part in PARTS:
        source = MATHJAX / part
        if source.is_dir():
            shutil.copytree(source, target / part, dirs_exist_ok=True)
        elif source.exists():
            (target / part).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, target / part)


def list_names(app, page, source):
    """Each public name gets its place on the page of the Python interface; modules stand last, with what they have."""
    import fenics_gears

    if page != "docs/api":
        return
    lines = []
    things = {name: getattr(fenics_gears, name) for name in fenics_gears.__all__}
    for name, thing in sorted(things.items(), key=lambda each: inspect.ismodule(each[1])):
        if inspect.ismodule(thing):
            lines += ["", f"{name}", "." * len(name), "", f".. automodule:: {thing.__name__}", "   :members:"]
            continue
        kind = "class" if inspect.isclass(thing) else "function" if inspect.isroutine(thing) else "data"
        lines += ["", f".. auto{kind}:: fenics_gears.{name}", *(["   :members:"] if kind == "class" else [])]
    source[0] += "\n".join(["", "```{eval-rst}", *lines, "```", ""])


def as_lists(app, what, name, thing, options, lines):
    """Lines "name: meaning" of a docstring are a list of parameters; what follows without a gap belongs to them. Other
    lines of a paragraph begin where its first one does."""
    if what == "data" and inspect.getdoc(thing) == inspect.getdoc(type(thing)):
        lines.clear()  # says what a number or a dictionary is
    try:
        known = set(inspect.signature(thing).parameters)
    except (TypeError, ValueError):
        known = set()
    inside, before = False, ""
    for place, line in enumerate(lines):
        names, colon, _ = line.partition(": ")
        deeper = len(line) - len(line.lstrip()) > len(before) - len(before.lstrip())
        if colon and {each.strip() for each in names.split(",")} <= known:
            lines[place], inside = f":param {line}", True
        elif inside and line:
            lines[place] = f"    {line.strip()}"
        elif line and before and deeper and not before.lstrip().startswith(("*", ">>>", "...")) and before[-1] != ":":
            lines[place] = before[: len(before) - len(before.lstrip())] + line.lstrip()
        inside, before = inside and bool(line), lines[place]


def setup(app):
    """Called by Sphinx."""
    from notebook_pages import SUFFIX, NotebookParser

    app.add_source_suffix(SUFFIX, "notebook")
    app.add_source_parser(NotebookParser)
    app.connect("source-read", list_names)
    app.connect("autodoc-process-docstring", as_lists)
    app.connect("build-finished", copy_mathjax)
