"""Contact over a face in the result: line loads, mesh stiffness in the transverse plane, and a warning where much of
the face does not touch."""

from collections.abc import Mapping
from math import sqrt
from typing import Any

import numpy as np
import xarray as xr

from fenics_gears.contact.laws import NO_FORCE
from fenics_gears.contact.mesh_cycle import Cycle

from .load_factors import end_of_line, load_factors
from .pairs import carrying_side
from .side_by_side import SideBySide

# Part of the face that touches, below which there is a warning: end relief takes the load off less than the rest.
NOTABLE_PART = 0.75
# Slices that touch, below which their number does not resolve how.
FEWEST_TOUCHING = 3


class AlongTheFace:
    """Further results of a mesh cycle over a face of many slices."""

    def __init__(self, cycle: Cycle):
        self.face = cycle.face
        self.pair = cycle.pair
        self.coast_flanks = cycle.coast_flanks

    def fields(self, nodes: SideBySide) -> dict[str, np.ndarray]:
        """Line load of each tooth pair on its drive flanks, and on its coast flanks where they can touch (steps, slots,
        slices), N/mm."""
        sides = {"line_load": nodes.drive} | ({"coast_line_load": ~nodes.drive} if self.coast_flanks else {})
        return {name: nodes.by_slice(nodes.normal * side) / self.face.widths for name, side in sides.items()}

    def curves(self, curves: Mapping[str, np.ndarray], nodes: SideBySide) -> dict[str, np.ndarray]:
        """Mesh stiffness in the transverse plane, as ISO 6336-1 has it; and the loaded tooth pairs, not their slices.

        A transverse approach of 1 mm is one of the cosine of the base helix angle along the normal, and of the force
        the transverse part is as large.
        """
        share = self.face.cosine**2
        sides = (True, False)
        loaded = [(nodes.by_slot(nodes.normal * (nodes.drive == side)) > NO_FORCE).sum(axis=1) for side in sides]
        stiffness = {name: share * curves[name] for name in ("mesh_stiffness", "mesh_stiffness_tangent")}
        return stiffness | {"loaded_pairs": np.maximum(*loaded).astype(float)}

    def coordinates(self) -> dict[str, tuple]:
        words = (
            "distance along the axes from the middle of the common face, towards the end from which the pinion is seen"
            " to turn counter-clockwise"
        )
        width = {"units": "mm", "long_name": "width of the slice along the axes"}
        return {
            "face_position": ("face_position", self.face.positions, {"units": "mm", "long_name": words}),
            "face_slice_width": ("face_position", self.face.widths, width),
        }

    def words(self, words: Mapping[str, str]) -> dict[str, str]:
        """Long names of root stress over the face, made of the names for one slice."""
        section = words["root_stress_at_30_degrees"]
        return {**words, "root_stress_at_30_degrees": f"largest {section}", "root_stress_over_face": section}

    def numbers(self, counted: xr.Dataset, known: Mapping[str, Any]) -> dict[str, float | str]:
        """Load factors, and at which end of its line of contact a helical pair has its largest pressure; `known`: the
        numbers that runs in the plane have, too."""
        return {**load_factors(counted, self.pair), **self._end_of_peak(known.get("peak_contact_pressure_diameter"))}

    def _end_of_peak(self, diameter: float | None) -> dict[str, str]:
        if diameter is None or not self.pair.slope:
            return {}
        end = end_of_line(self.pair, sqrt((0.5 * diameter) ** 2 - self.pair.pinion.base_radius**2))
        return {"peak_contact_pressure_beside": end} if end else {}

    def numbers_of_curves(
        self, curves: Mapping[str, np.ndarray], nodes: SideBySide, first: int, contact_steps: int
    ) -> dict[str, float]:
        """Load factors from the `curves` of a run, pair numbers among them, its steps counted from the `first` on;
        fields of the last `contact_steps`."""
        counted = {name: curves[name][first:] for name in ("time", "mesh_phase", "pair_number")}
        stored = max(len(counted["time"]) - contact_steps, 0)
        loads = {name: values[first:][stored:] for name, values in self.fields(nodes).items()}
        last = {f"contact_{name}": values[stored:] for name, values in counted.items()}
        forces = [name for name in curves if name.endswith("normal_force")]
        variables = {
            name: (("time", "slot") if name.startswith("pair_") else "time", curves[name][first:]) for name in forces
        }
        numbers = last.pop("contact_pair_number"), {"number_at_phase_0": nodes.first_number}
        coordinates = {
            **self.coordinates(),
            "time": counted["time"],
            **{name: ("contact_time", values) for name, values in last.items()},
            "contact_pair_number": (("contact_time", "slot"), *numbers),
        }
        fields = {name: (("contact_time", "slot", "face_position"), values) for name, values in loads.items()}
        return load_factors(xr.Dataset(variables | fields, coordinates), self.pair)

    def warnings(self, result: xr.Dataset) -> list[str]:
        """Where the flanks leave much of the face without load in all steps; nothing without stored contact fields."""
        if not result.sizes.get("contact_time"):
            return []
        face = self.face
        loads = result[f"{carrying_side(result)}line_load"].transpose(..., "face_position").values
        touched = (loads > NO_FORCE).reshape(-1, face.slices).any(axis=0)
        part = face.widths[touched].sum() / face.widths.sum()
        if not touched.any() or part >= NOTABLE_PART:
            return []
        begins = face.positions - 0.5 * face.widths
        ends = face.positions + 0.5 * face.widths
        where = ""
        remedy = "lower the crowning or the end relief"
        coarse = ""
        if touched[0] != touched[-1]:
            where = f"at its {'left' if touched[0] else 'right'} end, "
            remedy = "lower [misalignment], correct it by lead_modifications.pinion.helix_slope"
        if touched.sum() < FEWEST_TOUCHING:
            coarse = f"; {touched.sum()} of {face.slices} slices do not resolve how: raise accuracy.slices"
        return [
            f"the flanks touch over {part:.0%} of the face only, {where}from {begins[touched][0]:.3g} to"
            f" {ends[touched][-1]:.3g} mm of {begins[0]:.3g} to {ends[-1]:.3g} mm: {remedy}, or raise the"
            f" torque{coarse}"
        ]
