"""A pinion and a wheel on their centres: the line of action and the points on it.

Positions on the line of action are distances ``xi`` (mm) from T1, where it leaves the pinion's base circle. The pinion
drives: contact runs from the wheel's tip (path_start) to the pinion's tip (path_end), unless the mate is cut away
there. An internal wheel has negative numbers, and so have centre distance and T1 to T2 (ISO 21771).
"""

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from math import acos, copysign, cos, exp, floor, pi, sin, sqrt, tan

from fenics_gears.errors import GeometryError
from fenics_gears.inputs.tree import GEARS

from .gear import Gear, transverse_gear
from .gear_checks import Impossible, check_gear
from .gear_data import GearPairData, Helix
from .involute import inverse_involute, involute_function
from .pair_checks import check_pair
from .side import Side

WHOLE_CONTACT_RATIO_ROUNDING = 1e-9
# Reach, in normal modules, into a face that extends beyond the mate: of teeth on a thin rim, the addition for a solid
# body, and the depth over which it grows. Fitted to runs in three dimensions (docs/third_dimension.md).
REACH_OF_TEETH = 1.1
REACH_OF_BODY = 1.6
DEPTH_OF_BODY = 7.0


@dataclass(frozen=True)
class GearPair:
    """Two gears in mesh, in their transverse section; lengths in mm, angles in rad. Built and checked by ``gear_pair``.

    `face_width`: over which they meet; `own_face_widths`: None where both gears have that width. `helix`: None for spur
    gears; `axial_offsets`: mid-widths of pinion and wheel along the axis, from a common place.
    """

    pinion: Gear
    wheel: Gear
    centre_distance: float
    face_width: float
    own_face_widths: tuple[float, float] | None = None
    helix: Helix | None = None
    axial_offsets: tuple[float, float] = (0.0, 0.0)

    @property
    def gears(self) -> tuple[Gear, Gear]:
        """Both gears, the driving one first: the order of everything that has a part for each."""
        return self.pinion, self.wheel

    @property
    def teeth(self) -> tuple[int, int]:
        """Numbers of teeth of both gears; negative of an internal one."""
        return self.pinion.teeth, self.wheel.teeth

    @cached_property
    def sides(self) -> tuple[Side, Side]:
        """Both gears as sides of the mesh."""
        return Side(0, 1, self.pinion, 0.0), Side(1, -1, self.wheel, self.line_of_action_length)

    @cached_property
    def base_radii(self) -> tuple[float, float]:
        """Base radii (mm) of pinion and wheel."""
        return self.pinion.base_radius, self.wheel.base_radius

    @property
    def face_widths(self) -> tuple[float, float]:
        """Width (mm) of the pinion and of the wheel."""
        return self.own_face_widths or (self.face_width, self.face_width)

    @property
    def common_face(self) -> tuple[float, float]:
        """Ends z (mm) of the common face, left and right; 0 is its middle."""
        return -0.5 * self.face_width, 0.5 * self.face_width

    @property
    def gear_middles(self) -> tuple[float, float]:
        """Places z (mm) of the mid-widths of pinion and wheel, from the middle of the common face."""
        ends = [
            (offset - 0.5 * width, offset + 0.5 * width) for offset, width in zip(self.axial_offsets, self.face_widths)
        ]
        middle = 0.5 * (max(low for low, _ in ends) + min(high for _, high in ends))
        return self.axial_offsets[0] - middle, self.axial_offsets[1] - middle

    @property
    def overhangs(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Overhang (mm) of pinion and wheel beyond the common face, at its left and its right end."""
        low, high = self.common_face
        pinion, wheel = (
            (max(low - middle + 0.5 * width, 0.0), max(middle + 0.5 * width - high, 0.0))
            for middle, width in zip(self.gear_middles, self.face_widths)
        )
        return pinion, wheel

    @property
    def effective_face_widths(self) -> tuple[float, float]:
        """Width (mm) of pinion and wheel that counts in the plane. It is the common width and, of an overhang o at
        either end, the part r (1 - exp(-o/r)) that helps to carry. The reach r grows with the depth of the gear's body.
        """
        module = self.pinion.normal_module
        widths = []
        for gear, overhangs in zip(self.gears, self.overhangs):
            reach = module * (REACH_OF_TEETH + REACH_OF_BODY * (1.0 - exp(-gear.body_depth / (DEPTH_OF_BODY * module))))
            widths.append(self.face_width + sum(reach * (1.0 - exp(-each / reach)) for each in overhangs))
        return widths[0], widths[1]

    @cached_property
    def slope(self) -> float:
        """tau = d xi/dz of a contact line: tan(base helix angle), negative for a left-hand pinion, 0 for spur gears.

        The section at z is the middle one turned by tau z/rb1 (pinion) and -tau z/rb2 (wheel).
        """
        return 0.0 if self.helix is None else self.helix.sign * tan(self.helix.angle) * cos(self.pinion.pressure_angle)

    @cached_property
    def cosine(self) -> float:
        """Cosine of the base helix angle; the contact normal is (cosine, 0, -cosine slope)."""
        return 1.0 / sqrt(1.0 + self.slope**2)

    @property
    def overlap_ratio(self) -> float:
        """Common face width in axial pitches: b sin(beta)/(pi m_n) (ISO 21771); 0 for spur gears."""
        return 0.0 if self.helix is None else self.face_width * sin(self.helix.angle) / (pi * self.pinion.normal_module)

    @property
    def total_contact_ratio(self) -> float:
        """Transverse contact ratio plus overlap ratio."""
        return self.contact_ratio + self.overlap_ratio

    @property
    def rotation_ratio(self) -> float:
        """Teeth of the pinion over teeth of the wheel."""
        return self.pinion.teeth / self.wheel.teeth

    def force_of(self, torque: float) -> float:
        """Force (N) along the line of action that carries a torque (N mm) on the wheel, whichever way it acts."""
        return abs(torque / self.wheel.base_radius)

    @cached_property
    def base_pitch(self) -> float:
        """Distance (mm) between neighbouring tooth pairs along the line of action."""
        return self.pinion.base_pitch

    @cached_property
    def operating_pressure_angle(self) -> float:
        """Angle (rad) between the line of action and the perpendicular to the line of centres."""
        return acos(sum(self.base_radii) / self.centre_distance)

    @cached_property
    def line_of_action_length(self) -> float:
        """Distance (mm) from T1 to T2, where the line of action touches the base circles."""
        return copysign(sqrt(self.centre_distance**2 - sum(self.base_radii) ** 2), self.centre_distance)

    @property
    def pitch_point(self) -> float:
        """Position (mm) of the pitch point on the line of action."""
        return self.pinion.base_radius * tan(self.operating_pressure_angle)

    @property
    def pitch_point_to_wheel_tangent(self) -> float:
        """Distance (mm) from T2 to the pitch point, ``e`` of the paper."""
        return self.line_of_action_length - self.pitch_point

    @property
    def tip_positions(self) -> tuple[float, float]:
        """Positions (mm) where the wheel's tip and the pinion's tip cross the line of action."""
        pinion, wheel = self.sides
        return wheel.position(self.wheel.tip_roll_angle), pinion.position(self.pinion.tip_roll_angle)

    @cached_property
    def path_start(self) -> float:
        """Position (mm) where contact begins: at the wheel's tip, or later, at an undercut pinion's form circle."""
        tip = self.tip_positions[0]
        pinion = self.pinion
        return max(tip, pinion.base_radius * pinion.form_roll_angle) if pinion.undercut else tip

    @cached_property
    def path_end(self) -> float:
        """Position (mm) where contact ends: at the pinion's tip, or earlier, at an undercut wheel's form circle."""
        tip = self.tip_positions[1]
        wheel = self.sides[1]
        return min(tip, wheel.position(self.wheel.form_roll_angle)) if self.wheel.undercut else tip

    @cached_property
    def contact_ratio(self) -> float:
        """Length of the path of contact in transverse base pitches: the transverse contact ratio."""
        return (self.path_end - self.path_start) / self.base_pitch

    @property
    def fewest_pairs(self) -> int:
        """Smallest number of tooth pairs that rigid gears have in contact: 1 below a contact ratio of 2."""
        return floor(self.contact_ratio + WHOLE_CONTACT_RATIO_ROUNDING)

    @property
    def hpstc(self) -> float:
        """Position (mm) of the pinion's highest point of single tooth contact, the wheel's lowest; with a contact ratio
        above 2, where contact by the fewest pairs ends."""
        return self.path_start + self.fewest_pairs * self.base_pitch

    @property
    def lpstc(self) -> float:
        """Position (mm) of the pinion's lowest point of single tooth contact, the wheel's highest; see `hpstc`."""
        return self.path_end - self.fewest_pairs * self.base_pitch

    def pinion_roll_angle(self, position):
        """Roll angle (rad) of the pinion's contact point at positions (mm, any shape) on the line of action."""
        return position / self.pinion.base_radius

    def wheel_roll_angle(self, position):
        """Roll angle (rad) of the wheel's contact point at positions (mm, any shape) on the line of action."""
        return (self.line_of_action_length - position) / self.wheel.base_radius

    @property
    def hpstc_roll_angles(self) -> tuple[float, float]:
        """Roll angles (rad) of pinion and wheel at their highest points of single tooth contact."""
        return self.pinion_roll_angle(self.hpstc), self.wheel_roll_angle(self.lpstc)

    @property
    def lpstc_roll_angles(self) -> tuple[float, float]:
        """Roll angles (rad) of pinion and wheel at their lowest points of single tooth contact."""
        return self.pinion_roll_angle(self.lpstc), self.wheel_roll_angle(self.hpstc)

    @property
    def sap_roll_angles(self) -> tuple[float, float]:
        """Roll angles (rad) of pinion and wheel at their starts of active profile."""
        return self.pinion_roll_angle(self.path_start), self.wheel_roll_angle(self.path_end)

    @property
    def eap_roll_angles(self) -> tuple[float, float]:
        """Roll angles (rad) of pinion and wheel at their ends of active profile."""
        return self.pinion_roll_angle(self.path_end), self.wheel_roll_angle(self.path_start)

    @property
    def backlash(self) -> float:
        """Gap (mm) along the line of action between the coast flanks while the drive flanks touch; negative when teeth
        overlap. It is the base pitch less both base-circle thicknesses at the operating pressure angle."""
        swept = involute_function(tan(self.operating_pressure_angle))
        halves = (gear.base_radius * (gear.tooth_half_angle_at_base - swept) for gear in self.gears)
        return self.base_pitch - 2.0 * sum(halves)

    @property
    def circumferential_backlash(self) -> float:
        """Gap (mm) as an arc of the pitch circles, j_wt of ISO 21771."""
        return self.backlash / cos(self.operating_pressure_angle)

    @property
    def centre_distance_without_backlash(self) -> float:
        """Centre distance (mm) at which both flanks of a tooth touch."""
        bases = sum(self.base_radii)
        both_teeth = sum(gear.base_radius * gear.tooth_half_angle_at_base for gear in self.gears)
        return bases * sqrt(1.0 + inverse_involute((both_teeth - 0.5 * self.base_pitch) / bases) ** 2)

    @property
    def tip_clearances(self) -> tuple[float, float]:
        """Distances (mm) from the tip circles of pinion and wheel to the mate's root circle."""
        return (
            self.centre_distance - self.pinion.tip_radius - self.wheel.root_radius,
            self.centre_distance - self.wheel.tip_radius - self.pinion.root_radius,
        )


# Cost, warnings, the run and its quasi-static companion ask for the same pair.
@lru_cache(maxsize=16)
def gear_pair(data: GearPairData) -> GearPair:
    """The pair that a scene describes, checked; GeometryError for one that cannot be.

    >>> from fenics_gears import load_scene
    >>> pair = gear_pair(load_scene("demos/lundvall2004.toml").gears)
    >>> print(f"{pair.contact_ratio:.2f}, backlash {pair.backlash:.2f} mm")
    1.47, backlash 0.10 mm
    """
    try:
        return _built(data)
    except Impossible as problem:
        from .remedies import advice

        raise GeometryError(f"{problem}{advice(data, problem.remedies, _built)}") from None


def _built(data: GearPairData) -> GearPair:
    """The pair, checked; raises Impossible, without advice."""
    pinion, wheel = (
        transverse_gear(getattr(data, name), data.module, data.pressure_angle, data.helix_angle, data.modulus_of(name))
        for name in GEARS
    )
    check_gear(pinion, "pinion")
    check_gear(wheel, "wheel")
    helix = Helix(data.helix_angle, data.pinion_hand) if data.helix_angle else None
    pair = GearPair(pinion, wheel, data.centre_distance, data.face_width, data.face_widths, helix, data.axial_offsets)
    check_pair(pair)
    return _with_web_as_it_counts(pair)


def _with_web_as_it_counts(pair: GearPair) -> GearPair:
    """A web is as wide as it is, however much of the face counts."""
    pinion, wheel = (
        gear
        if gear.web is None or own == counts
        else replace(gear, web=replace(gear.web, stiff_share=gear.web.share * own / counts))
        for gear, own, counts in zip(pair.gears, pair.face_widths, pair.effective_face_widths)
    )
    return replace(pair, pinion=pinion, wheel=wheel)
