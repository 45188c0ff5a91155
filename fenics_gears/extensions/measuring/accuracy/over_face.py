"""What `gears accuracy` refines of flanks that are resolved over the face, and the plane model to compare with. A run
takes ten times as long as in the plane."""

from dataclasses import replace
from math import atan, cos, tan

from fenics_gears import Scene

SLICES = "slices"
LAYERS = "layers"
# Values as `refinement.Plan` has them; slices and layers in parts of their defaults.
FAMILY = "flank elements and contact nodes"
FLANK = "flank element size"
BODY = "body element size"
STEPS = "steps per mesh cycle"
LENGTH = "contact length"
FULL: dict[str, tuple[float, ...]] = {
    SLICES: (0.25, 0.5, 1.0, 2.0), LAYERS: (0.5, 1.0, 2.0), BODY: (2.0, 1.4, 1.0), FAMILY: (0.7, 1.4, 2.8),
    STEPS: (10, 20, 40), LENGTH: (0.75, 1.0),
}  # fmt: skip
QUICK: dict[str, tuple[float, ...]] = {
    SLICES: (0.25, 0.5, 1.0), LAYERS: (0.5, 1.0), BODY: (2.0, 1.4), FAMILY: (0.7, 1.4), STEPS: (10, 20), LENGTH: (1.0,),
}  # fmt: skip
FINE = {FLANK: 1.4, BODY: 1.4, LENGTH: 1.0, STEPS: 20, SLICES: 1.0, LAYERS: 1.0}
QUICK_FINE = {**FINE, FLANK: 0.7, SLICES: 0.5, LAYERS: 0.5}
# Targets whose settings are run in addition.
TARGETS = (0.05, 0.02)
# Order of their errors, and why.
ORDERS = {
    SLICES: (2.0, "the mean over a slice in place of each point in it: h^2"),
    LAYERS: (2.0, "elements of second order whose stress is unbounded at the ends of the face: about h^2"),
}
# The coarsest model in the table: plane strain, without a face.
PLANE = "plane"


def in_the_plane(scene: Scene) -> Scene:
    """The scene without what makes it three-dimensional, in plane strain; of a helical pair the transverse section, as
    a spur pair. Shafts that bend, with their bearings, are left out."""
    if scene.shafts is not None and scene.shafts.sections is not None:
        scene = replace(scene, shafts=None, bearings=None)
    gears = scene.gears
    bearings = scene.bearings
    lean = cos(gears.helix_angle)
    section = gears.changed(
        lambda gear: replace(
            gear, profile_shift=gear.profile_shift * lean, rack_tip_radius=gear.rack_tip_radius * lean
        ),
        module=gears.module / lean, pressure_angle=atan(tan(gears.pressure_angle) / lean), helix_angle=0.0,
        pinion_hand="right",
    )  # fmt: skip
    accuracy = replace(scene.accuracy, slices=None, layers=None)
    if bearings is not None:
        bearings = replace(bearings.held_axially, places=None)
    return replace(
        scene, gears=section, bearings=bearings, lead_modifications=None, misalignment=None, accuracy=accuracy
    )
