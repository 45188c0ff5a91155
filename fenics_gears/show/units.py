"""Numbers and units as people read them: micrometres instead of mm, microradians instead of rad, four digits."""

from __future__ import annotations

import numpy as np
import xarray as xr

from fenics_gears.errors import ComputationError
from fenics_gears.inputs.units import QuantityError, quantity


def factor(unit: str, wanted: str) -> float:
    """What a number in ``unit`` is multiplied with to be one in ``wanted`` ("rad", "µrad").

    Raises ComputationError where they measure different things or one is unknown.
    """
    try:
        size, kind = quantity(f"1 {unit}")
        wanted_size, wanted_kind = quantity(f"1 {wanted}")
    except QuantityError as error:
        raise ComputationError(f"a unit of the result {error}") from error
    if kind != wanted_kind:
        raise ComputationError(f'a variable in "{unit}" ({kind}) cannot be shown in "{wanted}" ({wanted_kind})')
    return size / wanted_size


def in_unit(variable: xr.DataArray, wanted: str) -> np.ndarray:
    """The values of a variable, any shape, in the unit ``wanted``; its own unit is its attribute ``units``.

    Raises ComputationError where it has no unit, or one that does not fit.
    """
    if "units" not in variable.attrs:
        raise ComputationError(f"{variable.name}: the result does not say its units")
    try:
        return variable.values * factor(variable.attrs["units"], wanted)
    except ComputationError as error:
        raise ComputationError(f"{variable.name}: {error}") from error


def digits(value: float) -> str:
    """Four digits, as measurements have them; three and a power of ten where a tile is too narrow for the number."""
    if abs(value) >= 1e6:
        mantissa, _, exponent = f"{value:.2e}".partition("e")
        return f"{mantissa}e{int(exponent)}"
    return f"{value:,.0f}" if abs(value) >= 1e4 else f"{value:.4g}"
