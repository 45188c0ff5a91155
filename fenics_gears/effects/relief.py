"""What ``[tip_relief]`` and ``[root_relief]`` share: fields, data, rules and findings. Not an effect by itself."""

from dataclasses import KW_ONLY, dataclass
from math import degrees
from typing import Any

from fenics_gears.inputs import units
from fenics_gears.inputs.allowed import Measured
from fenics_gears.inputs.fields import choice, either, number, quantity
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import Section, tree_of
from fenics_gears.inputs.tree import GEARS, Tree, given_for, table, with_gears

from .effect import ResultVariable

LINEAR, PARABOLIC = "linear", "parabolic"
POWERS = {LINEAR: 1, PARABOLIC: 2}

AT_KINK = ResultVariable(
    "largest_kink_pressure",
    "MPa",
    "largest pressure within a Hertz half-width of the kink where a linear relief starts; it does not converge as the"
    " mesh is refined",
)


# Each alone says where a relief starts.
STARTS = ("start", "length_on_path", "length_on_flank")
# And how it grows.
GROWTH = ("shape", "exponent")


def start_field(word: str, word_meaning: str) -> Any:
    """The field that says where a relief starts: ``word``, a roll angle or a diameter."""
    return either(
        ("1e-3 deg to 360 deg", "29.61 deg"),
        ("0.1 mm to 100 m", "80.1 mm"),
        words=(word,),
        meaning=(
            f"start of the relief: a roll angle, the {word_meaning} (with a contact ratio above 2, of double tooth"
            " contact, and so on), or a diameter, which is accepted for one gear only"
        ),
        otherwise="follows from a length; start or length is required where there is a depth",
    )


def length_field(measured: str) -> Any:
    return quantity(
        "1e-3 um to 100 m",
        "3 mm",
        meaning=f"length of the relief {measured}, from its start to its end",
        otherwise="follows from `start`",
    )


@dataclass(frozen=True)
class Relief(Section):
    """``[tip_relief.pinion]`` and ``[tip_relief.wheel]``; fields that are left out are those of ``[tip_relief]``, and
    the defaults hold if that section leaves them out too."""

    alternatives = (STARTS, GROWTH)

    depth: float | None = quantity(
        "1e-6 um to 100 mm",
        "31 um",
        meaning=(
            "depth at the end of the relief, normal to the flank in the transverse section, which is along the line of"
            " action there"
        ),
        otherwise="no relief",
        below="For a gear without relief, leave its depth out.",
    )
    start: float | Measured | str | None = start_field("HPSTC", "highest point of single tooth contact")
    _: KW_ONLY
    length_on_path: float | None = length_field("on the path of contact (length of roll: base radius times roll angle)")
    length_on_flank: float | None = length_field("along the flank (arc of the involute)")
    shape: str | None = choice(
        LINEAR,
        PARABOLIC,
        meaning="growth of the relief with the roll angle: `linear` starts with a kink, at which the pressure does not"
        " converge as the mesh is refined; `parabolic` starts without a kink",
        otherwise="`linear`",
    )
    exponent: float | None = number(
        1.5,
        lowest=1.0,
        highest=10.0,
        meaning="growth with this power of the roll angle, in place of `shape`: 1 is linear, 2 parabolic",
        otherwise="that of `shape`",
    )

    @property
    def length(self) -> float | None:
        """Length (mm) of the relief on the path of contact or along the flank, where the scene has one."""
        return self.length_on_flank if self.length_on_path is None else self.length_on_path

    @property
    def start_roll_angle(self) -> float | None:
        """Roll angle (rad) of the start, where the scene has one."""
        return self.start if isinstance(self.start, (int, float)) else None

    @property
    def start_diameter(self) -> float | None:
        """Diameter (mm) of the start, where the scene has one."""
        return self.start.number if isinstance(self.start, Measured) else None

    @property
    def power(self) -> float:
        return POWERS[self.shape or LINEAR] if self.exponent is None else self.exponent


@dataclass(frozen=True)
class RootReliefOfGear(Relief):
    """``[root_relief.pinion]`` and ``[root_relief.wheel]``; fields that are left out are those of ``[root_relief]``,
    and the defaults hold if that section leaves them out too."""

    start: float | Measured | str | None = start_field("LPSTC", "lowest point of single tooth contact")


@dataclass(frozen=True)
class Reliefs:
    """Relief of pinion and wheel; None for a gear without. One without start or length begins at HPSTC or LPSTC."""

    pinion: Relief | None
    wheel: Relief | None


def starts_without_single_contact(section: str, word: str, reliefs: Reliefs, model) -> list[str]:
    """A sentence where a relief starts at a point of single tooth contact and the pair has none."""
    pair = model.pair
    if pair.fewest_pairs < 2:
        return []
    contact, letters = pair.contact_by_fewest
    rolls = pair.hpstc_roll_angles if word == "HPSTC" else pair.lpstc_roll_angles
    own = [(roll, relief) for roll, relief in zip(rolls, (reliefs.pinion, reliefs.wheel)) if relief is not None]
    angles = [roll for roll, relief in own if relief.start is None and relief.length is None]
    if not angles:
        return []
    which = "highest" if word == "HPSTC" else "lowest"
    return [
        f'{section}.start = "{word}": with a contact ratio of {pair.contact_ratio:.4g} no tooth pair is ever alone;'
        f" relief starts at the {which} point of {contact} ({word[:2]}{letters}), roll angle"
        f" {' and '.join(f'{degrees(angle):.4g} deg' for angle in angles)}"
    ]


def read(kind: type[Reliefs], section: Any) -> Reliefs:
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


def write(usual: str, reliefs: Any) -> dict[str, Any]:
    """The section of both gears' reliefs, each by itself; one without a start begins at the ``usual`` place."""
    own = {gear: tree_of(getattr(reliefs, gear)) for gear in GEARS if getattr(reliefs, gear) is not None}
    return {gear: tree if {*STARTS} & {*tree} else tree | {"start": usual} for gear, tree in own.items()}


def rules(section: str, word: str, tree: Tree) -> Broken:
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
    given = {(section, gear): given_for(both, gear) for gear in own}
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
