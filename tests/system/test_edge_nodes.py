"""Hand-over, where flanks touch with an edge alone: what a contact node close to the edge gains."""

from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import frictionless, quasi_static

from fenics_gears import resolution
from fenics_gears.contact.window import EVEN
from fenics_gears.scene.data import Accuracy, Motion
from fenics_gears.simulation import simulate


@pytest.fixture(scope="module")
def curves(paper_scene):
    """T_E (um) of the paper's pair by spacing of contact nodes (mm) and edge: resolved or not."""
    scene = replace(quasi_static(frictionless(paper_scene)), motion=Motion(200.0, 1, 1))
    found = {}
    for resolved in (True, False):
        with pytest.MonkeyPatch.context() as patch:
            if not resolved:
                patch.setattr(resolution, "EDGE_CELLS", EVEN)
            for nodes in (16, 31, 61):
                accuracy = Accuracy(element="P2", flank_element_size=0.08, contact_length=2.4, contact_nodes=nodes, steps_per_mesh_cycle=50)
                run = simulate(replace(scene, accuracy=accuracy))
                assert "give way together" not in run.attrs["warnings"]
                found[2.4 / (nodes - 1), resolved] = run.transmission_error.values * run.attrs["base_radius_wheel"] * 1e3
    return found


def error(curves, spacing: float, resolved: bool) -> float:
    return float(np.linalg.norm(curves[spacing, resolved] - curves[0.04, True]))


def test_a_node_next_to_the_edge_takes_most_of_the_error(curves):
    """Known order: averaged over half a hat of width h the gap at an edge is too wide in proportion to h; without that, errors fall as h^2."""
    assert error(curves, 0.16, True) < 0.5 * error(curves, 0.16, False)
    assert error(curves, 0.08, True) < 0.35 * error(curves, 0.08, False)
    assert error(curves, 0.08, True) < 0.35 * error(curves, 0.16, True)


def test_both_grids_have_one_limit(curves):
    """Two routes to the same number: the even grid comes nearer to the other as it is refined."""
    assert error(curves, 0.04, False) < 0.6 * error(curves, 0.08, False) < 0.4 * error(curves, 0.16, False)
