"""The errors a user can meet, and the exit code each leads to; and what may fail without taking a result along."""

import logging
from collections.abc import Callable
from typing import Any, TypeVar

LOGGER = logging.getLogger(__name__)
# The attribute with the names of what failed after a march, such as factors, proposals and pictures, a line each.
FAILED = "failed_afterwards"
Value = TypeVar("Value")


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


def attempted(attributes: dict[str, Any], what: str, carry_out: Callable[[], Value]) -> Value | None:
    """What `carry_out` finds; where it fails, None, a warning in the attributes of the result, and `what` in their
    `failed_afterwards`."""
    try:
        return carry_out()
    except Exception as error:
        if isinstance(error.__cause__, KeyboardInterrupt):  # compiled code that Ctrl-C hit in the middle
            raise KeyboardInterrupt from error
        LOGGER.debug("%s failed", what, exc_info=True)
        warning = f"{what}: failed, and the result is without it: {reason(error)}"
        for name, line in (("warnings", warning), (FAILED, what)):
            attributes[name] = "\n".join(filter(None, [attributes.get(name, ""), line]))
        return None


def reason(error: Exception) -> str:
    """Why something failed, in one line; the kind of what is no error of this program."""
    said = " ".join(str(error).split())
    return said if isinstance(error, GearsError) else f"{type(error).__name__}: {said}"
