"""Dimensions, width and material of a gear pair, as on its drawing, and a rough stiffness of a tooth pair; in N, mm and
rad."""

from dataclasses import dataclass, field

from fenics_gears.inputs.fields import choice, number, quantity
from fenics_gears.inputs.tree import GEARS, PerGear

# ISO 53:1998, Annex A, in modules: addendum, dedendum, tip radius of the rack. The same as types A to D of GOST
# 13755-2015; A is also the rack of DIN 867.
RACKS = {
    "ISO 53 A": (1.0, 1.25, 0.38),
    "ISO 53 B": (1.0, 1.25, 0.3),
    "ISO 53 C": (1.0, 1.25, 0.25),
    "ISO 53 D": (1.0, 1.4, 0.39),
}


# Lengths (mm) below which a backlash, clearance or arc counts as exactly zero.
ROUNDING = 1e-6
# Thinnest rim between bore or outer circle and root circle, in modules, that leaves room for a mesh.
LEAST_RIM = 0.2
# Bore of a gear whose bore is not known, over its root diameter: the rim is thick enough not to matter.
USUAL_BORE = 0.4


@dataclass(frozen=True)
class Helix:
    """`angle`, rad, at the reference cylinders, positive; `pinion_hand`: "right" or "left"; a wheel has the
    other, an internal one the same."""

    angle: float
    pinion_hand: str = "right"

    @property
    def sign(self) -> float:
        """1 for a right-hand pinion, -1 for a left-hand one."""
        return 1.0 if self.pinion_hand == "right" else -1.0


@dataclass(frozen=True)
class Material:
    """Isotropic linear elasticity: Young's modulus and yield strength in MPa; the latter None where it is not known."""

    youngs_modulus: float
    poissons_ratio: float
    yield_strength: float | None = None


@dataclass(frozen=True)
class LumpedGear:
    """`mass`, N s^2/mm, and `moment_of_inertia`, N mm s^2, at a gear's centre; `width`, mm, of its face;
    `given_tilting`: about a diameter, where given."""

    mass: float
    moment_of_inertia: float
    width: float
    given_tilting: float | None = None

    @property
    def tilting_inertia(self) -> float:
        """Moment of inertia, N mm s^2, about a diameter at mid-width: as given, or J/2 + m b^2/12.

        That is a disc's; exact for any body whose sections along the width are alike, on the average over a turn, and
        with three teeth or more at any time.
        """
        if self.given_tilting is not None:
            return self.given_tilting
        return 0.5 * self.moment_of_inertia + self.mass * self.width**2 / 12.0


@dataclass(frozen=True)
class Web:
    """A part of the gear's body that is thinner than the face, from the hub's radius to the rim's inner radius (mm).

    `share`: its width over the face width; `stiff_share`: over that part of the face width that counts in the plane,
    None where all of it does. `offset`: of its middle from the gear's mid-width, to the right, over the face width.
    """

    hub_radius: float
    rim_radius: float
    share: float
    stiff_share: float | None = None
    offset: float = 0.0


@dataclass(frozen=True)
class Cutter:
    """A shaper cutter: its teeth and the profile shift of its teeth's thickness, of the transverse section."""

    teeth: int
    profile_shift: float = 0.0


HELD = "held"
FOUNDATION = "foundation"
SUPPORTS = (HELD, FOUNDATION)


@dataclass(frozen=True)
class RingSupport:
    """What holds the outer circle of an internal gear, of SUPPORTS; springs with a radial and a tangential stiffness
    per area, N/mm^3, of a foundation."""

    kind: str
    radial_stiffness: float | None = None
    tangential_stiffness: float | None = None


# Teeth that are spanned and ball diameter, by which a drawing measures pinion and wheel; None where it says none.
MeasuredOver = tuple[tuple[int | None, float | None], tuple[int | None, float | None]]
NOT_GIVEN: tuple[int | None, float | None] = (None, None)


@dataclass(frozen=True)
class GearData:
    """One gear: diameters in mm, profile shift (that of the tooth thickness) and rack tip radius in modules;
    `face_width` (mm) and `material` are None where it has the pair's.

    `tip_chamfer`, mm: its radial height. `protuberance`, mm, of the rack beyond the finished flank, and its angle, rad.
    `nominal_profile_shift`: that of the drawing, None where the thickness has it. An internal gear has negative teeth
    and diameters, that of the outer circle as `bore_diameter`, a `cutter` or None, and a `support`.
    """

    teeth: int
    profile_shift: float
    tip_diameter: float
    root_diameter: float
    bore_diameter: float
    rack_tip_radius: float
    face_width: float | None = None
    material: Material | None = None
    tip_chamfer: float = 0.0
    protuberance: float = 0.0
    protuberance_angle: float = 0.0
    web: Web | None = None
    nominal_profile_shift: float | None = field(default=None, compare=False)
    cutter: Cutter | None = None
    support: RingSupport | None = None


@dataclass(frozen=True)
class GearPairData(PerGear):
    """The pair: module and centre distance in mm, pressure angle in rad; rigid without a material.

    `face_width`, mm: over which both gears meet. `helix_angle`, rad, at the reference cylinder, 0 for spur gears;
    module, pressure angle and figures in modules are of the normal section. `pinion_hand`: "right" or "left", of
    `Helix`. `axial_offsets`, mm: of the mid-widths of pinion and wheel from a common place.
    """

    module: float
    pressure_angle: float
    centre_distance: float
    face_width: float
    pinion: GearData
    wheel: GearData
    material: Material | None
    helix_angle: float = 0.0
    pinion_hand: str = "right"
    axial_offsets: tuple[float, float] = (0.0, 0.0)

    @property
    def materials(self) -> tuple[Material, Material] | None:
        """Materials of pinion and wheel; None where they are rigid."""
        first, second = map(self.material_of, GEARS)
        return None if first is None or second is None else (first, second)

    def material_of(self, name: str) -> Material | None:
        """Material of the "pinion" or the "wheel"."""
        return getattr(self, name).material or self.material

    def modulus_of(self, name: str) -> float | None:
        """Young's modulus (MPa) of the "pinion" or the "wheel"; None where it is rigid."""
        material = self.material_of(name)
        return None if material is None else material.youngs_modulus

    @property
    def teeth(self) -> tuple[int, int]:
        """Numbers of teeth of both gears; negative of an internal one."""
        return self.pinion.teeth, self.wheel.teeth

    @property
    def face_widths(self) -> tuple[float, float]:
        """Width (mm) of the pinion and of the wheel."""
        first, second = (gear.face_width or self.face_width for gear in self.of_gears)
        return first, second


_ISO_6336 = "ISO 6336-2, table of the elasticity factor"
# The table has moduli alone; Poisson's ratios are common ones.
_PLASTICS = (
    "Encyclopedia of Physical Science and Technology, Plastics Engineering, Table I: short term, room temperature"
)
# Young's modulus, MPa, Poisson's ratio, yield strength, MPa, of named grades alone, and where they are from. The least
# yield strengths are of quenched and tempered steel more than 40 and up to 100 mm thick; strengths of case-hardened
# steels would be the core's, not the flanks'.
MATERIALS: dict[str, tuple[Material, str]] = {
    "steel": (Material(206e3, 0.3), "ISO 6336-1"),
    "C45 QT": (Material(206e3, 0.3, 370.0), "ISO 6336-1; yield strength EN ISO 683-1"),
    "42CrMo4 QT": (Material(206e3, 0.3, 650.0), "ISO 6336-1; yield strength EN ISO 683-2"),
    "34CrNiMo6 QT": (Material(206e3, 0.3, 800.0), "ISO 6336-1; yield strength EN ISO 683-2"),
    "cast steel": (Material(202e3, 0.3), _ISO_6336),
    "ductile cast iron": (Material(173e3, 0.3), _ISO_6336),
    "grey cast iron": (Material(118e3, 0.3), _ISO_6336),
    "tin bronze": (Material(113e3, 0.3), _ISO_6336),
    "cast tin bronze": (Material(103e3, 0.3), _ISO_6336),
    "POM": (Material(2.9e3, 0.35), _PLASTICS),
    "PA66": (Material(3.0e3, 0.39), _PLASTICS),
}


# ISO 6336-1 puts the stiffness of a steel tooth pair near 14 N/(mm um); in parts of Young's modulus.
PAIR_STIFFNESS = 14e3 / 206e3


def mean_youngs_modulus(materials: tuple[Material, Material]) -> float:
    """E (MPa) of a pair of two materials as ISO 6336-1 takes it: 2 E1 E2/(E1 + E2)."""
    first, second = (material.youngs_modulus for material in materials)
    return 2.0 * first * second / (first + second) if first != second else first


def rough_pair_stiffness(materials: tuple[Material, Material], face_width: float) -> float:
    """Stiffness (N/mm) of one tooth pair along the line of action, about 14 N/(mm um) for steel; `face_width` in mm."""
    return PAIR_STIFFNESS * mean_youngs_modulus(materials) * face_width


def youngs_modulus(otherwise: str):
    return quantity("1 kPa to 1e9 GPa", "206 GPa", meaning="Young's modulus", otherwise=otherwise)


def poissons_ratio(otherwise: str):
    return number(0.3, meaning="Poisson's ratio", above=-1, below=0.5, otherwise=otherwise)


def material_name(otherwise: str):
    listed = "; ".join(
        f"{name} {each.youngs_modulus / 1e3:g} GPa, {each.poissons_ratio:g}"
        + (f", yield strength {each.yield_strength:g} MPa" if each.yield_strength else "")
        for name, (each, _) in MATERIALS.items()
    )
    return choice(
        *MATERIALS,
        meaning=f'material by name, also written `material = "steel"` in the section above: {listed}',
        otherwise=otherwise,
    )
