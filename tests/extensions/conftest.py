"""The coarse scene of the studies' tests, and studies that are not drawn."""

from tests.studies.conftest import folder, undrawn  # noqa: F401
