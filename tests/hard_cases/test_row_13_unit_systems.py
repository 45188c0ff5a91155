"""Row 13: the unit system of a scene must not change what comes out."""

import functools
import itertools
from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, quasi_static

from fenics_gears import simulate
from fenics_gears.scene.data import Accuracy


def in_units(scene, length, force, time):
    """The scene's numbers in other units, each given as the new number of one old unit: mm, N, s."""
    gears, motion, accuracy = scene.gears, scene.motion, scene.accuracy

    def of(material):
        return material and replace(material, youngs_modulus=force / length**2 * material.youngs_modulus)

    def gear(data):
        diameters = ("tip_diameter", "root_diameter", "bore_diameter")
        sizes = {name: length * getattr(data, name) for name in diameters}
        return replace(data, **sizes, material=of(data.material))

    changes = {
        "gears": replace(
            gears,
            module=length * gears.module,
            centre_distance=length * gears.centre_distance,
            face_width=length * gears.face_width,
            pinion=gear(gears.pinion),
            wheel=gear(gears.wheel),
            material=of(gears.material),
        ),
        "load": replace(scene.load, wheel_torque=force * length * scene.load.wheel_torque),
        "motion": replace(motion, mesh_frequency=motion.mesh_frequency / time),
    }
    sizes = ("flank_element_size", "contact_length", "body_element_size")
    given = {name: length * size for name in sizes if (size := getattr(accuracy, name)) is not None}
    changes["accuracy"] = replace(accuracy, **given)
    if scene.shafts is not None:
        changes["shafts"] = replace(scene.shafts, torsional_stiffness=force * length * scene.shafts.torsional_stiffness)
    if scene.bearings is not None:
        changes["bearings"] = replace(scene.bearings, stiffness=force / length * scene.bearings.stiffness)
    if scene.misalignment is not None:
        sides = ("in_plane", "out_of_plane")
        changes["misalignment"] = replace(
            scene.misalignment, **{name: length * getattr(scene.misalignment, name) for name in sides}
        )
    if scene.lead_modifications is not None:
        own = scene.lead_modifications.pinion
        own = replace(own, crowning=length * own.crowning)
        changes["lead_modifications"] = replace(scene.lead_modifications, pinion=own)
    if scene.inertia is not None:
        changes["inertia"] = replace(
            scene.inertia,
            mass=force * time**2 / length * scene.inertia.mass,
            moment_of_inertia=force * length * time**2 * scene.inertia.moment_of_inertia,
        )
    if scene.damping is not None:
        changes["damping"] = replace(
            scene.damping,
            stiffness_proportional=time * scene.damping.stiffness_proportional,
            mass_proportional=scene.damping.mass_proportional / time,
        )
    return replace(scene, **changes)


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


# By day all effects in every system, and each of the others in one.
BY_DAY = [*(("all", system) for system in SYSTEMS), *((maker, "inch, pound-force, minute") for maker in MAKERS)]


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
