"""``[bearings]``: elastic support of the gear centres (``dynamics.drivetrain``)."""

from __future__ import annotations

from fenics_gears.dynamics.bearings import Bearings
from fenics_gears.inputs.problem import LISTED, Broken
from fenics_gears.inputs.tree import GEARS, Tree, given_for, module_in, quantity_in, shafts_with_sections, table

from .effect import OF_GEARS, Effect, ResultVariable, variables

DIRECTIONS = ("x", "y")
STIFFNESSES = ("stiffness", "stiffness_x", "stiffness_y")
# Bearings nearer to each other than so many modules are on one spot: nothing would hold the tilt.
LEAST_SPAN = 0.1


def supports_are_complete(tree: Tree) -> Broken:
    """Either shaft has a stiffness in either direction."""
    both = table(tree, "bearings")
    if both is None:
        return
    listed = [gear for gear in GEARS if LISTED in (table(both, gear) or {})]
    bent = shafts_with_sections(tree)
    if listed or bent:
        from .elastic_shaft_rules import rules_of_listed_bearings

        yield from rules_of_listed_bearings(tree, both, listed)
    missing = [
        (gear, direction)
        for gear in GEARS
        for direction in DIRECTIONS
        if not given_for(both, gear) & {"stiffness", f"stiffness_{direction}"}
        # Beside a shaft with bearings of its own a gear that names nothing is held.
        if not (listed or bent) or given_for(both, gear) & {*STIFFNESSES}
    ]
    example = 'Allowed: such as "0.155e6 N/mm"'
    if len(missing) == 4:
        message = f"is missing. {example}, or stiffness_x and stiffness_y, along and off the line of action."
        yield ("bearings", "stiffness"), message
    elif missing:
        gears = {gear for gear, _ in missing}
        for direction in sorted({direction for _, direction in missing}):
            path = ("bearings",) if len(gears) == 2 else ("bearings", *gears)
            yield (*path, f"stiffness_{direction}"), f"is missing. {example}, or stiffness for both directions."
    yield from _bearings_stand_apart(tree, both)
    yield from _axial_stiffness_has_places(both)


def _bearings_stand_apart(tree: Tree, both: Tree) -> Broken:
    places = table(both, "places")
    if places is None:
        return
    module = module_in(tree) or 0.0
    for gear in GEARS:
        written = places.get(gear)
        spots = [quantity_in(value) for value in written] if isinstance(written, list) else []
        if len(spots) == 2 and None not in spots and abs(spots[1] - spots[0]) < LEAST_SPAN * module:
            message = (
                "has both bearings on one spot, where nothing holds the tilt. Allowed: places at least"
                f" {LEAST_SPAN * module:g} mm apart, a tenth of the module."
            )
            yield ("bearings", "places", gear), message


def _axial_stiffness_has_places(both: Tree) -> Broken:
    """An axial stiffness is that of a shaft that can move: one whose bearings have places."""
    places = table(both, "places") or {}
    for path, section, gears in [((), both, GEARS), *(((gear,), table(both, gear) or {}, (gear,)) for gear in GEARS)]:
        if "axial_stiffness" in section and not any(gear in places for gear in gears):
            names = " or ".join(f"bearings.places.{gear}" for gear in gears)
            message = (
                f"has no effect: a shaft whose bearings have no places is held axially. Leave it out, or give {names}."
            )
            yield ("bearings", *path, "axial_stiffness"), message


def warnings(bearings: Bearings, model) -> list[str]:
    if bearings.places is None and bearings.each is None:
        return []
    from fenics_gears.dynamics.tilting import gyroscopic_warnings

    fastest = model.scene.mesh_frequencies[1]
    turns = {gear: fastest / getattr(model.scene.gears, gear).teeth for gear in GEARS}
    return within_gears(bearings, model) + gyroscopic_warnings(model.vibrations, turns)


def within_gears(bearings: Bearings, model) -> list[str]:
    """A sentence on each bearing within its gear's own face."""
    sentences = []
    for gear, width in zip(GEARS, model.pair.face_widths):
        inside = [place for place in bearings.places_of(gear) or () if abs(place) < 0.5 * width]
        if inside:
            places = " and ".join(f"{place:g} mm" for place in inside)
            said = f"the bearing at {places} stands" if len(inside) == 1 else f"the bearings at {places} stand"
            sentences.append(
                f"bearings.places.{gear}: {said} within the gear, which reaches {0.5 * width:g} mm to either side of"
                " its mid-width, from which places are counted: move the bearing out, unless the gear turns on it"
            )
    return sentences


EFFECT = Effect(
    section="bearings",
    description="elastic support of the gear centres",
    absent="the centres are fixed",
    fields=Bearings,
    unknowns=("two displacements of each gear centre; with places also two tilts and the axial position",),
    terms=("springs of the bearings",),
    variables=(
        *variables(
            OF_GEARS,
            centre_x=("mm", "displacement of the centre along the line of action"),
            centre_y=("mm", "displacement of the centre off the line of action"),
        ),
        *variables(
            OF_GEARS,
            field="places or each",
            axial_position=("mm", "displacement of the gear along its axis"),
            tilt_x=("rad", "tilt of the gear about the line of action"),
            tilt_y=("rad", "tilt of the gear about the direction off the line of action"),
        ),
        ResultVariable("energy_bearings", "N mm", "elastic energy of the bearings"),
    ),
    rules=supports_are_complete,
    warnings=warnings,
)
