"""Shafts of a train that bend, as the scene of one of its pairs has them: read and checked as those of a pair, whose
torque is coupled where the next gear of the shaft is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from fenics_gears.dynamics.shafts import Shafts
from fenics_gears.inputs.problem import Path
from fenics_gears.inputs.tree import GEARS, SHAFTS

from .data import Scene
from .train_shaft import BentShaft

BEHIND = {"moment_of_inertia": "1 kg m^2"}
# Both gears of a pair with the shafts that they are on, where these bend.
OfPair = Sequence[tuple[str, BentShaft | None]]


def of_pair(gears: Sequence[str], bent: Sequence[BentShaft]) -> OfPair:
    """The shafts of both gears, by their names."""
    return [(gear, next((each for each in bent if gear in each.own.carries), None)) for gear in gears]


def sections_of_pair(both: OfPair, tree: Mapping[str, Any], sections: Mapping[str, Any]) -> dict[str, Any]:
    """The sections of a pair's scene that shafts bring along, of the parsed train; `sections`: what it has without
    them."""
    if not any(bent for _, bent in both):
        return {}
    shafts: dict[str, Any] = {}
    beside: dict[str, Any] = {}
    written = sections.get("bearings")
    centres = written if isinstance(written, Mapping) else {}
    for (gear, bent), side, shaft in zip(both, GEARS, SHAFTS):
        if bent is None:
            own = {name: value for name, value in centres.items() if name not in GEARS} | dict(centres.get(side, {}))
            beside |= {side: own} if own else {}
            continue
        own = tree["shafts"][bent.name]
        places = dict(zip(bent.own.carries, own["gears_at"]))
        at = places.pop(gear)
        coupled = own.get("torque_at", next(iter(places.values()), at))
        shafts[shaft] = {"sections": own["sections"], "gear_at": at, "torque_at": coupled}
        shafts[shaft] |= {"material": own["material"]} if "material" in own else {}
        shafts[shaft] |= {"seat": bent.own.seats[bent.own.carries.index(gear)]} if bent.own.seats else {}
        beside[side] = own["bearings"]
    found: dict[str, Any] = {"shafts": shafts, "bearings": beside}
    if "inertia" in sections:
        # What stands behind the coupling of a pair's output shaft; the train counts it once, on its last shaft.
        found["inertia"] = sections["inertia"] | {"load": tree["inertia"].get("load", BEHIND)}
    return found


def place_of(both: OfPair, path: Path) -> Path | None:
    """Where a train has what a pair's scene has of its shafts at a path; None of anything else."""
    for (_, bent), side, shaft in zip(both, GEARS, SHAFTS):
        if bent is not None and path[:2] == ("shafts", shaft):
            rest = tuple({"gear_at": "gears_at", "seat": "seats"}.get(each, each) for each in path[2:])
            return ("shafts", bent.name, *rest)
        if bent is not None and path[:2] == ("bearings", side):
            return ("shafts", bent.name, "bearings")
    return None


def in_words_of_train(both: OfPair, text: str) -> str:
    """What is said of a pair's shafts, with the names that the train has for them."""
    for (gear, bent), side, shaft in zip(both, GEARS, SHAFTS):
        if bent is None:
            continue
        bearings = f"shafts.{bent.name}.bearings"
        for old, new in (
            (f"shafts.{shaft}.gear_at", f"shafts.{bent.name}.gears_at"),
            (f"shafts.{shaft}.seat ", f"shafts.{bent.name}.seats "),
            (f"shafts.{shaft}", f"shafts.{bent.name}"),
            (f"bearings.{side}", bearings),
            (f"the {side}", gear),
            (f"gears.{side}.", f"{_home(gear)}."),
        ):
            text = text.replace(old, new)
    return text


def _home(gear: str) -> str:
    """Where a train has what is said of a gear."""
    stage, _, own = gear.rpartition(".")
    return f"stages.{stage}.{f'gears.{own}' if own.isdigit() else own}"


def in_train(scene: Scene) -> Scene:
    """The scene of a pair whose shafts are not its own alone, over the face."""
    return replace(scene, shafts=replace(scene.shafts or Shafts(), in_train=True))
