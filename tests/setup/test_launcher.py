"""The launcher, by what the README promises: a checkout in a folder with spaces, scripts in place of the system's
tools."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TOOLS = "awk bash cat cksum comm df env flock grep head find mkdir mv readlink rm sed sort tail tr wc".split()

PROGRAM = "import os, sys\nprint(os.getcwd(), *sys.argv[1:], sep='|')\n"
BARE_PYTHON = f'exec {sys.executable} -I -S "$@"'
NO_PACKAGES = "exit 0"
# What a Debian has, but for apt-get; its user is root.
DEBIAN = {"python3": BARE_PYTHON, "dpkg": NO_PACKAGES, "dpkg_query": NO_PACKAGES, "id": "echo 0"}
ONLY_FOR_TESTS = {"python3-pytest", "python3-hypothesis", "python3-sphinx", "chromium"}


@pytest.fixture
def checkout(tmp_path):
    """A copy of the launcher and the set-up, with a program that prints its folder and arguments."""
    folder = tmp_path / "a folder with spaces"
    shutil.copytree(ROOT / "setup", folder / "setup", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy2(ROOT / "gears", folder)
    (folder / "docs").mkdir()
    shutil.copy2(ROOT / "docs/commands.md", folder / "docs")
    (folder / "fenics_gears").mkdir()
    (folder / "fenics_gears/__init__.py").write_text('__version__ = "1.0"\n')
    (folder / "fenics_gears/__main__.py").write_text(PROGRAM)
    return folder


@pytest.fixture
def machine(tmp_path):
    """A PATH with the usual tools and the given commands, each a line of shell."""

    def make(**commands):
        folder = tmp_path / "bin"
        folder.mkdir()
        for tool in TOOLS:
            (folder / tool).symlink_to(shutil.which(tool))
        for name, script in commands.items():
            path = folder / name.replace("_", "-")
            path.write_text(f"#!/bin/sh\n{script}\n")
            path.chmod(0o755)
        return {"PATH": str(folder), "HOME": str(tmp_path)}

    return make


@pytest.fixture
def this_python(checkout):
    edit(checkout, r"^NEEDED = \([^)]*\)", 'NEEDED = ("tomllib",)')
    edit(checkout, r"^NEEDED_BY_TESTS = \([^)]*\)", 'NEEDED_BY_TESTS = ("pytest",)')
    return {**os.environ, "FENICS_GEARS_PYTHON": sys.executable}


def call(launcher, *arguments, environment, folder="/"):
    return subprocess.run(
        [launcher, *arguments], env=environment, cwd=folder, capture_output=True, text=True, timeout=60
    )


def edit(checkout, old, new):
    check = checkout / "setup/check.py"
    check.write_text(re.sub(old, new, check.read_text(), flags=re.MULTILINE))


def set_up_already(checkout, environment):
    done = call(checkout / "gears", "--set-up-only", environment=environment)
    assert done.returncode == 0, done.stderr


def test_existing_python_is_tried_once_and_remembered(checkout, this_python):
    """There is no set-up to start any more, and the second call still works."""
    set_up_already(checkout, this_python)
    (checkout / "setup/install").chmod(0o644)
    again = call(checkout / "gears", "run", environment=this_python)
    assert (again.returncode, again.stdout, again.stderr) == (0, "/|run\n", "")


def test_program_runs_in_the_callers_folder_by_a_link_and_from_this_checkout(checkout, this_python, tmp_path):
    """Paths count from the caller's folder, and no file there takes the program's place."""
    set_up_already(checkout, this_python)
    elsewhere = tmp_path / "else where"
    elsewhere.mkdir()
    (elsewhere / "fenics_gears.py").write_text("raise SystemExit('the wrong program')")
    link = elsewhere / "gears link"
    link.symlink_to(checkout / "gears")
    done = call(link, "run", "my scene.toml", environment=this_python, folder=elsewhere)
    assert (done.returncode, done.stdout) == (0, f"{elsewhere}|run|my scene.toml\n"), done.stderr


def test_sources_are_compiled_after_each_change(checkout, this_python, tmp_path):
    """Only where a file is newer; not for help. Calls at the same time end well and leave one mark; of the loops each
    asks `compile_loops`, which lets one of them compile."""
    package, done = checkout / "fenics_gears", tmp_path / "compiled"
    for folder in ("contact", "simulation"):
        (package / folder).mkdir()
    (package / "simulation/warm_up.py").write_text(f"open({str(done)!r}, 'a').write('once ')\n")
    set_up_already(checkout, this_python)
    assert done.read_text() == "once "
    later = (checkout / ".setup/compiled").stat().st_mtime + 10.0
    (package / "contact/march.py").write_text("")
    os.utime(package / "contact/march.py", (later, later))
    call(checkout / "gears", "--help", environment=this_python)
    assert done.read_text() == "once "
    os.utime(checkout / ".setup/compiled", (later - 20.0, later - 20.0))
    os.utime(package / "contact/march.py", (later - 15.0, later - 15.0))
    environment = this_python | {"PYTHONDONTWRITEBYTECODE": "1"}
    calls = [
        subprocess.Popen([checkout / "gears", "run"], env=environment, stdout=subprocess.DEVNULL) for _ in range(3)
    ]
    assert [each.wait(60) for each in calls] == [0, 0, 0]
    assert done.read_text().count("once ") > 1
    assert [each.name for each in (checkout / ".setup").glob("compiled*")] == ["compiled"]
    found = done.read_text()
    call(checkout / "gears", "run", environment=this_python)
    assert done.read_text() == found
    # The module itself is compiled, also where Python keeps nothing by itself.
    assert list((package / "contact/__pycache__").glob("march.*.pyc"))


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("--help", "gears optimize"), ("", "gears optimize"), ("help", "gears optimize"), ("help run", "--no-pictures"),
        ("run --help", "--no-pictures"), ("test --help", "pytest"), ("--version", "gears "),
    ],
)  # fmt: skip
def test_help_installs_nothing(checkout, machine, tmp_path, arguments, said):
    """Who asks what a command does has not decided to install 800 MB for it."""
    environment = machine(apt_get=f"touch {tmp_path}/asked", dpkg_query=NO_PACKAGES, id="echo 0")
    done = call(checkout / "gears", *arguments.split(), environment=environment)
    assert done.returncode == 0 and said in done.stdout, done.stderr
    assert done.stderr == "" and not (tmp_path / "asked").exists() and not (checkout / ".setup").exists()


def test_help_of_the_tests_does_not_install_them(checkout, this_python):
    """The program is ready; what only the tests need is not asked for."""
    set_up_already(checkout, this_python)
    (checkout / "setup/install").chmod(0o644)
    done = call(checkout / "gears", "test", "--help", environment=this_python)
    assert done.returncode == 0 and "options are those of pytest" in done.stdout
    assert call(checkout / "gears", "run", "-h", environment=this_python).stdout == "/|run|-h\n"


def test_change_of_what_is_needed_leads_to_a_new_set_up(checkout, this_python):
    """The README: the next call continues the set-up; a package that is lacking then is named."""
    set_up_already(checkout, this_python)
    edit(checkout, '"tomllib"', '"tomllib", "no_such_module"')
    done = call(checkout / "gears", "run", environment=this_python)
    assert done.returncode == 1 and "lacks no_such_module" in done.stderr
    assert done.stdout == ""


def test_machine_without_apt_is_told_what_to_install(checkout, machine):
    """What is missing and two ways on; no program is started."""
    done = call(checkout / "gears", "run", environment=machine(python3=BARE_PYTHON))
    assert done.returncode == 1 and done.stdout == ""
    for part in ("no apt", "dolfinx", "petsc4py", "conda", "Dockerfile"):
        assert part in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_named_python_that_is_not_there(checkout, machine):
    """The variable and its value; nothing else is tried."""
    environment = machine(python3=BARE_PYTHON, apt_get=NO_PACKAGES) | {"FENICS_GEARS_PYTHON": "/no/python"}
    done = call(checkout / "gears", "run", environment=environment)
    assert done.returncode == 1 and "FENICS_GEARS_PYTHON=/no/python" in done.stderr


def test_debian_without_root_or_sudo_is_told_the_command(checkout, machine):
    """The missing packages."""
    environment = machine(**DEBIAN | {"apt_get": NO_PACKAGES, "id": "echo 1000"})
    done = call(checkout / "gears", "run", environment=environment)
    assert done.returncode == 1
    assert (
        "needs root or sudo" in done.stderr
        and "apt-get install" in done.stderr
        and "python3-dolfinx-real" in done.stderr
    )
    assert not ONLY_FOR_TESTS & set(done.stderr.split())


def test_what_a_relative_of_debian_lacks_for_some_tests_is_left_out(checkout, machine, tmp_path):
    """Ubuntu has no chromium; a package of the program is still asked for and fails."""
    environment = machine(
        **DEBIAN, apt_get=f'echo "$*" >>{tmp_path}/asked; case "$*" in *install*) exit 100;; esac',
        apt_cache='case $2 in chromium|python3-dolfinx-real) echo "  Candidate: (none)";; *) echo "  Candidate: '
            '1.0-1";; esac',
    )  # fmt: skip
    done = call(checkout / "gears", "test", environment=environment)
    assert done.returncode == 1 and "does not offer chromium" in done.stderr
    asked = (tmp_path / "asked").read_text().split()
    assert {"python3-dolfinx-real", "shellcheck"} <= set(asked) and "chromium" not in asked


def test_program_is_ready_without_what_the_tests_need(checkout, this_python):
    """The tests say what is lacking and leave the program ready."""
    edit(checkout, r"NEEDED_BY_TESTS = \(", 'NEEDED_BY_TESTS = ("no_such_module", ')
    set_up_already(checkout, this_python)
    tested = call(checkout / "gears", "test", environment=this_python)
    assert tested.returncode == 1 and "lacks no_such_module" in tested.stderr
    (checkout / "setup/install").chmod(0o644)
    again = call(checkout / "gears", "run", environment=this_python)
    assert (again.returncode, again.stdout) == (0, "/|run\n"), again.stderr


@pytest.mark.parametrize(
    ("printed", "sentence"),
    [
        ("E: Failed to fetch http://x/y.deb  Temporary failure resolving 'x'", "a package server cannot be reached"),
        ("E: You don't have enough free space in /var/cache/apt/archives/.", "the disk is full"),
        ("E: Unable to locate package python3-dolfinx-real", "Unable to locate package python3-dolfinx-real"),
    ],
)
def test_failure_of_apt_is_one_sentence_with_its_reason(checkout, machine, printed, sentence):
    """Why it failed and where the details are; the next call starts over."""
    environment = machine(**DEBIAN, apt_get=f'echo "{printed}"; exit 100')
    done = call(checkout / "gears", "run", environment=environment)
    assert done.returncode == 1
    assert sentence in done.stderr.splitlines()[-1]
    assert printed in (checkout / ".setup/log").read_text()
    assert not (checkout / ".setup/ready").exists()


def test_interrupted_set_up_leaves_nothing_that_looks_finished(checkout, machine):
    """Exit code 130 and no mark."""
    # The stand-in of apt reaches all of the call's processes, as the terminal's Ctrl-C does.
    # A second later: bash 5.2 may spin where a signal comes while it still starts the commands of a pipe.
    apt = "sleep 1; kill -INT 0; exec sleep 30"
    environment = machine(**DEBIAN, apt_get=apt, sleep='exec /bin/sleep "$@"')
    started = subprocess.Popen(
        [checkout / "gears", "run"], env=environment, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    said = started.communicate(timeout=300)[1]
    assert "[1/" in said
    assert started.returncode == 130 and "interrupted" in said
    assert not (checkout / ".setup/ready").exists()


@pytest.mark.parametrize("script", ["gears", "setup/install", ".ci/run"])
def test_scripts_are_free_of_shellcheck_findings(script):
    """ShellCheck, where it is installed."""
    if not shutil.which("shellcheck"):
        pytest.skip("shellcheck is not installed")
    done = subprocess.run(["shellcheck", "--severity=warning", ROOT / script], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
