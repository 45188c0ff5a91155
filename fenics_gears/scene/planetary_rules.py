"""What a planetary set may have beside its gears, and mistakes in it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from fenics_gears.effects.flank_errors_rules import PITCH_ROUNDING, not_closed
from fenics_gears.geometry.planetary import CARRIER, RING, SECOND_SUN, SUN
from fenics_gears.inputs.problem import NOTHING_DONE, Problem, did_you_mean
from fenics_gears.inputs.section import Section, names_in, read_by_itself
from fenics_gears.inputs.tree import GEARS
from fenics_gears.inputs.written import as_written

from .gear_schema import Gears
from .planetary_schema import (
    MESHES,
    MOST_PLANETS,
    OF_A_MESH,
    OF_THE_FACE,
    OF_THE_STEP,
    PLANETARY,
    RING_MESH,
    STEP,
    SUN_MESH,
    PlanetaryText,
    gears_in,
    meshes_in,
    second_in,
)
from .train_pair import STAGES
from .train_rules import ENDS

# Sections of a train with a set.
OF_THE_TRAIN = ("title", STAGES, *ENDS, "friction", "accuracy")
# Of a pair; what a set has in its place.
NOT_HERE = {
    "direction": "is of a pair. Allowed: planets or planet_angles.",
    "directions": "is of a row. Allowed: planets or planet_angles.",
    "gears": "is of a row. A set has the gears sun, planet and ring.",
    "pinion": "is of a pair. A set has the gears sun, planet and ring.",
    "wheel": "is of a pair. A set has the gears sun, planet and ring.",
    "backlash": "would thin the teeth of the planet differently in its meshes. Allowed: profile_shift of each gear.",
    "pinion_hand": "is of a pair. Allowed: sun_hand.",
    "flank_errors": "is of a pair. Of a set pitch errors alone are computed. Allowed: pitch_errors.",
    **dict.fromkeys(OF_A_MESH, f"is of one mesh: write it in [stages.NAME.{SUN_MESH}] or [stages.NAME.{RING_MESH}]."),
    "friction": "is of the whole train: write it as [friction].",
}  # fmt: skip
OF_A_SET_ALONE = ("inertia", "damping", "speed_ramp")
NOT_WITH_A_SET = {
    "shafts": "is not computed with a planetary set yet. Leave it out.",
    **dict.fromkeys(
        OF_A_SET_ALONE, "is computed of a planetary set by itself alone, not beside other stages yet. Leave it out."
    ),
    "bearings": "is not of a planetary set. Allowed: floating, carrier.pin_stiffness, and with [inertia]"
    " support_stiffness of the members in [stages.NAME.vibration].",
}
Tree = Mapping[str, Any]


def has_planets(tree: Tree) -> bool:
    """Whether a parsed train has a planetary set."""
    stages = tree["stages"]
    return isinstance(stages, Mapping) and any(
        isinstance(each, Mapping) and each.get("kind") == PLANETARY for each in stages.values()
    )


def wrong_sections(tree: Tree, known: Sequence[str] = OF_THE_TRAIN) -> Iterator[Problem]:
    """Sections that a train with a set does not have, and those that it has in another form."""
    for name in tree:
        if name in known:
            continue
        said = f"is not of a train.{did_you_mean(name, known)} Known: {', '.join(known)}."
        yield Problem((name,), as_written(tree[name]), NOT_WITH_A_SET.get(name, said))
    for section, name in (("load", "torques"), ("motion", "speed"), ("motion", "speed_of")):
        written = tree.get(section)
        if isinstance(written, Mapping) and name in written:
            said = "is not computed with a planetary set yet, which has one input and one output. Leave it out."
            yield Problem((section, name), as_written(written[name]), said)


def text_of_set(stage: str, content: Tree) -> tuple[PlanetaryText | None, list[Problem]]:
    """What a set has beside its gears, None where it is wrong, and all that is wrong with it."""
    path = (STAGES, stage)
    own = names_in(PlanetaryText)
    text, problems = read_by_itself(PlanetaryText, {name: content[name] for name in own if name in content}, path)
    shared = [name for name in names_in(Gears) if name not in (*GEARS, "backlash", "pinion_hand")]
    gears = gears_in(content)
    meshes = meshes_in(content)
    known = ["kind", "accuracy", *own, *shared, *gears, STEP, RING, *meshes]
    for name in content:
        if name in NOT_HERE:
            problems.append(Problem((*path, name), as_written(content[name]), NOT_HERE[name].replace("NAME", stage)))
        elif name not in known:
            said = f"is not known here.{did_you_mean(name, known)} Known: {', '.join(known)}."
            problems.append(Problem((*path, name), as_written(content[name]), said))
    for gear in gears:
        if not isinstance(content.get(gear), Mapping):
            written = None if gear not in content else as_written(content[gear])
            said = f"is missing. Add the section [{'.'.join((*path, gear))}] with teeth and the other fields of a gear."
            problems.append(Problem((*path, gear), written, said if written is None else "is not a section."))
    for mesh in meshes:
        stepped = STEP in content and mesh != SUN_MESH
        problems += _wrong_effects((*path, mesh), content.get(mesh, {}), OF_THE_STEP if stepped else ())
    problems += _wrong_steps(path, content)
    if text is not None:
        problems += _wrong_members(path, text, (SUN, second_in(content), CARRIER))
        problems += _wrong_pitches((*path, "pitch_errors"), text, content)
        if text.sun_hand is not None and "helix_angle" not in content:
            said = "has no meaning without helix_angle. Leave it out, or give helix_angle."
            problems.append(Problem((*path, "sun_hand"), f'"{text.sun_hand}"', said))
    return (None if problems else text), problems


def _wrong_effects(path: tuple[str, ...], content: Any, of_gears: tuple[str, ...]) -> Iterator[Problem]:
    """What the section of a mesh has that no mesh has; `of_gears`: fields that it may have of its gears."""
    allowed = (*OF_A_MESH, *of_gears)
    if not isinstance(content, Mapping):
        yield Problem(path, as_written(content), f"is not a section. Allowed in it: {', '.join(allowed)}.")
        return
    for name in content:
        if name not in allowed:
            said = f"is not computed in a mesh of a set.{did_you_mean(name, allowed)} Allowed: {', '.join(allowed)}."
            yield Problem((*path, name), as_written(content[name]), said)


def _wrong_steps(path: tuple[str, ...], content: Tree) -> Iterator[Problem]:
    """What sets with stepped planets, or with a second sun, do not have."""
    if SECOND_SUN in content and RING in content:
        said = (
            "stands beside a ring. Sets of three central gears, as with planets that mesh with each other (Ravigneaux),"
            f" are not computed. Allowed: {RING} or {SECOND_SUN}; or two sets one after the other."
        )
        yield Problem((*path, SECOND_SUN), "", said)
    if STEP not in content:
        if SECOND_SUN in content:
            said = (
                f"is missing: a {SECOND_SUN} meshes with a second gear of each planet. Add [{'.'.join(path)}.{STEP}]."
            )
            yield Problem((*path, STEP), None, said)
        if "step_angle" in content:
            said = f"is of stepped planets. Leave it out, or add [{'.'.join(path)}.{STEP}]."
            yield Problem((*path, "step_angle"), as_written(content["step_angle"]), said)
        return
    said = f"is not computed with stepped planets, which are spur and in the plane. Leave it out, or {STEP}."
    of_meshes = [(mesh, name) for mesh in MESHES for name in OF_THE_FACE if name in content.get(mesh, ())]
    for place in [*of_meshes, *((name,) for name in ("helix_angle", "vibration") if name in content)]:
        yield Problem((*path, *place), "", said)


def _wrong_members(path: tuple[str, ...], text: PlanetaryText, members: tuple[str, ...]) -> Iterator[Problem]:
    """Members that are named wrongly: of the three one is fixed, one driven, one drives the load."""
    listed = ", ".join(f'"{each}"' for each in members)
    if text.planets is None and text.planet_angles is None:
        said = "is missing. Allowed: a number of planets, equally spaced; or planet_angles, a list of their directions."
        yield Problem((*path, "planets"), None, said)
    if text.planet_angles is not None and not 2 <= len(text.planet_angles) <= MOST_PLANETS:
        yield Problem((*path, "planet_angles"), "a list", f"has not 2 to {MOST_PLANETS} angles, one for each planet.")
    if text.fixed is None:
        yield Problem((*path, "fixed"), None, f"is missing: no member is held. Allowed: one of {listed}.")
    if text.input is None:
        yield Problem((*path, "input"), None, f"is missing: no member is driven. Allowed: one of {listed}.")
    named = {name: getattr(text, name) for name in ("fixed", "input", "output")}
    floating = [(("floating",), each) for each in text.floating or ()]
    run_out = [] if text.eccentricity is None or text.eccentricity.ring is None else [(("eccentricity", RING), RING)]
    for place, member in (*(((name,), each) for name, each in named.items()), *floating, *run_out):
        if member is not None and member not in members:
            yield Problem((*path, *place), f'"{member}"', f"is no member of this set. Allowed: one of {listed}.")
            return
    for name, other in (("input", "fixed"), ("output", "fixed"), ("output", "input")):
        if named[name] is not None and named[name] == named[other]:
            left = [each for each in members if each not in {*named.values()}]
            said = (
                f"is the member that is {'fixed' if other == 'fixed' else 'the input'} too. Allowed: another one; of"
                f" {listed} one is fixed, one driven, and one has the load. Left: {', '.join(left)}."
            )
            yield Problem((*path, name), f'"{named[name]}"', said)
            return
    count = text.planets or len(text.planet_angles or ())
    if text.floating and count < 3:
        said = "needs three planets: two do not centre a member that nothing else holds. Leave it out."
        yield Problem((*path, "floating"), "a list", said)
    if len(set(text.floating or ())) > 1:
        # The planets roll: for any way of one centre there is one of the other at which all gaps stay as they are.
        said = "lets both centres move aside while the planets roll between them: nothing stops them. Leave one out."
        yield Problem((*path, "floating"), "a list", said)
    yield from _wrong_carrier(path, text, count)
    yield from _wrong_vibration(path, text)
    yield from _wrong_run_outs((*path, "eccentricity"), text, count)


def _wrong_carrier(path: tuple[str, ...], text: PlanetaryText, count: int) -> Iterator[Problem]:
    """Errors of more or fewer pins than there are, and a carrier that moves aside and does not find its place."""
    own = text.carrier
    if own is None:
        return
    yield from _not_one_each((*path, "carrier"), own, ("pin_errors", "radial_pin_errors"), count)
    if own.bearing_stiffness is None:
        return
    said = ""
    if own.pin_stiffness is None and own.stiffness is None:
        said = "needs springs between carrier and planets. Add pin_stiffness or stiffness."
    elif not own.bearing_stiffness and (text.floating or count < 3):
        said = "leaves a carrier that too little centres: it takes three planets, sun and ring held. Allowed: above 0."
    if said:
        yield Problem((*path, "carrier", "bearing_stiffness"), f"{own.bearing_stiffness:g} N/mm", said)


def _wrong_run_outs(path: tuple[str, ...], text: PlanetaryText, count: int) -> Iterator[Problem]:
    """Gears that run out by nothing, or planets that are more or fewer than the set has."""
    own = text.eccentricity
    if own is None:
        return
    if own.sun is None and own.planets is None and own.ring is None:
        name = ".".join(path)
        said = f"says of no gear that it runs out. Add [{name}.sun], [{name}.planets] or [{name}.ring]."
        yield Problem(path, "", said)
    if own.planets is None:
        return
    if own.planets.distance is None:
        said = f"is missing. Allowed: a list of {count} lengths, one for each planet."
        yield Problem((*path, "planets", "distance"), None, said)
    yield from _not_one_each((*path, "planets"), own.planets, ("distance", "phase"), count)


def _not_one_each(path: tuple[str, ...], section: Section, names: Sequence[str], count: int) -> Iterator[Problem]:
    """Lists of a section that have not one entry for each planet."""
    for name in names:
        listed = getattr(section, name)
        if listed is not None and len(listed) != count:
            said = f"has {len(listed)} entries for {count} planets. Allowed: one for each."
            yield Problem((*path, name), "a list", said)


def _wrong_pitches(path: tuple[str, ...], text: PlanetaryText, content: Tree) -> Iterator[Problem]:
    """Pitch errors of more or fewer teeth than gears have, or that do not close around one."""
    own = text.pitch_errors
    count = text.planets or len(text.planet_angles or ())
    of_gears = (SUN, content.get(SUN), 1), ("planets", content.get("planet"), count), (RING, content.get(RING), 1)
    for name, gear, gears in of_gears:
        pitches = getattr(own, name) if own is not None else None
        teeth = gear.get("teeth") if isinstance(gear, Mapping) else 0
        if pitches is None or not isinstance(teeth, int):
            continue
        if not teeth:
            yield Problem((*path, name), "a list", f"is of a gear that this set has not. {NOTHING_DONE}")
        elif len(pitches) != gears * abs(teeth):
            said = f"has {len(pitches)} entries for {gears} x {abs(teeth)} teeth. Allowed: one for each."
            yield Problem((*path, name), "a list", said)
        else:
            totals = np.array(pitches).reshape(gears, -1).sum(axis=1)
            worst = max(totals.tolist(), key=abs)
            if abs(worst) > PITCH_ROUNDING * abs(teeth):
                yield Problem((*path, name), "a list", not_closed(worst))


def _wrong_vibration(path: tuple[str, ...], text: PlanetaryText) -> Iterator[Problem]:
    """Lumped members whose springs are missing, or are of members that nothing holds."""
    if text.vibration is None:
        return
    for name in ("stiffness", "bearing_stiffness"):
        if text.carrier is not None and getattr(text.carrier, name) is not None:
            said = "is not in the natural frequencies. Leave it out, or vibration; support_stiffness holds the carrier."
            yield Problem((*path, "carrier", name), "", said)
    if text.carrier is None or text.carrier.pin_stiffness is None:
        said = (
            'is missing: natural frequencies need the spring of the pins. Add pin_stiffness, such as "3e5 N/mm", or'
            f" leave [{'.'.join((*path, 'vibration'))}] out."
        )
        yield Problem((*path, "carrier", "pin_stiffness"), None, said)
    for member in text.floating or ():
        stiffness = getattr(text.vibration, member).support_stiffness
        if stiffness:
            said = f'holds a member that is floating. Leave it out, or take "{member}" out of floating.'
            yield Problem((*path, "vibration", member, "support_stiffness"), f"{stiffness:g} N/mm", said)
