"""What follows a march, such as factors, proposals and pictures, may fail without taking the result along."""

import logging
from collections.abc import Callable
from typing import Any, TypeVar

from fenics_gears.errors import GearsError

LOGGER = logging.getLogger(__name__)
# The attribute with the names of what failed, a line each.
FAILED = "failed_afterwards"
Found = TypeVar("Found")


def attempted(attributes: dict[str, Any], what: str, carry_out: Callable[[], Found]) -> Found | None:
    """What `carry_out` finds; where it fails, None, a warning in the attributes of the result, and `what` in their
    `failed_afterwards`."""
    try:
        return carry_out()
    except Exception as error:
        if isinstance(error.__cause__, KeyboardInterrupt):  # compiled code that Ctrl-C hit in the middle
            raise KeyboardInterrupt from error
        LOGGER.debug("%s failed", what, exc_info=True)
        warning = f"{what}: failed, and the result stands without: {reason(error)}"
        for name, line in (("warnings", warning), (FAILED, what)):
            attributes[name] = "\n".join(filter(None, [attributes.get(name, ""), line]))
        return None


def reason(error: Exception) -> str:
    """Why something failed, in one line; the kind of what is no error of this program."""
    said = " ".join(str(error).split())
    return said if isinstance(error, GearsError) else f"{type(error).__name__}: {said}"
