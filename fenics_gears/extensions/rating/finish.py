"""What the standard wants to know of material, finish and oil."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Finish:
    """Endurance limits (MPa), flank tolerance class of ISO 1328-1, mean peak-to-valley roughness Rz (um) and the oil's
    viscosity grade ISO VG (mm^2/s at 40 degC).

    `flank_limit` is sigma_Hlim, `root_limit` sigma_Flim, which the stress correction 2 of the test gear makes sigma_FE.
    Of case-carburised steel unless given.
    """

    flank_limit: float = 1500.0
    root_limit: float = 430.0
    tolerance_class: int = 6
    flank_roughness: float = 4.8
    root_roughness: float = 16.0
    viscosity_grade: float = 100.0
    application_factor: float = 1.0
