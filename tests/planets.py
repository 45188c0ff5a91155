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
# Stepped planets with a ring, and with a second sun.
RINGED = {"teeth": (17, 20, 53), "step": 16, "planets": "planets = 3"}
TWO_SUNS = {
    "teeth": (20, 24, 26), "step": 18, "second": "second_sun", "planets": "planets = 4",
    "parts": ("second_sun", "sun", "carrier"),
}  # fmt: skip
COARSE = 'steps_per_mesh_cycle = 12\nflank_element_size = "0.3 mm"'


def written_out(
    teeth: tuple[int, int, int], angles: list[float], accuracy: str = COARSE, helix: str | None = None
) -> TrainScene:
    """Sun, planets at these angles (degrees) and ring as a train of pairs, under a torque on the ring; `helix`: the
    angle of their teeth, the sun's right-handed."""
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
            own = f'pinion = {pinion}\nwheel = {wheel}\ndirection = "{angle!r} deg"'
            if helix is not None:
                own += f'\nhelix_angle = "{helix}"'
            stages += f"[stages.{name}]\n{SHARED}\n{own}\n"
    return train_from_text(f'{stages}\n[load]\noutput_torque = "2 kN m"\n[accuracy]\n{accuracy}\n')


def planetary_text(
    teeth: tuple[int, int, int] = (17, 18, 53),
    planets: str = "planets = 2",
    parts: tuple[str, str, str] = ("ring", "sun", "carrier"),
    more: str = "",
    load: str = 'input_torque = "600 N m"',
    accuracy: str = COARSE,
    sections: str = "",
    step: int | None = None,
    second: str = "ring",
) -> str:
    """The scene of a planetary set; `parts`: what is fixed, input and output; `more` of the stage; `step`: teeth of the
    second gear of stepped planets; `second`: ring, or second_sun in its place."""
    sun, planet, ring = teeth
    of_ring = (
        f'outer_diameter = "{4 * ring + 60} mm", support = "held"' if second == "ring" else 'bore_diameter = "20 mm"'
    )
    stepped = f'step = {{ teeth = {step}, profile_shift = 0, bore_diameter = "30 mm" }}' if step else ""
    fixed, driven, loaded = parts
    return f"""
[stages.set]
kind = "planetary"
{SHARED}
{planets}
sun = {{ teeth = {sun}, profile_shift = 0, bore_diameter = "20 mm" }}
planet = {{ teeth = {planet}, profile_shift = 0, bore_diameter = "30 mm" }}
{stepped}
{second} = {{ teeth = {ring}, profile_shift = 0, {of_ring} }}
fixed = "{fixed}"
input = "{driven}"
output = "{loaded}"
{more}
[load]
{load}
[accuracy]
{accuracy}
{sections}
"""


def planetary(**options) -> TrainScene:
    """A planetary set; options are those of `planetary_text`."""
    return train_from_text(planetary_text(**options))


def in_time_text(
    speed: float = 1500,
    cycles: int = 1,
    *,
    more: str = "",
    pins: str = "",
    sun_springs: str = "",
    ring_springs: str = "",
    sections: str = "",
    inertia: str = "[inertia]",
    **options,
) -> str:
    """A planetary set with masses, its input at a `speed` (rpm); `pins`, `sun_springs`, `ring_springs`: more of the
    carrier's pins and of members. Without `inertia` it is at rest."""
    lumped = f"""
carrier = {{ pin_stiffness = "3e5 N/mm"{pins} }}
{more}
[stages.set.vibration]
sun = {{ mass = "2 kg", moment_of_inertia = "1.2e-3 kg m^2"{sun_springs} }}
ring = {{ mass = "8 kg", moment_of_inertia = "0.1 kg m^2"{ring_springs} }}
carrier = {{ mass = "15 kg", moment_of_inertia = "0.09 kg m^2" }}
planet = {{ mass = "2 kg", moment_of_inertia = "2e-3 kg m^2" }}
[stages.set.sun_mesh]
tip_relief = {RELIEF}
[stages.set.ring_mesh]
tip_relief = {RELIEF}
"""
    motion = f'[motion]\ninput_speed = "{speed} rpm"\nmesh_cycles = {cycles}\n'
    asked = {"teeth": (20, 16, 52), "planets": "planets = 3"} | options
    return planetary_text(more=lumped, sections=f"{inertia}\n{sections}\n{motion}", **asked)


def in_time(speed: float, cycles: int = 1, **options) -> TrainScene:
    """A planetary set with masses; options are those of `in_time_text`."""
    return train_from_text(in_time_text(speed, cycles, **options))
