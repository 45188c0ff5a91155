"""Folders for users who cannot write their own: the XDG specification and each library's variables."""

import os

import pytest

from fenics_gears.system import environment as folders


@pytest.fixture
def temporary(tmp_path, monkeypatch):
    monkeypatch.setattr(folders.tempfile, "gettempdir", lambda: str(tmp_path))
    return tmp_path


@pytest.mark.parametrize(
    "given", [{"HOME": "/dev/null/a"}, {"HOME": "relative"}, {"HOME": "/", "XDG_CACHE_HOME": "/dev/null"}]
)
def test_a_user_without_a_folder_for_caches_has_one_and_is_told_once(temporary, capsys, given):
    """One sentence that names the variable; the second process says nothing."""
    for sentences in (1, 0):
        environment = dict(given)
        folders.have_folders(environment, aloud=True)
        place = environment["XDG_CACHE_HOME"]
        assert place == environment["MPLCONFIGDIR"] == str(temporary / f"fenics_gears-{os.getuid()}")
        assert os.stat(place).st_mode & 0o077 == 0
        assert os.path.isabs(environment["HOME"])
        said = capsys.readouterr().err
        assert said.count("\n") == sentences and said.count("let XDG_CACHE_HOME name a folder") == sentences


def test_a_folder_that_somebody_else_could_write_is_not_used(temporary):
    """Compiled code in it would be run."""
    laid = temporary / f"fenics_gears-{os.getuid()}"
    laid.mkdir()
    laid.chmod(0o777)
    environment = {"HOME": "/dev/null"}
    folders.have_folders(environment, aloud=False)
    place = environment["XDG_CACHE_HOME"]
    assert place != str(laid) and os.stat(place).st_mode & 0o777 == 0o700


def test_a_user_with_a_home_is_left_alone(tmp_path, capsys):
    """Nothing set, made or said, unless one cache of the four cannot be written."""
    environment = {"HOME": str(tmp_path), "TMPDIR": str(tmp_path)}
    folders.have_folders(environment, aloud=True)
    assert environment == {"HOME": str(tmp_path), "TMPDIR": str(tmp_path)}
    assert capsys.readouterr().err == "" and not list(tmp_path.iterdir())
    (tmp_path / ".cache").mkdir()
    (tmp_path / ".cache" / "fenics").touch()
    assert not folders._keeps_caches(environment)


def test_temporary_files_go_where_there_is_room(tmp_path, capsys):
    """MPI would end the process; a full disk has less room than is needed."""
    environment = {"HOME": str(tmp_path), "TMPDIR": "/dev/null"}
    folders.have_folders(environment, aloud=True)
    assert environment["TMPDIR"] in folders.TEMPORARY and "cannot be written into /dev/null" in capsys.readouterr().err
