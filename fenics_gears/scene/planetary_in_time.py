"""What a planetary set with ``[inertia]`` has, and mistakes in it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from fenics_gears.errors import SceneError
from fenics_gears.geometry.planetary import CARRIER, RING, SUN, WITH_RING
from fenics_gears.inputs.problem import NOTHING_DONE, Path, Problem
from fenics_gears.inputs.tree import table
from fenics_gears.inputs.written import as_written

from .data import Scene
from .planetary_schema import PlanetaryText, VibrationText
from .train_loads import TrainMotion
from .train_whole import INERTIA, wrong_with_inertia


def wrong_inertia(tree: Mapping[str, Any]) -> Iterator[Problem]:
    """What `[inertia]` of a parsed set has beside its load."""
    for name, written in (table(tree, INERTIA) or {}).items():
        if name != "load":
            said = (
                "is not of a set. Its masses are in [stages.NAME.vibration]. Allowed here: [inertia.load], or nothing."
            )
            yield Problem((INERTIA, name), as_written(written), said)


def wrong_in_time(path: Path, text: PlanetaryText, motion: TrainMotion) -> Iterator[Problem]:
    """What a set lacks that runs with masses, and springs with which it is not computed; `path` of its stage."""
    yield from wrong_with_inertia(motion)
    place = (*path, "vibration")
    if text.vibration is None:
        said = f"is missing, which [inertia] needs. Add [{'.'.join(place)}], with the masses of all members."
        yield Problem(place, None, said)
        return
    yield from _wrong_springs(place, text, text.vibration)


def _wrong_springs(path: Path, text: PlanetaryText, given: VibrationText) -> Iterator[Problem]:
    if given.carrier.support_stiffness is not None:
        said = (
            "lets the carrier move aside, which is not computed with [inertia] yet. Leave it out: its centre is held."
        )
        yield Problem((*path, CARRIER, "support_stiffness"), f"{given.carrier.support_stiffness:g} N/mm", said)
    for member in (SUN, RING):
        if getattr(given, member).support_stiffness == 0.0 and member not in (text.floating or ()):
            said = f'holds nothing. Allowed: more, or floating = ["{member}"].'
            yield Problem((*path, member, "support_stiffness"), "0 N/mm", said)
    output = text.output or next((each for each in WITH_RING if each not in (text.fixed, text.input)), None)
    for member in WITH_RING:
        stiffness = getattr(given, member).torsional_stiffness
        said = "would take the torque of the output. Leave it out." if member == output else ""
        if stiffness == 0.0 and member != output:
            said = "lets a member turn that is to stand, or to turn as driven. Allowed: more, or leave it out."
        if stiffness is not None and said and (stiffness or member != output):
            yield Problem((*path, member, "torsional_stiffness"), f"{stiffness:g} N mm/rad", said)


def check_in_time(scene: Scene, place: str) -> None:
    """Raise SceneError for a set over the face."""
    if scene.three_dimensional:
        raise SceneError(
            f"{place}: [inertia] is not computed yet of a planetary set over the face. Allowed: without helix_angle,"
            f" lead_modifications and misalignment, in the plane; or without [inertia]. {NOTHING_DONE}"
        )
