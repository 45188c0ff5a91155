"""``[shafts]``: torsion of the input and the output shaft (``dynamics.drivetrain``), or shafts that also bend
(``dynamics.elastic_shaft``)."""

from dataclasses import replace
from pathlib import Path
from types import ModuleType

from fenics_gears.dynamics.shafts import HousingFile, Shaft, Shafts
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import allowed_in
from fenics_gears.inputs.tree import SHAFTS, Tree, shafts_with_sections, table

from .effect import OF_TIME, Effect, ResultVariable, variables


def shafts_are_complete(tree: Tree) -> Broken:
    """Either shaft has a stiffness, or one of them sections."""
    both = table(tree, "shafts")
    if both is None:
        return
    yield from _each_has_a_stiffness(both)
    bent = shafts_with_sections(tree)
    if "housing" in both and len(bent) < len(SHAFTS):
        message = (
            "is the housing of both shafts, which then have sections. Add them, or give that of one shaft as housing of"
            " [shafts.input] or [shafts.output]."
        )
        yield ("shafts", "housing"), message
    if bent:
        yield from _rules_of_bent().rules_of_elastic_shafts(tree)
        return
    if "torsional_stiffness" in both:
        return
    missing = [name for name in SHAFTS if name not in both]
    example = 'Allowed: such as "0.203e9 N mm/rad"'
    if len(missing) == 2:
        message = f"is missing. {example}, or one each in [shafts.input] and [shafts.output]."
        yield ("shafts", "torsional_stiffness"), message
    elif missing:
        path = ("shafts", *missing, "torsional_stiffness")
        yield path, f"is missing: only the other shaft has one. {example}, or torsional_stiffness of [shafts] for both."


def _rules_of_bent() -> ModuleType:
    """Rules of shafts that bend, which load beams and bearings."""
    from . import elastic_shaft_rules

    return elastic_shaft_rules


def _each_has_a_stiffness(both: Tree) -> Broken:
    for shaft in SHAFTS:
        own = table(both, shaft)
        if own is None or "sections" in own:
            continue
        if "torsional_stiffness" not in own:
            allowed = allowed_in(Shaft, "torsional_stiffness").description
            yield ("shafts", shaft, "torsional_stiffness"), f"is missing. Allowed: {allowed}; or sections."
        for name in ("gear_at", "torque_at", "seat", "material", "housing"):
            if name in own:
                message = "has no effect: it is of a shaft with sections. Add sections, or leave it out."
                yield ("shafts", shaft, name), message


def located(shafts: Shafts, directory: Path) -> Shafts:
    if not _housings(shafts):
        return shafts
    from .elastic_shaft_housing import located_housing

    own = {name: located_housing(each, directory) for name in SHAFTS if (each := getattr(shafts, name)) is not None}
    return replace(located_housing(shafts, directory), **own)


def _housings(shafts: Shafts) -> list[HousingFile]:
    both = (each for each in (shafts, shafts.input, shafts.output) if each is not None)
    return [each.housing for each in both if each.housing is not None]


def files(shafts: Shafts) -> dict[str, str]:
    return {each.path: each.digest for each in _housings(shafts)}


def check(shafts: Shafts, scene, pair) -> None:
    """Raise SceneError where gears, couplings and bearings do not fit their shafts."""
    if shafts.sections is not None:
        _rules_of_bent().check_shafts(scene, pair)


def warnings(shafts: Shafts, model) -> list[str]:
    return [] if shafts.sections is None else _rules_of_bent().shaft_warnings(model.scene, model.pair)


EFFECT = Effect(
    section="shafts",
    description="elastic torsion of the input and the output shaft, or shafts that also bend",
    absent="the prescribed rotation acts on the pinion and the load torque on the wheel directly",
    fields=Shafts,
    unknowns=("rotation of the pinion", "rotation of the far end of the output shaft"),
    terms=("torsional springs; of shafts with sections also springs of bending and stretching",),
    variables=(
        ResultVariable("shaft_end_rotation", "rad", "rotation of the far end of the output shaft"),
        ResultVariable("energy_shafts", "N mm", "elastic energy of the shafts"),
        # Departures of the axes have the signs of [misalignment] and, like it, are lengths over the common face.
        *variables(
            OF_TIME,
            field="sections",
            axis_inclination_in_plane=("um", "misalignment by the load in the plane of action, over the common face"),
            axis_inclination_out_of_plane=(
                "um",
                "misalignment by the load out of the plane of action, over the common face",
            ),
            axis_offset_in_plane=("um", "distance that the load adds between the axes along the line of action"),
            axis_offset_out_of_plane=(
                "um",
                "displacement of the wheel's axis against the pinion's off the line of action",
            ),
        ),
        *variables(
            ("time", "bearing"),
            field="sections",
            bearing_force_x=("N", "force of the shaft on its bearing along the line of action"),
            bearing_force_y=("N", "force of the shaft on its bearing off the line of action"),
            bearing_force_z=("N", "axial force of the shaft on its bearing"),
            bearing_moment_x=("N mm", "moment of the shaft on its bearing about the line of action"),
            bearing_moment_y=("N mm", "moment of the shaft on its bearing about the direction off the line of action"),
        ),
        *variables(
            ("contact_time", "gear", "shaft_point"),
            field="sections",
            shaft_deflection_x=("mm", "displacement of the shaft's axis along the line of action"),
            shaft_deflection_y=("mm", "displacement of the shaft's axis off the line of action"),
        ),
    ),
    rules=shafts_are_complete,
    located=located,
    files=files,
    check=check,
    warnings=warnings,
)
