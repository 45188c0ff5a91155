"""A short, coarse run over the face; it takes seconds."""

from dataclasses import replace
from functools import lru_cache

from tests.helical import wide_pair
from tests.internal import internal_scene

from fenics_gears import Load, scene_from_text, simulate
from fenics_gears.effects.coast_flanks import CoastFlanks
from fenics_gears.scene.data import Output

MORE = """
[misalignment]
in_plane = "10 um"
[accuracy]
slices = 5
layers = 3
body_element_size = "3 mm"
flank_element_size = "0.3 mm"
contact_length = "4 mm"
contact_nodes = 27
steps_per_mesh_cycle = 12
"""


@lru_cache
def helical_run():
    return simulate(wide_pair(MORE))


@lru_cache
def ring_run():
    """The planet of `tests.internal` in its ring, helical."""
    return simulate(scene_from_text(internal_scene(gears='helix_angle = "12 deg"', more=MORE)))


@lru_cache
def root_stress_run(coast: bool):
    """With friction, or driven from the wheel on its coast flanks."""
    scene = replace(
        wide_pair(("" if coast else "[friction]\ncoefficient = 0.08\n") + MORE), output=Output(root_stress=True)
    )
    if coast:
        scene = replace(scene, coast_flanks=CoastFlanks(), load=Load(-scene.load.wheel_torque))
    return scene, simulate(scene)
