"""The command line: exit codes, what is written when, what is printed. The simulation is replaced."""

import contextlib
import gc
import os
import re
import subprocess
from pathlib import Path

import pytest
from tests.commands.conftest import files, small_result
from tests.programs import DEMO, command, ended, environment, python

import fenics_gears
from fenics_gears import results
from fenics_gears.commands.cli import main
from fenics_gears.results.validity import NO_MEANING


def test_a_run_writes_its_result_and_pictures(simulation, capsys, tmp_path):
    """docs/promises.md; results/<name of the scene file>."""
    assert main(["run", str(DEMO)]) == 0
    assert files(tmp_path) == ["results/lundvall2004/run.nc", "results/lundvall2004/transmission_error.png"]
    assert results.load(tmp_path / "results/lundvall2004/run.nc").attrs["complete"] == 1
    output = capsys.readouterr()
    assert "results/lundvall2004/run.nc" in output.out
    assert "march: " in output.err


def test_the_summary_gives_the_transmission_error_as_angle_and_length(simulation, capsys):
    """5e-5 rad on a base radius of 50 mm are 2.5 um, 2e-4 rad are 10 um."""
    main(["run", str(DEMO)])
    output = capsys.readouterr()
    lines = {line.split("  ")[1]: line for line in output.out.splitlines() if line.startswith("  ")}
    assert lines["transmission error, mean"].endswith("2.5 um = 5e-05 rad")
    assert lines["transmission error, peak to peak"].endswith("10 um = 0.0002 rad")
    assert lines["Newton iterations per step"].endswith("3.00 on average, 4 at most")
    # Progress and summary have their seconds of one clock.
    told = dict(line.split(": ") for line in output.err.splitlines())
    assert list(told) == ["march", "draw pictures"]
    assert all(lines[name].endswith(f" {seconds}") for name, seconds in told.items())


def test_a_result_without_meaning_has_an_exit_code_of_its_own(simulation, capsys, tmp_path):
    """docs/troubleshooting.md; the result is kept with the reason."""
    said = f"{NO_MEANING}: the gears would have gone through each other"
    simulation.outcome = small_result().assign_attrs(warnings=f"{said}\nanother")
    assert main(["run", str(DEMO), "--output", "here", "--quiet"]) == 4
    assert capsys.readouterr() == ("", f"here/run.nc: {said}\n")
    assert results.load(tmp_path / "here/run.nc").attrs["complete"] == 1
    simulation.outcome = small_result().assign_attrs(warnings="another")
    assert main(["run", str(DEMO), "--output", "here", "--quiet"]) == 0


def on_a_terminal(command, more):
    ours, its = os.openpty()
    running = subprocess.Popen(command, stdout=its, stderr=subprocess.DEVNULL, env=environment(TERM="xterm", **more))
    os.close(its)
    written = b""
    with contextlib.suppress(OSError):  # what a terminal says when nobody writes to it any more
        while chunk := os.read(ours, 65536):
            written += chunk
    os.close(ours)
    assert running.wait() == 0
    return written.decode().replace("\r\n", "\n")


CHECK = command("check", DEMO)


def test_a_study_is_told_from_a_scene(capsys, tmp_path, monkeypatch):
    """One sentence with the right command."""
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(f'scene = "{DEMO}"\n[sweep]\nmotion.mesh_frequency = ["100 Hz", "200 Hz"]\n')
    for name in ("check", "run"):
        assert main([name, "study.toml"]) == 2
        assert (
            capsys.readouterr().err
            == "study.toml: is a study, not a scene; `gears study study.toml` runs it. Nothing was computed or"
            " written.\n"
        )
    assert main(["study", str(DEMO)]) == 2
    assert f"is a scene, not a study; `gears run {DEMO}` runs it" in capsys.readouterr().err
    assert files(tmp_path) == ["study.toml"]


def test_what_goes_into_a_log_is_plain():
    """ECMA-48's sequences begin with ESC; under mpirun none, on a terminal without it colours."""
    assert "\x1b" in on_a_terminal(CHECK, {})
    written = on_a_terminal(CHECK, {"OMPI_COMM_WORLD_SIZE": "1"})
    assert "\x1b" not in written and "Gear pair" in written
    assert not any(line.endswith(" ") for line in written.splitlines())


@pytest.mark.parametrize("command", ["plot", "picture", "export"])
@pytest.mark.parametrize("named", ["speeds", "speeds/study.nc"])
def test_pictures_of_a_study_are_those_of_its_report(simulation, capsys, tmp_path, command, named):
    """What a study has is said."""
    Path("speeds/cases").mkdir(parents=True)
    Path("speeds/study.nc").touch()
    assert main([command, named]) == 2
    assert f"{named} is a study" in (said := capsys.readouterr().err)
    assert "`gears report speeds`" in said and "speeds/cases/NAME.nc" in said
    assert files(tmp_path) == ["speeds/study.nc"]


def test_a_result_that_cannot_be_written_leaves_the_old_one(simulation, monkeypatch, capsys, tmp_path):
    """Hard case 27."""
    assert main(["run", str(DEMO), "--output", "here"]) == 0
    before = (tmp_path / "here/run.nc").read_bytes()

    def save_half(dataset, path):
        Path(path).write_bytes(before[:100])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(results, "save", save_half)
    assert main(["run", str(DEMO), "--output", "here"]) == 3
    assert "No space left on device" in capsys.readouterr().err
    assert (tmp_path / "here/run.nc").read_bytes() == before
    assert files(tmp_path) == ["here/run.nc", "here/transmission_error.png"]


def test_plot_draws_a_run_again(simulation, capsys, tmp_path):
    """docs/promises.md; the directory or the file."""
    main(["run", str(DEMO), "--output", "here", "--quiet"])
    for run in ("here", "here/run.nc"):
        Path("here/transmission_error.png").unlink()
        assert main(["plot", run]) == 0
        assert capsys.readouterr().out.split() == ["here/transmission_error.png"]
        assert files(tmp_path) == ["here/run.nc", "here/transmission_error.png"]


def test_check_prints_the_pair_and_the_effects_and_writes_nothing(simulation, capsys, tmp_path):
    """The values the paper prints (model.md, section 1); docs/promises.md."""
    assert main(["check", str(DEMO)]) == 0
    output = capsys.readouterr().out
    for printed in ("22.44 deg", "13.28 mm", "1.47", "29.61 deg", "27.64 deg", "20.95 mm"):
        value, _, unit = printed.partition(" ")
        last_digit = 10.0 ** -len(value.partition(".")[2])
        found = [float(number) for number in re.findall(rf" (\d+\.\d+) ?{unit}\n", output)]
        assert any(abs(number - float(value)) <= last_digit for number in found), printed
    lines = {line.split()[0]: line for line in output.splitlines() if line.startswith("  ")}
    assert " on " in lines["friction"] and "pair_friction_force" in lines["friction"]
    assert " off " in lines["tip_relief"] and "without tip relief" in lines["tip_relief"]
    assert simulation.calls == []
    assert files(tmp_path) == []


@pytest.mark.parametrize(
    "arguments",
    [[], ["measure", "x.toml"], ["study"], ["run"], ["run", "x.toml", "--fast"], ["run", "x.toml", "-v", "-q"]],
)
def test_a_wrong_call_has_exit_code_2(arguments, capsys):
    """docs/promises.md's exit codes."""
    with pytest.raises(SystemExit) as leaving:
        main(arguments)
    assert leaving.value.code == 2
    assert "usage: gears" in capsys.readouterr().err


def test_version(capsys):
    """The package's own number, exit code 0."""
    with pytest.raises(SystemExit) as leaving:
        main(["--version"])
    assert leaving.value.code == 0
    assert capsys.readouterr().out == f"gears {fenics_gears.__version__}\n"


def test_a_command_leaves_no_settings_behind(monkeypatch, capsys):
    """Definition: a process that goes on is as before."""
    seen = {}

    def run_python(options):
        gc.freeze()
        os.environ["FENICS_GEARS_MEMORY"] = "3 GB"
        seen.update(thresholds=gc.get_threshold())

    monkeypatch.setattr("fenics_gears.commands.python.carry_out", run_python)
    before = gc.get_threshold(), gc.get_freeze_count(), os.environ.get("FENICS_GEARS_MEMORY")
    main(["python"])
    assert seen["thresholds"] != before[0]
    assert (gc.get_threshold(), gc.get_freeze_count(), os.environ.get("FENICS_GEARS_MEMORY")) == before


def test_python_has_the_program_and_runs_in_the_folder_of_the_call(tmp_path):
    """The README; arguments are the script's."""
    (tmp_path / "beside.py").write_text("NAME = 'beside'\n")
    said = (
        "import sys, os, beside, fenics_gears\nprint(beside.NAME, sys.argv[1:], os.getcwd(),"
        " callable(fenics_gears.load_scene), 'simulate' in dir(fenics_gears))\nsys.exit(7)\n"
    )
    (tmp_path / "first.py").write_text(said)
    run = python("-P", "-m", "fenics_gears", "python", "first.py", "-v", "x", folder=tmp_path, ends=7)
    assert run.stdout == f"beside ['-v', 'x'] {tmp_path} True True\n"


def test_help_loads_neither_numerics_nor_the_schema():
    """What is not loaded takes no time."""
    program = (
        "import sys, fenics_gears.commands.cli as cli\n"
        "try: cli.main(['--help'])\n"
        "except SystemExit: pass\n"
        "slow = {'numpy', 'pydantic', 'rich', 'xarray', 'dolfinx', 'numba', 'matplotlib', 'importlib.metadata'}\n"
        "print(sorted(slow & set(sys.modules)))"
    )
    run = python("-c", program)
    assert run.stdout.splitlines()[-1] == "[]"
    assert "check" in run.stdout and "plot" in run.stdout


def test_the_test_command_runs_pytest_on_the_checkout(tmp_path):
    """docs/promises.md."""
    call = command("test", "--collect-only", "-q", "tests/effects/test_list_of_effects.py")
    run = ended(call, tmp_path, ends=0)
    assert "test_list_of_effects.py" in run.stdout and "test_cli.py" not in run.stdout


def test_a_reader_that_goes_away_is_no_error():
    """A shell's convention: `gears check SCENE | true` ends with 128 + SIGPIPE and says nothing."""
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(CHECK, stdout=writing, stderr=subprocess.PIPE, text=True)
    os.close(writing)
    assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.parametrize(
    ("call", "said"),
    [
        ("chek pair.toml", 'there is no command "chek". Did you mean "check"? Commands: check, run, '),
        ("run pair.toml --outptu here", 'arguments: --outptu here. Did you mean "--output"?'),
        ("run pair.toml --no-pictres=1", 'arguments: --no-pictres=1. Did you mean "--no-pictures"?'),
    ],
)
def test_misspelt_words_of_a_call_are_answered_with_the_nearest(capsys, call, said):
    """Standard of the house: an unknown name gets the nearest known one."""
    with pytest.raises(SystemExit, match="2"):
        main(call.split())
    assert said in capsys.readouterr().err
