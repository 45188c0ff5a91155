"""Three helical pairs, entered from what their sources print, with the sources' derived figures beside the program's.

The scenes in `cited` name their sources and what was chosen.
"""

from dataclasses import replace
from math import ceil, cos, degrees
from pathlib import Path

from tests.benchmarks.third_dimension.table import Row, read_rows, table, write_rows
from tests.iso_tooth_root import helical_form_and_stress_correction, helix_angle_factor

from fenics_gears import gear_pair, load_scene, mesh_factor, simulate, single_stiffness
from fenics_gears.geometry.characteristics import characteristics
from fenics_gears.scene.data import Accuracy

NAME = "cited"
CITED = Path(__file__).parent / "cited"
STEPS, SLICE_WIDTH, LAYER_THICKNESS, SECTION_SIZE = 20, 0.4, 1.0, 0.4
# By scene: what the source prints, by the words of `gears check` where it has them.
PRINTED = {
    "fzg_h501": {
        "contact ratio": 1.46, "overlap ratio": 0.54, "length of the line of action T1 to T2": 34.45,
        "path of contact, mm": 15.55, "force along the line of action, N": 2949.2,
        "axial force, N": 739.5, "Y_F of the pinion": 1.479, "Y_S of the pinion": 2.047, "Y_β": 0.932,
        "root stress of the pinion, MPa": 95.80, "root stress of the wheel, MPa": 96.01,
    },
    "drivetrainhub_17_35": {
        "operating pressure angle": 23.660563, "centre distance without backlash": 27.015921, "contact ratio": 1.068817,
        "overlap ratio": 0.741462,
        "pinion roll angle, start of active profile": 16.841207,
        "pinion specific sliding, start of active profile": -0.728941, "backlash along the line of action": 0.388539,
    },
    "iso_tr_6336_30": {
        "tangential force at the reference circle, N": 127352.0,
        "theoretical single stiffness c'th, N/(mm µm)": 17.85584, "single stiffness c', N/(mm µm)": 12.37047,
        "mesh stiffness, N/(mm µm)": 17.46485,
    },
}  # fmt: skip


def derived(name: str) -> dict[str, float]:
    """The program's figures that follow without a run."""
    scene = load_scene(CITED / f"{name}.toml")
    pair = gear_pair(scene.gears)
    form, correction, _ = helical_form_and_stress_correction(pair, "pinion")
    theoretical, single = single_stiffness(scene.gears)
    force = scene.load.wheel_torque / pair.wheel.base_radius
    return {label: value for label, value, _ in characteristics(pair)} | {
        "force along the line of action, N": force, "axial force, N": force * abs(pair.slope),
        "tangential force at the reference circle, N": force * cos(pair.wheel.pressure_angle),
        "path of contact, mm": pair.path_end - pair.path_start, "Y_F of the pinion": form,
        "Y_S of the pinion": correction,
        "Y_β": helix_angle_factor(pair.overlap_ratio, degrees(pair.pinion.helix_angle)),
        "theoretical single stiffness c'th, N/(mm µm)": theoretical,
        "single stiffness c', N/(mm µm)": single, "mesh stiffness, N/(mm µm)": single * mesh_factor(pair.contact_ratio),
    }  # fmt: skip


def root_stress(name: str) -> dict[str, float]:
    scene = load_scene(CITED / f"{name}.toml")
    if not scene.output.root_stress:
        return {}
    module, width = scene.gears.module, gear_pair(scene.gears).face_width / scene.gears.module
    accuracy = Accuracy(
        steps_per_mesh_cycle=STEPS,
        slices=ceil(width / SLICE_WIDTH),
        layers=ceil(width / LAYER_THICKNESS),
        body_element_size=SECTION_SIZE * module,
    )
    attributes = simulate(replace(scene, accuracy=accuracy)).attrs
    return {
        f"root stress of the {gear}, MPa": attributes[f"largest_root_stress_{gear}"] for gear in ("pinion", "wheel")
    }


def measure() -> None:
    """The figures, by scene and the number of the figure in `PRINTED`."""
    rows: list[Row] = []
    for scene, (name, printed) in enumerate(PRINTED.items()):
        found = derived(name) | root_stress(name)
        rows += [
            {"scene": scene, "figure": number, "printed": value, "found": found[label]}
            for number, (label, value) in enumerate(printed.items())
        ]
    write_rows(NAME, rows)


def section() -> str:
    lines = []
    for row in read_rows(NAME):
        name = list(PRINTED)[round(row["scene"])]
        label = list(PRINTED[name])[round(row["figure"])]
        lines.append(
            [
                name if row["figure"] == 0.0 else "",
                label,
                f"{row['printed']:.7g}",
                f"{row['found']:.7g}",
                f"{100.0 * (row['found'] / row['printed'] - 1.0):+.2f}",
            ]
        )
    return "\n".join(table(["pair", "figure", "source", "here", "off, %"], lines))
