"""The site that `docs/build` makes."""

import inspect
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from tests.docs.blocks import PAGES, ROOT, name_of

import fenics_gears

MATHJAX = Path("/usr/share/javascript/mathjax")
pytestmark = [
    pytest.mark.nightly,
    pytest.mark.skipif(shutil.which("sphinx-build") is None, reason="Sphinx is not installed"),
]


def built(checkout, site):
    own = os.environ | {"FENICS_GEARS_PYTHON": sys.executable}
    return subprocess.run([checkout / "docs" / "build", site], capture_output=True, text=True, env=own)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site") / "html"
    done = built(ROOT, folder)
    assert done.returncode == 0, done.stderr
    return folder


def test_every_page_is_in_the_site(site):
    """The Markdown files of the checkout."""
    missing = [name_of(page) for page in PAGES if not (site / Path(name_of(page)).with_suffix(".html")).exists()]
    assert not missing
    assert (site / re.search(r"url=([\w./]+)", (site / "index.html").read_text())[1]).exists()


def test_the_python_interface_is_described(site):
    """`fenics_gears.__all__`: a place to link to, an example of each function."""
    page = (site / "docs" / "api.html").read_text(encoding="utf-8")
    things = {name: getattr(fenics_gears, name) for name in fenics_gears.__all__}
    places = [
        f"module-{thing.__name__}" if inspect.ismodule(thing) else f"fenics_gears.{name}"
        for name, thing in things.items()
    ]
    assert not [place for place in places if f'id="{place}"' not in page]
    assert page.count('class="doctest ') >= sum(map(inspect.isfunction, things.values()))


def test_pictures_are_there(site):
    """As many as in the Markdown, and each one's file."""
    for page in PAGES:
        written = re.findall(r"!\[[^]]*\]\(([^)]+)\)", page.read_text(encoding="utf-8"))
        shown = site / Path(name_of(page)).with_suffix(".html")
        sources = re.findall(r'<img [^>]*src="([^"]+)"', shown.read_text(encoding="utf-8"))
        assert sorted(Path(source).name for source in written) == sorted(Path(source).name for source in sources)
        assert all((shown.parent / source).exists() for source in sources)


def test_equations_are_drawn_without_a_network(site):
    """What MathJax loads lies in the site."""
    if not MATHJAX.is_dir():
        pytest.skip("Debian's MathJax is not installed")
    page = (site / "docs" / "model.html").read_text(encoding="utf-8")
    scripts = re.findall(r'<script [^>]*src="([^"]+)"', page)
    assert any("mathjax/MathJax.js" in script for script in scripts)
    assert page.count('class="math notranslate') > 100
    for script in scripts:
        assert not script.startswith(("http:", "https:", "//"))
        assert (site / "docs" / script.split("?")[0]).exists()
    config = (site / "_static/mathjax/config/TeX-AMS_SVG.js").read_text(encoding="utf-8")
    assert "TeX" in config and (site / "_static/mathjax/jax/output/SVG/fonts/TeX").is_dir()


def in_browser(page, profile):
    """The page when all its scripts have run without network."""
    options = [
        "--headless=new",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-dev-shm-usage",
        f"--user-data-dir={profile}",
    ]
    # The browser's own clock runs ahead until nothing is left to do.
    options += ["--host-resolver-rules=MAP * ~NOTFOUND", "--virtual-time-budget=20000", "--dump-dom"]
    done = subprocess.run(["chromium", *options, f"file://{page}"], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout


needs_browser = pytest.mark.skipif(
    shutil.which("chromium") is None or not MATHJAX.is_dir(), reason="Chromium or Debian's MathJax is missing"
)
# How MathJax shows what it cannot read, and a name that it does not know.
FAILED_FORMULA = re.compile(r'<merror>|mathcolor="red"')


@needs_browser
def test_equations_are_drawn_in_a_browser(site, tmp_path):
    """The page's own formulas, none as an error."""
    shown = in_browser(site / "docs" / "model.html", tmp_path)
    formulas = shown.count('class="math notranslate')
    assert shown.count('class="MathJax_SVG"') == formulas > 100
    assert not FAILED_FORMULA.search(shown)


def test_pages_load_nothing_from_elsewhere(site):
    """Scripts, styles and pictures are the site's own."""
    for page in site.rglob("*.html"):
        sources = re.findall(
            r'<(?:script|img|link rel="stylesheet")[^>]*(?:src|href)="([^"]+)"', page.read_text(encoding="utf-8")
        )
        assert not [
            source for source in sources if source.startswith(("http:", "https:", "//")) and "mathjax" not in source
        ], page


WRONG = {
    "[a link](missing.md)": "missing.md",
    "[an anchor of another page](other.md#nowhere)": "nowhere",
    "[an anchor of this page](#no-such-place)": "no-such-place",
    "![a picture](pictures/missing.png)": "missing.png",
    "[a file](../fenics_gears/missing.py)": "missing.py",
}


@pytest.fixture(scope="module")
def small_checkout(tmp_path_factory):
    root = tmp_path_factory.mktemp("small")
    shutil.copytree(ROOT / "docs", root / "docs", ignore=shutil.ignore_patterns("_build", "pictures", "*.md"))
    (root / "docs" / "index.md").write_text("# One\n\n```{toctree}\nother\n```\n", encoding="utf-8")
    return root


def test_mistakes_end_the_build_and_all_are_named(small_checkout, tmp_path):
    """By hand: what leads nowhere, and a page that no list names."""
    (small_checkout / "docs" / "other.md").write_text("# Two\n\n" + "\n\n".join(WRONG), encoding="utf-8")
    (small_checkout / "docs" / "lost.md").write_text("# Lost\n", encoding="utf-8")
    done = built(small_checkout, tmp_path / "html")
    assert done.returncode != 0
    assert not [words for words in (*WRONG.values(), "lost.md") if words not in done.stderr], done.stderr
