"""What ``[tip_relief]`` and ``[root_relief]`` share, which is all but their ends. Not an effect by itself."""

from collections.abc import Callable
from functools import partial
from math import degrees
from typing import Any

from fenics_gears.geometry.characteristics import contact_by_fewest
from fenics_gears.geometry.relief import GROWTH, STARTS, Relief, Reliefs
from fenics_gears.inputs import units
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import tree_of
from fenics_gears.inputs.tree import GEARS, Tree, given_for, table, with_gears

from .effect import Effect, ResultVariable

AT_KINK = ResultVariable(
    "largest_kink_pressure",
    "MPa",
    "largest pressure within a Hertz half-width of the kink where a linear relief starts; it does not converge as the"
    " mesh is refined",
)


def relief_effect(end: str, usual: str, fields: type[Relief], kind: type[Reliefs], curves: Callable) -> Effect:
    """The effect of relief towards an `end`, "tip" or "root", which starts at the `usual` place; `curves(pair, data)`:
    material removed."""
    section = f"{end}_relief"
    return Effect(
        section=section,
        description=f"{end} relief, linear or parabolic in the roll angle",
        absent=f"involutes without {end} relief",
        fields=fields,
        terms=("gaps between the flanks",),
        read=partial(_read, kind),
        write=partial(_write, usual),
        rules=partial(_rules, section, usual),
        removal=lambda reliefs, pair: curves(pair, reliefs),
        warnings=partial(_starts_without_single_contact, section, usual),
        variables=(AT_KINK,),
    )


def _starts_without_single_contact(section: str, word: str, reliefs: Reliefs, model) -> list[str]:
    """A sentence where a relief starts at a point of single tooth contact and the pair has none."""
    pair = model.pair
    if pair.fewest_pairs < 2:
        return []
    contact, letters = contact_by_fewest(pair)
    rolls = pair.hpstc_roll_angles if word == "HPSTC" else pair.lpstc_roll_angles
    own = [(roll, relief) for roll, relief in zip(rolls, reliefs.of_gears) if relief is not None]
    angles = [roll for roll, relief in own if relief.start is None and relief.length is None]
    if not angles:
        return []
    which = "highest" if word == "HPSTC" else "lowest"
    return [
        f'{section}.start = "{word}": with a contact ratio of {pair.contact_ratio:.4g} no tooth pair is ever alone;'
        f" relief starts at the {which} point of {contact} ({word[:2]}{letters}), roll angle"
        f" {' and '.join(f'{degrees(angle):.4g} deg' for angle in angles)}"
    ]


def _read(kind: type[Reliefs], section: Any) -> Reliefs:
    return kind(*(_of_gear(section, getattr(section, gear)) for gear in GEARS))


def _of_gear(both: Relief, own: Relief | None) -> Relief | None:
    """One gear's relief; None without a depth. Fields that say the same are taken from its own section together."""
    values: dict[str, Any] = {}
    for names in (("depth",), STARTS, GROWTH):
        given = own if own is not None and any(getattr(own, name) is not None for name in names) else both
        values |= {name: getattr(given, name) for name in names}
    if isinstance(values["start"], str):
        values["start"] = None
    return None if values["depth"] is None else Relief(**values)


def _write(usual: str, reliefs: Any) -> dict[str, Any]:
    """The section of both gears' reliefs, each by itself; one without a start begins at the ``usual`` place."""
    own = {gear: tree_of(getattr(reliefs, gear)) for gear in GEARS if getattr(reliefs, gear) is not None}
    return {gear: tree if {*STARTS} & {*tree} else tree | {"start": usual} for gear, tree in own.items()}


def _rules(section: str, word: str, tree: Tree) -> Broken:
    """A relief has a depth and a start, which means the same for all gears that it is given for."""
    both = table(tree, section)
    if both is None:
        return
    own = {gear: table(both, gear) for gear in GEARS if table(both, gear) is not None}
    yield from _incomplete(both, own, section, word)
    takers = [
        gear for gear in GEARS if "depth" in given_for(both, gear) and not {*STARTS}.intersection(own.get(gear, {}))
    ]
    if _is_diameter(both.get("start")) and len(takers) > 1 and not _alike(tree):
        message = (
            "is a diameter, which is another place of either gear's flank. Allowed here: a roll angle, "
            f'"{word}", or length_on_path or length_on_flank instead; a diameter in [{section}.pinion] and'
            f" [{section}.wheel]."
        )
        yield (section, "start"), message


def _incomplete(both: Tree, own: dict[str, Tree], section: str, word: str) -> Broken:
    given: dict[tuple[str, ...], set[str]] = {(section, gear): given_for(both, gear) for gear in own}
    if "depth" in both or not given:
        given[section,] = set(both)
    for path, names in given.items():
        if "depth" not in names:
            yield (*path, "depth"), 'is missing. Allowed: such as "31 um".'
        if not names.intersection(STARTS):
            message = (
                f'is missing. Allowed: such as "{word}" or "29.61 deg", or length_on_path or length_on_flank, such as'
                ' "3 mm", instead.'
            )
            yield (*path, "start"), message


def _is_diameter(written: Any) -> bool:
    try:
        return isinstance(written, str) and units.quantity(written)[1] == "a length"
    except units.QuantityError:
        return False


def _alike(tree: Tree) -> bool:
    """Whether a diameter is the same place of both gears."""
    _, pinion, wheel = with_gears(tree, "gears").values()
    return {**pinion, "bore_diameter": None} == {**wheel, "bore_diameter": None}
