"""Pairs that books print in full, as scenes, with every figure of the book. ``python -m tests.drawn_pairs`` prints
the tables of docs/evidence/geometry.md."""

from dataclasses import dataclass
from math import cos, radians

from fenics_gears import Scene, build_scene, gear_pair
from fenics_gears.geometry.characteristics import characteristics


@dataclass(frozen=True)
class DrawnPair:
    """Its source, the sections of its scene, and the figures as printed, by what `gears check` calls them."""

    source: str
    gears: dict
    printed: dict[str, str]

    @property
    def scene(self) -> Scene:
        return build_scene({"gears": self.gears | {"face_width": "20 mm"}, "load": {"wheel_torque": "1 N m"}})


def _gear(teeth: int, shift: float, **others) -> dict:
    return {"teeth": teeth, "profile_shift": shift, "bore_diameter": f"{teeth / 2} mm", **others}


# cos(alpha_wt) cos(beta_b) of the third pair, by which its backlash normal to the flanks, 0.03 mm, is one at the pitch
# circles.
NORMAL = cos(radians(23.8707609654)) * cos(radians(21.0)) * cos(radians(20.0)) / cos(radians(21.2990642859))

PAIRS = {
    "spur, profile shifted": DrawnPair(
        "KHK Gear Technical Reference, The calculation of profile shifted spur gear; bolsover.com, Profile Shifted"
        " External Spur Gears",
        {
            "module": "3 mm",
            "pressure_angle": "20 deg",
            "centre_distance": "56.5 mm",
            "pinion": _gear(12, 0.6),
            "wheel": _gear(24, 0.36),
        },
        {
            "operating pressure angle": "26.0888",
            "contact ratio": "1.202",
            "pinion reference diameter": "36.000",
            "pinion base diameter": "33.8289",
            "pinion tip diameter": "44.840",
            "pinion root diameter": "32.100",
            "wheel reference diameter": "72.000",
            "wheel base diameter": "67.6579",
            "wheel tip diameter": "79.400",
            "wheel root diameter": "66.660",
        },
    ),
    "helical, profile shifted": DrawnPair(
        "KHK Gear Technical Reference, The calculation of a profile shifted helical gear in the normal system;"
        " bolsover.com, Profile Shifted External Helical Gear - Normal",
        {
            "module": "3 mm",
            "pressure_angle": "20 deg",
            "helix_angle": "30 deg",
            "pinion": _gear(12, 0.09809),
            "wheel": _gear(60, 0.0),
            "material": "steel",
        },
        {
            "centre distance": "125.000",
            "transverse pressure angle": "22.79588",
            "operating pressure angle": "23.1126",
            "contact ratio": "1.294",
            "overlap ratio": "1.061",
            "pinion reference diameter": "41.569",
            "pinion base diameter": "38.322",
            "pinion tip diameter": "48.154",
            "pinion root diameter": "34.658",
            "wheel reference diameter": "207.846",
            "wheel base diameter": "191.611",
            "wheel tip diameter": "213.842",
            "wheel root diameter": "200.346",
        },
    ),
    "helical, with backlash": DrawnPair(
        "Gear Generating Profile Shift Calculations (scribd.com 376176518), by ISO 21771:2007, equations 62 and 63:"
        " normal backlash 0.03 mm",
        {
            "module": "3.5 mm",
            "pressure_angle": "20 deg",
            "helix_angle": "21 deg",
            "centre_distance": "116.5 mm",
            "backlash": f"{0.03 / NORMAL:.9f} mm",
            "pinion": _gear(31, 0.291),
            "wheel": _gear(30, 0.651877131252 - 0.291),
            "material": "steel",
        },
        {
            "transverse pressure angle": "21.2990642859",
            "operating pressure angle": "23.8707609654",
            "normal backlash (j_bn)": "0.0300000",
            "sum of the profile shifts of the tooth thicknesses": "0.639346541",
        },
    ),
}


def figures(pair: DrawnPair) -> dict[str, float]:
    scene = pair.scene
    found = {name: value for name, value, _ in characteristics(gear_pair(scene.gears))}
    found |= {each.name: each.value for each in scene.derived}
    return found | {
        "sum of the profile shifts of the tooth thicknesses": (
            scene.gears.pinion.profile_shift + scene.gears.wheel.profile_shift
        )
    }


def table(pair: DrawnPair) -> list[str]:
    """Figure, book and program, with as many digits as the book has."""
    found, rows = figures(pair), []
    for name, printed in pair.printed.items():
        rows.append(f"| {name} | {printed} | {found[name]:.{len(printed.partition('.')[2])}f} |")
    return rows


if __name__ == "__main__":
    for title, each in PAIRS.items():
        print(f"\n{title}: {each.source}\n", *table(each), sep="\n")
