"""A scene as frozen dataclasses, in the units N, mm, s and rad.

A section that the scene does not name is ``None``: that effect is not simulated.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import pi, sin
from typing import TYPE_CHECKING

from fenics_gears.geometry.gear_data import NOT_GIVEN, GearPairData, Material, MeasuredOver
from fenics_gears.geometry.gear_data import GearData as GearData
from fenics_gears.inputs.tree import wheel_torque

from .accuracy import ELASTIC as ELASTIC
from .accuracy import IN_THE_PLANE, OVER_THE_FACE, WITH_OVERLAP, Fineness
from .accuracy import ISO_6336 as ISO_6336
from .accuracy import RIGID_TEETH as RIGID_TEETH
from .accuracy import STIFFNESS_TABLE as STIFFNESS_TABLE
from .accuracy import Accuracy as Accuracy
from .accuracy import Output as Output
from .schema import HUNTING_TOOTH_PERIOD as HUNTING_TOOTH_PERIOD
from .schema import LAST_CYCLES as LAST_CYCLES
from .schema import LOAD_WORDS as LOAD_WORDS
from .schema import Derived as Derived
from .schema import Load as Load
from .schema import Motion as Motion
from .write import html, text_of

if TYPE_CHECKING:
    from fenics_gears.contact.eccentricity import Eccentricity
    from fenics_gears.dynamics.bearings import Bearings
    from fenics_gears.dynamics.damping import Damping
    from fenics_gears.dynamics.inertia import Inertia
    from fenics_gears.dynamics.shafts import Shafts
    from fenics_gears.dynamics.torque_ripple import TorqueRipple
    from fenics_gears.effects.body_meshes import BodyMeshes
    from fenics_gears.effects.coast_flanks import CoastFlanks
    from fenics_gears.effects.corner_contact import EdgeRadii
    from fenics_gears.effects.friction import Friction
    from fenics_gears.effects.root_relief import RootRelief
    from fenics_gears.effects.speed_ramp import SpeedRamp
    from fenics_gears.effects.tip_relief import TipRelief
    from fenics_gears.effects.wheel_points import WheelPoints
    from fenics_gears.geometry.flank_errors import FlankErrors
    from fenics_gears.geometry.lead_modification import LeadModifications
    from fenics_gears.geometry.misalignment import Misalignment
    from fenics_gears.geometry.profile_modification import ProfileModifications


@dataclass(frozen=True)
class Scene:
    """All input of a run. Its `text` always says what its data are, also of a scene that ``dataclasses.replace``
    changed.

    One field for each effect of `effects.AT_THE_TOP`, in the same order, None where the scene does not name it.
    `derived`: what the scene leaves out of gears and load. `measured_over`: spanned teeth and ball diameter of
    pinion and wheel, where it names them. `written`: the text that it was read from. `folder`: from which its files are
    looked for. (Elastic teeth are an effect too: they are there where `gears` have a material.)
    """

    title: str
    gears: GearPairData
    load: Load
    motion: Motion
    accuracy: Accuracy = Accuracy()
    output: Output = Output()
    name: str = "scene"
    derived: tuple[Derived, ...] = ()
    body_meshes: BodyMeshes | None = None
    shafts: Shafts | None = None
    bearings: Bearings | None = None
    inertia: Inertia | None = None
    damping: Damping | None = None
    friction: Friction | None = None
    tip_relief: TipRelief | None = None
    root_relief: RootRelief | None = None
    lead_modifications: LeadModifications | None = None
    misalignment: Misalignment | None = None
    flank_errors: FlankErrors | None = None
    eccentricity: Eccentricity | None = None
    coast_flanks: CoastFlanks | None = None
    corner_contact: EdgeRadii | None = None
    torque_ripple: TorqueRipple | None = None
    speed_ramp: SpeedRamp | None = None
    profile_modifications: ProfileModifications | None = None
    wheel_points: WheelPoints | None = None
    measured_over: MeasuredOver = field(default=(NOT_GIVEN, NOT_GIVEN), compare=False, repr=False)
    written: str = field(default="", compare=False, repr=False)
    folder: str = field(default="", compare=False, repr=False)

    @cached_property
    def text(self) -> str:
        """The scene file that gives these data: as it was read where nothing was changed since, else written anew."""
        return text_of(self)

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        """The table that notebooks show."""
        return html(self)

    @property
    def mesh_frequencies(self) -> tuple[float, float]:
        """The lowest and the highest mesh frequency of the run, Hz."""
        ends = [self.motion.mesh_frequency] + ([self.speed_ramp.end_frequency] if self.speed_ramp is not None else [])
        return min(ends), max(ends)

    @property
    def given_load(self) -> float:
        """The load as the scene gives it: torque of the wheel or of the pinion, N mm, or power, N mm/s."""
        teeth = self.gears.teeth
        return self.load.wheel_torque / wheel_torque(self.load.given, 1.0, teeth, self.motion.mesh_frequency)

    @cached_property
    def tooth_elasticity(self) -> tuple[Material, Material] | None:
        """What makes the flanks of pinion and wheel elastic; None for rigid ones."""
        return None if self.accuracy.model == RIGID_TEETH else self.gears.materials

    @cached_property
    def three_dimensional(self) -> bool:
        """Whether the flanks are resolved over the face: where the scene names what has no meaning in a plane."""
        leaning = self.bearings is not None and self.bearings.places is not None
        return (
            self.gears.helix_angle > 0.0
            or self.lead_modifications is not None
            or self.misalignment is not None
            or leaning
            or (self.shafts is not None and (self.shafts.sections is not None or self.shafts.in_train))
        )

    @property
    def fineness(self) -> Fineness:
        """How finely flanks and steps are divided by default."""
        if not self.three_dimensional:
            return IN_THE_PLANE
        gears = self.gears
        overlap_ratio = gears.face_width * sin(gears.helix_angle) / (pi * gears.module)
        return WITH_OVERLAP if overlap_ratio >= 1.0 else OVER_THE_FACE

    @cached_property
    def resolves_contact(self) -> bool:
        """Whether contact is spread over nodes of elastic flanks, so that there are pressures."""
        return self.tooth_elasticity is not None and self.accuracy.model in (None, ELASTIC)
