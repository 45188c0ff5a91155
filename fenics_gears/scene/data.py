"""A scene as frozen dataclasses, in the units N, mm, s and rad.

A section that the scene does not name is ``None``: that effect is not simulated.
"""

from __future__ import annotations

from dataclasses import dataclass, make_dataclass
from typing import TYPE_CHECKING, Any, Optional, TypeAlias

from fenics_gears.effects import top_level
from fenics_gears.effects.tooth_elasticity import Material


@dataclass(frozen=True)
class GearData:
    """One gear: diameters in mm, rack tip radius in modules; `face_width` (mm) and `material` of its own, None for the pair's."""

    teeth: int
    profile_shift: float
    tip_diameter: float
    root_diameter: float
    bore_diameter: float
    rack_tip_radius: float
    face_width: float | None = None
    material: Material | None = None


@dataclass(frozen=True)
class GearPairData:
    """The pair: module and centre distance in mm, pressure angle in rad; rigid without a material.

    `face_width`, mm, is that over which both gears meet, the smaller of their own; `material` that of gears without one of their own.
    """

    module: float
    pressure_angle: float
    centre_distance: float
    face_width: float
    pinion: GearData
    wheel: GearData
    material: Material | None

    @property
    def materials(self) -> tuple[Material, Material] | None:
        """What pinion and wheel are made of; None where they are rigid."""
        found = (self.material_of("pinion"), self.material_of("wheel"))
        return None if None in found else found

    def material_of(self, name: str) -> Material | None:
        """What the "pinion" or the "wheel" is made of."""
        return getattr(self, name).material or self.material

    @property
    def face_widths(self) -> tuple[float, float]:
        """Width (mm) of the pinion and of the wheel."""
        return self.pinion.face_width or self.face_width, self.wheel.face_width or self.face_width


@dataclass(frozen=True)
class Load:
    """Couple on the wheel's shaft, N mm; positive when it resists the drive."""

    wheel_torque: float


# As many mesh cycles as pass until every tooth has met every other; the number follows from the teeth.
HUNTING_TOOTH_PERIOD = "hunting tooth period"
# As many are kept where nothing is said of it and all are alike, or all would be too many.
LAST_CYCLES = 2
# Of a scene that needs no speed and has none, Hz: its time counts mesh cycles in seconds.
NOMINAL_FREQUENCY = 1.0


@dataclass(frozen=True)
class Motion:
    """Mesh frequency in Hz (mesh cycles a second), how many cycles are run, and of how many of them, the last, contact fields are stored and pictures show.

    ``fewer_where_too_large``: where the result could not hold the contact fields of so many, those of fewer are stored; the scene does not ask for them by number.
    ``speed_given``: whether the scene has a speed; if not, nothing of it depends on one, and the frequency is ``NOMINAL_FREQUENCY``.
    """

    mesh_frequency: float
    mesh_cycles: int
    recorded_cycles: int
    fewer_where_too_large: bool = False
    speed_given: bool = True


# What a mesh is computed as: the full contact of elastic flanks, and the cheaper models.
ELASTIC, RIGID_TEETH, STIFFNESS_TABLE, ISO_6336 = "elastic", "rigid teeth", "stiffness table", "ISO 6336-1"


@dataclass(frozen=True)
class Accuracy:
    """How the scene is computed; None where the program shall choose from the scene.

    ``elastic_teeth``: teeth this many pitches apart and further do not feel each other; None: all that can be loaded together do.
    ``target``: relative error for which a run chooses all settings by measuring; no other field is given beside it.
    """

    element: str | None = None
    flank_element_size: float | None = None
    contact_length: float | None = None
    contact_nodes: int | None = None
    steps_per_mesh_cycle: int | None = None
    condensation: str | None = None
    body_element_size: float | None = None
    interpolation: str | None = None
    elastic_teeth: int | None = None
    model: str | None = None
    target: float | None = None


@dataclass(frozen=True)
class Output:
    """Results besides those that every run has."""

    root_stress: bool = False
    contact_fields: bool = True


@dataclass(frozen=True)
class _AlwaysThere:
    title: str
    gears: GearPairData
    load: Load
    motion: Motion
    accuracy: Accuracy = Accuracy()
    output: Output = Output()
    text: str = ""
    name: str = "scene"

    @property
    def mesh_frequencies(self) -> tuple[float, float]:
        """The lowest and the highest mesh frequency of the run, Hz."""
        ends = [self.motion.mesh_frequency] + ([self.speed_ramp.end_frequency] if self.speed_ramp is not None else [])
        return min(ends), max(ends)

    @property
    def tooth_elasticity(self) -> tuple[Material, Material] | None:
        """What makes the flanks of pinion and wheel elastic; None for rigid ones."""
        return None if self.accuracy.model == RIGID_TEETH else self.gears.materials

    @property
    def resolves_contact(self) -> bool:
        """Whether contact is spread over nodes of elastic flanks, so that there are pressures."""
        return self.tooth_elasticity is not None and self.accuracy.model in (None, ELASTIC)


# Everything a run needs to know, and the text it was read from; one field for each effect, None where the scene does not name it.
if TYPE_CHECKING:
    Scene: TypeAlias = Any  # of fields that are known when the program runs
else:
    Scene = make_dataclass("Scene", [(effect.section, Optional[effect.data], None) for effect in top_level()], bases=(_AlwaysThere,), frozen=True)
    Scene.__doc__ = "Everything a run needs to know, and the text it was read from; an effect that the scene does not name is None."
    Scene.__module__ = __name__
