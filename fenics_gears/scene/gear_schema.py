"""``[gears]`` and the sections below it: what a drawing of the pair says; ``scene.drawing`` derives the rest."""

from dataclasses import dataclass

from fenics_gears.effects.tooth_elasticity import MaterialText, OwnMaterialText
from fenics_gears.geometry.gear import Gear, transverse_gear
from fenics_gears.geometry.gear_data import RACKS, SUPPORTS, GearData
from fenics_gears.geometry.ring_fillet import Cutter
from fenics_gears.inputs.fields import choice, number, quantity, whole_number
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import MODULES, PRESSURE_ANGLES

# Measures of the tooth thickness, each with what has to be known with it.
MEASURES = {"tooth_thickness": None, "base_tangent_length": "spanned_teeth", "dimension_over_balls": "ball_diameter"}
# In place of what a drawing leaves out, where it does not count.
UNKNOWN = 0.0


def _length(example: str, meaning: str, otherwise: str):
    return quantity("0.01 mm to 100 m", example, meaning=meaning, otherwise=otherwise)


def _diameter(example: str, meaning: str, otherwise: str = ""):
    return quantity("0.1 mm to 100 m", example, meaning=meaning, otherwise=otherwise)


@dataclass(frozen=True)
class RackText(Section):
    """``[gears.rack]``: the generating rack of both gears, or within a gear's section its own. A figure that is given
    replaces that of the profile, and one of a gear's own that of both."""

    profile: str | None = choice(
        *RACKS,
        meaning=(
            "addendum, dedendum and tip radius by ISO 53:1998, Annex A: A 1/1.25/0.38, B 1/1.25/0.3, C 1/1.25/0.25, D"
            " 1/1.4/0.39; GOST 13755-2015 has the same, and DIN 867 A"
        ),
        otherwise="`ISO 53 A`",
    )
    addendum: float | None = number(
        1.0, meaning="addendum h_aP of the basic rack, in modules", above=0, highest=3, otherwise="that of the profile"
    )
    dedendum: float | None = number(
        1.25, meaning="dedendum h_fP of the basic rack, in modules", above=0, highest=3, otherwise="that of the profile"
    )
    tip_radius: float | None = number(
        0.38,
        meaning="tip radius of the rack's tooth, in modules; it shapes the fillet",
        lowest=0,
        highest=2,
        otherwise="that of the profile, or what has room on the rack's tip",
    )
    protuberance: float | None = quantity(
        "0 mm to 1 m",
        "0.15 mm",
        meaning=(
            "amount pr_P0 by which the rounding of the rack's tip stands out beyond its flank, normal to it, so that"
            " the root is cut free"
        ),
        otherwise="0 mm",
    )
    protuberance_angle: float | None = quantity(
        "1 deg to 34 deg",
        "10 deg",
        meaning="pressure angle alpha_prP0 of the short flank between protuberance and flank",
        otherwise="half the pressure angle; has no meaning without `protuberance`",
    )
    finishing_stock: float | None = quantity(
        "0 mm to 1 m",
        "0.1 mm",
        meaning="stock q, normal to the flanks, that finishing takes off these alone; no more than `protuberance`",
        otherwise="0 mm",
    )


@dataclass(frozen=True)
class WebText(Section):
    """``[gears.pinion.web]`` and ``[gears.wheel.web]``: a web between hub and rim that is less wide than the face. In
    the plane it counts by its share of the face width; over the face it is a body of its own, and the rim bends on
    it."""

    rim_inner_diameter: float = _diameter("100 mm", "inner diameter of the rim, where the web ends")
    width: float = _length("8 mm", "width of the web, at most the gear's face width", "")
    hub_diameter: float | None = _diameter(
        "50 mm", "outer diameter of the hub, where the web begins", "the bore diameter"
    )
    axial_offset: float | None = quantity(
        "-100 m to 100 m",
        "2 mm",
        meaning="middle of the web from the gear's mid-width, positive as the gear's own `axial_offset`",
        otherwise="0 mm",
        over_face=True,
    )


@dataclass(frozen=True, kw_only=True)
class CutterText(Section):
    """``[gears.wheel.cutter]``: the shaper cutter of an internal gear, whose tip shapes the fillets; its tip diameter
    follows from the root diameter."""

    teeth: int = whole_number(5, 1000, 23, meaning="number of teeth z_0 of the cutter")
    profile_shift: float | None = number(
        0.1,
        meaning="profile shift x_0 of the cutter, as it is ground at present, in modules",
        lowest=-2,
        highest=2,
        otherwise="0",
    )


@dataclass(frozen=True, kw_only=True)
class SupportText(Section):
    """``[gears.wheel.support]``: what holds the outer circle of an internal gear; `support = "held"` is short for the
    kind alone."""

    kind: str = choice(
        *SUPPORTS,
        meaning="`held`: the outer circle is rigid; `foundation`: springs evenly over the outer circle, as of a soft"
        " housing, whose other end is rigid",
        otherwise="`held`",
    )
    radial_stiffness: float | None = quantity(
        "1e-6 N/mm^3 to 1e12 N/mm^3",
        "500 N/mm^3",
        meaning="radial stiffness of the foundation per area of the outer circle",
        otherwise="required of a foundation",
    )
    tangential_stiffness: float | None = quantity(
        "1e-6 N/mm^3 to 1e12 N/mm^3",
        "200 N/mm^3",
        meaning="its tangential stiffness per area",
        otherwise="required of a foundation",
    )


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
        otherwise="that of the measured tooth thickness; one of both is required",
    )
    tip_diameter: float | None = _diameter(
        "82.64 mm", "tip diameter", "d_a = d + 2 m_n (x + h_aP + k), with k of `tip_shortening`"
    )
    root_diameter: float | None = _diameter(
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
    bore_diameter: float | None = _diameter(
        "30 mm",
        "bore diameter; the bore is a rigid ring on the shaft, which makes thin rims too stiff",
        "required of an external gear",
    )
    outer_diameter: float | None = _diameter(
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
    tooth_thickness: float | None = _length(
        "7.7 mm", "normal tooth thickness s_n at the reference cylinder", "from `profile_shift`"
    )
    base_tangent_length: float | None = _length(
        "34.5 mm", "base tangent length W_k over `spanned_teeth`", "from `profile_shift`"
    )
    spanned_teeth: int | None = whole_number(
        2,
        1000,
        3,
        meaning="number of teeth k that the base tangent length spans",
        otherwise="as `gears check` chooses; required with `base_tangent_length`",
    )
    dimension_over_balls: float | None = _length(
        "85.2 mm", "dimension M_d over two balls, of spur gears also over two pins", "from `profile_shift`"
    )
    ball_diameter: float | None = _length(
        "8 mm", "diameter D_M of the balls or pins", "as `gears check` chooses; required with `dimension_over_balls`"
    )
    face_width: float | None = _length("15 mm", "face width of this gear", "that of `[gears]`")
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
        below="For spur gears, leave it out.",
    )
    pinion_hand: str | None = choice(
        "right",
        "left",
        meaning="hand of the pinion's helix; the wheel has the other",
        otherwise="`right`; has no meaning without `helix_angle`",
    )
    centre_distance: float | None = _diameter(
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
    face_width: float | None = _length(
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
