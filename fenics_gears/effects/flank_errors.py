"""``[flank_errors]``: pitch, profile, helix and waviness deviations of single teeth (``geometry.flank_deviations``,
``contact.flank_gaps``).

Signs are those of ISO 1328-1. A pitch deviation is positive where the pitch is too long; a profile slope where the
flank has material in excess towards the tip; a profile form, which the standard gives no sign, where the middle of the
flank stands out. Those of the helix are the like along the face, positive towards the right end, whatever the hand.
Teeth are counted in the order in which they mesh, from the tooth of either gear that meshes first; a pitch is that from
the tooth before.
"""

from collections.abc import Sequence
from math import lcm
from typing import Any

from fenics_gears.inputs.section import tree_of
from fenics_gears.inputs.tree import GEARS

from .effect import Effect, ResultVariable
from .flank_errors_rules import errors_fit_the_gears
from .flank_errors_sections import HELIX, FlankErrors, GearErrors, lists_of
from .flank_errors_tables import check, files, located


def write(errors: FlankErrors) -> dict:
    """The section; what stands in tables is left to them."""
    found = tree_of(errors)
    for gear in GEARS:
        for column in getattr(errors, gear).columns:
            found[gear].pop(column, None)
    return found


def gaps(errors: FlankErrors, model):
    """What the errors of the teeth that meet add to the gaps."""
    from fenics_gears.contact.flank_gaps import flank_gaps

    return flank_gaps(errors, model.pair, model.resolution.steps_per_mesh_cycle, model.face)


def results(errors: FlankErrors, scene, cycle, steps) -> dict[str, Any]:
    """The deviations of every tooth, given and drawn; slope and form of measured curves are evaluated by ISO 1328-1."""
    from fenics_gears.contact.flank_gaps import deviations_of
    from fenics_gears.geometry.flank_deviations import slope_and_form

    values = {}
    for gear, found in zip(GEARS, deviations_of(errors, cycle.pair, cycle.face)):
        dimension = (f"{gear}_tooth",)
        values[f"{gear}_index_deviation"] = dimension, found.index
        slope, form = slope_and_form(found)
        values[f"{gear}_profile_slope"] = dimension, slope
        values[f"{gear}_profile_form"] = dimension, form
        if found.helix is not None:
            slope, form = slope_and_form(found.helix)
            values[f"{gear}_helix_slope"] = dimension, slope
            values[f"{gear}_helix_form"] = dimension, form
    return values


def period(errors: FlankErrors, scene) -> int:
    """Mesh cycles of whole turns of the gears whose teeth differ."""
    names, drawn = lists_of(scene), errors.tolerance_class is not None
    return lcm(*(getattr(scene.gears, gear).teeth for gear in GEARS if _differ(getattr(errors, gear), names, drawn)))


def _differ(own: GearErrors, names: Sequence[str], drawn: bool) -> bool:
    """Whether a gear's teeth are not all alike in some deviations; what is not given is `drawn`, or there is none."""
    given = [getattr(own, name) for name in names]
    measured = own.profile_curves is not None or own.helix_curves is not None
    return (
        own.waviness is not None
        or measured
        or any(drawn if values is None else len(set(values)) > 1 for values in given)
    )


EFFECT = Effect(
    section="flank_errors",
    description=(
        "pitch, profile and helix deviations and waviness of the teeth, given for each tooth or random within a flank"
        " tolerance class"
    ),
    absent="all teeth are alike and at their nominal places",
    fields=FlankErrors,
    terms=("gaps that differ from tooth to tooth, over a hunting tooth period",),
    variables=tuple(
        ResultVariable(
            f"{gear}_{name}",
            "mm",
            f"{words} of each tooth of the {gear}",
            dims=(f"{gear}_tooth",),
            over_face=name in HELIX,
        )
        for gear in GEARS
        for name, words in (
            ("index_deviation", "cumulative pitch deviation"),
            ("profile_slope", "profile slope deviation"),
            ("profile_form", "profile form deviation"),
            ("helix_slope", "helix slope deviation"),
            ("helix_form", "helix form deviation"),
        )
    ),
    write=write,
    located=located,
    files=files,
    check=check,
    rules=errors_fit_the_gears,
    gaps=gaps,
    period=period,
    results=results,
)
