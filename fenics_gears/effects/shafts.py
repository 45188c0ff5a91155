"""``[shafts]``: torsion of the input and the output shaft (``dynamics.drivetrain``), or shafts that also bend
(``dynamics.elastic_shaft``)."""

from dataclasses import dataclass, replace
from pathlib import Path

from fenics_gears.geometry.gear_data import MATERIALS, Material
from fenics_gears.inputs.allowed import Matrix
from fenics_gears.inputs.fields import choice, declared, file_name, quantity
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import AllowedTables, Section, allowed_in
from fenics_gears.inputs.tree import SHAFTS, Tree, shafts_with_sections, table

from .effect import OF_TIME, Effect, ResultVariable, own_or_shared, variables
from .tooth_elasticity import material_name, poissons_ratio, youngs_modulus

MOST_SECTIONS = 100
RIGID_SEAT = "rigid over its width"
PRESS_FIT = "press fit"
INTEGRAL = "integral"


def _stiffness(meaning: str, otherwise: str = ""):
    return quantity("1e-6 N mm/rad to 1e24 N mm/rad", "0.203e9 N mm/rad", meaning=meaning, otherwise=otherwise)


def _length(example: str, meaning: str, **otherwise: str):
    return quantity("0 mm to 100 m", example, meaning=meaning, **otherwise)


def _size(example: str, meaning: str, otherwise: str = ""):
    return quantity("0.1 mm to 100 m", example, meaning=meaning, otherwise=otherwise)


@dataclass(frozen=True)
class ShaftSection(Section):
    """A part of a shaft between two steps, a cylinder or a cone, with a bore."""

    length: float = _size("32 mm", "length along the axis")
    diameter: float = _size("28 mm", "outer diameter; of a cone that of its left end")
    end_diameter: float | None = _size("35 mm", "diameter of a cone's right end", "a cylinder")
    bore: float = _length("8 mm", "diameter of the bore", default="0 mm")

    @property
    def tapered(self) -> bool:
        return self.right_diameter != self.diameter

    @property
    def right_diameter(self) -> float:
        """Outer diameter of the right end, mm."""
        return self.diameter if self.end_diameter is None else self.end_diameter


_SECTIONS = AllowedTables(
    description="a list of sections, each with a length, a diameter and, if any, a bore and the end_diameter of a cone,"
    ' such as [{ length = "32 mm", diameter = "28 mm", bore = "8 mm" }, { length = "60 mm", diameter = "35 mm" }]',
    section=ShaftSection,
    singular="section",
    empty="For a rigid shaft, leave it out.",
    most=MOST_SECTIONS,
    meaning="parts of the shaft from left to right, the right end being that from which a driving pinion is seen to"
    " turn counter-clockwise: it then bends, twists and stretches on bearings of its own, `[[bearings.pinion]]` or"
    " `[[bearings.wheel]]`",
    otherwise="only `torsional_stiffness` gives way",
)


@dataclass(frozen=True)
class ShaftMaterial(Section):
    """``[shafts.input.material]`` and ``[shafts.output.material]``; what is left out is that of the gear."""

    name: str | None = material_name("the gear's")
    youngs_modulus: float | None = youngs_modulus("that of the `name`, or the gear's")
    poissons_ratio: float | None = poissons_ratio("that of the `name`, or the gear's")
    density: float | None = quantity(
        "1e-6 g/cm^3 to 1e6 g/cm^3",
        "7.85 g/cm^3",
        meaning="density, from which beside `[inertia]` the shaft's own mass follows",
        otherwise="that of the gear in `[inertia]`",
    )

    def constants(self, gear: Material) -> tuple[float, float]:
        """Young's modulus, N/mm^2, and Poisson's ratio of the shaft of a gear that is made of something."""
        named = gear if self.name is None else MATERIALS[self.name][0]
        modulus = named.youngs_modulus if self.youngs_modulus is None else self.youngs_modulus
        return modulus, named.poissons_ratio if self.poissons_ratio is None else self.poissons_ratio


@dataclass(frozen=True)
class HousingFile:
    """A file with the stiffness of a housing, a hash of what it says, and the matrix, or the `problem` with it."""

    path: str
    digest: str = ""
    stiffness: Matrix | None = None
    problem: str = ""


def _housing(seats: str, otherwise: str):
    return file_name(
        ".txt",
        "housing.txt",
        meaning=f"text file with the stiffness matrix of the housing between the seats of {seats}",
        otherwise=otherwise,
        made=HousingFile,
    )


@dataclass(frozen=True)
class Shaft(Section):
    """``[shafts.input]`` and ``[shafts.output]``: the shaft between the prescribed rotation and the pinion, and that
    between wheel and load. A shaft of `sections` is a Timoshenko beam; one that has nothing beside it is rigid."""

    alternatives = (("torsional_stiffness", "sections"),)

    torsional_stiffness: float | None = _stiffness("torsional stiffness of this shaft", "it follows from `sections`")
    sections: tuple[ShaftSection, ...] | None = declared(_SECTIONS)
    gear_at: float | None = _length(
        "58 mm", "middle of the gear's face, from the left end", otherwise="required with `sections`"
    )
    torque_at: float | None = _length(
        "0 mm", "where the motor or the load is coupled, from the left end", otherwise="required with `sections`"
    )
    seat: str | None = choice(
        RIGID_SEAT,
        PRESS_FIT,
        INTEGRAL,
        meaning="how the gear sits: the shaft does not give way within the gear's face width; or shaft and hub hold"
        " each other without slip, as one piece, and give way together; or the teeth are cut into the shaft, which"
        " bends and twists there as a cylinder of the root diameter",
        default=RIGID_SEAT,
    )
    material: ShaftMaterial = ShaftMaterial()
    housing: HousingFile | None = _housing(
        "this shaft's bearings, in N, mm and rad, a row on each line: six motions of each seat in the order of the"
        " bearings, displacements along x (the line of action), y and z (the axis) and rotations about them; lines that"
        " begin with #, %, ! or * are passed over",
        "the housing is rigid, or that of `[shafts]`",
    )


@dataclass(frozen=True)
class Shafts(Section):
    """``[shafts]``."""

    torsional_stiffness: float | None = _stiffness(
        "torsional stiffness of each of the two shafts", "each shaft has its own"
    )
    input: Shaft | None = None
    output: Shaft | None = None
    housing: HousingFile | None = _housing(
        "all bearings of both shafts, which it ties together: first those of `[[bearings.pinion]]`, then those of"
        " `[[bearings.wheel]]`; otherwise as that of a shaft",
        "each shaft has its own, if any",
    )

    def of(self, shaft: str) -> float | None:
        """Torsional stiffness (N mm/rad) of the "input" or the "output" shaft; None where it has sections or is
        rigid."""
        return own_or_shared(getattr(self, shaft), self, "torsional_stiffness")

    @property
    def sections(self) -> dict[str, Shaft] | None:
        """The shafts that have sections, by the gears on them; None where there are none."""
        both = zip(("pinion", "wheel"), (self.input, self.output))
        return {gear: each for gear, each in both if each is not None and each.sections is not None} or None


def shafts_are_complete(tree: Tree) -> Broken:
    """Either shaft has a stiffness, or one of them sections."""
    both = table(tree, "shafts")
    if both is None:
        return
    yield from _each_gives_way(both)
    bent = shafts_with_sections(tree)
    if "housing" in both and len(bent) < len(SHAFTS):
        message = (
            "is the housing of both shafts, which then have sections. Add them, or give that of one shaft as housing of"
            " [shafts.input] or [shafts.output]."
        )
        yield ("shafts", "housing"), message
    if bent:
        from .elastic_shaft_rules import rules_of_elastic_shafts

        yield from rules_of_elastic_shafts(tree)
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


def _each_gives_way(both: Tree) -> Broken:
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
    from .elastic_shaft_housing import found

    own = {name: found(each, directory) for name in SHAFTS if (each := getattr(shafts, name)) is not None}
    return replace(found(shafts, directory), **own)


def _housings(shafts: Shafts) -> list[HousingFile]:
    both = (each for each in (shafts, shafts.input, shafts.output) if each is not None)
    return [each.housing for each in both if each.housing is not None]


def files(shafts: Shafts) -> dict[str, str]:
    return {each.path: each.digest for each in _housings(shafts)}


def check(shafts: Shafts, scene, pair) -> None:
    """Raise SceneError where gears, couplings and bearings do not fit their shafts."""
    if shafts.sections is not None:
        from .elastic_shaft_rules import check_shafts

        check_shafts(scene, pair)


def warnings(shafts: Shafts, model) -> list[str]:
    if shafts.sections is None:
        return []
    from .elastic_shaft_rules import shaft_warnings

    return shaft_warnings(model.scene, model.pair)


EFFECT = Effect(
    section="shafts",
    description="elastic torsion of the input and the output shaft, or shafts that also bend",
    absent="the prescribed rotation acts on the pinion and the load torque on the wheel directly",
    fields=Shafts,
    unknowns=("rotation of the pinion", "rotation of the far end of the output shaft"),
    terms=("torsional springs; of shafts with sections also those of bending and stretching",),
    variables=(
        ResultVariable("shaft_end_rotation", "rad", "rotation of the far end of the output shaft"),
        ResultVariable("energy_shafts", "N mm", "elastic energy of the shafts"),
        # Departures of the axes are those of [misalignment], and as large over the common face.
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
