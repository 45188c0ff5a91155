"""Scenes of gears on elastic shafts, coarse over the face."""

import numpy as np
from tests.hard_cases.invariants import finished_helical_run

FEW = "slices = 5\ncontact_nodes = 9\nsteps_per_mesh_cycle = 8"
INPUT = """
[shafts.input]
sections = [{ length = "40 mm", diameter = "28 mm", bore = "8 mm" }, { length = "90 mm", diameter = "35 mm" }]
gear_at = "114 mm"
torque_at = "0 mm"
"""
PINION = """
[[bearings.pinion]]
at = "12 mm"
radial_stiffness = "0.3e6 N/mm"
axial_stiffness = "0.1e6 N/mm"
[[bearings.pinion]]
at = "85 mm"
radial_stiffness = "0.4e6 N/mm"
tilting_stiffness = "1e7 N mm/rad"
"""
OUTPUT = """
[shafts.output]
sections = [{ length = "150 mm", diameter = "40 mm" }]
gear_at = "60 mm"
torque_at = "150 mm"
material = "ductile cast iron"
"""
ROWS = "[[3e5, 1e4, 0, 0, 2e5], [1e4, 3e5, 0, 1e5, 0], [0, 0, 2e5, 0, 0], [0, 1e5, 0, 1e7, 0], [2e5, 0, 0, 0, 1e7]]"
WHEEL = f"""
[[bearings.wheel]]
at = "20 mm"
stiffness_matrix = {ROWS}
[[bearings.wheel]]
at = "110 mm"
radial_stiffness = "0.4e6 N/mm"
"""
ELASTIC = INPUT + PINION + OUTPUT + WHEEL
# Teeth cut into both shafts, on bearings that are alike in all directions.
CUT = (
    (INPUT + PINION + OUTPUT + WHEEL)
    .replace("torque_at", 'seat = "integral"\ntorque_at')
    .replace(f"stiffness_matrix = {ROWS}", 'radial_stiffness = "0.3e6 N/mm"\naxial_stiffness = "0.2e6 N/mm"')
    .replace('material = "ductile cast iron"\n', "")
)
# The same with a bearing of the wheel that is not alike in all directions, on the other side of which is another one.
SKEWED = CUT.replace('radial_stiffness = "0.3e6 N/mm"\naxial_stiffness = "0.2e6 N/mm"', f"stiffness_matrix = {ROWS}")
# The same on shafts that are as thick as the bores of helical pairs.
PRESSED = CUT.replace("integral", "press fit").replace('"35 mm"', '"22.36 mm"').replace('"40 mm" }]', '"43.48 mm" }]')
INERTIA = '[inertia]\nmass = "2 kg"\nmoment_of_inertia = "0.002 kg m^2"\n'
# The same shafts with a density, and what vibrates.
VIBRATING = (
    ELASTIC.replace('torque_at = "0 mm"', 'torque_at = "0 mm"\nmaterial = { density = "7.85 g/cm^3" }').replace(
        '"ductile cast iron"', '{ name = "ductile cast iron", density = "7.2 g/cm^3" }'
    )
    + INERTIA
)
ROLLING = (
    INPUT
    + """
[[bearings.pinion]]
at = "12 mm"
rolling = { number = 9, diameter = "12.7 mm", pitch_diameter = "65 mm", clearance = "15 um" }
[[bearings.pinion]]
at = "85 mm"
[bearings.pinion.rolling]
elements = "rollers"
number = 14
diameter = "9 mm"
length = "10 mm"
pitch_diameter = "65 mm"
clearance = "20 um"
"""
)
# An input shaft as of an e-axle: teeth cut in between its rolling bearings.
E_AXLE = (
    ROLLING.replace("114 mm", "58 mm").replace('"85 mm"', '"110 mm"').replace("torque", 'seat = "integral"\ntorque', 1)
)


def largest_difference_of_slow_runs(sections: str) -> float:
    """Largest difference of a run with [inertia], at a hundredth of a mesh cycle a second, from one without, in parts
    of each quantity's largest value."""
    moving, still = (
        finished_helical_run(more, offset=2.0, accuracy=FEW, frequency=0.01).result
        for more in (sections, sections.replace(INERTIA, ""))
    )
    names = ("transmission_error", "bearing_force_x", "bearing_moment_y", "tilt_y", "shaft_deflection_x")
    return max(
        np.nanmax(np.abs(moving[name].values - still[name].values)) / np.nanmax(np.abs(still[name].values))
        for name in names
    )
