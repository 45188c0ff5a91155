"""Spur pairs of unequal face widths, or side by side in part: in the plane, where a width counts, against three
dimensions."""

from dataclasses import replace

from tests.benchmarks.third_dimension.pairs import MODULE, STEEL, in_plane, scene_of, standard_gear, standard_pair
from tests.benchmarks.third_dimension.table import Row, read_rows, table, write_rows

from fenics_gears import gear_pair, simulate
from fenics_gears.geometry.gear_data import GearPairData
from fenics_gears.scene.data import Accuracy

NAME = "face_widths"
# Coarser than the default: the quotient of two widths hardly depends on it.
STEPS, SLICES_OF_A_MODULE, SECTION_SIZE, FLANK_SIZE = 20, 1.5, 0.6 * MODULE, 0.03 * MODULE
# Teeth and bores (of the root diameter) of pinion and wheel, common width in modules; then widths of pinion and wheel
# over the common one and the side on which
# they stand out: 0 both sides alike, 1 one side.
WIDER = ((1.25, 1.0, 0), (1.5, 1.0, 0), (2.5, 1.0, 0), (1.0, 2.5, 0), (1.0, 2.5, 1), (1.5, 1.5, 1))
CASES = (
    *(((20, 30), (0.5, 0.5), common, WIDER) for common in (3.0, 6.0)),
    ((20, 30), (0.5, 0.5), 12.0, WIDER[:2]),
    ((20, 30), (0.9, 0.9), 5.0, ((2.0, 1.0, 0), (1.0, 2.0, 0))),
    ((25, 80), (0.4, 0.3), 5.0, ((2.0, 1.0, 0), (1.0, 2.0, 0), (1.0, 2.0, 1))),
)


def pair_of(
    teeth: tuple[int, int], bores: tuple[float, float], common: float, widths: tuple[float, float], one_side: int
) -> GearPairData:
    """Standard teeth; `common` in modules, `widths` in parts of it. On `one_side` alone: the gears are flush at their
    left ends, or overlap by the common width."""
    own = tuple(width * common * MODULE for width in widths)
    offset = one_side * (0.5 * (own[0] + own[1]) - common * MODULE if min(widths) > 1.0 else 0.5 * (own[1] - own[0]))
    pinion, wheel = (
        replace(standard_gear(number, 0.0, bore), face_width=width) for number, bore, width in zip(teeth, bores, own)
    )
    return replace(
        standard_pair(common * MODULE, teeth=teeth, material=STEEL),
        pinion=pinion,
        wheel=wheel,
        axial_offsets=(0.0, offset),
    )


def mean_error(scene) -> float:
    """Mean transmission error, um along the line of action."""
    result = simulate(scene)
    return 1e3 * result.attrs["base_radius_wheel"] * result.attrs["mean_transmission_error"]


def row_of(teeth, bores, common, widths, one_side) -> Row:
    """One pair both ways."""
    data = pair_of(teeth, bores, common, widths, one_side)
    pair, slices = gear_pair(data), max(round(SLICES_OF_A_MODULE * common), 6)
    scene = scene_of(
        data,
        Accuracy(
            steps_per_mesh_cycle=STEPS, slices=slices, body_element_size=SECTION_SIZE, flank_element_size=FLANK_SIZE
        ),
    )
    return {
        "pinion_teeth": teeth[0],
        "wheel_teeth": teeth[1],
        "pinion_bore": bores[0],
        "wheel_bore": bores[1],
        "common": common,
        "pinion": widths[0],
        "wheel": widths[1],
        "one_side": one_side,
        "counts_pinion": pair.effective_face_widths[0] / pair.face_width,
        "counts_wheel": pair.effective_face_widths[1] / pair.face_width,
        "space": mean_error(scene),
        "plane": mean_error(in_plane(scene)),
    }


def measure() -> list[Row]:
    """Of each pair that of equal widths first."""
    rows: list[Row] = []
    for teeth, bores, common, wider in CASES:
        for first, second, one_side in ((1.0, 1.0, 0), *wider):
            rows.append(row_of(teeth, bores, common, (first, second), one_side))
            write_rows(NAME, rows)
    return rows


def quotients(rows: list[Row]) -> list[tuple[Row, Row]]:
    """Each row of unequal widths with that of equal ones."""
    found, equal = [], rows[0]
    for row in rows:
        if row["pinion"] == row["wheel"] == 1.0:
            equal = row
        else:
            found.append((row, equal))
    return found


def section() -> str:
    lines = []
    for row, equal in quotients(read_rows(NAME)):
        space, plane = row["space"] / equal["space"], row["plane"] / equal["plane"]
        lines.append(
            [
                f"{row['pinion_teeth']:g}, {row['wheel_teeth']:g}",
                f"{row['pinion_bore']:g}, {row['wheel_bore']:g}",
                f"{row['common']:g}",
                f"{row['pinion']:g}, {row['wheel']:g}",
                "one" if row["one_side"] else "both",
                f"{row['counts_pinion']:.3f}, {row['counts_wheel']:.3f}",
                f"{space:.4f}",
                f"{plane:.4f}",
                f"{100 * (plane / space - 1):+.2f}",
                f"{100 * (row['plane'] / row['space'] - 1):+.2f}",
                f"{100 * (equal['plane'] / equal['space'] - 1):+.2f}",
            ]
        )
    headings = [
        "teeth",
        "bores over root diameters",
        "common width b/m",
        "widths over b",
        "stand out at",
        "widths that count over b",
        "T_E over that of equal widths, three dimensions",
        "plane",
        "off, %",
        "T_E itself off, %",
        "at equal widths, %",
    ]
    return "\n".join(table(headings, lines))
