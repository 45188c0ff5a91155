"""A gear in its transverse section: circles, tooth thickness, the rack that cuts it.

An internal gear has negative numbers, as ISO 21771 has it: teeth, radii, pitch; its `bore_radius` is that of its rim's
outer circle. An angle with a negative radius points to the other side, so that one formula serves both kinds.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import atan, cos, hypot, pi, sin, tan
from typing import TYPE_CHECKING

import numpy as np

from fenics_gears.errors import GeometryError

from .gear_data import FOUNDATION, Cutter, GearData, Web
from .involute import inverse_involute, involute_function
from .outline import crossing, fillet_point, touching_end

if TYPE_CHECKING:
    from .ring_fillet import CutFillet, PlainFillet

# Of lengths in modules: what is left of a unit or a scale factor is in the last two digits of a double.
DECIMALS_IN_MODULES = 12


@dataclass(frozen=True)
class Gear:
    """A gear cut by a straight-sided rack with a rounded tip, or an internal one; lengths in mm, angles in rad.

    Module, pressure angle and profile shift are of the transverse section; `helix_angle` at the reference cylinder,
    without sign. `rack_tip_radius`, `protuberance` (by which the rack's rounding protrudes beyond the flank, normal to
    it) and `protuberance_angle` (at which it goes back) are of the normal section. `tip_chamfer`: radial height.
    An internal gear has, in place of the rack, a `cutter` whose tip has that radius; or none, and plain fillets of it.
    `foundation`: radial and tangential stiffness per area of springs around it, over Young's modulus, 1/mm, or None.
    """

    teeth: int
    module: float
    pressure_angle: float
    profile_shift: float
    tip_radius: float
    root_radius: float
    bore_radius: float
    rack_tip_radius: float
    helix_angle: float = 0.0
    tip_chamfer: float = 0.0
    protuberance: float = 0.0
    protuberance_angle: float = 0.0
    web: Web | None = None
    cutter: Cutter | None = None
    foundation: tuple[float, float] | None = None

    @property
    def internal(self) -> bool:
        """Whether the teeth point inwards."""
        return self.teeth < 0

    @property
    def tooth_count(self) -> int:
        """Number of teeth without sign."""
        return abs(self.teeth)

    @property
    def sign(self) -> float:
        """-1 of an internal gear, whose radii are negative, else 1."""
        return -1.0 if self.internal else 1.0

    @cached_property
    def ring_fillet(self) -> PlainFillet | CutFillet:
        """What shapes the fillet of an internal gear."""
        from .ring_fillet import ring_fillet

        return ring_fillet(self)

    @property
    def normal_module(self) -> float:
        """Module (mm) of the rack's normal section."""
        return self.module * cos(self.helix_angle)

    @cached_property
    def normal_pressure_angle(self) -> float:
        """Pressure angle (rad) of the rack's normal section."""
        return atan(tan(self.pressure_angle) * cos(self.helix_angle)) if self.helix_angle else self.pressure_angle

    @property
    def rack_stretch(self) -> float:
        """1/cos(helix angle): a length along the pitch line in the transverse over that in the normal section."""
        return 1.0 / cos(self.helix_angle)

    @property
    def reference_radius(self) -> float:
        """Radius (mm) of the circle that rolls on the generating rack."""
        return 0.5 * self.teeth * self.module

    @property
    def body_depth(self) -> float:
        """Thickness (mm) of the solid body below the teeth: down to the bore, or of the rim of a web."""
        return self.root_radius - (self.bore_radius if self.web is None else self.web.rim_radius)

    @cached_property
    def base_radius(self) -> float:
        """Radius (mm) of the circle whose involute the flank is."""
        return self.reference_radius * cos(self.pressure_angle)

    def in_modules(self, *lengths: float) -> tuple[float, ...]:
        """Lengths (mm) as multiples of the module, rounded so that similar gears have the very same numbers."""
        return tuple(round(length / self.module, DECIMALS_IN_MODULES) for length in lengths)

    @property
    def of_module_one(self) -> Gear:
        """The similar gear whose module is the unit of length."""
        names = ("tip_radius", "root_radius", "bore_radius", "rack_tip_radius", "tip_chamfer", "protuberance")
        lengths = dict(zip(names, self.in_modules(*(getattr(self, name) for name in names))))
        web = self.web
        if web is not None:
            hub, rim = self.in_modules(web.hub_radius, web.rim_radius)
            web = replace(web, hub_radius=hub, rim_radius=rim)
        springs = self.foundation and (self.foundation[0] * self.module, self.foundation[1] * self.module)
        return replace(self, module=1.0, web=web, foundation=springs, **lengths)

    @property
    def angular_pitch(self) -> float:
        """Angle (rad) from tooth to tooth."""
        return 2.0 * pi / self.teeth

    @property
    def base_pitch(self) -> float:
        """Distance (mm) between neighbouring flanks along the line of action."""
        return self.angular_pitch * self.base_radius

    @cached_property
    def tooth_half_angle_at_base(self) -> float:
        """Angle (rad) at the gear's centre between the tooth's centreline and the start of its involute."""
        shift = 2.0 * self.profile_shift * tan(self.pressure_angle)
        return (0.5 * pi + shift) / self.teeth + tan(self.pressure_angle) - self.pressure_angle

    @property
    def dedendum(self) -> float:
        """Depth (mm) of the root circle below the profile-shifted pitch line: the rack's addendum."""
        return self.reference_radius + self.profile_shift * self.module - self.root_radius

    @property
    def rack_depth(self) -> float:
        """Depth (mm) of the rack's tip below the rolling pitch line, profile shift included."""
        return self.reference_radius - self.root_radius

    def rack_half_thickness(self, depth: float) -> float:
        """Half the thickness (mm) of the rack's tooth between its flanks at a depth (mm) below the pitch line."""
        half_tip_land = 0.25 * pi * self.module - self.dedendum * tan(self.pressure_angle)
        return half_tip_land + (self.rack_depth - depth) * tan(self.pressure_angle)

    @property
    def _rack_half_tip_land(self) -> float:
        """Half the thickness (mm) of the rack's tip where the flanks, moved out by the protuberance, meet it."""
        return self.rack_half_thickness(self.rack_depth) + self.rack_stretch * self.protuberance / cos(
            self.normal_pressure_angle
        )

    @property
    def transverse_protuberance_angle(self) -> float:
        """Protuberance angle (rad) in the transverse section."""
        return atan(tan(self.protuberance_angle) * self.rack_stretch)

    @property
    def rack_tip_centre(self) -> tuple[float, float]:
        """Centre of the rack's tip rounding, mm: distance from the rack tooth's centreline, negative where the rounding
        does not fit, and depth below the pitch line."""
        alpha = self.normal_pressure_angle
        radius = self.rack_tip_radius
        across = self._rack_half_tip_land - self.rack_stretch * radius * (1.0 - sin(alpha)) / cos(alpha)
        return across, self.rack_depth - radius

    @property
    def largest_rack_tip_radius(self) -> float:
        """Tip radius (mm) at which the rack's two roundings meet; negative when the rack ends in a point before."""
        alpha = self.normal_pressure_angle
        half_tip_land = self._rack_half_tip_land / self.rack_stretch
        return half_tip_land * cos(alpha) / (1.0 - sin(alpha))

    @cached_property
    def rack_form_roll_angle(self) -> float:
        """Roll angle (rad) that the end of the rack's straight flank cuts; negative means undercut.

        At depth c below the pitch line, it crosses the line of action ``c/sin(alpha)`` before the pitch point.
        """
        alpha = self.pressure_angle
        flank_end = self.rack_depth - self.rack_tip_radius * (1.0 - sin(self.normal_pressure_angle))
        return tan(alpha) - flank_end / (self.reference_radius * sin(alpha) * cos(alpha))

    @property
    def undercut(self) -> bool:
        """Whether the fillet crosses the involute instead of touching it, so that an edge is where they meet."""
        return not self.internal and (self.rack_form_roll_angle < 0.0 or self.protuberance > 0.0)

    @cached_property
    def fillet_end(self) -> float:
        """Fillet parameter (rad, see outline.py) at the form circle; 0 is the root circle."""
        if self.internal:
            return self.ring_fillet.end
        return crossing(self) if self.undercut else touching_end(self)

    @cached_property
    def form_roll_angle(self) -> float:
        """Roll angle (rad) at the form circle, where the fillet ends and the involute begins."""
        if self.internal:
            return self.ring_fillet.form_roll_angle
        if not self.undercut:
            return self.rack_form_roll_angle
        x, y = fillet_point(self, self.fillet_end)
        return float(self.roll_angle(hypot(x, y)))

    @property
    def form_radius(self) -> float:
        """Radius (mm) of the form circle, where the fillet meets the involute."""
        return self.radius(self.form_roll_angle)

    @property
    def tip_form_radius(self) -> float:
        """Radius (mm) where the involute ends, at the tip's chamfer: d_Fa/2 of ISO 21771."""
        return self.tip_radius - self.tip_chamfer

    @cached_property
    def tip_roll_angle(self) -> float:
        """Roll angle (rad) where the involute ends at the tip."""
        return float(self.roll_angle(self.tip_form_radius))

    @property
    def roll_ends(self) -> tuple[float, float]:
        """Lowest and highest roll angle (rad) of the involute, of an internal gear at its tip and form circle."""
        ends = self.form_roll_angle, self.tip_roll_angle
        return (ends[1], ends[0]) if self.internal else ends

    @cached_property
    def chamfered_arc(self) -> float:
        """Arc (mm) of the tip circle that the chamfer takes off either side, as long as what it takes off the flank."""
        if not self.tip_chamfer:
            return 0.0
        return 0.5 * self.base_radius * float(self.roll_angle(self.tip_radius) ** 2 - self.tip_roll_angle**2)

    @property
    def tip_thickness(self) -> float:
        """Arc (mm) of the tip circle on the tooth; not positive when flanks or chamfers meet below it."""
        return float(self.tooth_thickness(self.tip_radius)) - 2.0 * self.chamfered_arc

    @property
    def pointed_radius(self) -> float:
        """Radius (mm) at which the two involutes of a tooth meet in a point."""
        return float(self.radius(inverse_involute(self.tooth_half_angle_at_base)))

    def roll_angle(self, radius):
        """Roll angle (rad) at a radius (mm, any shape); GeometryError below the base circle."""
        excess = np.square(np.asarray(radius, dtype=float) / self.base_radius) - 1.0
        if np.any(excess < -1e-12):
            raise GeometryError(
                f"radius {np.min(np.abs(radius)):.6g} mm lies below the base circle of radius"
                f" {abs(self.base_radius):.6g} mm, "
                "where there is no involute"
            )
        return np.sqrt(np.maximum(excess, 0.0))

    def radius(self, roll_angle):
        """Radius (mm) at a roll angle (rad, any shape)."""
        return self.base_radius * np.sqrt(1.0 + np.square(roll_angle))

    def tooth_thickness(self, radius):
        """Arc thickness (mm) of the tooth at a radius (mm, any shape, on the involute)."""
        half_angle = self.tooth_half_angle_at_base - involute_function(self.roll_angle(radius))
        return 2.0 * np.asarray(radius, dtype=float) * half_angle


def transverse_gear(
    gear: GearData, module: float, pressure_angle: float, helix_angle: float, youngs_modulus: float | None = None
) -> Gear:
    """The gear's transverse section, in which tan(pressure angle) stretches as the module does (ISO 21771); its
    foundation is stiff by its own Young's modulus (MPa), a rigid gear's not at all."""
    stretch = 1.0 / cos(helix_angle)
    foundation = None
    if youngs_modulus and gear.support is not None and gear.support.kind == FOUNDATION:
        springs = gear.support.radial_stiffness, gear.support.tangential_stiffness
        foundation = springs[0] / youngs_modulus, springs[1] / youngs_modulus
    return Gear(
        teeth=gear.teeth,
        module=module * stretch,
        pressure_angle=atan(tan(pressure_angle) * stretch) if helix_angle else pressure_angle,
        profile_shift=gear.profile_shift / stretch,
        tip_radius=0.5 * gear.tip_diameter,
        root_radius=0.5 * gear.root_diameter,
        bore_radius=0.5 * gear.bore_diameter,
        rack_tip_radius=gear.rack_tip_radius * module,
        helix_angle=helix_angle,
        tip_chamfer=gear.tip_chamfer,
        protuberance=gear.protuberance,
        protuberance_angle=gear.protuberance_angle,
        web=gear.web,
        cutter=gear.cutter and Cutter(gear.cutter.teeth, gear.cutter.profile_shift / stretch),
        foundation=foundation,
    )
