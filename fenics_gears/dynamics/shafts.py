"""Shafts: their torsional stiffness, or their sections, of which they bend, twist and stretch."""

from dataclasses import dataclass, field

from fenics_gears.geometry.gear_data import MATERIALS, Material, material_name, poissons_ratio, youngs_modulus
from fenics_gears.inputs.allowed import Matrix
from fenics_gears.inputs.fields import choice, declared, file_name, quantity
from fenics_gears.inputs.section import AllowedTables, Section, own_or_shared
from fenics_gears.inputs.tree import GEARS

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
    """A file with the stiffness of a housing, or of a carrier, a hash of what it says, and the matrix, or the `problem`
    with it."""

    path: str
    digest: str = ""
    stiffness: Matrix | None = None
    problem: str = ""


def housing_file(seats: str, otherwise: str):
    """A field that names the file of a housing."""
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
    housing: HousingFile | None = housing_file(
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
    housing: HousingFile | None = housing_file(
        "all bearings of both shafts, which it ties together: first those of `[[bearings.pinion]]`, then those of"
        " `[[bearings.wheel]]`, in the form of that of one shaft",
        "each shaft has its own, if any",
    )
    # Of a pair in a train, whose gears share shafts with those of other pairs; not of scenes.
    in_train: bool = field(default=False, compare=False)

    def of(self, shaft: str) -> float | None:
        """Torsional stiffness (N mm/rad) of the "input" or the "output" shaft; None where it has sections or is
        rigid."""
        return own_or_shared(getattr(self, shaft), self, "torsional_stiffness")

    @property
    def sections(self) -> dict[str, Shaft] | None:
        """The shafts that have sections, by the gears on them; None where there are none."""
        both = zip(GEARS, (self.input, self.output))
        return {gear: each for gear, each in both if each is not None and each.sections is not None} or None

    @property
    def of_pair(self) -> dict[str, Shaft] | None:
        """The same where they are the pair's alone."""
        return None if self.in_train else self.sections
