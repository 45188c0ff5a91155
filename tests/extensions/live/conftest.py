"""A pair that is computed in a moment, and a connection that keeps what is said."""

import pytest

from fenics_gears.scene_text import parsed

PAIR = """
[gears]
module = "3 mm"
pressure_angle = "20 deg"
face_width = "20 mm"
pinion = { teeth = 20, profile_shift = 0.2, bore_diameter = "20 mm" }
wheel = { teeth = 31, profile_shift = 0, bore_diameter = "30 mm" }
material = "steel"

[load]
wheel_torque = "200 N m"

[accuracy]
element = "P1"
flank_element_size = "0.15 mm"
steps_per_mesh_cycle = 20
"""

TRAIN = """
[stages.idler]
kind = "row"
module = "3 mm"
pressure_angle = "20 deg"
face_width = "20 mm"
gears = [
    { teeth = 20, profile_shift = 0, bore_diameter = "20 mm" },
    { teeth = 25, profile_shift = 0, bore_diameter = "30 mm" },
    { teeth = 31, profile_shift = 0, bore_diameter = "30 mm" },
]
directions = ["0 deg", "60 deg"]
material = "steel"

[load]
output_torque = "200 N m"

[accuracy]
element = "P1"
flank_element_size = "0.15 mm"
steps_per_mesh_cycle = 20
"""

SET = """
[stages.set]
kind = "planetary"
module = "4 mm"
pressure_angle = "20 deg"
face_width = "50 mm"
planets = 3
sun = { teeth = 17, profile_shift = 0, bore_diameter = "20 mm" }
planet = { teeth = 22, profile_shift = 0, bore_diameter = "40 mm" }
ring = { teeth = 61, profile_shift = 0, outer_diameter = "280 mm", cutter = { teeth = 23 }, support = "held" }
material = "steel"
fixed = "ring"
input = "sun"
output = "carrier"
floating = ["sun"]

[stages.set.sun_mesh.tip_relief]
depth = "30 um"
start = "HPSTC"

[load]
input_torque = "1 kN m"

[motion]
input_speed = "1500 rpm"

[accuracy]
element = "P1"
flank_element_size = "0.15 mm"
steps_per_mesh_cycle = 20
"""


@pytest.fixture
def tree():
    return dict(parsed(PAIR, "pair.toml"))


class Spoken:
    """In the place of a connection: what was sent through it, and what waits to be received."""

    def __init__(self):
        self.sent, self.waiting = [], []

    def send(self, message):
        self.sent.append(message)

    def poll(self):
        return bool(self.waiting)

    def recv(self):
        if not self.waiting:
            raise EOFError
        return self.waiting.pop(0)

    def of(self, kind):
        """What was sent of a kind."""
        return [each for each in self.sent if each["kind"] == kind]


@pytest.fixture
def spoken():
    return Spoken()


@pytest.fixture
def train():
    return dict(parsed(TRAIN, "train.toml"))
