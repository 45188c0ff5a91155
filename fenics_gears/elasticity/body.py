"""The elasticity of one gear as its flanks see it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fenics_gears.elasticity.compliance import FlankCompliance
    from fenics_gears.elasticity.face_compliance_data import FaceCompliance
    from fenics_gears.elasticity.whole_body.compliance import WholeBodyCompliance

STAGES = ("time_mesh", "time_compile", "time_condense")


@dataclass(frozen=True)
class Body:
    """A gear: flank compliance of its `section` in plane strain, and where flanks are resolved over the face that of
    the `solid` in three dimensions, whose contact the finer section corrects.

    timings: seconds that both took, by stage.
    """

    section: FlankCompliance | WholeBodyCompliance
    solid: FaceCompliance | None = None
    timings: dict[str, float] = field(default_factory=dict, compare=False)

    @classmethod
    def of(cls, section: FlankCompliance | WholeBodyCompliance, solid: FaceCompliance | None = None) -> Body:
        """The gear of these, with the times of both."""
        parts = [section.timings] if solid is None else [section.timings, solid.timings]
        return cls(section, solid, {name: sum(part[name] for part in parts) for name in STAGES})


Bodies = tuple[Body, Body]
