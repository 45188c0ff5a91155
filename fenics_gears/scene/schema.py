"""The sections that every scene has, with what each field allows, their data, and mistakes against them in words; an
effect's are in its own module. Ranges are generous: ``geometry`` checks whether teeth and diameters make a gear.
"""

import functools
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, make_dataclass, replace
from typing import Any

from fenics_gears.effects import AT_THE_TOP, effect_named
from fenics_gears.inputs.fields import quantity, text, whole_number
from fenics_gears.inputs.problem import MOST_TOLD, Path, Problem, did_you_mean, meant, nearest
from fenics_gears.inputs.section import Section, names_in, read, section_within
from fenics_gears.inputs.tree import LOADS

from .accuracy import Accuracy, Output
from .gear_schema import Gears


@dataclass(frozen=True)
class Load:
    """Torque on the wheel's shaft, N mm; positive when it resists the drive. `given`: the field by which the scene has
    it.
    """

    wheel_torque: float
    given: str = field(default="wheel_torque", compare=False)


# How a scene can give its load: unit and name for people.
LOAD_WORDS = {
    "wheel_torque": ("N m", "torque on the wheel"),
    "pinion_torque": ("N m", "torque on the pinion"),
    "power": ("kW", "power"),
}


@dataclass(frozen=True)
class LoadText(Section):
    """``[load]``: the mean torque on the end of the output shaft, by exactly one of these fields; the gears pass it on
    without losses."""

    alternatives = (LOADS,)

    wheel_torque: float | None = quantity(
        "-1e12 N m to 1e12 N m",
        "437 N m",
        meaning="torque that resists the wheel's rotation; if negative, the wheel drives, which needs `[coast_flanks]`",
        otherwise="from `pinion_torque` or `power`",
    )
    pinion_torque: float | None = quantity(
        "-1e12 N m to 1e12 N m",
        "291 N m",
        meaning="torque that drives the pinion; the wheel has it times z2/z1",
        otherwise="`wheel_torque` or `power` is given",
    )
    power: float | None = quantity(
        "-1e9 kW to 1e9 kW",
        "20 kW",
        meaning="power that goes through the pair at the speed of `[motion]`, which is then required",
        otherwise="`wheel_torque` or `pinion_torque` is given",
    )


# Mesh cycles until every tooth has met every other: the least common multiple of the numbers of teeth.
HUNTING_TOOTH_PERIOD = "hunting tooth period"
MOST_CYCLES = 1_000_000
# Recorded cycles where the scene does not give their number and all cycles are alike, or the result could not hold all.
LAST_CYCLES = 2
# Mesh frequency, Hz, of a scene that has no speed and needs none: its nominal time is 1 s a mesh cycle.
NOMINAL_FREQUENCY = 1.0


@dataclass(frozen=True)
class Motion:
    """Mesh frequency, Hz, mesh cycles that are run, and how many of the last of them have their contact fields stored
    and are shown.

    ``fewer_where_too_large``: the scene does not give that number, so a large result stores fewer. ``speed_given``: if
    not, no result depends on a speed, and the frequency is ``NOMINAL_FREQUENCY``.
    """

    mesh_frequency: float
    mesh_cycles: int
    recorded_cycles: int
    fewer_where_too_large: bool = False
    speed_given: bool = True


# No number of mesh cycles, but as many as a hunting tooth period has.
WHOLE_PERIOD = {HUNTING_TOOTH_PERIOD: 0}


@dataclass(frozen=True)
class MotionText(Section):
    """``[motion]``: the speed, given as mesh frequency or as pinion speed, and the length of the run. A scene without
    ``[inertia]`` needs none of it."""

    alternatives = (("mesh_frequency", "pinion_speed"), ("mesh_cycles", "settling_time"))

    mesh_frequency: float | None = quantity(
        "1e-6 Hz to 1e6 Hz",
        "200 Hz",
        meaning="mesh frequency (pinion speed times number of teeth)",
        otherwise="from `pinion_speed`. With `[inertia]` one of the two is required; otherwise a mesh cycle lasts 1 s",
    )
    pinion_speed: float | None = quantity(
        "1e-6 rpm to 1e6 rpm",
        "750 rpm",
        meaning="nominal speed of the pinion, also in 1/min",
        otherwise="from `mesh_frequency`",
    )
    mesh_cycles: int | None = whole_number(
        1,
        MOST_CYCLES,
        30,
        meaning="number of mesh cycles of the run",
        otherwise='required with `[inertia]`, or `settling_time`; else 1, or `"hunting tooth period"` if cycles differ',
        words=WHOLE_PERIOD,
    )
    settling_time: float | None = quantity(
        "0 s to 1e6 s",
        "25 ms",
        meaning=(
            "time for the start to die down, in place of `mesh_cycles`: its mesh cycles are run, rounded up, and the"
            " recorded ones after them; a sweep of the speed runs no longer than each speed needs"
        ),
        otherwise="`mesh_cycles` says how long",
    )
    recorded_cycles: int | None = whole_number(
        1,
        1_000_000,
        2,
        meaning="mesh cycles at the end of the run whose contact fields are stored and which pictures show",
        otherwise='2; all with `[speed_ramp]` or `mesh_cycles = "hunting tooth period"`, but fields of at most 1 GB',
        words=WHOLE_PERIOD,
    )


@dataclass(frozen=True)
class Derived:
    """A figure that a scene leaves out: its name, value, unit and formula, and a remark if it is `unusual`."""

    name: str
    value: float
    unit: str
    formula: str
    unusual: str = ""


# What a scene is called, and where it was read; it has its data whatever they are.
WORDS = ("title", "name", "derived", "measured_over", "written", "folder")


@dataclass(frozen=True, kw_only=True)
class _AlwaysThere(Section):
    title: str | None = text(500, meaning="title in summaries and pictures", otherwise="the name of the file")
    gears: Gears
    load: LoadText
    motion: MotionText = MotionText()
    accuracy: Accuracy = Accuracy()
    output: Output = Output()


def scene_text(named: Iterable[str] = AT_THE_TOP) -> type[Section]:
    """A whole scene file: the sections that are always there, and an optional one for each effect that is named."""
    return _scene_text(tuple(each for each in AT_THE_TOP if each in named))


@functools.cache
def _scene_text(effects: tuple[str, ...]) -> type[Section]:
    return make_dataclass(
        "SceneText",
        [(each, effect_named(each).fields | None, field(default=None)) for each in effects],
        bases=(_AlwaysThere,),
        namespace={each: None for each in AT_THE_TOP if each not in effects},
        frozen=True,
        kw_only=True,
    )


def known_paths() -> dict[tuple[str, ...], bool]:
    """Every path of a scene; True for a section, False for a field."""
    return paths_in(scene_text())


@functools.cache
def paths_in(section: type[Section], home: tuple[str, ...] = ()) -> dict[tuple[str, ...], bool]:
    """Every path of a section that lies at a path itself; True for a section, False for a field."""
    paths: dict[tuple[str, ...], bool] = {}
    for name in names_in(section):
        inner = section_within(section, name)
        path = (*home, name)
        paths |= {path: inner is not None} | (paths_in(inner, path) if inner is not None else {})
    return paths


def checked_sections(tree: Mapping[str, Any]) -> tuple[Any, list[Problem]]:
    """The sections of a parsed TOML file, None where it is wrong, and all that is wrong with it."""
    section, problems = read(scene_text(tree), tree)
    return section, list(_explained(problems))


def _explained(problems: Iterable[Problem]) -> Iterator[Problem]:
    """Unknown names with what they may mean: the first of them alone, since to search takes time."""
    unknown = 0
    for problem in problems:
        unknown += problem.unknown
        if not problem.unknown:
            yield problem
        else:
            yield replace(problem, message=_why_unknown(problem.path) if unknown <= MOST_TOLD else "is not known.")


def without_echoes(problems: Iterable[Problem]) -> list[Problem]:
    """The problems without those that follow from another: a second one of the same field, where a rule's message
    stays, or a field that is missing because it is misspelt.
    """
    by_path: dict[Path, list[Problem]] = {}
    for problem in problems:
        by_path.setdefault(problem.path, []).append(problem)
    first = {path: next((each for each in alike if not each.unknown), alike[0]) for path, alike in by_path.items()}
    unknown = [problem.path for problem in first.values() if problem.unknown]
    return [
        problem for problem in first.values() if problem.written is not None or not _is_misspelt(problem.path, unknown)
    ]


def _is_misspelt(missing: Path, unknown: Iterable[Path]) -> bool:
    return any(
        path[:-1] == missing[:-1] and (nearest(path[-1], missing[-1:]) or meant(path[:-1], path[-1], missing[-1:]))
        for path in unknown
    )


def _why_unknown(path: Path) -> str:
    name = path[-1]
    home = ".".join(path[:-1])
    known = [each[-1] for each in known_paths() if each[:-1] == path[:-1]]
    synonym = meant(path[:-1], name, known)
    hint = f' Did you mean "{synonym}"?' if synonym else did_you_mean(name, known) or _lives_elsewhere(name)
    kind = f"a known field of [{home}]" if home else "a known section or field of a scene"
    return f"is not {kind}.{hint} Known: {', '.join(known)}."


def _lives_elsewhere(name: str) -> str:
    # What both gears share stands for what each may have of its own.
    fields = [
        path
        for path in known_paths()
        if len(path) == 2 or len(path) > 2 and (*path[:-2], path[-1]) not in known_paths()
    ]
    homes = [f"[{'.'.join(path[:-1])}]" for path in fields if path[-1] == name]
    if homes:
        return f' "{name}" belongs to {" or ".join(homes)}.'
    if any(path[0] == name for path in known_paths()):
        return f" It is a section of the scene: [{name}]."
    # A symbol stands for something else in every section.
    named = [
        f'"{path[-1]}" of [{".".join(path[:-1])}]'
        for path in fields
        if len(name) > 2 and meant(path[:-1], name, path[-1:])
    ]
    return f" Did you mean {' or '.join(named)}?" if named else ""
