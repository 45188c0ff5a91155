"""Spur and helical gear pairs as flexible multi-body systems with frictional contact.

``load_scene`` reads a scene file and ``build_scene`` takes its sections as dictionaries; ``simulate`` runs a scene and
returns an ``xarray.Dataset``. ``__all__`` is all that programs and extensions may rely on: these names, and the modules
``units``, ``user_file``, ``spectrum``, ``charts`` and ``command_line``. Everything is in N, mm, s and rad unless it
says otherwise.
"""

import importlib

__version__ = "0.3.0"

# Where each name is defined. Loaded when first asked for, so that `gears --help` does not wait for the finite element
# stack.
_HOMES = {
    # A scene: read, checked, run.
    "Scene": "scene.data",
    "Load": "scene.data",
    "load_scene": "scene.read",
    "build_scene": "scene.read",
    "scene_from_text": "scene.read",
    "as_toml": "inputs.written",
    "toml_value": "inputs.written",
    "check_geometry": "model.modification",
    "simulate": "studies.simulate",
    # What follows from a scene without a run.
    "model_of": "model.model",
    "expected_cost": "model.cost",
    "lumped_gears": "model.drivetrain",
    "mesh_stiffness": "model.drivetrain",
    # The gears.
    "Gear": "geometry.gear",
    "GearPair": "geometry.pair",
    "Material": "geometry.gear_data",
    "RACKS": "geometry.gear_data",
    "gear_pair": "geometry.pair",
    "base_helix_angle": "geometry.tooth_thickness",
    "involute_function": "geometry.involute",
    "face_opening": "geometry.face",
    "single_stiffness": "geometry.iso_6336",
    "mesh_factor": "geometry.iso_6336",
    "flank_tolerance": "geometry.flank_tolerance",
    "helix_tolerance": "geometry.flank_tolerance",
    # A result: its file, its scene, its settled steps, its numbers.
    "load": "results.files",
    "save": "results.files",
    "save_tables": "results.curves_table",
    "carried_scene": "results.carried_scene",
    "of_settled": "results.settled",
    "mesh_force": "results.contact_variables",
    "HARMONIC_NAMES": "results.key_numbers",
    "MICROMETRE": "results.key_numbers",
    # Errors, each with its exit code.
    "GearsError": "errors",
    "SceneError": "errors",
    "GeometryError": "errors",
    "ComputationError": "errors",
}
_MODULES = {
    "units": "inputs.units",
    "spectrum": "results.spectrum",
    "user_file": "system.user_file",
    "charts": "charts",
    "command_line": "command_line",
}
__all__ = ["__version__", *_HOMES, *_MODULES]


def __getattr__(name: str):
    """Load a name of ``__all__`` on first use."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    # What BLAS, MPI and VTK read from the environment must stand there before they are loaded.
    importlib.import_module("fenics_gears.system.environment").prepare()
    home = importlib.import_module(f"fenics_gears.{_HOMES.get(name) or _MODULES[name]}")
    found = globals()[name] = getattr(home, name) if name in _HOMES else home
    return found


def __dir__() -> list[str]:
    """What is loaded on first use too."""
    return sorted({*globals(), *__all__} - {"importlib"})
