"""Fully resolved three-dimensional models of tests/face_reference."""

from itertools import groupby

from tests.benchmarks.third_dimension import resolved
from tests.benchmarks.third_dimension.__main__ import main as third_dimension
from tests.elasticity.face import test_web_on_shaft as web_on_shaft
from tests.evidence.claim import RESOLVED, Claim, Numbers, Part, within
from tests.face_reference.reference import OPENINGS

MODEL = "finite elements in 3D, wedges of second order, tests/face_reference"
KEYS = [(helix, 0.35, opening) for helix in (0.0, 20.0) for opening in OPENINGS]
AT_EDGES = [(helix, 0.85, "plain") for helix in (0.0, 20.0)]


def words(key: tuple[float, float, str]) -> str:
    helix, phase, opening = key
    kind = "helical, 20 deg" if helix else "spur"
    return f"{kind}, {opening}" + (", a tip edge touching" if phase == 0.85 else "")


def kept() -> Numbers:
    """Approaches (µm) of the analyses that have a row, and the line load that is furthest off, by the largest."""
    found: Numbers = {}
    ordered = groupby(resolved.fine_rows(), key=lambda row: (row["helix_angle"], row["phase"], row["opening"]))
    for (helix, phase, opening), rows in ordered:
        key, slices = (helix, phase, list(OPENINGS)[int(opening)]), list(rows)
        if key in KEYS + AT_EDGES:
            found[words(key)] = 1e3 * slices[0]["reference_approach"], 1e3 * slices[0]["approach"]
        if key == (20.0, 0.35, "crowned"):
            largest = max(row["reference"] for row in slices)
            worst = max(slices, key=lambda row: abs(row["line_load"] - row["reference"]))
            found["line load"] = largest, largest + worst["line_load"] - worst["reference"]
    return found


def _claims() -> dict[str, Claim]:
    made_of = "slices in plane strain at free ends; sections of 0.3 modules"
    found = {
        words(key): Claim(
            "approach of narrow teeth, " + words(key).replace("plain", "unmodified"), MODEL, "µm",
            within(0.005 if key in KEYS else 0.01), made_of if key in KEYS else f"{made_of}; contact on the edge",
        )
        for key in KEYS + AT_EDGES
    }  # fmt: skip
    return found | {
        "line load": Claim("largest line load, crowned helical, off in the worst slice", MODEL, "N/mm", within(0.03),
                           "the slice at the free end")
    }  # fmt: skip


def measured(_: str) -> Numbers:
    third_dimension([resolved.NAME])
    return kept()


def on_shaft(_: str) -> Numbers:
    """Of a wheel with web on a steel shaft: inclination (µrad) of the overhung one, offset (µm) of the other."""
    scales = {"overhung": ("inclination", 1e6), "between bearings": ("offset", 1e3)}
    found = {}
    for name, (quantity, unit) in scales.items():
        rigid = web_on_shaft.axis(name, web_on_shaft.PLAIN, web_on_shaft.FACE)
        each, solid = unit * 1e3 / web_on_shaft.FORCE / 206e3, web_on_shaft.by_solid(name)
        found[name] = each * solid[quantity], each * rigid[quantity]
        if name == "between bearings":
            fitted = web_on_shaft.by_program(name, press_fit=True)
            found["press fit"] = each * solid["rim"], each * fitted["rim"]
    return found


SOLID = "one solid of shaft, hub and web, by harmonics"
ON_SHAFT = {
    "overhung": Claim("inclination of the axis of an overhung wheel with web", SOLID, "µrad/kN", within(0.02),
                      "a seat rigid over the face"),
    "between bearings": Claim("offset of the axis of a wheel with web between bearings", SOLID, "µm/kN", within(0.02),
                              "the shaft bends under the hub, the rigid seat does not"),
    "press fit": Claim("mean displacement of the rim of the same wheel, press fit", SOLID, "µm/kN", within(0.02),
                       "shear of Timoshenko's beam"),
}  # fmt: skip
PARTS = [
    Part("resolved", RESOLVED, "third_dimension.md#fully-resolved-models", _claims(), measured, kept, minutes=0.5),
    Part("web_on_shaft", RESOLVED, "third_dimension.md#a-wheel-on-its-shaft", ON_SHAFT, on_shaft),
]
