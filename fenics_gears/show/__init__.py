"""Pictures of results."""

# Under which names the pictures of a run are written; see show.plots.
PICTURE_FILES = (
    "transmission_error.png",
    "mesh_forces.png",
    "load_sharing.png",
    "contact_pressure.png",
    "order_spectrum.png",
)
# Those of runs whose flanks are resolved over the face; the last one of shafts that bend.
FACE_PICTURE_FILES = ("contact_pattern.png", "line_load.png", "shafts.png")
# Those of runs of trains; the last ones of shafts that bend, and of planetary sets.
TRAIN_PICTURE_FILES = (
    "train.png",
    "transmission_error.png",
    "order_spectrum.png",
    "line_load.png",
    "shafts.png",
    "load_sharing.png",
    "orbit.png",
    "ring_points.png",
)
