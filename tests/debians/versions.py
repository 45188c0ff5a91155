"""Print the versions of what the program stands on, as JSON. Run inside each system by its own Python."""

import json
import platform

# VTK before DOLFINx: see setup/check.py.
from vtkmodules.vtkCommonCore import vtkVersion  # isort: skip
import dolfinx
import gmsh
import numpy
import pyvista
from petsc4py import PETSc

print(
    json.dumps(
        {
            "Python": platform.python_version(),
            "DOLFINx": dolfinx.__version__,
            "PETSc": ".".join(map(str, PETSc.Sys.getVersion())),
            "numpy": numpy.__version__,
            "VTK": vtkVersion().GetVTKVersion(),
            "pyvista": pyvista.__version__,
            "gmsh": gmsh.__version__,
        }
    )
)
