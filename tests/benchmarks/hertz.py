"""Flanks pressed together at the pitch point against Hertz, into docs/evidence/accuracy.md: `python -m
tests.benchmarks.hertz`.

The paper's pair under a quarter of its load, where the contact is small beside the tooth. Errors against the exact
solution, and their orders from one setting to the next; nothing is extrapolated.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from tests.benchmarks.marked_section import write_section
from tests.hertz_contact import QUANTITIES, SMALLER, HertzContact

from fenics_gears import Scene, load_scene
from fenics_gears.scene.data import Accuracy
from fenics_gears.simulation.warm_up import compile_kernels

ROOT = Path(__file__).parents[2]
SCENE, PAGE = ROOT / "demos" / "lundvall2004.toml", ROOT / "docs" / "evidence" / "accuracy.md"
LOAD = 0.25
# In a half-width of the larger load.
FLANK_ELEMENTS, CONTACT_NODES = (1, 2, 4, 8), (2, 4, 8, 16)


def pressed_scene(part: float = LOAD) -> Scene:
    """The paper's scene with nothing but its teeth to give way, under a part of its load."""
    scene = load_scene(SCENE)
    load = replace(scene.load, wheel_torque=part * scene.load.wheel_torque)
    return replace(scene, inertia=None, damping=None, shafts=None, bearings=None, accuracy=Accuracy(), load=load)


def orders(errors) -> list[str]:
    """Between each two of a ladder of halvings; nothing for the first."""
    found = np.log2(np.abs(np.array(errors[:-1]) / np.array(errors[1:])))
    return ["", *(f"{order:.1f}" for order in found)]


def table(heading: list[str], names: list[str], columns: list[list[float]]) -> list[str]:
    """Lines of a table: for each column errors in percent, and their orders in brackets."""
    lines = [f"|{'|'.join(heading)}|", "|---" * len(heading) + "|"]
    told = [
        [f"{100 * error:+.2f}" + (f" ({order})" if order else "") for error, order in zip(column, orders(column))]
        for column in columns
    ]
    return lines + [f"|{'|'.join([name, *cells])}|" for name, *cells in zip(names, *told)]


def section() -> str:
    """Three ladders: contact nodes, flank elements without contact, both together."""
    hertz = HertzContact(pressed_scene())
    width = hertz.half_width(hertz.line_load)
    gears = {n: hertz.compliances(width / n) for n in FLANK_ELEMENTS}
    finest = gears[FLANK_ELEMENTS[-1]]
    nodes = [hertz.errors(finest, width / n) for n in CONTACT_NODES]
    alone = [
        [hertz.flank_error(getattr(hertz.pair, name), gears[n][i]) for n in FLANK_ELEMENTS]
        for i, name in enumerate(("pinion", "wheel"))
    ]
    both = [hertz.errors(gears[n], width / n) for n in FLANK_ELEMENTS[1:]]
    of = lambda found: [[each[name] for each in found] for name in QUANTITIES]  # noqa: E731
    words = [f"{name}, %" for name in QUANTITIES]
    return "\n".join(
        [
            f"Half-width {width:.3f} mm, relative radius {hertz.radius:.2f} mm, {hertz.line_load:.0f} N/mm. Approach: "
            f"its "
            f"change between this load and {SMALLER:g} of it. "
            "The tables give errors, and in brackets the order from the line above.",
            "",
            f"Contact nodes refined, with {FLANK_ELEMENTS[-1]} flank elements in a half-width:",
            "",
            *table(["contact nodes in a half-width", *words], [f"{n}" for n in CONTACT_NODES], of(nodes)),
            "",
            "Flank elements refined, each flank under Hertz's pressure, without contact nodes:",
            "",
            *table(
                ["flank elements in a half-width", "approach, pinion, %", "approach, wheel, %"],
                [f"{n}" for n in FLANK_ELEMENTS],
                alone,
            ),
            "",
            "Both refined together:",
            "",
            *table(
                ["flank elements and contact nodes in a half-width", *words],
                [f"{n}" for n in FLANK_ELEMENTS[1:]],
                of(both),
            ),
        ]
    )


def main() -> None:
    compile_kernels(tangential=False)
    words = section()
    write_section(PAGE, "<!-- hertz: begin -->", "<!-- hertz: end -->", words)
    print(words)


if __name__ == "__main__":
    main()
