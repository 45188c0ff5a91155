"""Standard streams take any text: /dev/full, closed descriptors, encodings that are not UTF-8."""

import io
import os
import subprocess
import sys

import pytest

from fenics_gears.commands.cli import main
from fenics_gears.commands.shared import NOBODY_READS
from fenics_gears.system import console

GREEK = """
title = "Drehzahl \u03a9"
[gears]
module = "3 mm"
pressure_angle = "20 deg"
face_width = "12 mm"
material = "steel"
[gears.pinion]
teeth = 19
profile_shift = 0.3
bore_diameter = "20 mm"
[gears.wheel]
teeth = 25
profile_shift = 0.1
bore_diameter = "30 mm"
[load]
wheel_torque = "100 N m"
"""


@pytest.mark.parametrize("encoding", ["latin-1", "ascii"])
def test_a_console_that_lacks_a_letter_gets_another(tmp_path, monkeypatch, encoding):
    """What the encoding lacks is a question mark."""
    (tmp_path / "pair.toml").write_text(GREEK, encoding="utf-8")
    out, err = (io.TextIOWrapper(io.BytesIO(), encoding, errors="strict") for _ in range(2))
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setattr(sys, "stderr", err)
    with pytest.raises(SystemExit):
        main(["run", "--help"])
    assert main(["check", str(tmp_path / "pair.toml")]) == 0
    (tmp_path / "pair.toml").write_text(GREEK.replace('"3 mm"', '"3 \u03a9\u03c9"'), encoding="utf-8")
    assert main(["check", str(tmp_path / "pair.toml")]) == 2
    err.flush()
    assert b"Drehzahl ?\n" in out.buffer.getvalue() and b"??" in err.buffer.getvalue()


def test_a_full_disk_behind_the_output_is_said(tmp_path, monkeypatch, capsys):
    """One sentence and an exit code of its own."""
    (tmp_path / "pair.toml").write_text(GREEK, encoding="utf-8")
    with open("/dev/full", "w", encoding="utf-8") as full:
        monkeypatch.setattr(sys, "stdout", full)
        assert main(["check", str(tmp_path / "pair.toml")]) == NOBODY_READS
    said = "The standard output cannot be written: No space left on device. Send it elsewhere, or free space.\n"
    assert capsys.readouterr().err == said


def test_closed_streams_take_everything_and_lend_their_numbers_to_no_file(tmp_path):
    """A library's print to descriptor 1 must not reach a file of results."""
    program = (
        "import os, sys; os.chdir(sys.argv[1])\n"
        "from fenics_gears.system.console import prepare_streams; prepare_streams()\n"
        "opened = open('run.nc', 'w'); print('words'); print('words', file=sys.stderr)\n"
        "os.write(1, b'words'); sys.stdin.read(); opened.flush(); sys.exit(opened.fileno())"
    )
    call = f'"{sys.executable}" -P -c "$0" "$1" <&- >&- 2>&-'
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    ended = subprocess.run(["sh", "-c", call, program, tmp_path], env=environment, timeout=60)
    assert ended.returncode > 2 and (tmp_path / "run.nc").read_text() == ""


def test_what_a_terminal_would_obey_is_not_printed(monkeypatch, capsys):
    """ECMA-48; lone surrogates stand for bytes of a name."""
    console.print_rows("a\x1b[31m", [("b\x9b31m", "c\x07\udcff", "")])
    assert capsys.readouterr().out.split() == ["a\ufffd[31m", "b\ufffd31m", "c\ufffd\ufffd"]
