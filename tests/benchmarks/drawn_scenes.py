"""Scenes of all kinds with sizes drawn at random, for what is expected of a run beside what it takes."""

from math import ceil, cos, radians

import numpy as np
from tests.elastic_shaft_scenes import ELASTIC
from tests.paper_text import without

# Sections that a kind of scene has beside gears, load and motion; some are drawn further below.
KINDS = {
    "plane": "",
    "friction": "[friction]\ncoefficient = 0.06\n",
    "inertia": '[inertia]\ndensity = "7850 kg/m^3"\n[damping]\nratio = 0.05\n',
    "coast flanks": "[coast_flanks]\n[friction]\ncoefficient = 0.05\n",
    "rigid": "",
    "given mesh": "",
    "root stress": "[output]\nroot_stress = true\n",
    "face": '[misalignment]\nin_plane = "5 um"\n',
    "helical": "",
    "helical, friction": "[friction]\ncoefficient = 0.05\n",
    "helical, coast flanks": "[coast_flanks]\n",
    "web": "",
    "web beside the middle": "",
    "elastic shafts": ELASTIC,
    "helical, root stress": "[output]\nroot_stress = true\n",
}


def drawn_scene(number: int) -> tuple[str, str]:
    """The kind of scene with that number, and its text."""
    kind, draw = list(KINDS)[number % len(KINDS)], np.random.default_rng(number)
    if kind == "given mesh":
        return kind, _of_given_mesh(draw)
    over_face = list(KINDS).index(kind) >= list(KINDS).index("face")
    module = float(draw.choice([0.3, 1.0, 3.0, 8.0])) if kind != "elastic shafts" else 2.5
    helix = float(draw.choice([12.0, 20.0, 28.0])) if kind.startswith("helical") else 0.0
    width = module * float(draw.uniform(5.0, 11.0 if kind == "elastic shafts" else 16.0))
    text = _gears(draw, kind, module, helix, width)
    torque = float(10.0 ** draw.uniform(0.5, 1.5)) * width * module**2 * 20.0
    text += f'[load]\nwheel_torque = "{torque:.6g} N mm"\n'
    text += f'[motion]\nmesh_frequency = "{draw.uniform(20.0, 400.0):.5g} Hz"\nmesh_cycles = {draw.integers(1, 5)}\n'
    return kind, text + KINDS[kind] + _accuracy(draw, kind, module, over_face)


def _gears(draw, kind: str, module: float, helix: float, width: float) -> str:
    teeth = draw.integers(18, 45), draw.integers(20, 110)
    lean = f'helix_angle = "{helix} deg"\n' if helix else ""
    material = "" if kind == "rigid" else 'material = "steel"\n'
    text = (
        f'[gears]\nmodule = "{module} mm"\npressure_angle = "20 deg"\n{lean}face_width = "{width:.6g} mm"\n{material}'
    )
    for name, count in zip(("pinion", "wheel"), teeth):
        pitch = count * module / cos(radians(helix))
        bore = float(draw.uniform(0.3, 0.7)) * (pitch - 2.5 * module)
        text += f'[gears.{name}]\nteeth = {count}\nprofile_shift = 0.0\nbore_diameter = "{bore:.6g} mm"\n'
        if "web" in kind and name == "wheel":
            rim = pitch - 2.5 * module - 2.0 * module * float(draw.uniform(1.2, 2.5))
            hub = bore + 0.3 * (rim - bore)
            share = float(draw.uniform(0.2, 0.6))
            offset = 0.0 if kind == "web" else 0.1 * width
            text += (
                f'[gears.wheel.web]\nrim_inner_diameter = "{rim:.6g} mm"\nhub_diameter = "{hub:.6g} mm"\n'
                f'width = "{share * width:.6g} mm"\naxial_offset = "{offset:.6g} mm"\n'
            )
            if kind == "web":
                text = text.replace(f'axial_offset = "{offset:.6g} mm"\n', "")
    return text + ('[misalignment]\nin_plane = "0 um"\n' if "web" in kind or kind == "elastic shafts" else "")


def _accuracy(draw, kind: str, module: float, over_face: bool) -> str:
    text = f"[accuracy]\nsteps_per_mesh_cycle = {draw.choice([20, 40, 100] if over_face else [40, 200, 1000])}\n"
    if over_face:
        slices = int(draw.choice([6, 10] if kind == "web beside the middle" else [6, 10, 16, 24]))
        text += f"slices = {slices}\nlayers = {max(ceil(slices / draw.choice([1, 2, 4])), 3)}\n"
        text += f'body_element_size = "{module * draw.uniform(0.3, 1.2):.4g} mm"\n'
    elif kind != "rigid" and draw.random() < 0.7:
        text += f'element = "{draw.choice(["P1", "P2", "Q2"])}"\n'
        text += f'flank_element_size = "{module * draw.uniform(0.012, 0.06):.4g} mm"\n'
    return text


def _of_given_mesh(draw) -> str:
    """The cracked pinion's, without the mesh cycles of a whole turn."""
    from tests.effects.examples import BASE, EXAMPLES

    text = without(BASE, "accuracy") + EXAMPLES["tooth_elasticity"] + EXAMPLES["body_meshes"]
    cycles, steps = draw.integers(1, 16), draw.choice([20, 40, 80])
    return text.replace("mesh_cycles = 1", f"mesh_cycles = {cycles}") + (
        f"[accuracy]\nsteps_per_mesh_cycle = {steps}\n"
    )
