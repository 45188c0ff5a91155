"""The errors a user can meet, and the exit code each leads to."""

from typing import Any


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


class MemoryEnded(ComputationError):
    """There was not enough memory, `when` in words. `partial`: the march, or the dataset, of the steps before; None
    where there are none."""

    def __init__(self, when: str, partial: Any = None):
        self.partial = partial
        super().__init__(
            f"Memory ended {when}. `gears check` says what a run takes; larger elements take less, and over the face"
            " fewer slices. `--memory` or FENICS_GEARS_MEMORY say how much there is."
        )
