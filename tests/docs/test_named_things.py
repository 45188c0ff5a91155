"""Files and messages that the pages name are there."""

import re
import tomllib

import pytest
import xarray
from tests.docs.blocks import PAGES, ROOT, in_text, name_of

from fenics_gears.results.validity import NO_MEANING

PLACES = ("fenics_gears/", "tests/", "docs/", "demos/", "meshes/", "setup/")
SUFFIXES = (".py", ".md", ".toml", ".png", ".gif", ".apt", "/")


# Files that a page tells the reader to write.
TO_BE_WRITTEN = {"docs/adding_an_effect.md": {"fenics_gears/effects/brake.py", "tests/effects/test_brake.py"}}


@pytest.mark.parametrize("page", [pytest.param(page, id=name_of(page)) for page in PAGES])
def test_files_that_a_page_names_are_there(page):
    """The checkout."""
    named = {
        code
        for code in in_text(page)
        if code.startswith(PLACES) and code.endswith(SUFFIXES) and not set(code) & set(" *<")
    }
    assert {name for name in named if not (ROOT / name).exists()} == TO_BE_WRITTEN.get(name_of(page), set())


# Pages to look something up in, and pages for those who change the program.
REFERENCE = (
    "scene", "trains", "result", "commands", "effects", "rexs", "api", "promises", "hard_cases", "troubleshooting",
    "platforms",
)  # fmt: skip
FOR_AUTHORS = ("reading_the_code", "adding_an_effect", "adding_an_extension")
GUIDE = [page for page in (ROOT / "docs").glob("*.md") if page.stem not in REFERENCE + FOR_AUTHORS]


def test_the_guide_is_short():
    """CONTRIBUTING.md."""
    pages = [ROOT / "README.md", *GUIDE]
    assert sum(len(page.read_text(encoding="utf-8").split()) for page in pages) <= 15_000


def reading_table(heading):
    page = (ROOT / "docs" / "reading_the_code.md").read_text(encoding="utf-8")
    table = re.search(rf"^\| {heading} \|.*\n\|[-|]+\n((?:\|.*\n)+)", page, re.M)[1]
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in table.splitlines()]


def test_folders_stand_in_the_order_of_imports():
    """The contract that import-linter checks, the lowest folder first."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    layers = [name.rpartition(".")[2] for name in settings["contracts"][0]["layers"]]
    named = [row[0].strip("` ").rpartition("/")[2] for row in reading_table("folder")]
    files = ("errors", "command_line")  # and charts beside it
    assert named == [name for name in reversed(layers) if name not in files]


def length(name):
    return len((ROOT / name).read_text(encoding="utf-8").splitlines())


def test_what_is_to_be_read_is_as_long_as_the_page_says():
    """The files, to a sixth: they grow."""
    rows = [row for row in reading_table("you add") if row[3]]
    assert len(rows) > 10
    for added, change, read, lines in rows:
        files = re.findall(r"`(fenics_gears/[\w/]+\.pyi?)`", change if read.startswith("the same") else read)
        assert sum(map(length, files)) == pytest.approx(int(lines), rel=1 / 6), added


def test_names_are_in_the_files_that_the_page_gives_for_them():
    """The files: nouns, and `NAME` of `file` or in it."""
    page = (ROOT / "docs" / "reading_the_code.md").read_text(encoding="utf-8")
    named = [(row[0].strip("`"), row[2].partition(",")[0].strip("`")) for row in reading_table("noun")]
    named += re.findall(r"`(\w+)` (?:of|in) `(fenics_gears/[\w/]+\.py)`", page)
    assert len(named) > 15
    for name, file in named:
        declared = rf"^ *(class|def) {name}\b|^{name}\b.* = "
        assert re.search(declared, (ROOT / file).read_text(encoding="utf-8"), re.M), (name, file)


@pytest.mark.nightly
def test_the_pages_name_all_that_a_studys_dataset_holds(readers_folder):
    """A study of frequencies with friction and without; what it has of its own, and the numbers of each run."""
    named = {name for page in ("studies", "result") for name in in_text(ROOT / "docs" / f"{page}.md")}
    with xarray.open_dataset(readers_folder / "results" / "frequencies" / "study.nc", engine="h5netcdf") as study:
        assert len(study.data_vars) > 8 and not [name for name in study.data_vars if name not in named]


def sources():
    """The package's and the set-up's text, strings put together."""
    files = [*(ROOT / "fenics_gears").rglob("*.py"), *(ROOT / "setup").glob("*")]
    text = "\n".join(file.read_text(encoding="utf-8") for file in files if file.is_file())
    # Words that several messages share are named once.
    text = text.replace("{NO_MEANING}", NO_MEANING)
    return re.sub(r'"\s*\n\s*f?"', "", text)


def messages():
    text = (ROOT / "docs" / "troubleshooting.md").read_text(encoding="utf-8")
    return re.findall(r"^\| `([^`]+)` \|", text, re.M)


def test_messages_that_are_explained_are_the_programs():
    """A reader looks a message up by its words: those of docs/troubleshooting.md stand in the program's text."""
    said = sources()
    assert len(messages()) > 25
    assert not [message for message in messages() if message not in said]
