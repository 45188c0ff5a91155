"""A spur pair over the face where it is the plane pair."""

from dataclasses import replace

import numpy as np
from tests.benchmarks.third_dimension.pairs import MODULE, in_plane, scene_of, standard_pair

from fenics_gears import Material, simulate
from fenics_gears.scene.data import Accuracy

ACCURACY = Accuracy(steps_per_mesh_cycle=8, flank_element_size=0.12, contact_length=1.6, contact_nodes=25)


def test_without_poissons_ratio_the_face_is_the_plane():
    """Exact identity: nothing varies along the face and nothing is held along it. Slices do not end where layers do."""
    gears = standard_pair(4.0 * MODULE, material=Material(206e3, 0.0))
    scene = scene_of(gears, ACCURACY)
    over_face = scene_of(gears, replace(ACCURACY, slices=5, layers=4))
    face, plane = simulate(over_face), simulate(in_plane(scene))
    np.testing.assert_allclose(face.transmission_error, plane.transmission_error, rtol=1e-10)
    loads = face.line_load.sum("slot")
    np.testing.assert_allclose(loads / loads.mean("face_position"), 1.0, rtol=1e-9)
