"""What a wheel and a source distribution have beside the package."""

import email
import shutil
import subprocess
import sys
import tarfile
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BUILD = "import setuptools; setuptools.setup()"


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    """Texts by name, of the source distribution that setuptools makes of this checkout."""
    pytest.importorskip("setuptools", minversion="61")
    folder = tmp_path_factory.mktemp("build") / "checkout"
    shutil.copytree(ROOT, folder, ignore=shutil.ignore_patterns(".*", "results", "__pycache__", "*.egg-info"))
    call = [sys.executable, "-P", "-c", BUILD, "-q", "sdist", "-d", "dist"]
    done = subprocess.run(call, cwd=folder, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    (archive,) = (folder / "dist").glob("*.tar.gz")
    with tarfile.open(archive) as opened:
        return {each.name.partition("/")[2]: opened.extractfile(each).read() for each in opened if each.isfile()}


def test_metadata_say_what_it_is_and_whose(source):
    """pip and package indexes show them; the authors are those of CITATION.cff."""
    metadata = email.message_from_bytes(source["PKG-INFO"])
    described = metadata.get("Description") or metadata.get_payload()
    assert "# fenics_gears" in described and "Two commands" in described
    (author,) = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["authors"]
    assert f"name: {author['name']}" in (ROOT / "CITATION.cff").read_text()
    assert metadata["Author"] == author["name"] and metadata["License"] == "LGPL-3.0-or-later"
    assert set(metadata.get_all("License-File")) == {"LICENSE", "COPYING"}


def test_source_distribution_has_what_the_readme_runs(source):
    """Its commands name demonstrations and the launcher, which needs the lists of packages."""
    assert {"gears", "setup/install", "setup/trixie.apt", "docs/commands.md", "LICENSE", "COPYING"} <= set(source)
    demos = {path.relative_to(ROOT).as_posix() for path in (ROOT / "demos").rglob("*.toml")}
    assert demos and {name for name in demos if "/results/" not in name} <= set(source)


def test_source_distribution_has_no_tests(source):
    """They need each other and the checkout; setuptools on its own takes those that lie beside the folders of tests."""
    assert (ROOT / "tests/test_architecture.py").is_file()
    assert not [name for name in source if name.startswith("tests/")]
