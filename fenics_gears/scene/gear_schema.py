"""``[gears]`` and the sections below it: what a drawing of the pair says; ``scene.drawing`` derives the rest."""

from dataclasses import dataclass

from fenics_gears.effects.tooth_elasticity import MaterialText, OwnMaterialText
from fenics_gears.geometry.gear import Gear, transverse_gear
from fenics_gears.geometry.gear_data import Cutter, GearData
from fenics_gears.inputs.fields import choice, number, quantity, whole_number
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import MODULES, PRESSURE_ANGLES

from .gear_parts import CutterText, RackText, SupportText, WebText, diameter, length

# Measures of the tooth thickness, each with what has to be known with it.
MEASURES = {"tooth_thickness": None, "base_tangent_length": "spanned_teeth", "dimension_over_balls": "ball_diameter"}
# In place of what a drawing leaves out, where it does not count.
UNKNOWN = 0.0


@dataclass(frozen=True, kw_only=True)
class GearText(Section):
    """``[gears.pinion]`` and ``[gears.wheel]``: the pinion drives and is an external gear; the wheel may be internal,
    with a negative number of teeth and positive diameters. The tooth thickness is
    given by `profile_shift`, or measured (`tooth_thickness`, `base_tangent_length` or `dimension_over_balls`). With
    both, the measured thickness holds, and root circle with it, since one rack cuts both; tip circle and centre
    distance go by `profile_shift`."""

    alternatives = (tuple(MEASURES),)

    teeth: int = whole_number(
        5,
        1000,
        16,
        meaning="number of teeth; of a wheel that is an internal gear negative (ISO 21771), or positive with"
        " `internal = true`",
        negative_means="an internal gear",
    )
    profile_shift: float | None = number(
        0.196,
        meaning="profile shift coefficient x, in modules",
        lowest=-5,
        highest=5,
        otherwise="that of the measured tooth thickness; what `centre_distance` and the mate's `profile_shift` leave;"
        " else 0",
    )
    tip_diameter: float | None = diameter(
        "82.64 mm", "tip diameter", "d_a = d + 2 m_n (x + h_aP + k), with k of `tip_shortening`"
    )
    root_diameter: float | None = diameter(
        "62.50 mm",
        "root diameter, from which the dedendum of the generating rack follows",
        "d_f = d + 2 m_n (x - h_fP), with x of the tooth thickness",
    )
    tip_chamfer: float | None = quantity(
        "0 mm to 1 m",
        "0.3 mm",
        meaning=(
            "radial height h_K of the chamfer between flank and tip circle, as long on the one as on the other; the"
            " involute ends at d_Fa = d_a - 2 h_K"
        ),
        otherwise="0 mm",
    )
    bore_diameter: float | None = diameter(
        "30 mm",
        "bore diameter; the bore is a rigid ring on the shaft, which makes thin rims too stiff",
        "0.4 of the root diameter; none of an internal gear",
    )
    outer_diameter: float | None = diameter(
        "280 mm", "outer diameter of the rim of an internal gear", "required of an internal gear"
    )
    rack_tip_radius: float | None = number(
        0.38,
        meaning="tip radius of the generating rack, in modules; the same as `tip_radius` of `[gears.pinion.rack]`; of"
        " an internal gear that of its cutter, or of its plain fillets",
        lowest=0,
        highest=2,
        otherwise="`tip_radius` of the rack; 0.38, or what has room on the rack's tip",
    )
    tooth_thickness: float | None = length(
        "7.7 mm", "normal tooth thickness s_n at the reference cylinder", "from `profile_shift`"
    )
    base_tangent_length: float | None = length(
        "34.5 mm", "base tangent length W_k over `spanned_teeth`", "from `profile_shift`"
    )
    spanned_teeth: int | None = whole_number(
        2,
        1000,
        3,
        meaning="number of teeth k that the base tangent length spans",
        otherwise="as `gears check` chooses; required with `base_tangent_length`",
    )
    dimension_over_balls: float | None = length(
        "85.2 mm", "dimension M_d over two balls, of spur gears also over two pins", "from `profile_shift`"
    )
    ball_diameter: float | None = length(
        "8 mm", "diameter D_M of the balls or pins", "as `gears check` chooses; required with `dimension_over_balls`"
    )
    face_width: float | None = length("15 mm", "face width of this gear", "that of `[gears]`")
    axial_offset: float | None = quantity(
        "-100 m to 100 m",
        "2 mm",
        meaning=(
            "mid-width along the axis, from a place common to both gears, positive to the right, the end from which the"
            " pinion is seen to turn counter-clockwise"
        ),
        otherwise="0 mm",
    )
    rack: RackText | None = None
    web: WebText | None = None
    cutter: CutterText | None = None
    support: SupportText | None = None
    material: OwnMaterialText | None = None

    @property
    def measure(self) -> str | None:
        """The field that gives the tooth thickness; None where `profile_shift` does."""
        return next((name for name in MEASURES if getattr(self, name) is not None), None)


@dataclass(frozen=True, kw_only=True)
class Gears(Section):
    """``[gears]``: what both gears share. Coefficients, such as profile shifts, count in modules of the normal section
    whatever gives the size of the teeth."""

    alternatives = (MODULES, PRESSURE_ANGLES)

    module: float | None = quantity(
        "0.01 mm to 1 m",
        "4.5 mm",
        meaning="module: with `helix_angle` the normal module, without it that of the plane of rotation",
        otherwise="from the next three; one of the four is required",
    )
    transverse_module: float | None = quantity(
        "0.01 mm to 1 m",
        "4.66 mm",
        meaning="module of the plane of rotation, m_t = m_n/cos(beta)",
        otherwise="from `module`",
    )
    diametral_pitch: float | None = quantity(
        "0.02 1/in to 2540 1/in",
        "10 1/in",
        meaning="teeth per inch of reference diameter, in the plane of rotation: P = 25.4 mm/m_t",
        otherwise="from `module`",
    )
    normal_diametral_pitch: float | None = quantity(
        "0.02 1/in to 2540 1/in",
        "10 1/in",
        meaning="diametral pitch of the normal section, 25.4 mm/m_n",
        otherwise="from `module`",
    )
    pressure_angle: float | None = quantity(
        "10 deg to 35 deg",
        "20 deg",
        meaning="pressure angle of the generating rack: with `helix_angle` in its normal section",
        otherwise="from `transverse_pressure_angle`; one of the two is required",
    )
    transverse_pressure_angle: float | None = quantity(
        "10 deg to 45 deg",
        "20.65 deg",
        meaning="pressure angle in the plane of rotation: tan(alpha_t) = tan(alpha_n)/cos(beta)",
        otherwise="from `pressure_angle`",
    )
    helix_angle: float | None = quantity(
        "1e-3 deg to 45 deg",
        "15 deg",
        meaning=("helix angle at the reference cylinder, without sign; modules are then normal modules (ISO 21771)"),
        otherwise="spur gears",
        below="For spur gears, leave it out; pinion_hand is the hand of the helix.",
    )
    pinion_hand: str | None = choice(
        "right",
        "left",
        meaning="hand of the pinion's helix; the wheel has the other, an internal one the same",
        otherwise="`right`; has no meaning without `helix_angle`",
    )
    centre_distance: float | None = diameter(
        "91.5 mm",
        "distance of the axes",
        "that of the profile shifts without backlash: inv(alpha_wt) = inv(alpha_t) + 2 (x1 + x2) tan(alpha_n)/(z1"
        " + z2)",
    )
    backlash: float | None = quantity(
        "0 mm to 1 m",
        "0.1 mm",
        meaning=(
            "circumferential backlash j_wt at the pitch circles. Where both `profile_shift` are given too, each gear's"
            " teeth are thinned by half of it; where both tooth thicknesses are measured, the centre distance follows"
            " from it"
        ),
        otherwise="what centre distance and tooth thicknesses leave",
    )
    tip_shortening: float | None = number(
        0.05,
        meaning="how much shorter the addendum of both gears is, in modules: -k of DIN 3960 and ISO 21771",
        lowest=0,
        highest=1,
        too_low="It is -k: write the amount by which the tips are shorter, without sign.",
        otherwise="what keeps the tip clearance of the rack: k m_n = a - a_d - (x1 + x2) m_n, not above 0",
    )
    face_width: float | None = length(
        "15 mm",
        "face width of both gears; unequal ones mesh over the smaller, centred unless they have an `axial_offset`. In"
        " plane runs one to three modules of the wider gear's overhang count as carrying (`gears check` says how much)",
        "each gear has its own `face_width`",
    )
    pinion: GearText
    wheel: GearText
    rack: RackText | None = None
    material: MaterialText | None = None

    def in_rotation(self, gear: GearData) -> Gear:
        """A gear in the section of rotation."""
        return transverse_gear(gear, self.module, self.pressure_angle, self.helix_angle or 0.0)

    def rack_gear(self, teeth: int, shift: float, root_diameter: float = UNKNOWN, cutter: Cutter | None = None) -> Gear:
        """A gear of which only rack or cutter, teeth and profile shift are known, and perhaps the root."""
        return self.in_rotation(GearData(teeth, shift, UNKNOWN, root_diameter, UNKNOWN, UNKNOWN, cutter=cutter))
