"""``[output]``: results besides those that every run has."""

from __future__ import annotations

import re
from dataclasses import dataclass
from math import inf
from typing import Any

from fenics_gears.inputs.allowed import Allowed, Refused
from fenics_gears.inputs.fields import declared, switch
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.written import as_written

_LAST_CYCLES = re.compile(r"last ([1-9]\d{0,6}) cycles?")


class AllowedContactFields(Allowed):
    """True, false or "last N cycles"."""

    def convert(self, value: Any) -> bool | float:
        """A number of mesh cycles, infinite for true; false as it is."""
        found = _LAST_CYCLES.fullmatch(value) if isinstance(value, str) else None
        if found is None and not isinstance(value, bool):
            raise Refused(f"is {as_written(value)}.")
        return int(found[1]) if found else value and inf


_CONTACT_FIELDS = AllowedContactFields(
    description='true, false, or "last N cycles", such as "last 3 cycles"',
    meaning=(
        "steps at which pressure, traction and place of every contact node are stored: all, none, or those of the last"
        " mesh cycles. Stress pictures and pressure maps need them. Replaces `motion.recorded_cycles`"
    ),
    otherwise="the last `motion.recorded_cycles`",
)


@dataclass(frozen=True)
class Output(Section):
    """``[output]``: results that take additional time or storage."""

    root_stress: bool = switch(
        meaning=(
            "stress along the fillets of the loaded teeth over time, and dynamic factors by force and by stress; see"
            " [stress](stress.md)"
        )
    )
    # Of a scene that was read: whether there are any; how many cycles is in its motion.
    contact_fields: bool | float = declared(_CONTACT_FIELDS, True)
