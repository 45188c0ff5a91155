"""Parts of effects over the face that a scene can do without one at a time: each lead modification, tilting and axial
motion.

The helix is none of them: without it a pair has another transverse section and another centre distance.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from fenics_gears.effects.lead_modifications import LeadModification, LeadModifications
from fenics_gears.scene.data import Scene

UNMODIFIED = LeadModification()
OF_LEAD = tuple(vars(UNMODIFIED))
GEARS = ("pinion", "wheel")
TILTING, AXIAL = "tilting and axial motion", "axial motion"


def without_parts(scene: Scene) -> Iterator[tuple[str, Scene]]:
    """Each part, in words, and the scene without it; nothing where an effect has that part alone, and leaving it out is
    leaving out the effect."""
    lead = scene.lead_modifications
    if lead is not None:
        named = [
            name
            for name in OF_LEAD
            if any(getattr(gear, name) for gear in (lead.pinion, lead.wheel) if gear is not None)
        ]
        for name in named if len(named) > 1 else ():
            yield name, replace(scene, lead_modifications=_without(lead, name))
    bearings = scene.bearings
    if bearings is None or bearings.places is None:
        return
    own = {
        gear: replace(getattr(bearings, gear), axial_stiffness=None)
        for gear in GEARS
        if getattr(bearings, gear) is not None
    }
    held = replace(bearings, axial_stiffness=None, **own)
    yield TILTING, replace(scene, bearings=replace(held, places=None))
    if any(bearings.axial(gear) is not None for gear in GEARS):
        yield AXIAL, replace(scene, bearings=held)


def _without(lead: LeadModifications, name: str) -> LeadModifications:
    return LeadModifications(
        *(
            None if gear is None else replace(gear, **{name: getattr(UNMODIFIED, name)})
            for gear in (lead.pinion, lead.wheel)
        )
    )
