"""Errors and times of runs: whole settings of `[accuracy]` and their runs, distances of answers, subsets of effects.

`SettingRuns` runs a scene with a `Setting` once, and `answer` has its measures; `distance` compares one measure of two
answers, relative to the second. Of two sizes `part_left` tells what is left. `run_sharing` runs a model with gears that
other runs have, `Times` are its seconds by stage.

An `Answer` is a dictionary: `SPAN`, `MEAN`, `DEFECT` and, over the face, `OVER_FACE` with `FACE_LOAD` are names of its
measures. `STAGES` are those of `Times`, `SECTIONS` the effects of a scene. Values that settings take: `AVERAGED`
contact nodes, `NODE_SPACING` flank elements apart; gears condensed `ONCE` or at `EVERY_STEP`; the models `RIGID_TEETH`,
`ISO_6336` and `STIFFNESS_TABLE`.

>>> from fenics_gears.measuring import part_left
>>> round(part_left((1.0, 0.5), order=2.0), 3)
0.333
"""

from fenics_gears.contact.interpolation import AVERAGED
from fenics_gears.contact.mesh_cycle import Cycle
from fenics_gears.effects import SECTIONS, effect_named, every_effect, without
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.root_stress import root_stress_rows
from fenics_gears.geometry.lead_modification import LeadModification
from fenics_gears.model.model import Model
from fenics_gears.model.resolution import EVERY_STEP, ONCE
from fenics_gears.runs.one_run import completed
from fenics_gears.runs.settings.convergence import part_left
from fenics_gears.runs.settings.measures import (
    DEFECT,
    FACE_LOAD,
    MEAN,
    OVER_FACE,
    SPAN,
    Answer,
    answer,
    comparable,
    distance,
    distances,
    judged,
    measures_of,
)
from fenics_gears.runs.settings.setting import Setting, default_setting, half_width, own_setting, without_settings
from fenics_gears.runs.settings.setting_runs import SettingRuns
from fenics_gears.runs.settings.target import choose
from fenics_gears.runs.timed import STAGES, Times, run_sharing, shared_gears
from fenics_gears.scene.accuracy import NODE_SPACING
from fenics_gears.scene.data import ISO_6336, RIGID_TEETH, STIFFNESS_TABLE, Accuracy, Output
from fenics_gears.scene.rules import broken_rules
from fenics_gears.simulation.stored_forces import stored_forces
from fenics_gears.simulation.warm_up import compile_kernels
from fenics_gears.system.versions import processor, versions

__all__ = [
    "AVERAGED", "DEFECT", "EVERY_STEP", "FACE_LOAD", "ISO_6336", "MEAN", "NODE_SPACING", "ONCE", "OVER_FACE",
    "RIGID_TEETH", "SECTIONS", "SPAN", "STAGES", "STIFFNESS_TABLE", "Accuracy", "Answer", "Cache", "Cycle",
    "LeadModification", "Model", "Output", "Setting", "SettingRuns", "Times", "answer", "broken_rules", "choose",
    "comparable", "compile_kernels", "completed", "default_setting", "distance", "distances", "effect_named",
    "every_effect", "half_width", "judged", "measures_of", "own_setting", "part_left", "processor",
    "root_stress_rows", "run_sharing", "shared_gears", "stored_forces", "versions", "without", "without_settings",
]  # fmt: skip
