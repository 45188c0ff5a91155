"""What the pages tell a reader to type works."""

import contextlib
import doctest
import importlib.util
import io
import os
import re
import shlex
import tomllib

import matplotlib
import pytest
from tests.docs.blocks import PAGES, ROOT, blocks, in_text, name_of
from tests.docs.commands_page import commands, parser
from tests.paper_text import PAPER as DEMO

from fenics_gears import as_toml, results, scene_from_text, simulate, train_from_text
from fenics_gears.extensions.optimization.design_file import load_design
from fenics_gears.extensions.report.layout import load_layout
from fenics_gears.results.summary import summary_rows
from fenics_gears.studies.study_file import load_study

matplotlib.use("Agg")
# Pages whose code is a module in pieces; these tests put them together and run them.
RUN_ELSEWHERE = {
    "docs/adding_an_effect.md": "tests/effects/test_pages.py",
    "docs/adding_an_extension.md": "tests/extensions/test_adding_an_extension.py",
}
PROMPT = ">>> "
# What stands for a number or a word in the pages' commands.
STAND_FOR = {"N": "2", "SECONDS": "2", "PHASE": "0.25", "TORQUE": "437 N m", "SPEED": "750 rpm"}
STARTERS = ("mpirun", "srun")
START = ROOT / "docs" / "start.md"


def holding(language):
    """Pages that hold blocks of a language and do not have them run elsewhere."""
    pages = [page for page in PAGES if any(block.language == language for block in blocks(page))]
    return [pytest.param(page, id=name_of(page)) for page in pages if name_of(page) not in RUN_ELSEWHERE]


def run_python(page):
    """Run a page's Python, sessions in one namespace; what differs from the page, in words."""
    shared, runner, differences = {}, doctest.DocTestRunner(), io.StringIO()
    for block in blocks(page):
        if block.language == "python" and PROMPT in block.code:
            session = doctest.DocTestParser().get_doctest(block.code, shared, page.name, str(page), block.line - 1)
            # The parser copies the names that it is given.
            session.globs = shared
            runner.run(session, out=differences.write, clear_globs=False)
        elif block.language == "python":
            exec(compile("\n" * (block.line - 1) + block.code, str(page), "exec"), {})
    return differences.getvalue()


@pytest.mark.parametrize("page", holding("python"))
def test_python_runs_and_gives_what_the_page_says(page, readers_folder, monkeypatch):
    """The page."""
    monkeypatch.chdir(readers_folder)
    assert run_python(page) == ""


def test_a_wrong_answer_on_a_page_is_noticed(tmp_path):
    """A page that says what is not so, and one whose code does not run."""
    page = tmp_path / "wrong.md"
    page.write_text("```python\n>>> one = 1\n\n```\n\n```python\n>>> one + 1\n3\n\n```\n", encoding="utf-8")
    assert "Expected:\n    3\nGot:\n    2" in run_python(page)
    page.write_text("```python\nunknown\n```\n", encoding="utf-8")
    with pytest.raises(NameError):
        run_python(page)


@pytest.mark.parametrize("page", holding("toml"))
def test_scenes_and_studies_are_valid(page, readers_folder, tmp_path):
    """The program's own reading; a piece is put into the demo, or into the train that the page has before it."""
    train = None
    for block in blocks(page):
        if block.language != "toml":
            continue
        tree = tomllib.loads(block.code)
        if "sweep" in tree:
            # A study's scene stands beside it; what it leaves out must be there.
            relieved = DEMO + '\n[tip_relief]\ndepth = "31 um"\nstart = "HPSTC"\n'
            (tmp_path / tree["scene"]).write_text(relieved, encoding="utf-8")
            (tmp_path / "study.toml").write_text(block.code, encoding="utf-8")
            assert load_study(tmp_path / "study.toml").cases
        elif "stages" in tree or train:
            train = tree if "stages" in tree else merged(train, tree)
            assert train_from_text(as_toml(train), f"{name_of(page)}:{block.line}").meshes
        elif "variables" in tree:
            (tmp_path / tree["scene"]).write_text(DEMO, encoding="utf-8")
            (tmp_path / "design.toml").write_text(block.code, encoding="utf-8")
            assert load_design(tmp_path / "design.toml").variables
        elif "limits" in tree:
            (tmp_path / tree["logo"]).write_text("<svg/>", encoding="utf-8")
            (tmp_path / "layout.toml").write_text(block.code, encoding="utf-8")
            assert load_layout(tmp_path / "layout.toml").limits
        else:
            whole = {"gears", "load"} <= set(tree)
            scene_from_text(
                block.code if whole else as_toml(merged(around(tree), tree)), f"{name_of(page)}:{block.line}"
            )


def around(piece):
    """The demo, without what a piece with a target or shafts that bend excludes."""
    scene = tomllib.loads(DEMO)
    if "sections" in piece.get("shafts", {}).get("input", {}):
        scene = {name: own for name, own in scene.items() if name not in ("shafts", "bearings", "inertia", "damping")}
    if "target" in piece.get("accuracy", {}):
        del scene["accuracy"]
    return scene


def merged(scene, piece):
    both = dict(scene)
    for name, value in piece.items():
        both[name] = (
            merged(scene[name], value) if isinstance(value, dict) and isinstance(scene.get(name), dict) else value
        )
    return both


def calls_of_gears(text):
    """Arguments of each call of the program in lines of a shell, or in code in a sentence."""
    for line in text.splitlines():
        words = shlex.split(line.partition(" | ")[0].replace("`", ""), comments=True)
        places = [i for i, word in enumerate(words) if word in ("gears", "./gears")]
        if places and (places[0] == 0 or words[0] in STARTERS):
            yield [
                STAND_FOR.get(word, word)
                for word in (word.strip("[]") for word in words[places[0] + 1 :])
                if word != "..."
            ]


def calls(page):
    shell = "\n".join(
        block.code.replace("\\\n", " ") for block in blocks(page) if block.language in ("", "bash", "sh", "console")
    )
    text = "\n".join(code for code in in_text(page) if code.startswith(("gears ", "./gears ")))
    return [
        call
        for call in (*calls_of_gears(shell), *calls_of_gears(text))
        if call and call[0] not in ("test", "--set-up-only")
    ]


WITH_CALLS = [
    pytest.param(page, id=name_of(page))
    for page in PAGES
    # The one has usages; the other makes a command, which the test of extensions calls.
    if name_of(page) not in ("docs/commands.md", "docs/adding_an_extension.md") and calls(page)
]


@pytest.mark.parametrize("page", WITH_CALLS)
def test_commands_are_the_programs(page):
    """The program's own argument parser."""
    wrong = []
    for call in calls(page):
        if len(call) == 1 and call[0] in commands():
            continue  # a command's name, not a call
        if call[0] == "python":
            continue  # what follows is for Python
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            try:
                parser(call[0]).parse_args(call)
            except SystemExit as ended:
                if ended.code:
                    wrong.append(f"{' '.join(call)}: {said.getvalue()}")
    assert not wrong


def test_commands_are_found_in_blocks_in_sentences_and_behind_mpirun():
    """By hand."""
    assert list(calls_of_gears("./gears run a.toml # why\nmpirun -n 8 gears study b.toml\nls gears")) == [
        ["run", "a.toml"],
        ["study", "b.toml"],
    ]
    assert list(calls_of_gears("gears study [-n N] STUDY")) == [["study", "-n", "2", "STUDY"]]


@pytest.mark.parametrize("page", [pytest.param(page, id=name_of(page)) for page in PAGES])
def test_modules_and_scripts_that_a_page_names_are_there(page):
    """The checkout."""
    everything = "\n".join([*(block.code for block in blocks(page)), *in_text(page)])
    for module in re.findall(r"(?<!gears )python3? -m ([\w.]+)", everything):
        assert importlib.util.find_spec(module), module
    for script in re.findall(r"^(?:\./)?((?!docs/_build)(?:demos|docs|setup)/[a-z0-9_/]+)(?=\s|$)", everything, re.M):
        path = ROOT / script
        assert path.is_dir() or os.access(path, os.X_OK), script


@pytest.fixture(scope="module")
def first_run(readers_folder):
    return results.load(readers_folder / "results" / "lundvall2004" / "run.nc")


def micrometres(result):
    """Peak-to-peak on the wheel's base circle, um."""
    return 1e3 * result.attrs["base_radius_wheel"] * result.attrs["peak_to_peak_transmission_error"]


def test_the_summary_is_as_shown(first_run):
    """docs/start.md, with numbers as meshes of other gmsh versions give them."""
    shown = next(block.code for block in blocks(START) if block.language == "text").splitlines()
    assert shown[0] == first_run.attrs["title"]
    rows = {label: value for label, value, _ in summary_rows(first_run)}
    lines = [re.split(r"\s{2,}", line.strip()) for line in shown[1:] if line.strip() != "..."]
    assert len(lines) >= 3
    for label, value in lines:
        numbers = [[float(number) for number in re.findall(r"\d+\.?\d*", text)] for text in (value, rows[label])]
        assert numbers[0] == pytest.approx(numbers[1], rel=5e-3)


def test_tip_relief_does_what_the_page_says(first_run):
    """The two numbers of docs/start.md."""
    text = START.read_text(encoding="utf-8")
    before, after = (float(number) for number in re.search(r"falls from ([\d.]+) to ([\d.]+) um", text).groups())
    appended = next(block.code for block in blocks(START) if block.language == "toml")
    relieved = simulate(scene_from_text(DEMO + "\n" + appended, "mine"))
    assert micrometres(first_run) == pytest.approx(before, rel=5e-3)
    assert micrometres(relieved) == pytest.approx(after, rel=1e-2)
