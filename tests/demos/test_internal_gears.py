"""The demonstration of internal gears."""

from dataclasses import replace

from demos.internal_gears import planet_in_ring
from demos.internal_gears.picture import picture

from fenics_gears import load_scene, simulate
from fenics_gears.scene.data import Accuracy


def test_a_softer_support_makes_a_softer_mesh():
    """The demonstration's own words, on coarse bodies."""
    scene = load_scene(planet_in_ring.HERE / "planet_in_ring.toml")
    coarse = replace(
        scene,
        accuracy=Accuracy(
            element="P1", flank_element_size=0.2, contact_length=3.0, contact_nodes=20, steps_per_mesh_cycle=20
        ),
    )
    results = {each: simulate(planet_in_ring.supported(coarse, each)) for each in (None, 1000.0, 200.0)}
    rows = [planet_in_ring.row(*each) for each in results.items()]
    held, stiff, soft = (float(row[3]) for row in rows)
    assert held > 1.15 * stiff > 1.15 * 1.3 * soft
    assert float(rows[2][2]) < 2.0 * float(rows[0][2])
    assert [len(axes.get_lines()) for axes in picture(scene, results).axes] == [1, 3]
