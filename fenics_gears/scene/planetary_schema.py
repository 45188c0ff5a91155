"""What ``[stages.NAME]`` with ``kind = "planetary"`` has beside the fields of gears."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from fenics_gears.dynamics.shafts import HousingFile
from fenics_gears.geometry.planetary import MEMBERS, RING, SECOND_SUN, SUN
from fenics_gears.inputs.allowed import Allowed, Refused
from fenics_gears.inputs.fields import choice, declared, file_name, quantities, quantity, whole_number
from fenics_gears.inputs.problem import did_you_mean
from fenics_gears.inputs.section import Section

PLANETARY = "planetary"
SUN_MESH = "sun_mesh"
RING_MESH = "ring_mesh"
MESHES = (SUN_MESH, RING_MESH, f"{SECOND_SUN}_mesh")
STEP = "step"
GEARS_OF_SET = (SUN, "planet", STEP, RING, SECOND_SUN)
MOST_PLANETS = 10
# Effects of a pair that the meshes of a set may have of their own.
OF_THE_FACE = ("lead_modifications", "misalignment")
OF_A_MESH = ("tip_relief", "root_relief", "profile_modifications", "corner_contact", *OF_THE_FACE)
# Of the gears of the second mesh of stepped planets, where they are not as those of the first.
OF_THE_STEP = ("module", "pressure_angle", "face_width")
PIN_ERRORS = "-10 mm to 10 mm"


def second_in(content: Mapping[str, Any]) -> str:
    """Which member the scene of a set has beside the sun."""
    return SECOND_SUN if SECOND_SUN in content else RING


def gears_in(content: Mapping[str, Any]) -> tuple[str, ...]:
    """The gears that the scene of a set has."""
    return (SUN, "planet", *((STEP,) if STEP in content else ()), second_in(content))


def meshes_in(content: Mapping[str, Any]) -> tuple[str, str]:
    """The sections of the meshes that the scene of a set has."""
    return SUN_MESH, f"{second_in(content)}_mesh"


@dataclass(frozen=True, kw_only=True)
class AllowedMembers(Allowed):
    """A list of members of a set, each once."""

    names: tuple[str, ...]

    def convert(self, value: Any) -> tuple[str, ...]:
        if not isinstance(value, list) or not all(isinstance(each, str) for each in value):
            raise Refused("is no list of members.")
        for each in value:
            if each not in self.names:
                raise Refused(f'has "{each}", which is none of them.{did_you_mean(each, self.names)}')
        if len({*value}) < len(value):
            raise Refused("names a member twice.")
        return tuple(value)


@dataclass(frozen=True, kw_only=True)
class CarrierText(Section):
    """``[stages.NAME.carrier]``: the pins of the planets, and what gives way between them and the axis."""

    pin_stiffness: float | None = quantity(
        "1e-3 N/mm to 1e15 N/mm",
        "3e5 N/mm",
        meaning="stiffness of each pin and its bearing, alike in all directions",
        otherwise="pins do not give way",
    )
    stiffness: HousingFile | None = file_name(
        ".txt",
        "carrier.txt",
        meaning="text file with the stiffness matrix of the carrier between its pins, in N/mm, its hub held: over the"
        " displacements of each pin in the direction 0 of the set and 90 deg counter-clockwise of it, pin after pin; in"
        " the plane",
        otherwise="the carrier is rigid",
        made=HousingFile,
    )
    bearing_stiffness: float | None = quantity(
        "0 N/mm to 1e15 N/mm",
        "1e5 N/mm",
        meaning="stiffness that holds the carrier's centre, alike in all directions; 0 where its planets alone do; with"
        " `pin_stiffness` or `stiffness`, in the plane",
        otherwise="its centre is held",
    )
    pin_errors: tuple[float, ...] | None = quantities(
        PIN_ERRORS,
        "20 um",
        "0 um",
        meaning="by how much each pin stands beside its place along the circle of the planets, in the order of the"
        " planets; positive against the force of its planet, which then carries more",
        otherwise="0 mm",
    )
    radial_pin_errors: tuple[float, ...] | None = quantities(
        PIN_ERRORS, "20 um", "0 um", meaning="by how much each pin stands further out than its place", otherwise="0 mm"
    )


RUN_OUT = "0 mm to 10 mm"
DIRECTIONS = "-360 deg to 360 deg"
AT_THE_START = (
    "at the start: angle counter-clockwise from the direction 0 of the set, as the carrier sees it; the gear then takes"
    " it along"
)


@dataclass(frozen=True, kw_only=True)
class RunOutOfMember(Section):
    """``[stages.NAME.eccentricity.sun]`` and ``ring``: its base circle is off its axis."""

    distance: float = quantity(
        RUN_OUT, "10 um", meaning="eccentricity: distance of the base circle's centre from the axis of rotation"
    )
    phase: float = quantity(
        DIRECTIONS, "90 deg", meaning=f"direction of the base circle's centre {AT_THE_START}", default="0 deg"
    )


@dataclass(frozen=True, kw_only=True)
class RunOutOfPlanets(Section):
    """``[stages.NAME.eccentricity.planets]``: each planet's base circle is off its axis."""

    distance: tuple[float, ...] | None = quantities(
        RUN_OUT, "10 um", "0 um", meaning="eccentricity of each planet, in their order", otherwise="required"
    )
    phase: tuple[float, ...] | None = quantities(
        DIRECTIONS,
        "90 deg",
        "0 deg",
        meaning=f"direction of the base circle's centre of each planet {AT_THE_START}",
        otherwise="0 deg",
    )


@dataclass(frozen=True, kw_only=True)
class RunOutsOfSet(Section):
    """``[stages.NAME.eccentricity]``: gears of a set that run out."""

    sun: RunOutOfMember | None = None
    planets: RunOutOfPlanets | None = None
    ring: RunOutOfMember | None = None


def _pitches(of: str, more: str = "") -> Any:
    meaning = (
        f"single pitch deviations of {of}, positive where the pitch is too long; they sum to zero around a gear. Teeth"
        f" are counted as in [the flank errors](#flank_errors) of a pair, from the one that meshes first{more}"
    )
    return quantities("-10 mm to 10 mm", "3 um", "-3 um", meaning=meaning, otherwise="none", closed=True)


@dataclass(frozen=True, kw_only=True)
class PitchErrorsOfSet(Section):
    """``[stages.NAME.pitch_errors]``: deviations of each pitch of the gears of a set."""

    sun: tuple[float, ...] | None = _pitches("the sun", " with planet 1")
    planets: tuple[float, ...] | None = _pitches("the planets, one after the other", " with the sun")
    ring: tuple[float, ...] | None = _pitches("the ring", " with planet 1")


SUPPORTS = "0 N/mm to 1e15 N/mm"


@dataclass(frozen=True, kw_only=True)
class VibratingPlanet(Section):
    """``[stages.NAME.vibration.planet]``: each planet as a lumped mass on its pin."""

    mass: float = quantity("1e-9 kg to 1e9 kg", "0.66 kg", meaning="mass")
    moment_of_inertia: float = quantity(
        "1e-15 kg m^2 to 1e15 kg m^2", "1.5e-3 kg m^2", meaning="moment of inertia about its axis"
    )


@dataclass(frozen=True, kw_only=True)
class VibratingMember(VibratingPlanet):
    """``[stages.NAME.vibration.sun]``, ``ring`` and ``carrier``: a member as a lumped mass on springs."""

    support_stiffness: float | None = quantity(
        SUPPORTS,
        "1e5 N/mm",
        meaning="stiffness that holds its centre, alike in all directions",
        otherwise="its centre is held; 0 of a member that is `floating`",
    )
    torsional_stiffness: float | None = quantity(
        "0 N mm/rad to 1e18 N mm/rad",
        "1e9 N mm/rad",
        meaning="stiffness that holds its rotation",
        otherwise="the fixed member is held, others turn freely",
    )


@dataclass(frozen=True, kw_only=True)
class VibrationText(Section):
    """``[stages.NAME.vibration]``: lumped members, for the natural frequencies that `gears check` prints, and with
    `[inertia]` for the run. Pins have the `pin_stiffness` of the carrier."""

    sun: VibratingMember
    ring: VibratingMember
    carrier: VibratingMember
    planet: VibratingPlanet
    sun_mesh_stiffness: float | None = quantity(
        "1e-3 N/mm to 1e15 N/mm",
        "5e5 N/mm",
        meaning="stiffness of each mesh with the sun along the line of action",
        otherwise="that of one tooth pair, about",
    )
    ring_mesh_stiffness: float | None = quantity(
        "1e-3 N/mm to 1e15 N/mm",
        "5e5 N/mm",
        meaning="stiffness of each mesh with the ring along the line of action",
        otherwise="that of one tooth pair, about",
    )


@dataclass(frozen=True, kw_only=True)
class PlanetaryText(Section):
    """A planetary set, whose planets are alike: their places, which member is fixed, and between which the power
    goes."""

    alternatives = (("planets", "planet_angles"),)

    planets: int | None = whole_number(
        2,
        MOST_PLANETS,
        3,
        meaning="number of planets, equally spaced, the first one in direction 0",
        otherwise="`planet_angles`",
    )
    planet_angles: tuple[float, ...] | None = quantities(
        "-360 deg to 360 deg",
        "0 deg",
        "91.43 deg",
        meaning="directions of the planets from the centre, counter-clockwise; each at a multiple of 360 deg/(z_s +"
        " z_r) from the first, within a thousandth of it",
        otherwise="from `planets`",
    )
    fixed: str | None = choice(*MEMBERS, meaning="the member that does not turn", otherwise="required")
    input: str | None = choice(*MEMBERS, meaning="the member that is driven", otherwise="required")
    output: str | None = choice(*MEMBERS, meaning="the member with the load", otherwise="the third one")
    sun_hand: str | None = choice(
        "right",
        "left",
        meaning="hand of the sun's helix; planets and ring have the other",
        otherwise="`right`; has no meaning without `helix_angle`",
    )
    step_angle: float | None = quantity(
        "-360 deg to 360 deg",
        "3 deg",
        meaning="of stepped planets, how far a tooth of `step` stands from one of `planet`, counter-clockwise",
        otherwise="0 deg: two of their teeth stand in line",
    )
    floating: tuple[str, ...] | None = declared(
        AllowedMembers(
            description='a list of one of "sun", "ring" and "second_sun", such as ["sun"]',
            meaning="member whose centre nothing holds but its meshes; three planets or more centre it",
            otherwise="centres are held",
            names=(SUN, RING, SECOND_SUN),
        )
    )
    carrier: CarrierText | None = None
    eccentricity: RunOutsOfSet | None = None
    pitch_errors: PitchErrorsOfSet | None = None
    vibration: VibrationText | None = None
