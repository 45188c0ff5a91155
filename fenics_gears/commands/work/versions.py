"""What ``gears --version -v`` says of the libraries."""

from fenics_gears.system import blas
from fenics_gears.system.versions import processor, versions


def print_versions() -> int:
    print(versions().removeprefix("fenics_"), processor(), sep="\n")
    for each in blas.libraries():
        words = f"kernels for {each['kernels']}, threads {each['threads']}"
        print(f"OpenBLAS {each['version']} ({each['file']}): {words}")
    return 0
