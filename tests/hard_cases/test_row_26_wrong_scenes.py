"""Row 26: a wrong value in any field of the schema is refused before any computation, with file, field, value, what
is allowed and the nearest known name; exit code 2, nothing written."""

import re
import tomllib
from itertools import product
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.hard_cases.scene_fields import (
    DEMO,
    UNITS,
    Field,
    fields,
    plane_scene,
    plane_scene_with_webs,
    scene_with,
    whole_scene,
)
from tests.paper_text import ACCURACY, without

from fenics_gears import GeometryError, Scene, SceneError, scene_from_text
from fenics_gears.commands.cli import main
from fenics_gears.inputs.problem import LISTED

WRONG_TYPES = ("true", "[1, 2]", "{ a = 1 }", "1979-05-27", '""')


class Computed(Exception):
    """Raised in the place of a computation."""


@pytest.fixture
def outcome(tmp_path, monkeypatch, capsys):
    """Runs a scene's text: the refusal's words, None where the scene is taken; fails where anything is written."""
    monkeypatch.chdir(tmp_path)

    def compute(scene, **options):
        raise Computed

    monkeypatch.setattr("fenics_gears.commands.work.kept_run.simulate", compute)

    def run(text):
        file = tmp_path / "pair.toml"
        file.write_text(text)
        try:
            code = main(["run", "pair.toml"])
        except Computed:
            code = None
        said = capsys.readouterr()
        assert [each.name for each in tmp_path.rglob("*")] == ["pair.toml"]
        if code is None:
            return None
        assert code == 2 and said.out == "" and said.err.startswith("pair.toml") and "Traceback" not in said.err
        assert "Nothing was computed or written." in said.err
        return said.err

    return run


def as_said(literal: str) -> str:
    """How a message shows a value."""
    return "a list" if literal.startswith("[") else "" if literal.startswith("{") else literal


def not_numbers(field: Field) -> list[str]:
    return [field.literal(value) for value in ("nan", "-nan", "inf", "-inf", "1e400", "-1e400")] if field.bounds else []


def huge(field: Field) -> list[str]:
    if not field.bounds:
        return []
    numbers = ["1e300", "-1e300", "1e30"] + (["9" * 50, "1" + 400 * "0"] if not field.allowed.kind else [])
    return [field.literal(number) for number in numbers]


def negative(field: Field) -> list[str]:
    return [field.literal(number) for number in (-123, -1e-30, -1e-320) if field.bounds and not field.takes(number)]


def zero(field: Field) -> list[str]:
    tiny = [field.literal(number) for number in ("0", "-0.0", "1e-320", "5e-324", "0e9")]
    return tiny if field.bounds and not field.takes(0.0) and not field.takes(1e-320) else []


def wrong_unit(field: Field) -> list[str]:
    if not field.allowed.kind:
        return [f'"3 {unit}"' for unit in ("mm", "1/s")] if field.path[-1] != "title" else []
    others = [f'"3 {unit}"' for kind, unit in UNITS.items() if kind not in field.kinds]
    return [
        *others,
        f'"3 {field.unit}x"',
        '"3"',
        "3.5",
        "3",
        "nan",
        f'"3,5 {field.unit}"',
        f'"3 {field.unit} {field.unit}"',
        f'"{field.unit}"',
    ]


def wrong_type(field: Field) -> list[str]:
    if field.path[-1] == "title":
        return ["true", "3", "[1, 2]", '"' + 501 * "x" + '"']
    right = (
        ("true", "false")
        if field.allowed.description == "true or false" or field.path == ("output", "contact_fields")
        else ()
    )
    return [
        *(each for each in WRONG_TYPES if each not in right),
        *(["1.5"] if field.whole else []),
        *(['"3"'] if not field.allowed.kind else []),
    ]


KINDS = {
    "NaN and infinity": not_numbers,
    "far too large": huge,
    "negative": negative,
    "zero and denormal": zero,
    "wrong unit": wrong_unit,
    "wrong type": wrong_type,
}


# By day every field has one mistake of every other kind, another one than its neighbours; by night all of them.
breadth = pytest.mark.parametrize(
    "every", [pytest.param(False, id="one each"), pytest.param(True, id="all", marks=pytest.mark.nightly)]
)


def tries_of(every: bool, mistakes) -> list[tuple[Field, str]]:
    """Fields with the mistakes (a function of the field) that are made in them."""
    found = [(field, mistakes(field)) for field in fields()]
    return [
        (field, literal)
        for at, (field, all_of) in enumerate(found)
        if all_of
        for literal in (all_of if every else [all_of[at % len(all_of)]])
    ]


@breadth
@pytest.mark.parametrize("kind", KINDS)
def test_a_wrong_value_in_any_field_is_refused(outcome, measured, kind, every):
    """Every field that the kind of mistake can be made in."""
    tries = tries_of(every, KINDS[kind])
    tries = tries if every else tries[list(KINDS).index(kind) :: 6]
    wrong = []
    for field, literal in tries:
        said = outcome(scene_with(field.path, literal))
        shown = as_said(literal)
        # A list of tables is named by its section.
        name = field.name.removesuffix(f".{LISTED}") if literal.startswith("[") else field.name
        named = f"{name} = {shown[:50]}" if shown and len(shown) <= 60 else name
        if said is None or named not in said or "Allowed: " not in said or not re.match(r"pair\.toml:\d+: ", said):
            wrong.append((field.name, literal, said))
    measured(
        f"{kind}: refused",
        f"{len(tries) - len(wrong)} of {len(tries)} in {len({field.name for field, _ in tries})} fields",
        "all",
    )
    assert len(tries) > 7 and wrong == []


@breadth
def test_a_missing_field_is_named(outcome, measured, every):
    """Every field without a default, and the demo's choice among alternatives; others may be left out, or a rule
    says what then is missing."""
    chosen = {"load.wheel_torque", "gears.material.youngs_modulus", "gears.material.poissons_ratio"}
    required = [field for field in fields() if field.required or field.name in chosen][:: 1 if every else 3]
    said = {field.name: outcome(scene_with(field.path, None)) for field in required}
    wrong = [
        name for name, words in said.items() if words is None or f": {name}\n    is missing. Allowed: " not in words
    ]
    measured("missing fields named", f"{len(required) - len(wrong)} of {len(required)} fields", "all")
    assert len(required) > 6 and wrong == []
    for field in fields() if every else ():
        if not field.required:
            words = outcome(scene_with(field.path, None))
            assert words is None or "is missing. Allowed: " in words


@breadth
def test_a_misspelt_field_is_answered_with_the_right_one(outcome, measured, every):
    """A letter lost in every field's name."""
    wrong, tries = [], fields()[:: 1 if every else 10]
    for field in tries:
        key = field.path[-1]
        misspelt = key[:2] + key[3:]
        said = outcome(scene_with(field.path, '"1 mm"', misspelt))
        if (
            said is None
            or f'{".".join((*field.path[:-1], misspelt))} = "1 mm"\n' not in said
            or f'Did you mean "{key}"?' not in said
        ):
            wrong.append((field.name, said))
        elif field.required and "1 mistake in" not in said:
            wrong.append((field.name, said))
    measured("misspelt fields: nearest known name given", f"{len(tries) - len(wrong)} of {len(tries)} fields", "all")
    assert wrong == []


def bounds_of(field: Field) -> list[str]:
    """Both ends of a field's range, or the numbers next to them where an end is left out."""
    found = []
    for end, excluded, inwards in zip(field.bounds, field.excluded, (1, -1)):
        number = end + inwards * (1e-12 * abs(end) or 1e-12) if excluded else end
        if field.allowed.kind:
            number /= float(scale(field))
        while not field.takes(number):  # a digit lost to the unit
            number *= 1 + 1e-15 * inwards * (1 if number > 0 else -1)
        found.append(field.literal(int(number) if field.whole else repr(float(number))))
    return found


def scale(field: Field) -> float:
    from fenics_gears.inputs.units import quantity

    return quantity(f"1 {field.unit}")[0]


@breadth
def test_either_end_of_every_range_is_a_scene_or_refused(tmp_path, monkeypatch, capsys, measured, every):
    """`gears check` describes it, refuses it in words, or says that it cannot fit; by day every fortieth."""
    monkeypatch.chdir(tmp_path)
    outcomes = []
    for field, literal in tries_of(every, lambda field: bounds_of(field) if field.bounds else [])[
        :: 1 if every else 40
    ]:
        (tmp_path / "pair.toml").write_text(scene_with(field.path, literal))
        code, said = main(["check", "pair.toml"]), capsys.readouterr()
        outcomes.append((field.name, literal, code, "nan" in said.out.lower().split(), said.err))
    taken = sum(code == 0 for _, _, code, _, _ in outcomes)
    measured(
        "ends of ranges",
        f"{taken} accepted by `gears check`, {len(outcomes) - taken} refused with a message",
        "all one or the other, no NaN",
    )
    assert all(code in (0, 2, 3) and not nan and (code == 0) == (err == "") for _, _, code, nan, err in outcomes), (
        outcomes
    )
    # What the memory of no machine holds is a right scene all the same.
    assert all(err.startswith("CANNOT FIT") for _, _, code, _, err in outcomes if code == 3)


COSTLY = {"accuracy.steps_per_mesh_cycle", "accuracy.contact_nodes", "accuracy.flank_element_size", "accuracy.target"}
OVER_FACE = re.compile(r"helix|lead_mod|misalign|axial|wobble|slices|layers|tilting|places")
ONE_CYCLE = {"motion": {"mesh_frequency": "200 Hz", "mesh_cycles": 1, "recorded_cycles": 1}}
COARSE = tomllib.loads(ACCURACY)["accuracy"]


def quick_scene(field: Field) -> dict:
    """One coarse mesh cycle; over the face only for fields that a plane scene has not, with webs for theirs."""
    if OVER_FACE.search(field.name):
        return (
            whole_scene() | ONE_CYCLE | {"accuracy": COARSE | {"slices": 3, "layers": 1, "body_element_size": "4 mm"}}
        )
    tree = plane_scene_with_webs() if "web" in field.path else plane_scene()
    return tree | ONE_CYCLE | {"accuracy": COARSE}


@pytest.mark.nightly
def test_either_end_of_every_range_can_be_run(tmp_path, monkeypatch, capsys, measured):
    """A run ends with a result without NaN or a typed error; ends that only cost time are left out."""
    from fenics_gears import results

    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("FENICS_GEARS_CACHE", str(tmp_path / "cache"))
    codes, wrong = [], []
    for field in fields():
        for literal in bounds_of(field) if field.bounds and field.name not in COSTLY else []:
            text = scene_with(field.path, literal, tree=quick_scene(field))
            (tmp_path / "pair.toml").write_text(text)
            codes.append(main(["run", "pair.toml", "--output", "here", "--quiet", "--no-pictures"]))
            said = capsys.readouterr().err
            if codes[-1] not in (0, 2, 3, 4) or (codes[-1] > 0) != (said != ""):
                wrong.append((field.name, literal, codes[-1], said))
            if codes[-1] == 0 and not results.load("here/run.nc").transmission_error.notnull().all():
                wrong.append((field.name, literal, "NaN"))
    measured(
        "runs at the ends of ranges",
        f"{codes.count(0)} results, {codes.count(2)} refused, {codes.count(3)} errors with their cause",
        "all",
    )
    assert wrong == []


ANY_VALUE = (
    "0", "-1", "1e-320", "nan", "-inf", '""', '"mm"', '"1 mm"', '"HPSTC"', "true", "[]", "{}", "{depth = 3}",
    "12:30:00", "9" * 60, '"1e308 m"', "'''3 mm'''"
)  # fmt: skip
LEFT_OUT = ("", "shafts", "bearings", "inertia", "motion", "gears", "coast_flanks")


@pytest.mark.parametrize(
    "every", [pytest.param(397, id="by day"), pytest.param(23, id="by night", marks=pytest.mark.nightly)]
)
def test_any_value_in_any_field_is_taken_or_refused(every):
    """A scene or a refusal, never another error; also where another section is missing."""
    for field, value, missing in list(product(fields(), ANY_VALUE, LEFT_OUT))[::every]:
        text = scene_with(field.path, value)
        if missing:
            text = without(text, missing)
        try:
            scene = scene_from_text(text)
        except GeometryError as error:
            assert re.search(r"(pinion|wheel|gears)\b.*\n?.*Nothing was computed or written\.", str(error)), (
                field.name,
                value,
                missing,
            )
        except SceneError as error:
            assert "mistake" in str(error), (field.name, value, missing)
        else:
            assert isinstance(scene, Scene)


LINES = DEMO.read_text().splitlines()
WRITTEN = [number for number, line in enumerate(LINES) if re.match(r"\w+ *=", line)]
ANY_LINE = st.integers(0, len(LINES) - 1)
EDIT = st.one_of(
    st.tuples(st.just("delete"), ANY_LINE, ANY_LINE),
    st.tuples(st.just("duplicate"), ANY_LINE, ANY_LINE),
    st.tuples(st.just("move"), ANY_LINE, ANY_LINE),
    st.tuples(st.just("swap values"), st.sampled_from(WRITTEN), st.sampled_from(WRITTEN)),
    st.tuples(st.just("swap names"), st.sampled_from(WRITTEN), st.sampled_from(WRITTEN)),
    st.tuples(
        st.just("character"), ANY_LINE, st.tuples(st.integers(0, 60), st.characters(blacklist_categories=("Cs",)))
    ),
    st.tuples(st.just("cut"), ANY_LINE, st.integers(0, 60)),
)


def edited(lines: list[str], edit) -> list[str]:
    """The lines after one edit; places count round where there are fewer lines by now."""
    kind, first, other = edit
    lines, first = list(lines), edit[1] % len(lines)
    if kind == "delete":
        del lines[first]
    elif kind == "duplicate":
        lines.insert(other, lines[first])
    elif kind == "move":
        lines.insert(other, lines.pop(first))
    elif kind in ("swap values", "swap names"):
        other %= len(lines)
        one, two = lines[first].partition("="), lines[other].partition("=")
        lines[first], lines[other] = ("".join((*one[:2], two[2])), "".join((*two[:2], one[2])))
        if kind == "swap names":
            lines[first], lines[other] = lines[other], lines[first]
    elif kind == "character":
        place, character = other
        lines[first] = lines[first][:place] + character + lines[first][place + 1 :]
    else:
        lines[first] = lines[first][:other]
    return lines or [""]


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A directory for files that are written again and again."""
    return tmp_path_factory.mktemp("edited")


def check_edited(place: Path, edits, capsys) -> int:
    """`gears check` on the demonstration scene after some edits: 0, or 2 with a message and no result."""
    lines = LINES
    for edit in edits:
        lines = edited(lines, edit)
    file = place / "pair.toml"
    file.write_text("\n".join(lines) + "\n")
    code = main(["check", str(file)])
    said = capsys.readouterr()
    assert (code == 0 and said.out and not said.err) or (code == 2 and said.err and not said.out)
    return code


@pytest.mark.parametrize("examples", [40, pytest.param(250, marks=pytest.mark.nightly)])
def test_a_scene_edited_at_random_is_described_or_refused(place, capsys, measured, examples):
    """Exit code 0 or 2, never a traceback."""
    codes = []

    @settings(max_examples=examples)
    @given(st.lists(EDIT, min_size=1, max_size=3))
    def edits(each):
        codes.append(check_edited(place, each, capsys))

    edits()
    measured(
        "scenes edited at random",
        f"{codes.count(0)} accepted, {codes.count(2)} refused with a message",
        "all one or the other",
    )
    assert len(codes) >= examples
