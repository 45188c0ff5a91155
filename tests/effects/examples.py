"""One example of every effect's section; an effect that is added has its example here."""

from pathlib import Path

from fenics_gears import Scene, scene_from_text
from fenics_gears.effects import SECTIONS, effect_named

MESHES = Path(__file__).parents[2] / "meshes"

BASE = """
title = "Example"

[gears]
module = "4.5 mm"
pressure_angle = "20 deg"
centre_distance = "91.5 mm"
face_width = "15 mm"

[gears.pinion]
teeth = 16
profile_shift = 0.196
tip_diameter = "82.64 mm"
root_diameter = "62.50 mm"
bore_diameter = "30 mm"

[gears.wheel]
teeth = 24
profile_shift = 0.125
tip_diameter = "118.64 mm"
root_diameter = "98.37 mm"
bore_diameter = "40 mm"

[load]
wheel_torque = "437 N m"

[motion]
mesh_frequency = "200 Hz"
mesh_cycles = 1

[accuracy]
element = "P1"
flank_element_size = "0.12 mm"
contact_length = "3 mm"
contact_nodes = 26
steps_per_mesh_cycle = 20
"""

EXAMPLES = {
    "tooth_elasticity": """
[gears.material]
youngs_modulus = "206 GPa"
poissons_ratio = 0.3
""",
    "body_meshes": """
[body_meshes]
pinion = "meshes/cracked_pinion.msh"
""",
    "wheel_points": """
[wheel_points]
count = 8
radial_stiffness = "2e5 N/mm"
tangential_stiffness = "2e5 N/mm"
""",
    "shafts": """
[shafts]
torsional_stiffness = "0.203e9 N mm/rad"
""",
    "bearings": """
[bearings]
stiffness = "0.155e6 N/mm"
""",
    "inertia": """
[inertia]
mass = "4.9 kg"
moment_of_inertia = "24.5e-3 kg m^2"
""",
    "damping": """
[damping]
stiffness_proportional = "0.4e-3 s"
mass_proportional = "0.5e-3 1/s"
""",
    "friction": """
[friction]
coefficient = 0.1
""",
    "tip_relief": """
[tip_relief]
depth = "31 um"
start = "HPSTC"
""",
    "profile_modifications": """
[profile_modifications.pinion]
crowning = "4 um"
[profile_modifications.wheel]
slope = "5 um"
""",
    "root_relief": """
[root_relief]
depth = "10 um"
start = "LPSTC"
""",
    "lead_modifications": """
[lead_modifications.pinion]
crowning = "6 um"
""",
    "misalignment": """
[misalignment]
in_plane = "12 um"
""",
    "flank_errors": """
[flank_errors]
tolerance_class = 6
""",
    "eccentricity": """
[eccentricity.wheel]
distance = "10 um"
""",
    "coast_flanks": """
[coast_flanks]
""",
    "corner_contact": """
[corner_contact]
edge_radius = "0.1 mm"
""",
    "torque_ripple": """
[torque_ripple]
harmonics = [{ order = 1, amplitude = "20 N m" }]
""",
    "speed_ramp": """
[speed_ramp]
end_frequency = "260 Hz"
""",
}


def with_needs(*sections: str) -> tuple[str, ...]:
    closed = set(sections)
    while more := {need for each in closed for need in effect_named(each).needs} - closed:
        closed |= more
    return tuple(each for each in SECTIONS if each in closed)


OVER_FACE = {"lead_modifications", "misalignment"}
COARSE_BODIES = 'slices = 3\nlayers = 1\nbody_element_size = "6 mm"\n'


def text_of(*sections: str) -> str:
    """Meshes are found wherever the text is read."""
    more = COARSE_BODIES if OVER_FACE & set(sections) else ""
    return BASE + more + "".join(EXAMPLES[section] for section in sections).replace('"meshes/', f'"{MESHES}/')


def scene_of(*sections: str) -> Scene:
    return scene_from_text(text_of(*sections), "example")
