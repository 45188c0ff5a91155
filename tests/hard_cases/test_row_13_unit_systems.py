"""Row 13: the unit system of a scene must not change what comes out."""

import functools
import itertools
from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, quasi_static

from fenics_gears import simulate
from fenics_gears.scene.data import Accuracy

# Of each quantity the powers of length, force and time.
STRESS, TORQUE, STIFFNESS, PER_TIME = (-2, 1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, -1)
POWERS = {
    **{f"gears.{name}": (1, 0, 0) for name in ("module", "centre_distance", "face_width")},
    **{
        f"gears.{gear}.{name}": (1, 0, 0)
        for gear in ("pinion", "wheel")
        for name in ("tip_diameter", "root_diameter", "bore_diameter")
    },
    **{f"gears.{gear}material.youngs_modulus": STRESS for gear in ("", "pinion.", "wheel.")},
    "load.wheel_torque": TORQUE, "motion.mesh_frequency": PER_TIME,
    **{f"accuracy.{name}": (1, 0, 0) for name in ("flank_element_size", "contact_length", "body_element_size")},
    "shafts.torsional_stiffness": TORQUE, "bearings.stiffness": STIFFNESS,
    **{f"misalignment.{name}": (1, 0, 0) for name in ("in_plane", "out_of_plane")},
    "lead_modifications.pinion.crowning": (1, 0, 0),
    "inertia.mass": (-1, 1, 2), "inertia.moment_of_inertia": (1, 1, 2),
    "damping.stiffness_proportional": (0, 0, 1), "damping.mass_proportional": PER_TIME,
}  # fmt: skip


def in_units(scene, *units):
    """The scene's numbers in other units, each given as the new number of one old unit: mm, N, s."""
    for path, powers in POWERS.items():
        scene = scaled(scene, path.split("."), float(np.prod(np.power(units, powers))))
    return scene


def scaled(data, path, factor):
    """Data whose number at a path of fields is multiplied, where it is there."""
    name, *rest = path
    own = getattr(data, name)
    if own is None:
        return data
    return replace(data, **{name: scaled(own, rest, factor) if rest else factor * own})


SYSTEMS = {
    "SI (m, N, s)": (1e-3, 1.0, 1.0),
    "Young's modulus and forces x 1e6": (1.0, 1e6, 1.0),
    "gears three times as large, steel": (3.0, 9.0, 3.0),
    "inch, pound-force, minute": (1.0 / 25.4, 1.0 / 4.4482216152605, 1.0 / 60.0),
}


def default_accuracy(scene):
    return frictionless(quasi_static(replace(scene, accuracy=Accuracy(steps_per_mesh_cycle=40))))


MAKERS = {
    "quasi-static": quasi_static, "frictionless": frictionless, "all": lambda scene: scene,
    "default accuracy": default_accuracy
}  # fmt: skip


@pytest.fixture(scope="module")
def usual(paper_scene):
    """The scene that a maker makes, and its result in N, mm, s, simulated once."""

    @functools.cache
    def of(maker):
        scene = MAKERS[maker](coarse_scene(paper_scene))
        return scene, simulate(scene)

    return of


# By day each scene in one system.
BY_DAY = [*zip(MAKERS, SYSTEMS)]


@pytest.mark.parametrize(
    ("maker", "system"),
    [
        pytest.param(*each, marks=[pytest.mark.nightly] if each not in BY_DAY else [])
        for each in itertools.product(MAKERS, SYSTEMS)
    ],
)
def test_units_scale_out(system, maker, usual, measured):
    """Exact identity (dimensional analysis), iterations included."""
    scene, here = usual(maker)
    length, force, time = SYSTEMS[system]
    there = simulate(in_units(scene, length, force, time))
    scale = np.abs(here.transmission_error).max().item()
    angle = np.abs(there.transmission_error.values - here.transmission_error.values).max() / scale
    forces = np.abs(there.normal_force.values / force - here.normal_force.values).max() / here.normal_force.max().item()
    iterations = int(np.abs(there.newton_iterations.values - here.newton_iterations.values).max())
    measured(f"{system}: largest change", max(angle, forces), "1e-9")
    measured(f"{system}: change of the number of iterations", float(iterations), "0")
    assert angle <= 1e-9
    assert forces <= 1e-9
    assert iterations == 0
