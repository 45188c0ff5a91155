"""A finished run, study or train as pictures and pages show it: its charts, its rows of numbers, its words.

`ShownRun` is a run with the cycles that are shown, `Cases` a study; functions named `..._charts` and the like take one
of them and give `charts.Chart`. Rows are (label, value, unit).

Words of a page: `NO_SCENE` and `TOO_FEW` say why a section is missing. Names of numbers: `PEAK_TO_PEAK` of a pair and
`OF_THE_WHOLE` of a train; `SHARE` and `OF_SHARES` of paths; `RUNG` begins those of the solver's methods. `STATES` of a
case stand in the order from done to missing. A page lists `LISTED_CASES` of them; a curve has `MOST_POINTS`.

>>> from fenics_gears import gear_pair, load_scene
>>> from fenics_gears.shown import characteristics, load_in_words
>>> scene = load_scene("demos/lundvall2004.toml")
>>> load_in_words(scene)
'437 N m on the wheel'
>>> label, value, unit = characteristics(gear_pair(scene.gears), scene.measured_over)[0]
>>> label
'operating pressure angle'
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fenics_gears.geometry.characteristics import characteristics, contact_by_fewest
from fenics_gears.geometry.gear_data import GearPairData
from fenics_gears.model.description import describe, effect_states
from fenics_gears.model.train import train_model_of
from fenics_gears.model.train_motion_rows import Rows, frequencies_of_train, motion_rows
from fenics_gears.results.carried_scene import changed_files
from fenics_gears.results.contact_variables import largest_normal_force, transmitted
from fenics_gears.results.numbers import RUNG
from fenics_gears.results.pairs import contact_times
from fenics_gears.results.path_shares import OF_SHARES, SHARE
from fenics_gears.results.sets_in_train import set_runs
from fenics_gears.results.summary import solver_rows, stage_rows
from fenics_gears.scene.train import TrainScene
from fenics_gears.scene.train_mesh import MeshOfScene
from fenics_gears.show.cases import LISTED_CASES, OF_THE_WHOLE, PEAK_TO_PEAK, STATES, Cases
from fenics_gears.show.chart import over_time
from fenics_gears.show.line_load import line_loads
from fenics_gears.show.motion import error_values, force_charts, motion_charts, pair_forces
from fenics_gears.show.orders import bars_by_origin, order_spectrum
from fenics_gears.show.over_face import charts_over_face
from fenics_gears.show.pair_drawing import drawings
from fenics_gears.show.panels import MOST_POINTS, digits, factor, in_unit
from fenics_gears.show.planetary import orbits, points_of_ring
from fenics_gears.show.planetary import shares as planet_shares
from fenics_gears.show.pressure import has_pressure, largest_pressures, pressure_maps
from fenics_gears.show.run import NO_SCENE, TOO_FEW, ShownRun, load_in_words, shown_mesh
from fenics_gears.show.study_charts import effort_charts, result_charts
from fenics_gears.show.train import bent_shafts_of, drawing_of
from fenics_gears.show.train import errors as train_errors
from fenics_gears.show.train import orders as train_orders
from fenics_gears.simulation.stored_forces import stored_index

if TYPE_CHECKING:
    from fenics_gears.show.chart import Chart

__all__ = [
    "LISTED_CASES", "MOST_POINTS", "NO_SCENE", "OF_SHARES", "OF_THE_WHOLE", "PEAK_TO_PEAK", "RUNG", "SHARE", "STATES",
    "TOO_FEW", "Cases", "GearPairData", "MeshOfScene", "Rows", "ShownRun", "TrainScene", "bars_by_origin",
    "bent_shafts_of", "changed_files", "characteristics", "charts_over_face", "contact_by_fewest", "contact_times",
    "describe", "digits", "drawing_of", "drawings", "effect_states", "effort_charts", "error_values", "factor",
    "force_charts", "frequencies_of_train", "has_pressure", "in_unit", "largest_normal_force", "largest_pressures",
    "line_loads", "load_in_words", "motion_charts", "motion_rows", "orbits", "order_spectrum", "over_time",
    "pair_forces", "planet_shares", "points_of_ring", "pressure_maps", "result_charts", "set_runs", "shown_mesh",
    "solver_rows",
    "stage_rows", "stored_index", "stress_drawing", "train_errors", "train_model_of", "train_orders", "transmitted",
]  # fmt: skip


def stress_drawing(run: ShownRun, index: int) -> tuple[bytes, str, list[Chart]]:
    """PNG of both gears in mesh at a stored time, what it shows in words, and the charts that go with it."""
    # A page without the picture needs no DOLFINx.
    from fenics_gears.show.stress_drawn import drawn

    return drawn(run, index)
