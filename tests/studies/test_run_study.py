"""Running a study in one process."""

import re
import signal
from pathlib import Path

import numpy as np
import pytest
from tests.programs import command, ended
from tests.studies.conftest import stamps, write_study

from fenics_gears import load_scene, model_of, results, simulate
from fenics_gears.commands.cli import main
from fenics_gears.commands.work import study as commands_study
from fenics_gears.contact.errors import ContactNotConverged
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.runs import one_run
from fenics_gears.simulation.bodies import gear_bodies
from fenics_gears.simulation.simulate import solved
from fenics_gears.studies.study_file import load_study
from fenics_gears.system.progress import SilentProgress

TWO = 'without = ["inertia", "damping", "friction"]\n[sweep]\nmotion.mesh_frequency = ["100 Hz", "200 Hz"]\n'
FOUR = '[sweep]\nmotion.mesh_frequency = ["100 Hz", "200 Hz"]\nfriction = ["absent", "present"]\n'
THREE = 'without = ["inertia", "damping"]\n[sweep]\nfriction.coefficient = [0.1, 0.3, 0.2]\n'


def load(directory):
    import xarray

    with xarray.open_dataset(Path(directory) / "study.nc", engine="h5netcdf") as opened:
        return opened.load()


def test_every_case_is_what_a_run_of_its_scene_gives(folder):
    """Exact identity with a run of each scene alone."""
    study = write_study(folder, FOUR)
    assert main(["study", str(study), "--quiet"]) == 0
    combined = load("results/study")
    assert combined.sizes["mesh_frequency"] == combined.sizes["friction"] == 2
    assert (
        list(combined["mesh_frequency"].values) == [100.0, 200.0] and combined["mesh_frequency"].attrs["units"] == "Hz"
    )
    assert list(combined["friction"].values) == ["absent", "present"]
    for case in load_study(study).cases:
        alone, row = simulate(case.scene), combined.isel(mesh_frequency=case.index // 2, friction=case.index % 2)
        for name in ("peak_to_peak_transmission_error", "mean_transmission_error"):
            assert float(row[name]) == alone.attrs[name]
        for name in ("transmission_error", "centre_y", "normal_force"):
            assert np.array_equal(row[name].values, alone[name].values)
        assert np.array_equal(
            results.load(Path("results/study", str(row["case_file"].values)))["contact_pressure"],
            alone["contact_pressure"],
        )
    assert np.isnan(combined["friction_force"].sel(friction="absent")).all()
    assert np.isfinite(combined["friction_force"].sel(friction="present")).all()
    assert combined.attrs["complete"] == 1 and combined.attrs["study"] == study.read_text()
    assert all(combined[name].attrs["units"] == "rad" for name in ("transmission_error", "mean_transmission_error"))


@pytest.mark.usefixtures("undrawn")
def test_a_study_run_again_computes_only_what_is_new(folder, capsys):
    """Inode and time of each file; cases are found by content."""
    study = write_study(folder, TWO)
    main(["study", str(study), "--quiet", "--output", "here"])
    before, combined = stamps("here"), load("here")
    assert main(["study", str(study), "--output", "here"]) == 0
    assert stamps("here") == before
    assert "2 kept, 0 to be computed" in capsys.readouterr().err
    assert load("here").equals(combined)
    write_study(folder, TWO.replace('["100 Hz"', '["50 Hz", "100 Hz"'))
    assert main(["study", str(study), "--output", "here"]) == 0
    said = capsys.readouterr()
    assert "2 kept, 1 to be computed" in said.err
    # How quick it was, and what limits: the parts of a run add up to all of it.
    assert re.search(r"1 computed, [\d.e+-]+ per second, 2 kept from before", said.out)
    march, numbers, beside = map(
        int, re.search(r"march (\d+)%.* (\d+)%, contact.* (\d+)% of the time", said.out).groups()
    )
    assert 0 < march + numbers <= 100 and 0 <= beside <= 100
    after = stamps("here")
    assert set(before.values()) < set(after.values()) and len(after) == 3
    assert (
        load("here").sel(mesh_frequency=[100.0, 200.0]).drop_vars("case_file").equals(combined.drop_vars("case_file"))
    )


@pytest.mark.usefixtures("undrawn")
def test_processes_are_started_only_where_something_is_missing(folder, capsys, monkeypatch):
    """Count of calls: a study of kept cases starts none, nor reads what is there where more is asked for."""
    started, study = [], write_study(folder, TWO)
    monkeypatch.setattr(commands_study, "under_mpirun", lambda options, arguments: started.append(arguments) or 7)
    call = ["study", str(study), "--output", "here", "--processes", "2"]
    assert main(call) == 7 and main(call[:-2]) == 0
    combined = load("here")
    capsys.readouterr()
    assert main(call) == 0 and "2 kept, 0 to be computed.\n" in capsys.readouterr().err
    assert len(started) == 1 and load("here").equals(combined)
    # A file that turns out to be damaged, one that is not there, and a case more.
    first, second = sorted(Path("here/cases").glob("*.nc"))
    whole = first.read_bytes()
    first.write_bytes(whole[:-1] + b"?")
    assert main(call) == 7
    first.write_bytes(whole)
    second.rename(folder / "elsewhere.nc")
    assert main(call) == 7
    (folder / "elsewhere.nc").rename(second)
    assert main(call) == 0
    write_study(folder, TWO.replace('["100 Hz"', '["50 Hz", "100 Hz"'))
    assert main(call) == 7 and len(started) == 4


@pytest.mark.usefixtures("undrawn")
def test_a_changed_base_scene_is_noticed_and_so_are_other_numbers(folder, capsys, monkeypatch):
    """Hash of what the scene says: a comment is no change, a width is, and so is another version of the numbers. A
    change that no case is left with changes no case."""
    study, scene = write_study(folder, TWO), folder / "pair.toml"
    text = scene.read_text()
    wider = text.replace('face_width = "15 mm"', 'face_width = "16 mm"')

    def told(written):
        scene.write_text(written)
        assert main(["study", str(study), "--output", "here"]) == 0
        return capsys.readouterr().err

    told(text)
    before, old = stamps("here"), load("here")["mean_transmission_error"]
    assert "2 kept, 0 to be computed.\n" in told(f"# a comment\n{text}") and stamps("here") == before
    assert "2 to be computed. The base scene has changed" in told(wider)
    assert before.items() < stamps("here").items() and (load("here")["mean_transmission_error"] < old).all()
    with monkeypatch.context() as updated:
        for module in ("runs.run", "studies.index"):
            updated.setattr(f"fenics_gears.{module}.NUMBERS_VERSION", 10**6)
        assert "2 to be computed. Results that are here of a version of the program with other numbers" in told(wider)
        assert "2 kept, 0 to be computed.\n" in told(wider)
    write_study(folder, TWO.replace("[sweep]", '[set]\ngears.face_width = "15 mm"\n[sweep]'))
    assert "2 kept, 0 to be computed" in told(wider) and load("here")["mean_transmission_error"].equals(old)


@pytest.mark.usefixtures("undrawn")
def test_a_failed_case_is_a_record_and_the_others_go_on(folder, capsys, monkeypatch):
    """The contact's own error; exit code 3; tried again the next time."""

    def fails_once(model, **options):
        if model.scene.friction.coefficient == 0.3:
            raise ContactNotConverged([], "self-locking", time=0.1, step=3)
        return solved(model, **options)

    monkeypatch.setattr(one_run, "solved", fails_once)
    study = write_study(folder, THREE)
    assert main(["study", str(study), "--output", "here"]) == 3
    assert "1 of 3 cases failed" in capsys.readouterr().err
    combined = load("here")
    assert list(combined["failed"].values) == [0, 1, 0]
    assert list(np.isnan(combined["peak_to_peak_transmission_error"].values)) == [False, True, False]
    assert "contact did not converge" in str(combined["failure"].values[1]) and str(combined["failure"].values[0]) == ""
    assert combined.attrs["complete"] == 0 and combined.attrs["cases_failed"] == 1
    (note,) = Path("here/cases").glob("*.failed.txt")
    text = note.read_text()
    assert "contact did not converge" in text and "Traceback" in text and "coefficient = 0.3" in text
    before = stamps("here")
    assert main(["study", str(study), "--output", "here"]) == 3
    assert "2 kept, 1 to be computed" in capsys.readouterr().err and stamps("here") == before


FIVE = '[sweep]\nmotion.mesh_frequency = { start = "100 Hz", stop = "400 Hz", count = 5 }\n'


def stopped_in_the_middle(folder, study, how, ranks=0):
    """A study stopped by a signal when a process, under mpirun rank 1, has done three cases, there two."""
    # Alone it has no mpi4py, which DOLFINx needs: its gears come from the cache.
    gear_bodies(model_of(load_scene(folder / "pair.toml")), SilentProgress(), user_cache())
    call = command("study", study, "--output", "here", ranks=ranks)
    at = call.index("fenics_gears")
    call[at : at + 1] = ["tests.studies.stopped_study", how.name, "2" if ranks else "3", "1" if ranks else "0"]
    return ended(call, folder, timeout=120)


def test_ctrl_c_keeps_what_is_done(folder):
    """docs/promises.md: exit code 130, marked incomplete. Alone MPI is never touched."""
    study = write_study(folder, FIVE)
    done = stopped_in_the_middle(folder, study, signal.SIGINT)
    assert (
        done.returncode == 130
        and "Interrupted. What was done is kept" in done.stderr
        and "Traceback" not in done.stderr
    )
    combined = load("here")
    done = len(stamps("here"))
    assert done == 3 and combined.attrs["complete"] == 0
    assert int(np.isfinite(combined["peak_to_peak_transmission_error"]).sum()) == done
    assert int(combined["failed"].sum()) == 0
