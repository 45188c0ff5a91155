"""Transmission error of the paper's pair by CalculiX: teeth alone, no friction, the true outlines."""

import csv
import subprocess
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np
from tests.corner_contact_reference.calculix import CalculixFailed, couples
from tests.corner_contact_reference.gear_mesh import MeshSizes, gear_mesh

from fenics_gears import GearPair, Scene, gear_pair, load_scene

FILE = Path(__file__).with_name("reference.csv")
SCENE = Path(__file__).parents[2] / "demos" / "lundvall2004.toml"
SIZES = MeshSizes(flank=0.08, tip=0.03)
# Mesh cycles after a pair reaches the start of the path. The pinion's tip leaves its path at 0.47 and the wheel's
# enters it at 1.
LEAVING = (0.44, 0.46, 0.47, 0.48, 0.5, 0.52, 0.53, 0.54, 0.55)
ENTERING = (0.92, 0.93, 0.94, 0.95, 0.96, 0.98)
ELSEWHERE = (0.0, 0.2, 0.7)
FIRST_GUESS = 7e-4
CLOSE_ENOUGH = 0.015


@dataclass(frozen=True)
class Case:
    """Mesh phase, edge radius of both tips (mm); `refinement`: factor on element sizes; `slave`: the gear whose
    surface contact is integrated over; `penalty`, MPa/mm."""

    phase: float
    edge_radius: float
    refinement: float = 1.0
    slave: int = 0
    penalty: float = 1e8


@dataclass(frozen=True)
class Row:
    case: Case
    transmission_error: float
    couple_ratio: float
    nodes: int
    code: str


ROUNDED = (0.5, 0.52, 0.54, 0.95, 0.96, 0.98)


def tip_touching(phase: float) -> int:
    """The gear whose tip comes into or leaves contact about that phase: 0 the pinion, 1 the wheel. It is the slave:
    a sharp edge has no normal, and only the edge's mesh resolves its narrow contact; otherwise the tip is 0.6 to 1.5
    % off."""
    return 1 if phase > 0.935 else 0


def case(phase: float, edge_radius: float, **change) -> Case:
    return Case(phase, edge_radius, **{"slave": tip_touching(phase), **change})


VARIANTS = (
    *(case(phase, radius, refinement=0.7) for phase in (0.5, 0.95) for radius in (0.0, 0.1)),
    *(case(phase, 0.0, penalty=1e7) for phase in (0.5, 0.95)),
)
CASES = (
    *(case(phase, 0.0) for phase in LEAVING + ENTERING + ELSEWHERE),
    *(case(phase, 0.1) for phase in ROUNDED),
    *VARIANTS,
)


def paper_pair() -> tuple[Scene, GearPair]:
    scene = load_scene(SCENE)
    return scene, gear_pair(scene.gears)


def computed(scene: Scene, pair: GearPair, case: Case, folder: Path, guess: float = FIRST_GUESS) -> Row:
    """The wheel's rotation that takes the scene's couple, by secant steps."""
    pairs = (0, 1) if case.phase < 0.75 else (-1, 0)
    sizes = SIZES.scaled(case.refinement)
    meshes = tuple(
        gear_mesh(gear, sizes, case.edge_radius, tuple(sense * k for k in pairs))
        for gear, sense in ((pair.pinion, 1), (pair.wheel, -1))
    )
    wanted = scene.load.wheel_torque / pair.face_width
    for _ in range(4):
        rotations = guess * np.array([1.0 - CLOSE_ENOUGH, 1.0 + CLOSE_ENOUGH])
        found = couples(pair, scene.gears.material, meshes, case.phase, rotations, folder, case.slave, case.penalty)
        slope = (found[1, 1] - found[0, 1]) / (rotations[1] - rotations[0])
        if not slope > 0.0:
            raise CalculixFailed(
                f"{case}: the couple does not rise with the wheel's rotation, {found[:, 1]} N; see {folder}/gears.log"
            )
        answer = rotations[0] + (wanted - found[0, 1]) / slope
        if abs(answer / guess - 1.0) < 2.0 * CLOSE_ENOUGH:
            break
        guess = answer
    ratio = float(np.mean(found[:, 0] / found[:, 1]))
    return Row(case, float(answer), ratio, sum(len(mesh.points) for mesh in meshes), version())


def version() -> str:
    said = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout
    return "CalculiX " + said.split()[-1]


def read(file: Path = FILE) -> list[Row]:
    if not file.exists():
        return []
    rows = []
    with file.open() as lines:
        for line in csv.DictReader(lines):
            done = Case(
                **{field.name: (int if field.name == "slave" else float)(line[field.name]) for field in fields(Case)}
            )
            rows.append(
                Row(
                    done,
                    float(line["transmission_error"]),
                    float(line["couple_ratio"]),
                    int(line["nodes"]),
                    line["code"],
                )
            )
    return rows


def write(rows: list[Row], file: Path = FILE) -> None:
    order = {case: number for number, case in enumerate(CASES)}
    flat = [{**asdict(row.case), **{key: value for key, value in asdict(row).items() if key != "case"}} for row in rows]
    flat = [
        line
        for _, line in sorted(zip([order.get(row.case, len(order)) for row in rows], flat), key=lambda item: item[0])
    ]
    with file.open("w", newline="") as lines:
        writer = csv.DictWriter(lines, list(flat[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(flat)
