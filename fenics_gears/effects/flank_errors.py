"""``[flank_errors]``: pitch, profile, helix and waviness deviations of single teeth (``geometry.flank_deviations``,
``contact.flank_gaps``).

Signs follow ISO 1328-1. A pitch deviation is positive where the pitch is too long. A profile slope is positive where
the flank has material in excess towards the tip. A profile form, which has no sign in the standard, is positive where
the middle of the flank has material in excess. Those of the helix are the like along the face, positive towards the
right end, whatever the hand. Teeth are counted in the order in which they mesh, from the tooth of either gear that
meshes first; a pitch is that from the tooth before.
"""

from math import lcm
from typing import Any

from fenics_gears.contact.flank_gaps import check_waves, deviations_of, flank_gaps
from fenics_gears.geometry.flank_deviations import slope_and_form
from fenics_gears.geometry.flank_errors import HELIX, FlankErrors, GearErrors, lists_of
from fenics_gears.inputs.section import tree_of
from fenics_gears.inputs.tree import GEARS

from .effect import Effect, ResultVariable
from .flank_errors_rules import errors_fit_the_gears
from .flank_errors_tables import check, files, located


def write(errors: FlankErrors) -> dict:
    section = tree_of(errors)
    for gear in GEARS:
        for column in getattr(errors, gear).columns:
            section[gear].pop(column, None)
    return section


def gaps(errors: FlankErrors, model):
    return flank_gaps(errors, model.pair, model.resolution.steps_per_mesh_cycle, model.face)


def fits(errors: FlankErrors, model) -> None:
    check_waves(errors, model.pair, model.resolution.steps_per_mesh_cycle)


def results(errors: FlankErrors, scene, cycle, steps) -> dict[str, Any]:
    """The deviations of every tooth, given and drawn; slope and form of measured curves are evaluated by ISO 1328-1."""
    values = {}
    for gear, deviations in zip(GEARS, deviations_of(errors, cycle.pair, cycle.face)):
        dimension = (f"{gear}_tooth",)
        values[f"{gear}_index_deviation"] = dimension, deviations.index
        for kind, errors_of_kind in (("profile", deviations), ("helix", deviations.helix)):
            if errors_of_kind is not None:
                slope, form = slope_and_form(errors_of_kind)
                values |= {f"{gear}_{kind}_slope": (dimension, slope), f"{gear}_{kind}_form": (dimension, form)}
    return values


def period(errors: FlankErrors, scene) -> int:
    """Mesh cycles of whole turns of the gears whose teeth differ."""
    return lcm(*(getattr(scene.gears, gear).teeth for gear in GEARS if teeth_differ(errors, scene, gear)))


def teeth_differ(errors: FlankErrors, scene, gear: str) -> bool:
    """Whether a gear's teeth are not all alike in some deviations; what is not given is drawn, or there is none."""
    own: GearErrors = getattr(errors, gear)
    names = lists_of(scene)
    drawn = errors.tolerance_class is not None
    if any(each is not None for each in (own.waviness, own.profile_curves, own.helix_curves)):
        return True
    return any(drawn if (given := getattr(own, name)) is None else len(set(given)) > 1 for name in names)


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
            f"{gear}_{name}", "mm", f"{words} of each tooth of the {gear}", "", (f"{gear}_tooth",), "", name in HELIX
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
    fits=fits,
    gaps=gaps,
    period=period,
    results=results,
)
