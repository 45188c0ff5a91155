"""A scene as frozen dataclasses, in the units N, mm, s and rad.

A section that the scene does not name is ``None``: that effect is not simulated.
"""

from __future__ import annotations

from dataclasses import dataclass, make_dataclass
from typing import Optional

from fenics_gears.effects import top_level
from fenics_gears.effects.tooth_elasticity import Material


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
class GearPairData:
    """The pair: module, centre distance and face width in mm, pressure angle in rad; rigid without a material."""

    module: float
    pressure_angle: float
    centre_distance: float
    face_width: float
    pinion: GearData
    wheel: GearData
    material: Material | None


@dataclass(frozen=True)
class Load:
    """Couple on the wheel's shaft, N mm; positive when it resists the drive."""

    wheel_torque: float


# As many mesh cycles as pass until every tooth has met every other; the number follows from the teeth.
HUNTING_TOOTH_PERIOD = "hunting tooth period"
# As many are kept where nothing is said of it and all are alike, or all would be too many.
LAST_CYCLES = 2


@dataclass(frozen=True)
class Motion:
    """Mesh frequency in Hz (mesh cycles a second), how many cycles are run, and of how many of them, the last, contact fields are stored and pictures show.

    ``fewer_where_too_large``: where the result could not hold the contact fields of so many, those of fewer are stored; the scene does not ask for them by number.
    """

    mesh_frequency: float
    mesh_cycles: int
    recorded_cycles: int
    fewer_where_too_large: bool = False


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
    def tooth_elasticity(self) -> Material | None:
        """What makes the flanks elastic; None for rigid ones."""
        return None if self.accuracy.model == RIGID_TEETH else self.gears.material

    @property
    def resolves_contact(self) -> bool:
        """Whether contact is spread over nodes of elastic flanks, so that there are pressures."""
        return self.tooth_elasticity is not None and self.accuracy.model in (None, ELASTIC)


# Everything a run needs to know, and the text it was read from; one field for each effect, None where the scene does not name it.
Scene = make_dataclass("Scene", [(effect.section, Optional[effect.data], None) for effect in top_level()], bases=(_AlwaysThere,), frozen=True)
Scene.__doc__ = "Everything a run needs to know, and the text it was read from; an effect that the scene does not name is None."
Scene.__module__ = __name__
