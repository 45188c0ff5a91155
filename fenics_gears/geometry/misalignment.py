"""How far the axes of a pair depart from parallel."""

from dataclasses import dataclass

from fenics_gears.inputs.fields import quantity
from fenics_gears.inputs.section import Section


def _deviation(example: str, meaning: str):
    return quantity("-100 mm to 100 mm", example, meaning=meaning, default="0 um", small=True)


@dataclass(frozen=True)
class Misalignment(Section):
    """``[misalignment]``: departure of the wheel's axis from parallel, as lengths over the common face width. The axis
    turns about the pitch point in the middle of the common face, so that half an amount opens one end and half closes
    the other. ISO/TR 10064-3 has such deviations in the plane of both axes and perpendicular to it; these are in the
    plane of action and perpendicular to it. Viewed from the right end the pinion turns counter-clockwise."""

    empty = 'names no deviation. Add in_plane or out_of_plane, such as "12 um", or leave the section out.'

    in_plane: float = _deviation(
        "12 um",
        "in the plane of action: positive where the right end of the wheel's axis moves away from the pinion along the"
        " line of action",
    )
    out_of_plane: float = _deviation(
        "0 um",
        "perpendicular to the plane of action: positive where the right end of the wheel's axis moves towards the side"
        " of the pinion's axis; opens nothing between drive flanks, whose contact points it moves in the plane of the"
        " flanks, but something between coast flanks",
    )

    @property
    def is_none(self) -> bool:
        """Whether the axes are parallel: who names zero has the flanks resolved over the face."""
        return self.in_plane == self.out_of_plane == 0.0
