"""Natural frequencies of a set's lumped members, from its scene."""

from dataclasses import replace

import numpy as np
import pytest
from tests.planets import planetary

from fenics_gears.dynamics.frequencies import natural_frequencies
from fenics_gears.dynamics.planetary_modes import set_modes
from fenics_gears.dynamics.train import train_drivetrain
from fenics_gears.geometry.gear_data import LumpedGear
from fenics_gears.model.planetary_frequencies import lumped_set, set_frequency_rows
from fenics_gears.model.train import train_model_of
from fenics_gears.model.train_parts import parts_of
from fenics_gears.scene.train_mesh import gear_names

LUMPED = """
carrier = { pin_stiffness = "3e5 N/mm" }
[stages.set.vibration]
sun = { mass = "2 kg", moment_of_inertia = "1.2e-3 kg m^2" }
ring = { mass = "8 kg", moment_of_inertia = "0.1 kg m^2" }
carrier = { mass = "15 kg", moment_of_inertia = "0.09 kg m^2" }
planet = { mass = "2 kg", moment_of_inertia = "2e-3 kg m^2" }
"""


def row_of(planets: str, parts: tuple[str, str, str] = ("ring", "sun", "carrier")):
    """The row of a set with lumped members."""
    scene = planetary(teeth=(20, 16, 52), planets=planets, parts=parts, more=LUMPED)
    (row,) = train_model_of(scene).rows
    return row


@pytest.mark.parametrize("planets", ["planets = 3", 'planet_angles = ["0 deg", "90 deg", "190 deg"]'])
def test_with_its_carrier_at_rest_a_set_is_a_train(planets):
    """The same gears as an ordinary train, whose matrices are put together mesh by mesh in frames of their own; its
    first gear turns as prescribed."""
    row = row_of(planets, ("carrier", "sun", "ring"))
    lumped = lumped_set(row)
    held = replace(lumped, sun=replace(lumped.sun, torsion=None))
    own = {"set.sun": (2e-3, 1.2), "set.ring": (8e-3, 100.0)}
    masses = [LumpedGear(*own.get(gear, (2e-3, 2.0)), 40.0) for gear in gear_names(row.meshes)]
    parts = replace(parts_of(row.meshes, row.shafts), masses=masses)
    springs = np.tile(lumped.mesh_stiffness, 3)
    wanted = natural_frequencies(train_drivetrain(parts), springs)
    assert len(wanted) == 10
    assert [each.frequency for each in set_modes(held)] == pytest.approx(wanted.tolist(), rel=1e-9)


def test_rows_count_all_motions():
    """Four planets: held centres leave 3 x 4 of the planets, and rotations of sun and carrier."""
    rows = set_frequency_rows(row_of("planets = 4"))
    times = {"single": 1, "double": 2}
    modes = [name.split(", ") for name, _, _ in rows if ", " in name and name.startswith(("rot", "trans", "planet"))]
    assert sum(times[many] for _, many in modes) == 14
    assert [kind for kind, _ in modes].count("planet") == 3
    assert rows[1][1] == 0.0 and "rigid" in rows[1][2]
