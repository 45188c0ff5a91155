"""The paper's pair on a coarse mesh; each run takes a fraction of a second."""

from dataclasses import replace

from fenics_gears.effects import without
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.scene.data import Accuracy, Motion
from fenics_gears.simulation.routes import prepared
from fenics_gears.system.progress import SilentProgress

COARSE = Accuracy(element="P1", flank_element_size=0.12, contact_length=3.0, contact_nodes=26, steps_per_mesh_cycle=40)


def coarse_scene(paper_scene, cycles: int = 2):
    """The last of `cycles` mesh cycles kept."""
    return replace(paper_scene, accuracy=COARSE, motion=Motion(200.0, cycles, 1))


def quasi_static(scene, **changes):
    """Without inertia."""
    return replace(scene, inertia=None, damping=None, **changes)


def frictionless(scene):
    return replace(scene, friction=None)


def teeth_alone(scene):
    """On rigid shafts and bearings, without inertia."""
    return quasi_static(scene, shafts=None, bearings=None)


def cycle_of(model):
    """Its mesh cycle, whose gears are in the cache."""
    return prepared(model, SilentProgress(), user_cache())[1]


def rigid_pair(scene):
    """Rigid flanks on rigid shafts and bearings, quasi-static."""
    return without(scene, "tooth_elasticity", "friction", "inertia", "damping", "shafts", "bearings")
