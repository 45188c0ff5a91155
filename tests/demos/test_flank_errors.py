"""The demonstration of errors of manufacture."""

from dataclasses import replace

import pytest
from demos.flank_errors.order_spectrum import SCENE, named_lines
from tests.coarse import COARSE

from fenics_gears import load_scene, simulate
from fenics_gears.show.orders import order_spectrum
from fenics_gears.show.run import ShownRun


@pytest.mark.nightly
def test_the_picture_names_every_error_of_the_scene():
    """The scene: run-out, 37 waves, tolerance class 6, 48 mesh cycles so that every line stands alone."""
    scene = load_scene(SCENE)
    assert (scene.motion.mesh_cycles, scene.motion.recorded_cycles) == (48, 48)
    assert scene.flank_errors.tolerance_class == 6
    result = simulate(replace(scene, accuracy=COARSE))
    chart = order_spectrum(ShownRun(result))
    flags = {flag.words: flag for flag in chart.flags}
    named = {
        "mesh",
        "mesh − 1",
        "mesh + 1",
        "run-out of the pinion",
        "run-out of the wheel",
        "ghost order: 37 waves on the pinion",
    }
    assert named <= set(flags)
    heights = {curve.name: curve.y for curve in chart.curves}
    # Run-out of 10 and 15 um and pitch errors of the same size: the largest lines are those of the turns.
    assert 5.0 < heights["turn of the pinion"].max() < 25.0 and 5.0 < heights["turn of the wheel"].max() < 30.0
    ghost = flags["ghost order: 37 waves on the pinion"]
    # A wave of 1 um, seen by one or two pairs in contact patches shorter than itself.
    assert ghost.x == 37.0 and 0.5 < ghost.y < 1.1
    # What the README says of them: the mesh's own lines stand out of its sidebands, the ghost order out of its
    # neighbours.
    lines = named_lines(result)
    assert lines["ghost order of 37 waves on the pinion"] == pytest.approx(ghost.y, rel=1e-12)
    assert lines["mesh"] > 5.0 * max(amplitude for name, amplitude in lines.items() if name.startswith("sideband"))
    assert lines["run-out of the wheel"] > lines["run-out of the pinion"] > lines["mesh"]
