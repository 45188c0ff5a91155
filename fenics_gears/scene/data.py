"""A scene as frozen dataclasses, in the units N, mm, s and rad.

A section that the scene does not name is ``None``: that effect is not simulated.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class GearData:
    """One gear: diameters in mm, rack tip radius in modules."""

    teeth: int
    profile_shift: float
    tip_diameter: float
    root_diameter: float
    bore_diameter: float
    rack_tip_radius: float


@dataclass(frozen=True)
class Material:
    """Isotropic linear elasticity; Young's modulus in MPa."""

    youngs_modulus: float
    poissons_ratio: float


@dataclass(frozen=True)
class GearPairData:
    """The pair: module, centre distance and face width in mm, pressure angle in rad."""

    module: float
    pressure_angle: float
    centre_distance: float
    face_width: float
    pinion: GearData
    wheel: GearData
    material: Material


@dataclass(frozen=True)
class Load:
    """Couple on the wheel's shaft, N mm; positive when it resists the drive."""

    wheel_torque: float


@dataclass(frozen=True)
class Motion:
    """Mesh frequency in Hz (mesh cycles a second) and how many cycles are run and kept."""

    mesh_frequency: float
    mesh_cycles: int
    recorded_cycles: int


@dataclass(frozen=True)
class Shafts:
    """Torsional stiffness of either shaft, N mm/rad."""

    torsional_stiffness: float


@dataclass(frozen=True)
class Bearings:
    """Translational stiffness of either shaft's support, N/mm."""

    stiffness: float


@dataclass(frozen=True)
class Inertia:
    """Mass of a gear, N s^2/mm, and moment of inertia, N mm s^2; one value for both gears."""

    mass: float
    moment_of_inertia: float


@dataclass(frozen=True)
class Damping:
    """Rayleigh damping of each shaft: alpha K + beta M, alpha in s, beta in 1/s."""

    stiffness_proportional: float
    mass_proportional: float


@dataclass(frozen=True)
class Friction:
    """Coulomb friction on the flanks."""

    coefficient: float


@dataclass(frozen=True)
class Relief:
    """Tip relief of one gear: depth at the tip, mm; start as a roll angle in rad, None for HPSTC."""

    depth: float
    start_roll_angle: float | None


@dataclass(frozen=True)
class TipRelief:
    """Tip relief of the pair, linear in the roll angle; a gear without relief has None."""

    pinion: Relief | None
    wheel: Relief | None


@dataclass(frozen=True)
class CoastFlanks:
    """Contact on the unloaded flanks, with the backlash that the geometry has."""


@dataclass(frozen=True)
class Accuracy:
    """How the scene is computed; None where the program shall choose from the scene."""

    element: str | None = None
    flank_element_size: float | None = None
    contact_length: float | None = None
    contact_nodes: int | None = None
    steps_per_mesh_cycle: int | None = None
    condensation: str | None = None


@dataclass(frozen=True)
class Scene:
    """Everything a run needs to know, and the text it was read from."""

    title: str
    gears: GearPairData
    load: Load
    motion: Motion
    shafts: Shafts | None = None
    bearings: Bearings | None = None
    inertia: Inertia | None = None
    damping: Damping | None = None
    friction: Friction | None = None
    tip_relief: TipRelief | None = None
    coast_flanks: CoastFlanks | None = None
    accuracy: Accuracy = Accuracy()
    text: str = ""
    name: str = "scene"
