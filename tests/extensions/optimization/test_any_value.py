"""Any value that TOML has, anywhere in a design file: a design, or a refusal in words (hard case 26)."""

from itertools import product

import pytest
from tests.studies.test_any_value import ANY_VALUE, any_value_taken_or_refused

from fenics_gears.extensions.optimization.design_file import load_design

DESIGN = {
    "scene": '"pair.toml"',
    "title": '"any"',
    "without": '["friction"]',
    "set.tip_relief.start": '"HPSTC"',
    "variables.tip_relief.depth": '["5 um", "60 um"]',
    "variables.load.wheel_torque": '["300 N m", "437 N m"]',
    "loads.load.wheel_torque": '["300 N m", "437 N m"]',
    "loads.weights": "[1, 3]",
    "loads.combine": '"mean"',
    "goals.peak_to_peak_transmission_error": "1",
    "constraints.peak_contact_pressure": '{ at_most = "3000 MPa" }',
    "constraints.peak_contact_pressure.at_most": '"3000 MPa"',
    "tolerances.tolerance_class": "6",
    "tolerances.tip_relief.depth": '"4 um"',
    "tolerances.load.wheel_torque": '"5 N m"',
    "tolerances.samples": "4",
    "tolerances.judged": '"quantile"',
    "tolerances.quantile": "0.75",
    "search.evaluations": "8",
    "search.seed": "1",
}
PLAIN = (
    "scene", "without", "set.tip_relief.start", "variables.tip_relief.depth", "loads.load.wheel_torque",
    "goals.peak_to_peak_transmission_error", "tolerances.tolerance_class",
)  # fmt: skip


@pytest.mark.parametrize("every", [13, pytest.param(1, marks=pytest.mark.nightly)])
def test_any_value_in_any_field_of_a_design(folder, every):
    """A design, or its SceneError."""
    for name, value in list(product(DESIGN, ANY_VALUE))[::every]:
        fields = {other: DESIGN[other] for other in PLAIN} | {name: value}
        any_value_taken_or_refused(load_design, folder / "design.toml", fields)
