"""Scenes and files of one's own as TOML text: read, changed field by field, and refused with the place of each mistake.

A field has a path, such as ``load.wheel_torque``; its value is written as a scene has it. `fields` changes and
describes fields, `Section` declares sections of one's own, `model_of_tree` makes the model of a parsed scene.

>>> from fenics_gears.scene_text import fields, parsed, value_at
>>> tree = parsed('[load]\\nwheel_torque = "400 N m"', "mine.toml")
>>> value_at(fields.changed(tree, ("load", "wheel_torque"), "500 N m"), "load", "wheel_torque")
'500 N m'
>>> fields.is_numeric(("load", "wheel_torque"))
True
"""

from fenics_gears.inputs.allowed import AllowedFile, AllowedNumber
from fenics_gears.inputs.fields import choice, declared, text, whole_number
from fenics_gears.inputs.limits import Limit, limits_of, what_is_allowed
from fenics_gears.inputs.problem import NOTHING_DONE, Mistakes, Problem, did_you_mean, line_numbers, listed
from fenics_gears.inputs.section import Section, names_in, read
from fenics_gears.inputs.tree import GEARS, Tree, over_the_face, value_at, wheel_torque
from fenics_gears.inputs.written import as_written
from fenics_gears.scene.data import LOAD_WORDS
from fenics_gears.scene.parsing import is_train, name_of, parsed, text_of
from fenics_gears.scene.read import load_scene_or_train
from fenics_gears.scene.schema import known_paths
from fenics_gears.scene.train_pair import STAGES
from fenics_gears.studies import fields
from fenics_gears.studies.axis import AxisError, factor_of, number_in, values_in_words, values_of
from fenics_gears.studies.scenes import Models, NoScene, SceneChanges, model_of_tree
from fenics_gears.studies.study_file import entries, left_out

__all__ = [
    "GEARS", "LOAD_WORDS", "NOTHING_DONE", "STAGES", "AllowedFile", "AllowedNumber", "AxisError", "Limit", "Mistakes",
    "Models", "NoScene", "Problem", "SceneChanges", "Section", "Tree", "as_written", "choice", "declared",
    "did_you_mean", "entries", "factor_of", "fields", "is_train", "known_paths", "left_out", "limits_of",
    "line_numbers", "listed", "load_scene_or_train", "model_of_tree", "name_of", "names_in", "number_in",
    "over_the_face", "parsed", "read", "text", "text_of", "value_at", "values_in_words", "values_of",
    "what_is_allowed", "wheel_torque", "whole_number",
]  # fmt: skip
