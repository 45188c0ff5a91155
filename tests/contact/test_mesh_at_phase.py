"""A mesh whose pairs are further on their way, as the second mesh of an idler is."""

import numpy as np
import pytest
from tests.helical import helical_scene, on_stand_in_bodies

from fenics_gears.contact.face_mesh import face_mesh, opening_over_face
from fenics_gears.contact.mesh_cycle import Cycle, Gaps
from fenics_gears.contact.row import at_phase
from fenics_gears.contact.tooth_pair import Flanks
from fenics_gears.model.model import model_of

LEANING = """
[corner_contact]
[misalignment]
in_plane = "20 um"
"""


@pytest.mark.parametrize("step", [0, 5, 13])
def test_a_mesh_begun_at_a_phase_is_the_mesh_at_that_phase(step):
    """Identity: contact nodes, gaps of flanks and tip edges that stand back along the face, and pairs' numbers."""
    model = model_of(helical_scene(LEANING))
    bodies = on_stand_in_bodies(model)
    flanks = Flanks(model.pair, tuple(body.section for body in bodies))
    solids = tuple(body.solid for body in bodies)
    mesh = face_mesh(flanks, solids, model.face, model.resolution.contact_grid, model.corner)

    def operator(mesh, step):
        cycle = Cycle(mesh, 16, model.drivetrain.indices, False)
        opening = opening_over_face(cycle, model.face_opening)
        return cycle.with_gaps(Gaps(openings=(opening,))).position(step).operator

    ahead = operator(at_phase(mesh, 0.375), step)
    itself = operator(mesh, step + 6)
    later = (step + 6) // 16
    assert any(pair.place.line is not None for pair in itself.pairs)
    assert [pair.place.index + later for pair in ahead.pairs] == [pair.place.index for pair in itself.pairs]
    assert ahead.gap == pytest.approx(itself.gap, rel=1e-9, abs=1e-12)
    np.testing.assert_allclose(ahead.compliance, itself.compliance, rtol=1e-9, atol=1e-15)
