"""All names that programs and extensions may rely on, and where each is defined: ``__init__.py`` loads them by this
list when they are first asked for."""

from fenics_gears import charts as charts
from fenics_gears import command_line as command_line
from fenics_gears import many_runs as many_runs
from fenics_gears import measuring as measuring
from fenics_gears import pages as pages
from fenics_gears import scene_text as scene_text
from fenics_gears import shown as shown
from fenics_gears.dynamics.frequencies import Vibration as Vibration
from fenics_gears.dynamics.frequencies import vibrations as vibrations
from fenics_gears.dynamics.shaft_at_work import face_compliance_of_shafts as face_compliance_of_shafts
from fenics_gears.dynamics.shaft_at_work import middles_of_slices as middles_of_slices
from fenics_gears.errors import ComputationError as ComputationError
from fenics_gears.errors import GearsError as GearsError
from fenics_gears.errors import GeometryError as GeometryError
from fenics_gears.errors import SceneError as SceneError
from fenics_gears.geometry.face import face_opening as face_opening
from fenics_gears.geometry.flank_tolerance import flank_tolerance as flank_tolerance
from fenics_gears.geometry.flank_tolerance import helix_tolerance as helix_tolerance
from fenics_gears.geometry.gear import Gear as Gear
from fenics_gears.geometry.gear_data import RACKS as RACKS
from fenics_gears.geometry.gear_data import USUAL_BORE as USUAL_BORE
from fenics_gears.geometry.gear_data import Material as Material
from fenics_gears.geometry.involute import inverse_involute as inverse_involute
from fenics_gears.geometry.involute import involute_function as involute_function
from fenics_gears.geometry.involute import sum_of_profile_shifts as sum_of_profile_shifts
from fenics_gears.geometry.iso_6336 import mesh_factor as mesh_factor
from fenics_gears.geometry.iso_6336 import single_stiffness as single_stiffness
from fenics_gears.geometry.pair import GearPair as GearPair
from fenics_gears.geometry.pair import gear_pair as gear_pair
from fenics_gears.geometry.tooth_thickness import base_helix_angle as base_helix_angle
from fenics_gears.inputs import units as units
from fenics_gears.inputs.written import as_toml as as_toml
from fenics_gears.inputs.written import toml_value as toml_value
from fenics_gears.model.cost import expected_cost as expected_cost
from fenics_gears.model.drivetrain import lumped_gears as lumped_gears
from fenics_gears.model.drivetrain import mesh_stiffness as mesh_stiffness
from fenics_gears.model.model import model_of as model_of
from fenics_gears.model.modification import check_geometry as check_geometry
from fenics_gears.results import spectrum as spectrum
from fenics_gears.results.carried_scene import carried_scene as carried_scene
from fenics_gears.results.contact_variables import mesh_force as mesh_force
from fenics_gears.results.curves_table import save_tables as save_tables
from fenics_gears.results.files import load as load
from fenics_gears.results.key_numbers import HARMONIC_NAMES as HARMONIC_NAMES
from fenics_gears.results.key_numbers import MICROMETRE as MICROMETRE
from fenics_gears.results.layout import MICRORADIANS as MICRORADIANS
from fenics_gears.results.layout import OVERALL as OVERALL
from fenics_gears.results.mesh_of_train import carried_train as carried_train
from fenics_gears.results.mesh_of_train import mesh_run as mesh_run
from fenics_gears.results.overall_orders import cycles_of_meshes as cycles_of_meshes
from fenics_gears.results.overall_orders import overall_orders as overall_orders
from fenics_gears.results.settled import of_settled as of_settled
from fenics_gears.runs.simulate import simulate as simulate
from fenics_gears.runs.train import simulate_train as simulate_train
from fenics_gears.scene.data import Load as Load
from fenics_gears.scene.data import Scene as Scene
from fenics_gears.scene.read import build_scene as build_scene
from fenics_gears.scene.read import load_scene as load_scene
from fenics_gears.scene.read import scene_from_text as scene_from_text
from fenics_gears.scene.train import load_train as load_train
from fenics_gears.scene.train import train_from_text as train_from_text
from fenics_gears.system import user_file as user_file

__version__: str
__all__: list[str]
