"""Spur and helical gear pairs as flexible multi-body systems with frictional contact.

``load_scene`` reads a scene file and ``build_scene`` takes its sections as dictionaries; ``simulate`` runs a scene and
returns an ``xarray.Dataset``. ``__all__`` is all that programs and extensions may rely on: these names and, among them,
the names of its modules. Everything is in N, mm, s and rad unless it says otherwise.
"""

import importlib

__version__ = "0.4.0"

# The names are listed in `__init__.pyi`, which editors and type checkers read as well. Each is loaded when first asked
# for, so that `gears --help` does not wait for the finite element stack.
with open(f"{__file__}i", encoding="utf-8") as _stub:
    # Each line of them says: from HOME import NAME as NAME.
    _HOMES = {words[3]: words[1] for words in map(str.split, _stub) if words[:1] == ["from"]}
__all__ = ["__version__", *_HOMES]


def __getattr__(name: str):
    """Load a name of ``__all__`` on first use."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    # What BLAS, MPI and VTK read from the environment must be there before they are loaded.
    importlib.import_module("fenics_gears.system.environment").prepare()
    home = importlib.import_module(_HOMES[name])
    # Where a module fails to be imported, its own error is told.
    known = vars(home)[name] if name in vars(home) else importlib.import_module(f"{home.__name__}.{name}")
    globals()[name] = known
    return known


def __dir__() -> list[str]:
    """What is loaded on first use too."""
    return sorted({*globals(), *__all__} - {"importlib"})
