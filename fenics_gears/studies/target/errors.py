"""What goes wrong in choosing settings."""

from __future__ import annotations

from fenics_gears.errors import ComputationError


class TargetNotReached(ComputationError):
    """No settings that this program may use reach the target."""
