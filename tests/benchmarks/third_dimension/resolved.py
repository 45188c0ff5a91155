"""Line loads of a narrow spur pair, free ends among them, against the resolved model of tests/face_reference at one phase."""

from __future__ import annotations

import csv
from dataclasses import replace

import numpy as np
from tests.benchmarks.third_dimension.pairs import PRESSURE_ANGLE, STEEL, scene_of
from tests.benchmarks.third_dimension.table import Row, read_rows, table, write_rows
from tests.face_reference.cases import FACE_WIDTH, NORMAL_MODULE, reference_pair
from tests.face_reference.reference import FILE, FORCE

from fenics_gears.contact.laws import Tolerance
from fenics_gears.contact.operator import CENTRE_COORDINATES
from fenics_gears.contact.step_solver import StepProblem, cold_start, solve_step
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.geometry.face_data import LeadModification, LeadModifications, Misalignment
from fenics_gears.geometry.gear import Gear
from fenics_gears.geometry.gear_data import GearData, GearPairData
from fenics_gears.model.model import model_of
from fenics_gears.scene.data import Accuracy
from fenics_gears.simulation.face_route import face_route
from fenics_gears.system.progress import SilentProgress

NAME, PHASE, SLICES, LAYERS = "resolved", 0.35, 16, 8
OPENINGS = {
    "plain": {},
    "misaligned": {"misalignment": Misalignment(in_plane=0.010)},
    "crowned": {"misalignment": None, "lead_modifications": LeadModifications(pinion=LeadModification(crowning=0.010))},
}


def _data(gear: Gear) -> GearData:
    return GearData(gear.teeth, 0.0, 2.0 * gear.tip_radius, 2.0 * gear.root_radius, 2.0 * gear.bore_radius, gear.rack_tip_radius / NORMAL_MODULE)


def here(opening: str) -> tuple[float, np.ndarray]:
    """Approach (mm) and line loads (SLICES,), N/mm, of this program."""
    pair = reference_pair(0.0)
    gears = GearPairData(NORMAL_MODULE, PRESSURE_ANGLE, pair.centre_distance, FACE_WIDTH, _data(pair.pinion), _data(pair.wheel), STEEL)
    scene = scene_of(gears, Accuracy(steps_per_mesh_cycle=20, slices=SLICES, layers=LAYERS), FORCE / FACE_WIDTH)
    cycle = face_route(model_of(replace(scene, **OPENINGS[opening])), SilentProgress(), user_cache())[1]
    operator = cycle.between(PHASE, PHASE).operator
    problem = StepProblem(
        stiffness=np.zeros((1, 1)), load=np.array([FORCE]), compliance=operator.compliance, gap=operator.gap, slip_before=np.empty(0), friction=0.0,
        jacobian=np.abs(operator.jacobian[:, [cycle._coordinates.index(CENTRE_COORDINATES.index("rotation_2"))]]), free_motion=np.ones(1),
        tolerance=Tolerance.of_load(FORCE),
    )  # fmt: skip
    solution, load = solve_step(problem, cold_start(operator.gap, operator.node_pair)), np.zeros(SLICES)
    np.add.at(load, [operator.pairs[pair].place.slice for pair in operator.node_pair], solution.forces)
    return float(solution.coordinates[0]), load / cycle.face.widths


def of_reference(opening: str) -> tuple[float, np.ndarray]:
    """The same of the resolved model: its line loads, of all pairs together, averaged over the slices."""
    with open(FILE, encoding="utf-8", newline="") as opened:
        rows = [row for row in csv.DictReader(opened) if row["opening"] == opening and float(row["helix_angle"]) == 0.0 and float(row["phase"]) == PHASE]
    z = np.array(sorted({float(row["z"]) for row in rows}))
    load = np.array([sum(float(row["line_load"]) for row in rows if float(row["z"]) == each) for each in z])
    fine = np.linspace(-0.5 * FACE_WIDTH, 0.5 * FACE_WIDTH, 100 * SLICES, endpoint=False) + FACE_WIDTH / (200 * SLICES)
    return float(rows[0]["approach"]), np.interp(fine, z, load).reshape(SLICES, -1).mean(axis=1)


def measure() -> list[Row]:
    """All openings, numbered as in OPENINGS."""
    rows: list[Row] = []
    for number, opening in enumerate(OPENINGS):
        (approach, load), (exact, reference) = here(opening), of_reference(opening)
        rows += [
            {"opening": number, "slice": k, "line_load": load[k], "reference": reference[k], "approach": approach, "reference_approach": exact}
            for k in range(SLICES)
        ]
    write_rows(NAME, rows)
    return rows


def section() -> str:
    """Table."""
    rows, lines = read_rows(NAME), []
    for number, opening in enumerate(OPENINGS):
        own = [row for row in rows if row["opening"] == number]
        load, reference = (np.array([row[name] for row in own]) for name in ("line_load", "reference"))
        inside = np.abs(load - reference)[1:-1].max() / reference.max()
        lines.append([
            opening, f"{load[0]:.1f}", f"{reference[0]:.1f}", f"{load.max():.1f}", f"{reference.max():.1f}", f"{100 * inside:.1f}",
            f"{100 * (own[0]['approach'] / own[0]['reference_approach'] - 1):+.1f}",
        ])  # fmt: skip
    headings = ["", "outermost slice, N/mm", "resolved", "largest, N/mm", "resolved", "largest difference further in, % of the largest", "approach, %"]
    return "\n".join(table(headings, lines))
