"""From a TOML file or text to the fields of the scene that it describes, or all its mistakes at once."""

import datetime
import math
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from fenics_gears.effects import effects_on
from fenics_gears.effects.tooth_elasticity import material_of
from fenics_gears.errors import GeometryError, SceneError
from fenics_gears.geometry.gear_data import MATERIALS
from fenics_gears.inputs.problem import NOTHING_DONE, Problem, did_you_mean, line_numbers, listed, placed
from fenics_gears.inputs.tree import GEARS, LOADS, MOST_NESTED, nested_too_deeply, wheel_torque, written_out
from fenics_gears.inputs.written import WrittenFloat, as_written
from fenics_gears.system import user_file
from fenics_gears.system.console import control_character, printable

from .drawing import gear_pair_data
from .gear_schema import Gears
from .rules import broken_rules
from .schema import LAST_CYCLES, NOMINAL_FREQUENCY, Derived, Load, LoadText, Motion, checked_sections, without_echoes

ALLOWED_DEPTH = f"Allowed: {MOST_NESTED} tables and lists within one another."
# The text of a scene that no file gives (`scene.write`).
NO_FILE = "# No scene file gives this scene, which was made or changed in Python"


def text_of(path: Path, kind: str) -> str:
    """The text of a file that should be a "scene" or a "study". Raises SceneError where it cannot be read."""
    try:
        return user_file.text_of(path, user_file.LARGEST_SCENE)
    except user_file.Missing as problem:
        raise SceneError(f"{path}: {problem}{_nearest_file(path)}") from None
    except user_file.Unreadable as problem:
        raise SceneError(f"{path}: {problem}; a {kind} is a TOML file") from None


def name_of(path: Path) -> str:
    """What a scene or a study is called by its file: its name without the ending, as a text that can be stored."""
    return printable(path.stem)


def _nearest_file(path: Path) -> str:
    neighbours = [each.name for each in path.parent.glob("*.toml")] if path.parent.is_dir() else []
    return "." + did_you_mean(path.name, neighbours)


def parsed(text: str, source: str) -> dict[str, Any]:
    """What a TOML text holds, its numbers as they were written, and what is written short as its section. Raises
    SceneError, which calls the text `source`."""
    try:
        tree = tomllib.loads(text, parse_float=WrittenFloat)
    except tomllib.TOMLDecodeError as error:
        from fenics_gears.inputs.toml_mistakes import in_words

        raise SceneError(f"{in_words(error, text, source)}\n{NOTHING_DONE}") from None
    except (ValueError, RecursionError) as error:
        why = "is nested too deeply" if isinstance(error, RecursionError) else "a number has thousands of digits"
        raise SceneError(f"{source}: is not valid TOML: {why}. {NOTHING_DONE}") from None
    if too_deep := nested_too_deeply(tree):
        raise SceneError(f"{source}: [{too_deep}] is nested too deeply. {ALLOWED_DEPTH} {NOTHING_DONE}")
    tree = written_out(tree)
    if problems := list(_of_no_field((), tree)):
        raise SceneError(listed(problems, line_numbers(text), source))
    return tree


def _of_no_field(path: tuple[str, ...], value: Any) -> Iterator[Problem]:
    """Texts with control characters, which a terminal would obey and a file of results could not hold; dates and
    times."""
    if isinstance(value, Mapping):
        for name, inner in value.items():
            yield from _of_no_field((*path, name), inner)
    elif isinstance(value, list):
        for inner in value:
            yield from _of_no_field(path, inner)
    elif isinstance(value, datetime.date | datetime.time):
        allowed = "Allowed: texts between quotes, numbers, true and false."
        yield Problem(path, as_written(value), f"is a date or a time, which no field takes. {allowed}")
    elif isinstance(value, str) and (character := control_character(value)):
        allowed = "Allowed: characters that can be printed, tabs and new lines."
        yield Problem(path, as_written(value), f"has the control character {character}. {allowed}")


def is_train(tree: Mapping[str, Any]) -> bool:
    """Whether a parsed text is of a train, not of a pair."""
    return "stages" in tree and "gears" not in tree


def values_of_text(
    text: str, name: str, *, source: str | None = None, directory: Path = Path(), with_lines: bool = True
) -> dict[str, Any]:
    """The fields of the scene that a TOML text describes, by name; arguments and errors as in
    `read.scene_from_text`."""
    source = source or name
    tree = parsed(text, source)
    if "sweep" in tree and "gears" not in tree:
        raise SceneError(f"{source}: is a study, not a scene; `gears study {source}` runs it. {NOTHING_DONE}")
    if is_train(tree):
        raise SceneError(
            f"{source}: is a train of gears, where the scene of a pair is wanted. `gears run` writes that of each stage"
            " of two gears, as scene.toml into a folder by the stage's name; take it. In Python"
            f" fenics_gears.load_train reads a train. {NOTHING_DONE}"
        )
    if "stages" in tree:
        raise SceneError(
            f"{source}: has [gears], which are those of a pair, and [stages], which are those of a train. Leave one of"
            f" the two out. {NOTHING_DONE}"
        )
    try:
        values, problems = values_of(tree, text, name, directory)
    except GeometryError as error:
        raise GeometryError(placed(str(error), text if with_lines else "", source)) from error
    if values is None:
        raise SceneError(listed(problems, line_numbers(text) if with_lines else {}, source))
    return values


def values_of(
    tree: Mapping[str, Any], text: str, name: str, directory: Path
) -> tuple[dict[str, Any] | None, list[Problem]]:
    """The fields of the scene of a parsed text, by name, None where it is wrong, and all that is wrong with it.

    Raises GeometryError for a figure of the gears that cannot be derived.
    """
    checked, problems = checked_sections(tree)
    problems = without_echoes(problems + broken_rules(tree))
    if problems:
        return None, problems
    gears, derived = gear_pair_data(checked.gears)
    motion = _motion(checked)
    load, of_load = load_data(checked.load, checked.gears, motion)
    values = dict(
        title=checked.title or name,
        gears=gears,
        load=load,
        motion=motion,
        accuracy=checked.accuracy,
        output=replace(checked.output, contact_fields=checked.output.contact_fields is not False),
        name=name,
        derived=(*derived, *named_materials(checked.gears), *of_load),
        measured_over=(_measured_over(checked.gears.pinion), _measured_over(checked.gears.wheel)),
        written=text,
        folder=str(directory.absolute()),
        **{each.section: each.data_of(getattr(checked, each.section), directory) for each in effects_on(checked)},
    )
    return values, []


def _measured_over(drawn) -> tuple[int | None, float | None]:
    ball = drawn.ball_diameter
    return drawn.spanned_teeth, None if ball is None else float(ball)


def _motion(checked) -> Motion:
    """A turn of the pinion has as many mesh cycles as it has teeth.

    Cycles that are run, unless given: one, or a whole hunting tooth period where cycles differ; the cycles of a
    settling time come before them. Cycles that are recorded, unless given: the last two; of a speed ramp or a whole
    period all that fit.
    """
    motion = checked.motion
    gears = checked.gears
    frequency = motion.mesh_frequency
    if motion.pinion_speed is not None:
        frequency = motion.pinion_speed / (2 * math.pi) * gears.pinion.teeth
    speed_given = frequency is not None
    if not speed_given:
        frequency = NOMINAL_FREQUENCY
    whole_period = math.lcm(gears.pinion.teeth, gears.wheel.teeth)
    recorded = None if motion.recorded_cycles is None else motion.recorded_cycles or whole_period
    stored = checked.output.contact_fields
    asked = None if isinstance(stored, bool) else stored
    cycles = motion.mesh_cycles or whole_period
    whole = motion.mesh_cycles == 0
    if motion.mesh_cycles is None:
        least = 1 if motion.settling_time is None else LAST_CYCLES
        wanted = recorded or (least if asked in (None, math.inf) else asked)
        whole = any(effect.period is not None for effect in effects_on(checked))
        # Rounded, so that 25 ms at 40 Hz are one cycle in spite of round-off.
        settling = math.ceil(round((motion.settling_time or 0.0) * frequency, 9))
        cycles = settling + max(whole_period if whole else 1, wanted)
    fewer = False
    if asked is not None:
        recorded = min(cycles, asked)
    elif recorded is None:
        fewer = checked.speed_ramp is not None or whole
        recorded = cycles if fewer else min(LAST_CYCLES, cycles)
    return Motion(frequency, cycles, recorded, fewer, speed_given)


def named_materials(gears: Gears) -> list[Derived]:
    texts = {"": (gears.material,), **{f"{name} ": (getattr(gears, name).material, gears.material) for name in GEARS}}
    named = {
        words: (each[0].name, material_of(*each))
        for words, each in texts.items()
        if each[0] is not None and each[0].name is not None
    }
    return [
        Derived(
            f"{words}Young's modulus",
            1e-3 * material.youngs_modulus,
            "GPa",
            f"Poisson's ratio {material.poissons_ratio:g}, {name} ({MATERIALS[name][1]})",
        )
        for words, (name, material) in named.items()
    ]


def load_data(load: LoadText, gears: Gears, motion: Motion) -> tuple[Load, list[Derived]]:
    """The torque on the wheel, N mm, and how it was derived."""
    name = next(each for each in LOADS if getattr(load, each) is not None)
    torque = wheel_torque(
        name, float(getattr(load, name)), (gears.pinion.teeth, gears.wheel.teeth), motion.mesh_frequency
    )
    assert torque is not None, "a load by power has a speed"
    why = {"pinion_torque": "T_2 = T_1 z2/z1", "power": "T_2 = P/(2 pi n_2)"}
    derived = [Derived("torque on the wheel", 1e-3 * torque, "N m", why[name])] if name in why else []
    return Load(torque, name), derived
