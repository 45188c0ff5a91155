"""How tooth and rim give way on a rigid bore, and on a thin web, against a solid body; `python -m
tests.benchmarks.rigid_bore` writes the table of docs/evidence/geometry.md."""

from dataclasses import replace
from math import cos, pi, radians, sin, tan
from pathlib import Path

import numpy as np
from tests.benchmarks.marked_section import write_section
from tests.benchmarks.third_dimension.pairs import STEEL
from tests.benchmarks.third_dimension.table import table

from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.geometry.gear import Gear, transverse_gear
from fenics_gears.geometry.gear_data import GearData, Web
from fenics_gears.model.modification import too_stiff

PAGE = Path(__file__).parents[2] / "docs" / "evidence" / "geometry.md"
TEETH, RIMS = (20, 40, 80), (0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0)
PRESSURE_ANGLE = radians(20.0)
# Bore and hub of the solid body and of the web, of the root diameter; width of the web, of the face.
BORE, HUB, WEB = 0.2, 0.2, 0.15
SIZE, HALF_WIDTH = 0.04, 0.1
# Teeth further away than this (rad) move with the body as a whole.
FAR = pi / 3.0


def gear_of(teeth: int, rim: float | None = None, on_web: bool = False) -> Gear:
    """Module 1 mm, no profile shift; a solid body, or a rim of so many modules on a rigid ring, or on a web."""
    root = teeth - 2.5
    bore = BORE * root if rim is None or on_web else root - 2.0 * rim
    gear = transverse_gear(GearData(teeth, 0.0, teeth + 2.0, root, bore, 0.3), 1.0, PRESSURE_ANGLE, 0.0)
    return replace(gear, web=Web(0.5 * HUB * root, 0.5 * root - rim, WEB)) if on_web else gear


def _turned(angle: float) -> np.ndarray:
    return np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])


def deflection(gear: Gear) -> float:
    """Deflection, mm per N/mm, of a flank at its pitch point under a normal force, less the body's motion as a
    whole."""
    body = flank_compliance(gear, STEEL, Discretisation("P2", SIZE, None, None, None), Reach(gear.teeth // 2))
    arc = 0.5 * gear.base_radius * body.roll_angle**2
    node = int(np.abs(body.roll_angle - tan(PRESSURE_ANGLE)).argmin())
    roll, weights = (
        body.roll_angle[node],
        np.clip(1.0 - ((arc - arc[node]) / HALF_WIDTH) ** 2, 0.0, None) * np.gradient(arc),
    )
    weights /= weights.sum()
    inwards = -np.array([cos(roll), -sin(roll)])
    place = _turned(-roll) @ [gear.base_radius * roll, -gear.base_radius]
    far, own = [], 0.0
    for ahead in range(-body.offsets, body.offsets + 1):
        angle = 2.0 * pi * ahead / gear.teeth
        moved = weights @ (body.block(ahead) @ np.kron(weights, inwards)).reshape(-1, 2)
        if ahead == 0:
            own = float(moved @ inwards)
        if FAR < abs(angle) <= pi:
            far.append((*(_turned(angle) @ place), *(_turned(angle) @ moved)))
    x, y, *moved = np.array(far).T
    rows = np.block(
        [
            [np.ones((len(x), 1)), np.zeros((len(x), 1)), -y[:, None]],
            [np.zeros((len(x), 1)), np.ones((len(x), 1)), x[:, None]],
        ]
    )
    along, across, turn = np.linalg.lstsq(rows, np.concatenate(moved), rcond=None)[0]
    return own - float(np.array([along - turn * place[1], across + turn * place[0]]) @ inwards)


def off(teeth: int, rim: float, on_web: bool) -> float:
    """Per cent by which tooth and rim give way more than in a solid body."""
    return 100.0 * (deflection(gear_of(teeth, rim, on_web)) / deflection(gear_of(teeth)) - 1.0)


def section() -> str:
    lines = []
    for rim in RIMS:
        cells = []
        for teeth in TEETH:
            fits = rim < 0.35 * teeth
            cells += (
                [
                    f"{off(teeth, rim, False):+.0f} ({-too_stiff(gear_of(teeth, rim)):+.0f})",
                    f"{off(teeth, rim, True):+.0f}",
                ]
                if fits
                else ["", ""]
            )
        lines.append([f"{rim:g}", *cells])
    return "\n".join(
        table(
            ["rim, modules", *(words for teeth in TEETH for words in (f"{teeth} teeth, rigid ring, %", "on a web, %"))],
            lines,
        )
    )


if __name__ == "__main__":
    write_section(PAGE, "<!-- rigid_bore: begin -->", "<!-- rigid_bore: end -->", section())
