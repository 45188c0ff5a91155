"""Many runs: studies of a scene, and runs that share gears and contact equations, by one process or by all of a job.

`study_of` and `run_with` make and run a study; `Runs` computes the `Run` of each model that is not kept yet. What a run
of a scene depends on is told by `effects_on`, `common_period` and `settling_time`.

>>> from fenics_gears import load_scene
>>> from fenics_gears.many_runs import common_period, effects_on, quasi_static
>>> scene = load_scene("demos/lundvall2004.toml")
>>> [effect.section for effect in effects_on(quasi_static(scene))]
['tooth_elasticity', 'shafts', 'bearings', 'friction']
>>> common_period(scene)
1
"""

from fenics_gears.effects import common_period, effects_on
from fenics_gears.results.attributes import RESULT_ATTRIBUTES
from fenics_gears.results.dataset import RunResult
from fenics_gears.results.files import save
from fenics_gears.results.planetary import LARGEST_OF_SETS, kinds_of_meshes
from fenics_gears.results.settled import settling_time
from fenics_gears.results.summary import result_rows
from fenics_gears.results.together import OVER_FACE
from fenics_gears.results.train_rows import train_rows
from fenics_gears.results.validity import NO_MEANING
from fenics_gears.runs.common_windows import CommonWindows
from fenics_gears.runs.condensing import BODY, gear_tasks
from fenics_gears.runs.folder import sole_writer
from fenics_gears.runs.gear_store import GearStore, operators_key
from fenics_gears.runs.lines import FolderOfLines, kept
from fenics_gears.runs.record import NUMBERS, OF_TRAINS, numbers_of, record_of
from fenics_gears.runs.run import Run, run_of
from fenics_gears.runs.runs import Failure, Runs, most_together, solved_at_once
from fenics_gears.runs.simulate import settled_run
from fenics_gears.runs.spent import Spent, seconds_of
from fenics_gears.runs.team import Alone, Together, ranks
from fenics_gears.simulation.dynamic_factor import quasi_static
from fenics_gears.studies.combine import load_combined
from fenics_gears.studies.run_study import Outcome, run_with
from fenics_gears.studies.study import Study
from fenics_gears.studies.study_file import study_of
from fenics_gears.studies.summary import last_words, summary_rows
from fenics_gears.system.job import communicator
from fenics_gears.system.progress import Interruption, Progress, SilentProgress

__all__ = [
    "BODY", "LARGEST_OF_SETS", "NO_MEANING", "NUMBERS", "OF_TRAINS", "OVER_FACE",
    "RESULT_ATTRIBUTES", "Alone", "CommonWindows", "Failure", "FolderOfLines", "GearStore", "Interruption", "Outcome",
    "Progress", "Run", "RunResult", "Runs", "SilentProgress", "Spent", "Study", "Together", "common_period",
    "communicator", "effects_on", "gear_tasks", "kept", "kinds_of_meshes", "last_words", "load_combined",
    "most_together", "numbers_of", "operators_key", "quasi_static", "ranks", "record_of", "result_rows", "run_of",
    "run_with", "save", "seconds_of", "settled_run", "settling_time", "sole_writer", "solved_at_once", "study_of",
    "summary_rows", "train_rows",
]  # fmt: skip
