"""Row 12: in what order nodes, cells, contact nodes and gears are numbered must not matter."""

import numpy as np
import pytest
from tests.coarse import coarse_scene, frictionless, quasi_static
from tests.coarse_sector import PINION, coarse_condensed_sector, coarse_sector_mesh, relative
from tests.permuted_cycle import solved_in_other_order

from fenics_gears import simulate
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.mesh_data import BodyMesh
from fenics_gears.elasticity.ring import condensed_sector, ring_compliance

SCENES = {
    "quasi-static, friction": quasi_static,
    "quasi-static, frictionless": lambda scene: frictionless(quasi_static(scene)),
    "200 Hz, friction": lambda scene: scene,
}


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.nightly)])
@pytest.mark.parametrize("name", SCENES)
def test_order_of_contact_nodes_and_gears(name, seed, paper_scene, measured):
    """Exact identity: shuffled equations have the same solution."""
    scene = SCENES[name](coarse_scene(paper_scene))
    plain, shuffled = simulate(scene), solved_in_other_order(scene, seed)
    of_both = [(each.transmission_error.values, each.contact_pressure.fillna(0.0).values) for each in (shuffled, plain)]
    is_the_same(*of_both, name, "pressure", measured)


def is_the_same(shuffled, plain, case, second, measured):
    """Transmission error and a second array of shuffled unknowns against those of the usual order."""
    change, other = (relative(one - usual, usual) for one, usual in zip(shuffled, plain))
    measured(
        f"contact nodes and gears shuffled, {case}: change of transmission error, of {second}",
        f"{change:.1g}, {other:.1g}",
        "1e-11",
        row=12,
    )
    assert change <= 1e-11
    assert other <= 1e-11


def renumbered(mesh: BodyMesh, seed: int) -> BodyMesh:
    """The same mesh with nodes and cells shuffled, and every cell's corners begun at another one."""
    random = np.random.default_rng(seed)
    order = random.permutation(len(mesh.points))
    index = np.argsort(order)
    cells = index[random.permutation(mesh.cells)]
    first = random.integers(cells.shape[1], size=len(cells))
    cells = np.take_along_axis(cells, (first[:, None] + np.arange(cells.shape[1])) % cells.shape[1], axis=1)
    edges = {name: index[random.permutation(edge)] for name, edge in mesh.edges.items()}
    return BodyMesh(mesh.points[order], cells, edges)


@pytest.mark.parametrize("name", ELEMENTS)
def test_order_of_mesh_nodes_and_cells(name, measured):
    """Exact identity: the stiffness is a sum over cells, and nodes are found by their place."""
    shuffled = condensed_sector(renumbered(coarse_sector_mesh(name), 5), ELEMENTS[name], 0.3)
    blocks = [ring_compliance(sector, PINION.teeth, 2) for sector in (shuffled, coarse_condensed_sector(name))]
    change = relative(blocks[0] - blocks[1], blocks[1])
    measured(f"mesh nodes and cells shuffled, {name}: change of the compliance", change, 1e-11)
