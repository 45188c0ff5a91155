"""What holds gears and shafts: stiffness at the gears' centres, or bearings along a shaft."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fenics_gears.inputs.allowed import AllowedMatrix, Matrix
from fenics_gears.inputs.fields import choice, declared, number, quantities, quantity, whole_number
from fenics_gears.inputs.section import AllowedTables, Section, names_in, own_or_shared
from fenics_gears.inputs.tree import GEARS

BALLS = "balls"
ROLLERS = "rollers"
OF_ROLLERS = ("length",)
OF_BALLS = ("inner_groove", "outer_groove")
# Radii of grooves over the ball's diameter to which ISO 281 and ISO/TS 16281 refer.
INNER_GROOVE = 0.52
OUTER_GROOVE = 0.53
MOST_BEARINGS = 20


def _stiffness(meaning: str, otherwise: str):
    return quantity("1e-6 N/mm to 1e20 N/mm", "0.155e6 N/mm", meaning=meaning, otherwise=otherwise)


def _places(gear: str):
    meaning = (
        f"where the {gear}'s two bearings are, from its mid-width, positive towards the right end, from which a driving"
        " pinion is seen to turn counter-clockwise"
    )
    return quantities(
        "-10 m to 10 m", "-40 mm", "60 mm", meaning=meaning, otherwise=f"the {gear} does not tilt", count=2
    )


def _size(example: str, meaning: str, limits: str = "0.1 mm to 10 m", **otherwise: str):
    return quantity(limits, example, meaning=meaning, **otherwise)


def _groove(meaning: str, otherwise: float):
    return number(
        otherwise, above=0.5, highest=1.0, meaning=f"radius of the {meaning} over the ball's diameter",
        otherwise=f"{otherwise:g}",
    )  # fmt: skip


@dataclass(frozen=True)
class RollingBearing(Section):
    """One row of balls or rollers between two rings."""

    number: int = whole_number(3, 500, 9, meaning="how many of them")
    diameter: float = _size("12.7 mm", "their diameter, of tapered rollers in the middle")
    pitch_diameter: float = _size("65 mm", "diameter of the circle through their middles")
    elements: str = choice(BALLS, ROLLERS, meaning="what rolls", default=BALLS)
    length: float | None = _size("14 mm", "effective length of a roller", otherwise="required of rollers")
    contact_angle: float = quantity(
        "-80 deg to 80 deg",
        "15 deg",
        meaning="nominal contact angle; positive where the bearing holds the shaft against moving to the right",
        default="0 deg",
    )
    clearance: float = _size(
        "10 um", "radial clearance in operation, negative for an interference", "-1 mm to 1 mm", default="0 mm"
    )
    preload: float = quantity(
        "0 N to 1e9 N",
        "200 N",
        meaning="axial force by which bearings with contact angles brace each other",
        default="0 N",
    )
    inner_groove: float | None = _groove("inner ring's groove", INNER_GROOVE)
    outer_groove: float | None = _groove("outer ring's groove", OUTER_GROOVE)

    @property
    def rollers(self) -> bool:
        return self.elements == ROLLERS

    @property
    def grooves(self) -> tuple[float, float]:
        return self.diameter * (self.inner_groove or INNER_GROOVE), self.diameter * (self.outer_groove or OUTER_GROOVE)

    @property
    def bracing(self) -> float:
        """Axial force, N, of the shaft on the bearing by its preload: positive towards the right."""
        return self.preload if self.contact_angle > 0.0 else -self.preload


@dataclass(frozen=True)
class Bearing(Section):
    """A bearing of a shaft with sections: stiff across the axis, along it and against tilting, by a matrix, or as its
    rolling elements make it."""

    at: float = quantity("0 mm to 100 m", "12 mm", meaning="its place, from the left end of the shaft")
    radial_stiffness: float | None = quantity(
        "1e-6 N/mm to 1e15 N/mm", "0.3e6 N/mm", meaning="across the axis", otherwise="`stiffness_matrix` or `rolling`"
    )
    axial_stiffness: float = quantity("0 N/mm to 1e15 N/mm", "0.1e6 N/mm", meaning="along the axis", default="0 N/mm")
    tilting_stiffness: float = quantity(
        "0 N mm/rad to 1e24 N mm/rad", "1e8 N mm/rad", meaning="against tilting", default="0 N mm/rad"
    )
    stiffness_matrix: Matrix | None = declared(
        AllowedMatrix(
            description="five rows of five bare numbers in N, mm and rad, symmetric and not negative",
            size=5,
            meaning="stiffness over x along and y off the line of action, z along the axis, and tilts about x and y, in"
            " place of the other stiffnesses",
            otherwise="from the other stiffnesses",
        )
    )
    rolling: RollingBearing | None = None
    # The stiffness of a rolling bearing under the load of its shaft; not of scenes.
    worked: Matrix | None = None

    @property
    def matrix(self) -> Matrix:
        """Stiffness over x along and y off the line of action, z along the axis, and tilts about x and y; of a rolling
        bearing without load that with all of its rolling elements pressed alike."""
        if self.stiffness_matrix is not None:
            return self.stiffness_matrix
        if self.rolling is not None:
            from .rolling_bearing import nominal_stiffness

            return self.worked or self.with_axial(nominal_stiffness(self.rolling))
        radial = self.radial_stiffness or 0.0
        tilting = self.tilting_stiffness
        diagonal = (radial, radial, self.axial_stiffness, tilting, tilting)
        return tuple(tuple(each if row == column else 0.0 for column in range(5)) for row, each in enumerate(diagonal))

    def with_axial(self, stiffness) -> Matrix:
        """A stiffness (5, 5) of rolling elements, and the axial one beside it."""
        return tuple(
            tuple(float(each) + self.axial_stiffness * (row == column == 2) for column, each in enumerate(of_row))
            for row, of_row in enumerate(stiffness)
        )


_EACH = AllowedTables(
    description='a list of bearings, such as [{ at = "12 mm", radial_stiffness = "0.3e6 N/mm" }], each with the fields'
    f" {', '.join(names_in(Bearing))}",
    section=Bearing,
    singular="bearing",
    empty="For a centre that is fixed, leave it out.",
    most=MOST_BEARINGS,
    meaning="bearings of a shaft with sections, also written as tables `[[bearings.pinion]]`: `at`, and how stiff the"
    " bearing is: `radial_stiffness`, with `axial_stiffness` and `tilting_stiffness` if any, or a `stiffness_matrix`,"
    " or `rolling`",
    otherwise="the stiffness is that of the gear's centre",
)


@dataclass(frozen=True)
class Stiffnesses(Section):
    """What holds a gear's centre."""

    stiffness: float | None = _stiffness(
        "stiffness in all directions across the axis", "from `stiffness_x` and `stiffness_y`"
    )
    stiffness_x: float | None = _stiffness("stiffness along the line of action", "`stiffness`")
    stiffness_y: float | None = _stiffness("stiffness off the line of action", "`stiffness`")
    axial_stiffness: float | None = _stiffness(
        "stiffness of the whole shaft along its axis, only of a gear whose bearings have `places`",
        "the shaft is held axially",
    )

    def along(self, direction: str) -> float | None:
        """Stiffness (N/mm) in "x" or "y"; None where it is not given."""
        own = {"x": self.stiffness_x, "y": self.stiffness_y}[direction]
        return self.stiffness if own is None else own


@dataclass(frozen=True)
class Support(Stiffnesses):
    """``[bearings.pinion]`` and ``[bearings.wheel]``; fields that are left out are those of ``[bearings]``, and the
    defaults hold if that section leaves them out too."""

    each: tuple[Bearing, ...] | None = declared(_EACH)


@dataclass(frozen=True)
class BearingPlaces(Section):
    """``[bearings.places]``: where the bearings stand along the shafts, each of them with half of the stiffness. The
    shafts are rigid, and the gears tilt on them."""

    empty = 'is empty. Allowed: the places of the bearings of either shaft, such as pinion = ["-40 mm", "60 mm"].'

    pinion: tuple[float, ...] | None = _places("pinion")
    wheel: tuple[float, ...] | None = _places("wheel")


@dataclass(frozen=True)
class Bearings(Stiffnesses):
    """``[bearings]``: stiffness of the support of each gear, the same in all directions or separate along (x) and off
    (y) the line of action.

    Without ``places`` a gear does not tilt and stays where it is along its axis. With them its two bearings have half
    of that stiffness each.
    """

    pinion: Support | None = None
    wheel: Support | None = None
    places: BearingPlaces | None = None

    def of(self, gear: str, direction: str) -> float | None:
        """Stiffness (N/mm) of the "pinion"'s or the "wheel"'s support in "x" or "y"; None where it has none, or
        bearings of its own."""
        own = getattr(self, gear)
        stiffness = None if own is None else own.along(direction)
        return self.along(direction) if stiffness is None else stiffness

    def axial(self, gear: str) -> float | None:
        """Axial stiffness (N/mm) of the "pinion"'s or the "wheel"'s shaft; None where it is held."""
        return own_or_shared(getattr(self, gear), self, "axial_stiffness")

    @property
    def held_axially(self) -> Bearings:
        """The same without axial stiffness: either shaft is held."""
        own = {gear: replace(each, axial_stiffness=None) for gear in GEARS if (each := getattr(self, gear)) is not None}
        return replace(self, axial_stiffness=None, **own)

    @property
    def each(self) -> tuple[Bearing, ...] | None:
        """The bearings of both shafts with sections; None where there are none."""
        return tuple(bearing for gear in GEARS for bearing in self.each_of(gear)) or None

    def each_of(self, gear: str) -> tuple[Bearing, ...]:
        """The bearings of the shaft with sections that the "pinion" or the "wheel" is on."""
        own = getattr(self, gear)
        return () if own is None or own.each is None else own.each

    def places_of(self, gear: str) -> tuple[float, ...] | None:
        """Places (2,), mm, of the bearings of the "pinion"'s or the "wheel"'s shaft; None where that gear does not
        tilt."""
        return getattr(self.places, gear, None)
