"""Row 27: a full disk, kill -9 at any moment, and several runs at once on one cache: never half a result, the
undisturbed run's bits."""

import errno
import json
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from tests.hard_cases.kept_files import ARRAYS, KEY, left_over
from tests.programs import command, environment
from tests.studies.conftest import folder, stamps, undrawn, write_study  # noqa: F401  # noqa: F401
from tests.studies.test_run_study import TWO, load

from fenics_gears import results
from fenics_gears.commands.cli import main
from fenics_gears.elasticity.cache import Cache
from fenics_gears.simulation.unfinished import unfinished


@pytest.mark.parametrize(
    ("number", "what"), [(2, "before its second gear is kept"), (3, "before its result has its name")]
)
@pytest.mark.nightly
def test_a_run_killed_between_its_files(folder, measured, number, what):
    """kill -9 with the first gear kept and the second written aside, and with the result written aside."""
    program = (
        "import os, signal, sys\n"
        "from fenics_gears.commands import cli\n"
        "replace, left = os.replace, [None] * int(sys.argv[1])\n"
        "def killed(*files): left.pop(); replace(*files) if left else os.kill(os.getpid(), signal.SIGKILL)\n"
        "os.replace = killed\n"
        "cli.main(sys.argv[2:])\n"
    )
    call = [
        sys.executable,
        "-c",
        program,
        str(number),
        "run",
        "pair.toml",
        "--output",
        "here",
        "--quiet",
        "--no-pictures",
    ]
    ended = subprocess.run(call, cwd=folder, env={**environment(), "FENICS_GEARS_CACHE": "own"}, timeout=60)
    results_kept, entries = list(Path("here").glob("*.nc")), list(Path("own").glob("*.h5"))
    measured(
        f"a run killed {what}",
        f"{len(results_kept)} results, {len(entries)} gears kept",
        "none incomplete; run again, the same to the bit",
    )
    assert ended.returncode == -signal.SIGKILL and results_kept == [] and len(entries) == number - 1
    assert all(Cache(Path("own")).load(entry.stem) is not None for entry in entries)
    assert (
        main(["run", "pair.toml", "--output", "usual", "--quiet", "--no-pictures"])
        == main(["run", "pair.toml", "--output", "here", "--quiet", "--no-pictures"])
        == 0
    )
    assert results.load("here/run.nc").transmission_error.equals(results.load("usual/run.nc").transmission_error)


def lengthened(folder, cycles):
    """The coarse scene with more mesh cycles, fields of the last one recorded; its name."""
    text = (
        Path("pair.toml")
        .read_text()
        .replace("mesh_cycles = 2 ", f"mesh_cycles = {cycles} ")
        .replace("recorded_cycles = 2", "recorded_cycles = 1")
    )
    (folder / "long.toml").write_text(text)
    return "long.toml"


@pytest.mark.nightly
@pytest.mark.parametrize("kills", [1, pytest.param(30, marks=pytest.mark.nightly)])
def test_a_run_killed_while_it_marches_has_its_steps_on_disk(folder, measured, capsys, kills):
    """At random moments: every step that is there is the undisturbed run's; `gears plot` and `gears report` draw
    them and say that the run did not end."""
    scene = lengthened(folder, 400)
    program = (
        "import sys\nfrom fenics_gears.results import journal\njournal.SECONDS_WITHOUT = journal.APART = 0.0\nfrom"
        " fenics_gears.commands import cli\ncli.main(sys.argv[1:])\n"
    )
    assert main(["run", scene, "--output", "usual", "--quiet", "--no-pictures"]) == 0
    usual, moments, there, wrong = results.load("usual/run.nc"), np.random.default_rng().uniform(0.0, 0.3, kills), [], 0
    for number, moment in enumerate(moments):
        directory = folder / f"out{number}"
        process = subprocess.Popen(
            [sys.executable, "-c", program, "run", scene, "--output", str(directory), "--quiet", "--no-pictures"],
            cwd=folder,
            env=environment(),
        )
        deadline = time.monotonic() + 60
        while not (directory / "run.nc.part").is_file() and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.002)
        time.sleep(moment)
        os.kill(process.pid, signal.SIGKILL)
        process.wait(timeout=60)
        ended = (directory / "run.nc").exists()
        found = results.load(directory / "run.nc") if ended else unfinished(directory / "run.nc.part")
        steps, of_field = found.sizes["time"], found.sizes["contact_time"]
        there.append(steps)
        wrong += sum(
            not variable.equals(usual.variables[name][:steps])
            for name, variable in found.variables.items()
            if variable.dims[:1] == ("time",)
        )
        np.testing.assert_array_equal(found["contact_time"], usual["time"][steps - of_field : steps])
        assert ended or (found.attrs["complete"], found.attrs["stopped"], found.attrs["steps"]) == (
            0,
            "not ended",
            steps - 1,
        )
    measured(
        f"a run killed at {kills} moments of its march: steps on disk",
        f"{min(there)} to {max(there)} of {usual.sizes['time']}, {wrong} curves wrong",
        "those done, none wrong",
    )
    assert wrong == 0 and min(there) > 0
    # Killed before its first block a run has nothing to draw but its start.
    if kills == 1 and not ended and steps > 1:
        assert main(["plot", str(directory)]) == main(["report", str(directory), "--no-stress"]) == 0
        assert (
            capsys.readouterr().err.count(
                f"has not come to its end (its process was killed, or still runs): {steps - 1} of its"
                f" {usual.attrs['steps']} steps are there"
            )
            == 2
        )
        assert "INCOMPLETE RUN. Its process was killed, or still runs." in (directory / "report.html").read_text(
            encoding="utf-8"
        )


def test_an_interrupted_write_leaves_no_file(tmp_path, monkeypatch, measured):
    """Ctrl-C between writing aside and renaming."""

    def interrupt(source, target):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", interrupt)
    with pytest.raises(KeyboardInterrupt):
        Cache(tmp_path).store(KEY, ARRAYS)
    measured("Ctrl-C before the cache's rename", f"{len(list(tmp_path.iterdir()))} files left", "none")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.nightly
@pytest.mark.parametrize("count", [2, 5])
def test_runs_at_once_on_one_empty_cache(folder, measured, tmp_path, count):
    """Each has the number of a run alone, to the bit."""
    own = tmp_path / "shared"
    calls = [
        command("run", "pair.toml", "--output", f"out{number}", "--quiet", "--no-pictures") for number in range(count)
    ]
    processes = [
        subprocess.Popen(
            call, cwd=folder, env={**environment(), "FENICS_GEARS_CACHE": str(own)}, stderr=subprocess.PIPE, text=True
        )
        for call in calls
    ]
    said = [process.communicate(timeout=120)[1] for process in processes]
    assert [process.returncode for process in processes] == [0] * count, said
    assert main(["run", "pair.toml", "--output", "alone", "--quiet", "--no-pictures"]) == 0
    alone = results.load("alone/run.nc").transmission_error
    same = sum(results.load(f"out{number}/run.nc").transmission_error.equals(alone) for number in range(count))
    names, unfinished = left_over(own)
    entries = [name for name in names if name.endswith(".h5")]
    found = f"{same} of {count} the same, {len(entries)} entries, {len(unfinished)} unfinished"
    measured(f"{count} runs at once on one empty cache", found, f"{count}, one entry for each gear, none")
    assert same == count and unfinished == [] and all("not usable" not in words for words in said)
    assert len(entries) == 2 and all(Cache(own).load(Path(name).stem) is not None for name in entries)


def within(size):
    """A process's files may have so many bytes and no more, as on a full disk."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


# The place has room when it is tried, and none later.
IN_ONE_PROCESS = (
    "import json, sys; from fenics_gears.commands.cli import main; from fenics_gears.system import output;"
    " output.TRIED = 0; print(json.dumps([main(call) for call in json.loads(sys.argv[1])]))"
)


def limited(folder, size, *calls):
    """Calls of `gears` one after another in a process with a limit on its files: exit codes, and what was said."""
    call = [sys.executable, "-c", IN_ONE_PROCESS, json.dumps(calls)]
    ended = subprocess.run(
        call, cwd=folder, env=environment(), capture_output=True, text=True, timeout=120, preexec_fn=within(size)
    )
    return json.loads(ended.stdout), ended.stderr


def run_into(directory):
    return ["run", "pair.toml", "--output", directory, "--quiet", "--no-pictures"]


@pytest.mark.nightly
@pytest.mark.parametrize("size", [100, 8192])
def test_a_full_disk_leaves_no_half_result(folder, undrawn, measured, size):
    """Exit code 3, nothing half under a final name, an earlier result bit for bit as it was; with room again the
    undisturbed results. The gears are in the cache: what MPI does without room is not this program's."""
    study = write_study(folder, TWO)
    in_study = ["study", str(study), "--quiet", "--output", "study"]
    assert main(run_into("earlier")) == main([*in_study[:-1], "usual"]) == 0
    before = {path.name: path.read_bytes() for path in Path("earlier").iterdir()}
    codes, said = limited(folder, size, run_into("here"), run_into("earlier"), in_study)
    names, unfinished = left_over("here")
    same = {path.name: path.read_bytes() for path in Path("earlier").iterdir()} == before
    of_study, unfinished_of_study = left_over("study")
    halves = [name for name in of_study if name.endswith(".nc")]
    measured(
        f"disk full after {size} bytes of a file",
        f"exit code {codes[0]}, {len(names) + len(unfinished)} files",
        "3, none",
    )
    measured(
        "full disk over an earlier result",
        f"exit code {codes[1]}, " + ("unchanged" if same else "changed"),
        "3, unchanged",
    )
    measured(
        "study on a full disk",
        f"exit code {codes[2]}, {len(halves)} results, {len(unfinished_of_study)} unfinished",
        "3, none, none",
    )
    assert codes == [3, 3, 3] and said.count("could not be written: File too large") >= 3 and "Traceback" not in said
    assert names == unfinished == halves == unfinished_of_study == [] and same
    assert main(run_into("here")) == main(in_study) == 0
    assert results.load("here/run.nc").attrs["complete"] == 1
    # How many iterations a step takes depends on what its process knows already.
    study, usual = (load(name).drop_vars(["wall_time", "newton_iterations"]) for name in ("study", "usual"))
    assert study.equals(usual)


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EDQUOT, errno.EACCES])
def test_the_cache_warns_of_a_full_disk(tmp_path, code, monkeypatch, caplog, measured):
    """A full disk may show only when the file is flushed."""

    def fail(descriptor):
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr(os, "fsync", fail)
    Cache(tmp_path).store(KEY, ARRAYS)
    measured(f"cache: {os.strerror(code)}", f"{len(list(tmp_path.iterdir()))} files left", "none, a warning")
    assert list(tmp_path.iterdir()) == [] and os.strerror(code) in caplog.text
