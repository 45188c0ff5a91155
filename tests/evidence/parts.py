"""All parts, in the order of the page."""

from tests.evidence import contact_loss, exact, laws, programs, resolved, standards, tables
from tests.evidence.claim import GROUPS, Part

PARTS: list[Part] = sorted(
    [*exact.PARTS, contact_loss.PART, *resolved.PARTS, *programs.PARTS, *standards.PARTS, *tables.PARTS, *laws.PARTS],
    key=lambda part: GROUPS.index(part.group),
)
