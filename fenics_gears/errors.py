"""The errors a user can meet, and the exit code each leads to."""


class GearsError(Exception):
    """Base of every error this program raises on purpose."""

    exit_code = 3


class SceneError(GearsError):
    """The scene is wrong; nothing has been computed and nothing written."""

    exit_code = 2


class GeometryError(SceneError):
    """The gear data describe no gear, or a pair that cannot run."""


class ComputationError(GearsError):
    """The computation could not be finished; what was done is kept."""
