"""Planets between a sun and a ring for tests, with coarse elements."""

from fenics_gears import train_from_text
from fenics_gears.scene.train import TrainScene

SHARED = """
    module = "4 mm"
    pressure_angle = "20 deg"
    face_width = "40 mm"
    material = "steel"
    """
RELIEF = '{ depth = "20 um", start = "HPSTC", shape = "parabolic" }'
COARSE = 'steps_per_mesh_cycle = 12\nflank_element_size = "0.3 mm"'


def written_out(teeth: tuple[int, int, int], angles: list[float], more: str = "") -> TrainScene:
    """Sun, planets at these angles (degrees) and ring as a train of pairs, under a torque on the ring; `more`: of each
    mesh."""
    sun, planet, ring = (f"teeth = {each}, profile_shift = 0" for each in teeth)
    stages = ""
    for number, angle in enumerate(angles):
        gears = {
            f"sun{number}": (f'{{ {sun}, bore_diameter = "20 mm" }}' if number == 0 else '"sun0.pinion"'),
            f"ring{number}": f'"sun{number}.wheel"',
        }
        wheels = (
            f'{{ {planet}, bore_diameter = "30 mm" }}',
            f'{{ {ring}, internal = true, outer_diameter = "{4 * teeth[2] + 60} mm", support = "held" }}'
            if number == 0
            else '"ring0.wheel"',
        )
        for (name, pinion), wheel in zip(gears.items(), wheels):
            own = f'pinion = {pinion}\nwheel = {wheel}\ndirection = "{angle!r} deg"\n{more}'
            stages += f"[stages.{name}]\n{SHARED}\n{own}\n"
    return train_from_text(f'{stages}\n[load]\noutput_torque = "2 kN m"\n[accuracy]\n{COARSE}\n')
