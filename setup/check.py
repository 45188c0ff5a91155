"""Say what this Python lacks of what fenics_gears needs, with the argument "test" its tests too; exit code 0 when
nothing.

Run by the launcher before the program: a plain script that imports nothing of it.
"""

import importlib
import sys

# VTK stands before DOLFINx: DOLFINx 0.5 loaded first aborts VTK 9.7 (clash of std::regex symbols).
NEEDED = (
    "tomllib",
    "vtkmodules.vtkRenderingOpenGL2",
    "pyvista",
    "dolfinx",
    "petsc4py.PETSc",
    "mpi4py.MPI",
    "gmsh",
    "numpy",
    "scipy",
    "numba",
    "h5py",
    "xarray",
    "pydantic",
    "rich",
    "platformdirs",
    "matplotlib",
    "threadpoolctl",
    "jinja2",
)
# What single commands need, which say so themselves, stands here too.
NEEDED_BY_TESTS = (
    "aiohttp",
    "optuna",
    "cmaes",
    "plotly",
    "h5netcdf",
    "pytest",
    "pytest_benchmark",
    "xdist",
    "hypothesis",
    "sphinx",
    "myst_parser",
    "furo",
)


def lacking(names):
    """Names that do not import, each with the reason."""
    missing = {}
    for name in names:
        try:
            module = importlib.import_module(name)
        except Exception as error:  # a broken library raises anything from OSError to RuntimeError
            missing[name] = f"{type(error).__name__}: {error}".splitlines()[0]
            continue
        if name == "pydantic" and not hasattr(module, "model_validator"):
            missing[name] = "version 2 is needed"
        if name == "petsc4py.PETSc" and not module.Sys.hasExternalPackage("mumps"):
            missing[name] = "PETSc is built without MUMPS"
    return missing


if __name__ == "__main__":
    missing = lacking(NEEDED + NEEDED_BY_TESTS if sys.argv[1:] == ["test"] else NEEDED)
    for name, reason in missing.items():
        print(f"{name.split('.')[0]} ({reason})")
    sys.exit(bool(missing))
