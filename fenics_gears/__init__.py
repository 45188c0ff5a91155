"""Spur and helical gear pairs as flexible multi-body systems with frictional contact.

``load_scene`` reads a scene file and ``build_scene`` takes its sections as dictionaries; ``simulate`` runs a scene and
returns an ``xarray.Dataset``.
"""

import importlib

__version__ = "0.3.0"
__all__ = ["__version__", "build_scene", "load_scene", "simulate"]

# Loaded when first asked for, so that `gears --help` does not wait for the finite element stack.
_HOMES = {
    "build_scene": "fenics_gears.scene.read",
    "load_scene": "fenics_gears.scene.read",
    "simulate": "fenics_gears.simulation.simulate",
}


def __getattr__(name: str):
    """Load ``build_scene``, ``load_scene`` or ``simulate`` on first use."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    # What BLAS, MPI and VTK read from the environment must stand there before they are loaded.
    importlib.import_module("fenics_gears.system.environment").prepare()
    return getattr(importlib.import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    """What is loaded on first use too."""
    return sorted({*globals(), *__all__} - {"importlib"})
