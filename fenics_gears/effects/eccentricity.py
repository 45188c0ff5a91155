"""``[eccentricity]``: run-out of either gear and wobble of its teeth (``contact.run_out``)."""

from math import lcm

from fenics_gears.contact.eccentricity import Eccentricity
from fenics_gears.contact.run_out import RunOut
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.tree import GEARS, Tree, table

from .effect import Effect


def offsets_are_given(tree: Tree) -> Broken:
    for gear in GEARS:
        own = table(table(tree, "eccentricity") or {}, gear)
        if own is not None and not {"distance", "wobble"} & set(own):
            message = 'is missing. Allowed: such as "10 um"; or a wobble in a three-dimensional scene.'
            yield ("eccentricity", gear, "distance"), message


def gaps(eccentricity: Eccentricity, model):
    return RunOut(model.pair, eccentricity, model.resolution.steps_per_mesh_cycle)


def period(eccentricity: Eccentricity, scene) -> int:
    return lcm(*(getattr(scene.gears, name).teeth for name in GEARS if getattr(eccentricity, name) is not None))


EFFECT = Effect(
    section="eccentricity",
    description="eccentricity of the gears on their shafts (run-out), wobble of their teeth",
    absent="no run-out",
    fields=Eccentricity,
    terms=("gaps that vary once per revolution of the gear",),
    rules=offsets_are_given,
    gaps=gaps,
    period=period,
)
