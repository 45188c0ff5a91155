"""A helical pair for tests: 15 degrees, 18 and 35 teeth."""

from fenics_gears.scene.data import Scene
from fenics_gears.scene.read import scene_from_text

HELICAL = """
title = "Helical pair"
[gears]
module = "3 mm"
pressure_angle = "20 deg"
helix_angle = "15 deg"
centre_distance = "82.4 mm"
face_width = "30 mm"
[gears.pinion]
teeth = 18
profile_shift = 0.0
tip_diameter = "61.8 mm"
root_diameter = "48.3 mm"
bore_diameter = "20 mm"
[gears.wheel]
teeth = 35
profile_shift = 0.0
tip_diameter = "114.6 mm"
root_diameter = "101.1 mm"
bore_diameter = "40 mm"
[gears.material]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
[load]
wheel_torque = "300 N m"
[motion]
mesh_frequency = "200 Hz"
mesh_cycles = 1
recorded_cycles = 1
"""


def helical_scene(more: str = "") -> Scene:
    """That pair's scene, with more sections."""
    return scene_from_text(HELICAL + more)
