"""Figures that books and papers print."""

import numpy as np
from tests.benchmarks.third_dimension import cited, stiffness_function
from tests.benchmarks.third_dimension.__main__ import main as third_dimension
from tests.benchmarks.third_dimension.table import read_rows
from tests.corner_contact_reference.reference import paper_pair
from tests.drawn_pairs import PAIRS, figures
from tests.evidence.claim import TABLES, Claim, Numbers, Part, within
from tests.geometry.test_published_pairs import CITED, PAPER
from tests.hard_cases.test_row_04_energy import friction_loss, loss_factor

from fenics_gears.geometry.characteristics import characteristics


def _digits_off(value: float, printed: str) -> float:
    return abs(value - float(printed)) * 10.0 ** len(printed.partition(".")[2])


def books(_: str) -> Numbers:
    """The figure of each pair that is furthest off its book, in units of the last digit."""
    found = {}
    for name, pair in PAIRS.items():
        own = figures(pair)
        found[name] = 0.0, max(_digits_off(own[label], printed) for label, printed in pair.printed.items())
    own = cited.derived("drivetrainhub_17_35")
    found["drivetrainhub"] = (
        0.0,
        max(_digits_off(own[label], f"{printed:.6f}") for label, printed in CITED["drivetrainhub_17_35"].items()),
    )
    return found


def paper(_: str) -> Numbers:
    """What the paper prints of its pair, and the loss that a formula gives."""
    scene, pair = paper_pair()
    rows = {name: value for name, value, _ in characteristics(pair)}
    worst = max(abs(rows[label] - printed) * 100.0 for label, (printed, _) in PAPER.items())
    return {"figures": (0.0, worst), "loss": (0.1 * loss_factor(scene), friction_loss(scene))}


def function() -> Numbers:
    """Over the mean, of stiff bodies."""
    values = np.array([row["bore_0.85"] for row in read_rows(stiffness_function.NAME)])
    shares = values / values.mean()
    smallest, largest = stiffness_function.PUBLISHED
    return {"smallest": (smallest, float(shares.min())), "largest": (largest, float(shares.max()))}


def measured(_: str) -> Numbers:
    third_dimension([stiffness_function.NAME])
    return function()


VELEX = "Gu, Velex, Sainsot and Bruyère 2015, Fig. 5"
SOURCES = {
    "spur, profile shifted": "KHK Gear Technical Reference",
    "helical, profile shifted": "KHK Gear Technical Reference",
    "helical, with backlash": "scribd.com 376176518, by ISO 21771:2007",
    "drivetrainhub": "Drivetrain Hub, notebook on helical gears",
}
COUNTS = {name: len(pair.printed) for name, pair in PAIRS.items()} | {
    "drivetrainhub": len(CITED["drivetrainhub_17_35"])
}
PARTS = [
    Part(
        "books", TABLES, "geometry.md#published-pairs",
        {
            name: Claim(f"{COUNTS[name]} figures of a pair ({name.replace('drivetrainhub', 'helical, 17/35')}), the"
                        " furthest off in units of the last digit", source, "", (0.0, 0.51),
                        "printed digits")
            for name, source in SOURCES.items()
        },
        books,
    ),
    Part(
        "paper", TABLES, "paper.md",
        {
            "figures": Claim(f"{len(PAPER)} figures of the paper's pair, the furthest off in units of the last digit",
                             "Lundvall, Strömberg, Klarbring 2004, Table 2", "", (0.0, 1.0), "digits cut off in print"),
            "loss": Claim("friction loss of the paper's pair at a coefficient of 0.1",
                          "Niemann/Winter, Maschinenelemente 2, mesh loss factor", "of the work", within(0.05),
                          "the formula's load stands half on each of two pairs"),
        },
        paper,
    ),
    Part(
        "function", TABLES, "third_dimension.md#mesh-stiffness-over-the-mesh-cycle",
        {
            "smallest": Claim("smallest mesh stiffness of a cycle over the mean", VELEX, "", within(0.05),
                              "teeth couple along the face"),
            "largest": Claim("largest mesh stiffness of a cycle over the mean", VELEX, "", within(0.05), "the same"),
        },
        measured, function, minutes=1.0,
    ),
]  # fmt: skip
