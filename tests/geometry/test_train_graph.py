"""Trains as graphs."""

from itertools import combinations

import pytest

from fenics_gears.geometry.train_graph import TrainGraph, groups

# Two paths; two stages, of which the second is one of three paths; a row behind two paths that meet.
GRAPHS = (
    TrainGraph(((0, 1), (0, 2), (3, 4), (5, 4)), (0, 1, 2, 1, 3, 2)),
    TrainGraph(
        ((0, 1), (2, 3), (2, 4), (2, 5), (6, 9), (7, 9), (8, 9)), (0, 1, 1, 2, 3, 4, 2, 3, 4, 5)
    ),
    TrainGraph(((0, 1), (0, 2), (1, 3), (2, 3), (3, 4)), (0, 1, 2, 3, 4)),
    TrainGraph(((0, 1), (2, 3), (4, 5)), (0, 1, 1, 2, 2, 3)),
)  # fmt: skip


@pytest.mark.parametrize("graph", GRAPHS)
def test_meshes_that_touch_hold_all_shafts_where_every_cut_has_one(graph):
    """Brute force over all sets of meshes: the first shaft's turn reaches all shafts through meshes that touch if, and
    only if, each part that could turn by itself has one that touches between it and the others."""
    meshes = range(len(graph.gears))
    for count in range(len(graph.gears) + 1):
        for touching in combinations(meshes, count):
            reached = len(groups(range(graph.last + 1), [graph.between[mesh] for mesh in touching])) == 1
            held = all(any(len({*graph.between[mesh]} & {*part}) == 1 for mesh in touching) for part in graph.cuts)
            assert reached == held


def test_a_chain_has_a_cut_for_each_mesh():
    """All behind it."""
    assert GRAPHS[3].cuts == [[1, 2, 3], [2, 3], [3]]
    assert GRAPHS[3].is_chain
    assert not GRAPHS[0].is_chain
