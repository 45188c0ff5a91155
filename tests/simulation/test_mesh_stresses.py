"""Gears of a mesh of a train recovered under the forces of all meshes that they are in."""

import numpy as np
import pytest
from tests.planets import planetary
from tests.simulation.test_run_stresses import opening_of
from tests.trains import helical_row, row, split_text

from fenics_gears import simulate_train, train_from_text
from fenics_gears.simulation.mesh_stresses import MeshStresses
from fenics_gears.simulation.run_stresses import RunStresses
from fenics_gears.simulation.stored_forces import stored_forces

TRAINS = {
    "an idler": lambda: row((24, 31, 40), (0, 60), 300.0),
    "an idler wedged between its mates": lambda: row(
        (24, 31, 40), (0, 100), 300.0, more='[stages.row.coast_flanks]\n[bearings]\nstiffness = "5e4 N/mm"\n'
    ),
    "two mates on one flank": lambda: train_from_text(split_text()),
    "a planetary set": planetary,
}


@pytest.mark.parametrize("name", TRAINS)
def test_flanks_touch_where_the_pressure_is(name):
    """Signorini: the displacement by the forces of all meshes closes the gap at every node under pressure, and leaves
    none negative; without those of the other meshes it does not."""
    train = TRAINS[name]()
    found = simulate_train(train)
    for number in range(len(train.meshes)):
        with MeshStresses(found, train, number) as stresses:
            for index in (0, 7):
                stored = stored_forces(stresses.result, stresses.model, stresses.cycle, index)
                assert any(np.any(force) for force in stored.forces)
                closed, others = opening_of(stresses, stored, stresses.forces)
                assert np.abs(closed).max() < 1e-9 and others.min(initial=0.0) > -1e-9
            alone, _ = opening_of(stresses, stored, lambda gear, own: RunStresses.forces(stresses, gear, own))
            assert np.abs(alone).max() > 1e-7


@pytest.mark.nightly
def test_over_the_face_as_in_the_plane():
    """A spur row over the face without Poisson's effect: what the forces of the other mesh add to the displacement of
    the roots of the idler's loaded teeth is as in the plane; elements have other sizes."""
    added = []
    for more in ("", '[stages.row.misalignment]\nin_plane = "0 um"'):
        train = helical_row((24, 31, 40), (0, 60), 300.0, helix=0.0, poissons_ratio=0.0, more=more)
        with MeshStresses(simulate_train(train), train, 0) as stresses:
            moved = [_roots_of_the_idler(stresses)]
            stresses.forces = lambda gear, own, stresses=stresses: RunStresses.forces(stresses, gear, own)
            moved.append(_roots_of_the_idler(stresses))
        added.append(np.linalg.norm(moved[0] - moved[1]))
    assert added[0] > 0.2 * np.linalg.norm(moved[1])
    assert added[1] == pytest.approx(added[0], rel=0.01)


def _roots_of_the_idler(stresses: MeshStresses) -> np.ndarray:
    """Mean displacement (2,), mm, of the roots of three teeth in mesh."""
    idler = stresses.at(3).gears[1]
    loaded = [place for place, tooth in enumerate(idler.sectors) if tooth % 31 in (0, 30, 29)]
    return idler.elastic[loaded][:, :, idler.in_root, :2].mean(axis=(0, 1, 2))
