"""Exact solutions: Hertz, Lame, beams with shear."""

from math import log, pi

from tests.annulus import TOLERANCE, error_under_pressure
from tests.benchmarks.hertz import pressed_scene
from tests.benchmarks.third_dimension.crowned import THEIR_RATIO, CrownedFlanks
from tests.dynamics import test_elastic_shaft as shafts
from tests.evidence.claim import EXACT, Claim, Numbers, Part, within
from tests.hertz_contact import SMALLER, HertzContact

JOHNSON = "Hertz; Johnson, Contact Mechanics, 1985, 4.2 and 5.6"
ELEMENTS = {"": 8, ", 4 elements": 4}


def hertz(_: str) -> Numbers:
    """With 8 and with 4 elements and nodes in a half-width."""
    contact, found = HertzContact(pressed_scene()), {}
    width, load = contact.half_width(contact.line_load), contact.line_load
    exact = {
        "peak pressure": 2.0 * load / (pi * width),
        "half-width": 1e3 * width,
        "approach": 1e6 * log(1.0 / SMALLER) / (pi * contact.modulus),
    }
    for words, count in ELEMENTS.items():
        errors = contact.errors(contact.compliances(width / count), width / count)
        found |= {name + words: (exact[name], exact[name] * (1.0 + error)) for name, error in errors.items()}
    return found


def _line_contact(words: str, band: dict[str, float], made_of: str) -> dict[str, Claim]:
    units = {"peak pressure": "MPa", "half-width": "µm", "approach": "nm mm/N"}
    names = {
        "peak pressure": "peak pressure of a line contact",
        "half-width": "its half-width",
        "approach": "its approach per line load, change between two loads",
    }
    return {
        name + words: Claim(names[name] + words, JOHNSON, unit, within(band[name]), made_of)
        for name, unit in units.items()
        if name in band
    }


def lame(_: str) -> Numbers:
    """Forces at the rim of a thick ring, in the elements of the default."""
    return {"P2": (0.0, error_under_pressure("P2", 0.3))}


def beams(_: str) -> Numbers:
    """Deflections and twist of shafts, in the units of the rows."""
    deflection, slope = shafts.simply_supported(45.0, 0, 4, 1.0)
    found = {
        "between": (deflection, 1e3),
        "slope": (slope, 1e6),
        "overhung": (shafts.overhung(), 1e3),
        "cone": (shafts.cone()[1], 1e3),
        "twist": (shafts.twisted(), 1e9),
    }
    return {name: (unit * exact, unit * float(own)) for name, ((exact, own), unit) in found.items()}


def crowned(_: str) -> Numbers:
    """Crowned flanks with an ellipse of ten to one."""
    flanks = CrownedFlanks(THEIR_RATIO)
    exact, errors = flanks.exact, flanks.errors()
    smaller = exact.under(SMALLER)
    values = {
        "peak_pressure": exact.peak_pressure,
        "short_axis": 1e3 * exact.short_axis,
        "long_axis": exact.long_axis,
        "approach": 1e6 * (smaller.approach / smaller.load - exact.approach / exact.load),
    }
    return {name: (value, value * (1.0 + errors[name])) for name, value in values.items()}


TIMOSHENKO = "Timoshenko beam in closed form, shear by Cowper 1966"
ROUND = "round-off"
PARTS = [
    Part(
        "hertz", EXACT, "accuracy.md#comparison-with-hertz",
        _line_contact("", {"peak pressure": 0.01, "half-width": 0.01, "approach": 0.01},
                      "elements and contact nodes, an eighth of the half-width long")
        | _line_contact(", 4 elements", {"peak pressure": 0.02}, "the same, a quarter long: second order"),
        hertz,
    ),
    Part(
        "crowned", EXACT, "third_dimension.md#crowned-flanks",
        {
            "peak_pressure": Claim("peak pressure of crowned flanks, ellipse 10:1", JOHNSON, "MPa", within(0.02),
                                   "slices in plane strain; layers"),
            "short_axis": Claim("half-width of the ellipse", JOHNSON, "µm", within(0.02), "contact nodes"),
            "long_axis": Claim("half-length of the ellipse", JOHNSON, "mm", within(0.02), "slices and layers"),
            "approach": Claim("approach per load, change between two loads", JOHNSON, "nm/N", within(0.02), "layers"),
        },
        crowned,
    ),
    Part(
        "lame", EXACT, "geometry.md#webs",
        {"P2": Claim("forces at the rim of a thick ring, error", "Lamé, plane strain", "of them",
                     (0.0, TOLERANCE["P2"]), "elements: order 4")},
        lame,
    ),
    Part(
        "beams", EXACT, "third_dimension.md#shafts-that-bend",
        {
            "between": Claim("deflection of a hollow shaft between two bearings", TIMOSHENKO, "µm/kN", within(1e-10),
                             ROUND),
            "slope": Claim("its slope", TIMOSHENKO, "µrad/kN", within(1e-8), ROUND),
            "overhung": Claim("deflection at an overhung gear", TIMOSHENKO, "µm/kN", within(1e-10), ROUND),
            "cone": Claim("cantilever of a cone of ten to one", TIMOSHENKO, "µm/kN", within(1e-9), ROUND),
            "twist": Claim("twist of steps and a cone", "sum of L/(G J) and the cone's integral", "nrad/(N mm)",
                           within(1e-12), ROUND),
        },
        beams,
    ),
]  # fmt: skip
