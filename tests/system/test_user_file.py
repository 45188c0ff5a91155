"""Files that users name: POSIX's kinds of files, and the limits of ``user_file``."""

import os

import pytest

from fenics_gears.system import user_file


def kinds(folder):
    made = {name: folder / name for name in WORDS if name != "a name with NUL"}
    os.mkfifo(made["a pipe"])
    made["a folder"].mkdir()
    made["a link to itself"].symlink_to("a link to itself")
    made["a link to a device"].symlink_to("/dev/zero")
    made["text with NUL"].write_bytes(b"a\r\nb\0")
    made["no UTF-8"].write_bytes(b"ab\xff")
    with open(made["large"], "wb") as file:
        file.truncate(3_000_000_000)
    return made | {"a name with NUL": f"{folder}/a\0b"}


WORDS = {
    "a pipe": "it is a device or a pipe, not a file",
    "a folder": "it is a folder",
    "a link to itself": "Too many levels of symbolic links",
    "a link to a device": "it is a device or a pipe, not a file",
    "text with NUL": "the character NUL in line 2",
    "no UTF-8": r"is not a text in UTF-8 \(byte 2\)",
    "large": "has 3000 MB; a file of more than 10 MB is not read",
    "missing": "there is no such file",
    "a name with NUL": "cannot be read: ",
}


@pytest.mark.parametrize("kind", WORDS)
def test_what_is_no_text_is_refused_in_words(tmp_path, kind):
    """A pipe would be waited for, a device would fill the memory."""
    with pytest.raises(user_file.Unreadable, match=WORDS[kind]):
        user_file.text_of(kinds(tmp_path)[kind], user_file.LARGEST_SCENE)


def test_a_file_that_grows_while_it_is_read_is_refused(tmp_path, monkeypatch):
    """Its length is read once more."""
    (tmp_path / "grows").write_bytes(b"x" * 11)
    monkeypatch.setattr(user_file, "check_file", lambda path, largest: None)
    with pytest.raises(user_file.Unreadable, match="has more than 0 MB"):
        user_file.content_of(tmp_path / "grows", 10)
