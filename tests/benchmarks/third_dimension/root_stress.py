"""Root stress over the face against ISO 6336-3, method B, at helix angles from 0 to 30 degrees.

sigma_F0 = F_t/(b m_n) Y_F Y_S Y_beta in the edition of 2006; that of 2019 has load sharing, f_epsilon, in its Y_F, and
Y_beta/cos(beta)^3.
"""

from dataclasses import replace
from math import cos, radians

from tests.benchmarks.third_dimension.pairs import LINE_LOAD, MODULE, divided, scene_of, standard_pair
from tests.benchmarks.third_dimension.table import Row, read_rows, table, write_rows
from tests.iso_tooth_root import helical_form_and_stress_correction, helix_angle_factor, load_sharing_factor

from fenics_gears import gear_pair, simulate
from fenics_gears.scene.data import Output

NAME = "root_stress"
HELIX_ANGLES, WIDTH, BORE = (0.0, 10.0, 20.0, 30.0), 8.0, 0.5
LAYER_THICKNESS, SECTION_SIZE, SLICE_WIDTH, STEPS = 1.0, 0.3, 0.4, 40
GEARS = ("pinion", "wheel")


def measure() -> list[Row]:
    rows = []
    for degrees in HELIX_ANGLES:
        gears = standard_pair(WIDTH * MODULE, radians(degrees), bore=BORE)
        accuracy = divided(gears, SLICE_WIDTH, LAYER_THICKNESS, SECTION_SIZE, STEPS)
        result, pair = simulate(replace(scene_of(gears, accuracy), output=Output(root_stress=True))), gear_pair(gears)
        # Of the tangential force at the reference cylinder.
        nominal = LINE_LOAD * cos(pair.pinion.pressure_angle) / MODULE
        for number, name in enumerate(GEARS):
            form, correction, normal_contact_ratio = helical_form_and_stress_correction(pair, name)
            share = float((result["pair_normal_force"] / result["pair_normal_force"].sum("slot")).max())
            over_face = result["root_stress_over_face"].isel(gear=number).max(("slot", "fillet"))
            rows.append({
                "helix_angle": degrees, "gear": number, "transverse_contact_ratio": pair.contact_ratio,
                "overlap_ratio": pair.overlap_ratio,
                "form": form, "correction": correction, "nominal": nominal, "largest_share": share,
                "helix_factor": helix_angle_factor(pair.overlap_ratio, degrees),
                "sharing_factor": load_sharing_factor(pair.overlap_ratio, normal_contact_ratio),
                "largest": result.attrs[f"largest_root_stress_{name}"],
                "at_30_degrees": float(over_face.max()),
                "mean_over_face": float(over_face.mean("face_position").max()),
            })  # fmt: skip
        write_rows(NAME, rows)
    return rows


def section() -> str:
    lines = []
    for row in read_rows(NAME):
        older = row["nominal"] * row["form"] * row["correction"] * row["helix_factor"]
        newer = older * row["sharing_factor"] / cos(radians(row["helix_angle"])) ** 3
        share = f"{row['largest_share']:.2f}" if row["gear"] == 0.0 else ""
        lines.append([
            f"{row['helix_angle']:g}", GEARS[round(row["gear"])], f"{row['form']:.3f}", f"{row['correction']:.3f}",
            f"{row['helix_factor']:.3f}", f"{row['sharing_factor']:.3f}",
            *(f"{value:.0f}" for value in (older, newer, row["largest"], row["at_30_degrees"], row["mean_over_face"])),
            *(f"{100.0 * (row['largest'] / value - 1.0):+.0f}" for value in (older, newer)), share,
        ])  # fmt: skip
    headings = [
        "β, deg", "gear", "Y_F", "Y_S", "Y_β", "f_ε", "ISO 6336-3:2006, MPa", "ISO 6336-3:2019", "largest here",
        "at the 30 deg tangent", "there, mean over the face",
        "largest off 2006, %", "off 2019, %", "largest share of a pair",
    ]  # fmt: skip
    return "\n".join(table(headings, lines))
