"""Gears that several geometry tests start from."""

from math import atan, cos, radians, tan

import pytest

from fenics_gears import Gear, gear_pair
from fenics_gears.scene.data import GearData, GearPairData, Material


@pytest.fixture
def paper_data():
    """Lundvall, Stromberg & Klarbring 2004, Table 2; the bores are ours."""
    return GearPairData(
        module=4.5,
        pressure_angle=radians(20.0),
        centre_distance=91.5,
        face_width=15.0,
        pinion=GearData(16, 0.196, 82.64, 62.50, 30.0, 0.38),
        wheel=GearData(24, 0.125, 118.64, 98.37, 40.0, 0.38),
        material=Material(206e3, 0.3),
    )


@pytest.fixture
def paper_pair(paper_data):
    return gear_pair(paper_data)


@pytest.fixture
def cut_gear():
    """A gear by its proportions in normal modules; angles in degrees, in the normal section."""

    def cut(
        teeth,
        profile_shift=0.0,
        addendum=1.0,
        dedendum=1.25,
        rack_tip=0.38,
        module=1.0,
        pressure_angle=20.0,
        helix_angle=0.0,
    ):
        cosine = cos(radians(helix_angle))
        pitch = 0.5 * teeth / cosine + profile_shift
        return Gear(
            teeth=teeth,
            module=module / cosine,
            pressure_angle=atan(tan(radians(pressure_angle)) / cosine) if helix_angle else radians(pressure_angle),
            profile_shift=profile_shift * cosine,
            helix_angle=radians(helix_angle),
            tip_radius=module * (pitch + addendum),
            root_radius=module * (pitch - dedendum),
            bore_radius=module * 0.2 * teeth,
            rack_tip_radius=module * rack_tip,
        )

    return cut
