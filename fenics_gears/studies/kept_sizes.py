"""Remarks on sizes of the gears that a study leaves as they are although a designer would change them with a swept one;
curves do not show it."""

from __future__ import annotations

from collections.abc import Iterable

from fenics_gears.scene.data import Derived
from fenics_gears.studies.axis import Axis

TIP, ROOT, SHIFT, CENTRES = "tip_diameter", "root_diameter", "profile_shift", "centre_distance"
OF_ONE_GEAR = {SHIFT: (TIP, ROOT), "teeth": (TIP, ROOT)}
OF_BOTH_GEARS = {"module": (TIP, ROOT), "helix_angle": (TIP, ROOT), "pressure_angle": (), CENTRES: (SHIFT, TIP)}
# A field's name as a derived figure is called: "pinion tip diameter".
IN_WORDS = str.maketrans("._", "  ")


def kept_sizes(axes: Iterable[Axis], derived: Iterable[Derived] = ()) -> list[str]:
    """A sentence for each swept size of the gears, on the diameters, profile shifts and the centre distance that stay
    the same in all cases.

    derived: what the scenes leave out, which follows the swept size.
    """
    swept, follow = {axis.dotted for axis in axes}, {each.name for each in derived}
    kept = {
        name: [
            each
            for each in _bound_to(name)
            if each not in swept and each[len("gears.") :].translate(IN_WORDS) not in follow
        ]
        for name in sorted(swept)
    }
    return [_sentence(name, sizes) for name, sizes in kept.items() if sizes]


def _bound_to(name: str) -> list[str]:
    """The fields that a design changes with the named one."""
    home, _, quantity = name.rpartition(".")
    if home in ("gears.pinion", "gears.wheel") and quantity in OF_ONE_GEAR:
        return [*(f"{home}.{each}" for each in OF_ONE_GEAR[quantity]), f"gears.{CENTRES}"]
    if home == "gears" and quantity in OF_BOTH_GEARS:
        of_gears = [f"gears.{gear}.{each}" for each in OF_BOTH_GEARS[quantity] for gear in ("pinion", "wheel")]
        return of_gears + ([] if quantity == CENTRES else [f"gears.{CENTRES}"])
    return []


def _sentence(name: str, kept: list[str]) -> str:
    listed = kept[0] if len(kept) == 1 else f"{', '.join(kept[:-1])} and {kept[-1]}"
    return (
        f"{name} is swept and {listed} {'is' if len(kept) == 1 else 'are'} kept, so that contact ratio, tip clearance"
        ' and backlash change with it; sweep them along (combine = "zip") for gears that are designed anew'
    )
