"""A release: one version everywhere, a conda recipe that says what pyproject.toml says, a wheel that is whole."""

import tomllib
import zipfile

import pytest
import yaml
from release.__main__ import one_version, versions
from release.wheel import CHECKOUT, NotReady, built, compare, files_of_package, try_out

import fenics_gears

CONDA_NAMES = {"matplotlib": "matplotlib-base", "gmsh": "python-gmsh"}
NOT_BY_PIP = {"fenics-dolfinx", "petsc4py", "petsc", "mpi4py", "h5py", "h5netcdf"}


def test_files_name_one_version():
    named = versions()
    # Between releases the changes have no version yet.
    if named["CHANGELOG.md"] == "Unreleased":
        with pytest.raises(NotReady, match=r"but CHANGELOG.md says Unreleased$"):
            one_version(named)
        del named["CHANGELOG.md"]
    assert one_version(named) == fenics_gears.__version__


def test_recipe_asks_for_what_the_package_asks_for():
    """pyproject.toml with all extras but those of the tests, and the packages that pip does not bring."""
    project = tomllib.loads((CHECKOUT / "pyproject.toml").read_text())["project"]
    extras = [line for name, lines in project["optional-dependencies"].items() if name != "test" for line in lines]
    recipe = yaml.safe_load((CHECKOUT / "release" / "recipe.yaml").read_text())
    run = {line.split()[0]: "".join(line.split()[1:]) for line in recipe["requirements"]["run"]}
    needed = {}
    for line in [*project["dependencies"], *extras]:
        name, *bound = line.split(">=")
        needed[CONDA_NAMES.get(name, name)] = "".join(f">={each}" for each in bound)
    assert run.pop("python") == project["requires-python"]
    assert {name: bound for name, bound in run.items() if name not in NOT_BY_PIP} == needed
    assert run.keys() >= NOT_BY_PIP
    assert recipe["build"]["python"]["entry_points"] == [f"gears = {project['scripts']['gears']}"]


def test_wheel_that_lacks_a_file_is_told(tmp_path):
    wheel = tmp_path / "small.whl"
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr("fenics_gears/__init__.py", "")
        archive.writestr("fenics_gears-1.dist-info/RECORD", "")
    compare(wheel, {"fenics_gears/__init__.py"})
    with pytest.raises(NotReady, match=r"small.whl lacks \['fenics_gears/results/dataset.py'\] and has nothing"):
        compare(wheel, {"fenics_gears/__init__.py", "fenics_gears/results/dataset.py"})


@pytest.mark.nightly
def test_wheel_runs_beside_the_packages_of_this_python(tmp_path):
    """The source archive once lacked fenics_gears/results."""
    wheel = built(tmp_path)
    compare(wheel, files_of_package())
    assert try_out(wheel, fenics_gears.__version__)[0] == f"gears {fenics_gears.__version__}"
