"""The cases of a study: swept values, results and file of each."""

import os
import re
import urllib.parse
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import xarray as xr

from fenics_gears import results
from fenics_gears.errors import ComputationError
from fenics_gears.results.layout import OVERALL
from fenics_gears.results.planetary import kinds_of_meshes
from fenics_gears.results.stored import stored
from fenics_gears.results.validity import NO_MEANING
from fenics_gears.studies.axis import SAMPLE
from fenics_gears.system.output import unsealed

from .panels import factor

PRESENT = "present"
ABSENT = "absent"
# Sections whose name says nothing that their fields' names do not.
PLAIN_SECTIONS = ("motion", "load", "gears", "accuracy", "output", "stages")
PEAK_TO_PEAK = "peak_to_peak_transmission_error"
OF_THE_WHOLE = f"peak_to_peak_{OVERALL}"
# Between what a measure is and the mesh that it is of.
OF_MESH = ", of mesh "
MEAN_OF_THE_WHOLE = f"mean_{OVERALL}"
K_GAMMA = "load_sharing_factor"
# A value this many times the largest of the other cases would make them a line along the axis.
FAR_OFF = 10.0
LISTED_CASES = 12
STATES = ("done", "warnings", "failed", "missing")


@dataclass(frozen=True)
class SweptField:
    """A swept field: its path in the scene, its unit, its value in each case (n,), numbers (not a number where it is
    absent) or words."""

    name: str
    path: str
    unit: str
    values: np.ndarray

    @property
    def numeric(self) -> bool:
        """Whether its values are numbers."""
        return self.values.dtype.kind in "fiu"

    @property
    def called(self) -> str:
        """Its path in words: "mesh frequency" of `motion.mesh_frequency`, "tip relief depth" of `tip_relief.depth`."""
        section, _, rest = self.path.partition(".")
        return (rest if rest and section in PLAIN_SECTIONS else self.path).replace(".", " ").replace("_", " ")

    @property
    def title(self) -> str:
        """That with its unit, for an axis or a column."""
        return f"{self.called} ({self.unit})" if self.unit else self.called

    def words(self, case: int) -> str:
        """The value in a case."""
        value = self.values[case]
        if not self.numeric:
            return str(value)
        return f"{value:.6g}" if np.isfinite(value) else ABSENT

    def setting(self, case: int) -> str:
        """Its value in a case in words: "with friction", "mesh frequency 200 Hz"."""
        words = self.words(case)
        if words in (PRESENT, ABSENT):
            return f"{'with' if words == PRESENT else 'without'} {self.called}"
        return f"{self.called} {words} {self.unit if self.numeric else ''}".rstrip()


@dataclass(frozen=True)
class Cases:
    """All cases of a study's dataset, where it was read from, and where a page on it goes to."""

    dataset: xr.Dataset
    file: Path
    output: Path | None = None

    @property
    def count(self) -> int:
        """How many there are."""
        return int(self.dataset["failed"].size)

    @cached_property
    def fields(self) -> list[SweptField]:
        """The swept fields, the last one turning fastest."""
        shape = self.dataset["failed"]
        swept = []
        for name, coordinate in self.dataset.coords.items():
            if name in ("case", SAMPLE, "mesh_phase", "gear", "mesh") or not set(coordinate.dims) <= set(shape.dims):
                continue
            values = coordinate.broadcast_like(shape).transpose(*shape.dims).values.ravel()
            unit, path = (str(coordinate.attrs.get(*each)) for each in (("units", ""), ("long_name", name)))
            swept.append(SweptField(str(name), path, "" if unit == "1" else unit.replace("um", "µm"), values))
        order = {dimension: place for place, dimension in enumerate(shape.dims)}
        return sorted(swept, key=lambda field: order.get(field.name, len(order)))

    def numbers(self, name: str) -> np.ndarray:
        """A number of each case (n,), not a number where there is none, as of most where a study keeps few; of trains
        the largest of their meshes."""
        if name not in self.dataset:
            return np.full(self.count, np.nan)
        values = self.dataset[name]
        values = values.max("mesh") if "mesh" in values.dims else values
        return values.values.ravel().astype(float)

    @property
    def of_trains(self) -> bool:
        """Whether the cases are trains."""
        return OF_THE_WHOLE in self.dataset

    @property
    def meshes(self) -> list[str]:
        """Names of the meshes of trains; none where numbers of the whole alone are kept."""
        return [str(each) for each in self.dataset["mesh"].values] if "mesh" in self.dataset else []

    def texts(self, name: str) -> list[str]:
        """A text of each case, empty where there is none."""
        return [str(each) for each in self.dataset[name].values.ravel()]

    @cached_property
    def states(self) -> list[str]:
        """The state of each case: one of `STATES`."""
        done = np.isfinite(self.numbers(OF_THE_WHOLE if self.of_trains else PEAK_TO_PEAK))
        failed = self.dataset["failed"].values.ravel()
        return [
            STATES[1] if ready and said else STATES[0] if ready else STATES[2] if wrong else STATES[3]
            for ready, wrong, said in zip(done, failed, self.texts("warnings"))
        ]

    def far_off(self, values: np.ndarray) -> np.ndarray:
        """Which cases (n,) have a value that is many times all others' and belongs to a result without meaning."""
        without_meaning = np.array([NO_MEANING in each for each in self.texts("warnings")]) & np.isfinite(values)
        sound = np.isfinite(values) & ~without_meaning
        return without_meaning & (np.abs(values) > FAR_OFF * np.abs(values[sound]).max(initial=0.0)) & sound.any()

    def far_off_in_words(self, far_off: np.ndarray) -> str:
        """A note on cases that are not drawn; empty without any."""
        count = np.count_nonzero(far_off)
        if not count:
            return ""
        cases = ", ".join(map(str, np.flatnonzero(far_off)[:LISTED_CASES])) + (", …" if count > LISTED_CASES else "")
        which = f"Case {cases}, whose result has" if count == 1 else f"Cases {cases}, whose results have"
        return (
            f"{which} no meaning and more than {FAR_OFF:g} times the others' value, {'is' if count == 1 else 'are'}"
            " left out; the table of cases has all."
        )

    def words(self, case: int) -> str:
        """A case by its swept values."""
        return ", ".join(field.setting(case) for field in self.fields)

    def run(self, case: int) -> xr.Dataset | None:
        """The run of a case; None where its file is not there or damaged."""
        name = self.texts("case_file")[case]
        try:
            return results.load(self.file.parent / name) if name else None
        except ComputationError:
            return None

    def link(self, case: int) -> str:
        """Where a case's report, or else its file, is from the page on; empty where there is none."""
        name = self.texts("case_file")[case]
        if not name:
            return ""
        file = self.file.parent / name
        page = file.with_suffix(".html")
        target = next((each for each in (page, file) if each.is_file()), None)
        if target is None:
            return ""
        return urllib.parse.quote(os.path.relpath(target.resolve(), self.output.parent.resolve()))

    @cached_property
    def error_scale(self) -> tuple[float, str]:
        """Factor and unit of a transmission error in rad: lengths where all cases have the same gears."""
        if not any(field.path.startswith("gears") for field in self.fields):
            done = next((case for case, state in enumerate(self.states) if state in STATES[:2]), None)
            radius = None if done is None else self._base_radius(done)
            if radius is not None:
                return radius * factor("mm", "µm"), "µm"
        return factor("rad", "µrad"), "µrad"

    def _base_radius(self, case: int) -> float | None:
        try:
            with unsealed(self.file.parent / self.texts("case_file")[case]) as content, stored(content) as run:
                return float(run.attrs["base_radius_wheel"])
        # HDF5 raises whatever it met in a damaged file.
        except Exception:
            return None

    @cached_property
    def measures(self) -> dict[str, tuple[np.ndarray, str, str]]:
        """What is compared between cases: values (n,), unit, name."""
        if self.of_trains:
            return self._of_trains
        measures = {
            PEAK_TO_PEAK: (*self.error_scale, "Transmission error, peak to peak"),
            "mean_transmission_error": (*self.error_scale, "Transmission error, mean"),
            "max_normal_force": (1.0, "N", "Largest mesh force"),
        }
        return {name: (self.numbers(name) * scale, unit, words) for name, (scale, unit, words) in measures.items()}

    @property
    def _of_trains(self) -> dict[str, tuple[np.ndarray, str, str]]:
        """The measures of trains: of the last shaft, and of the wheel of each mesh."""
        scale, unit = factor("rad", "µrad"), "µrad"
        found = {
            OF_THE_WHOLE: (self.numbers(OF_THE_WHOLE) * scale, unit, "Overall transmission error, peak to peak"),
            MEAN_OF_THE_WHOLE: (self.numbers(MEAN_OF_THE_WHOLE) * scale, unit, "Overall transmission error, mean"),
        }
        for factor_of_set, words in (
            (K_GAMMA, "K_gamma of the sun's meshes"),
            (f"{K_GAMMA}_ring", "K_gamma of the ring's"),
        ):
            if factor_of_set in self.dataset:
                found[factor_of_set] = (self.numbers(factor_of_set), "", words)
        for mesh, places in kinds_of_meshes(self.meshes).items():
            values = self.dataset[PEAK_TO_PEAK].isel(mesh=places).max("mesh").values.ravel() * scale
            name = f"{PEAK_TO_PEAK}_{re.sub(r'[^A-Za-z0-9-]+', '_', mesh)}"
            found[name] = (values, unit, f"Transmission error, peak to peak{OF_MESH}{mesh}")
        return found
