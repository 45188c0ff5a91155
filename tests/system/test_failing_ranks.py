"""One rank of a job fails, at each stage of each command that ranks share. `python -m
tests.system.test_failing_ranks` prints the table."""

import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import pytest
from tests.paper_text import coarse_text
from tests.programs import DEMO, environment, gears, mpirun
from tests.system.failing_rank import WORDS

from fenics_gears.results import load

pytestmark = pytest.mark.ranks

PLANE = coarse_text()
EVERY_STEP = PLANE.replace("steps_per_mesh_cycle = 20", 'steps_per_mesh_cycle = 2\ncondensation = "every step"')
FACE = (
    (DEMO.parent / "misaligned_spur" / "misaligned.toml").read_text().partition("[accuracy]")[0]
    + '[accuracy]\nflank_element_size = "0.6 mm"\nbody_element_size = "9 mm"\nlayers = 1\nslices = 2\ncontact_length '
    '= "3 mm"\ncontact_nodes = 9\nsteps_per_mesh_cycle = 4\n'
)
STUDY = 'scene = "pair.toml"\n[sweep]\nmotion.mesh_frequency = ["100 Hz", "200 Hz", "300 Hz"]\n'
# Arguments and files of each command.
COMMANDS = {
    "plane": (["run", "pair.toml", "--no-pictures"], {"pair.toml": PLANE}),
    "every step": (["run", "pair.toml", "--no-pictures"], {"pair.toml": EVERY_STEP}),
    "face": (["run", "pair.toml", "--no-pictures"], {"pair.toml": FACE}),
    "study": (["study", "study.toml"], {"pair.toml": PLANE, "study.toml": STUDY}),
}
# Stages that every rank comes to; to the others comes rank 0 alone.
SHARED = {"remeshing", "condensing for a study", "a case", "writing a case"}
OF_A_RUN = ("reading", "model", "positions", "march", "writing")
STAGES_OF = {
    "plane": ("plane sections", "march"),
    "every step": (*OF_A_RUN, "remeshing"),
    "face": (*OF_A_RUN, "plane sections", "section mesh", "condensing", "ring"),
    "study": ("reading a study", "condensing for a study", "a case", "writing a case", "combining"),
}
CODES = {"refuses": 2, "fails": 3, "breaks": 3, "interrupted": 130, "killed": 128 + signal.SIGKILL}


def failures(stages, shared=SHARED, goes_on=()):
    """Stage, rank and way of each failure; a failure at a stage of `goes_on` ends nothing, unless the process is
    killed."""
    return [
        (stage, rank, how)
        for stage in stages
        for rank in (0, 1)
        for how in ("fails", "killed")
        if not (how == "fails" and (stage in goes_on or rank == 1 and stage not in shared))
    ]


MATRIX = [(command, *each) for command, stages in STAGES_OF.items() for each in failures(stages)] + [
    ("face", "reading", 0, "refuses"),
    ("face", "ring", 0, "interrupted"),
    ("face", "march", 0, "interrupted"),
    ("every step", "remeshing", 1, "breaks"),
]


@dataclass(frozen=True)
class End:
    """How a job ended: exit code, what it said, seconds after the failure, processes that are still there."""

    code: int
    told: str
    seconds: float
    left: list[int]


def ended(folder: Path, command, stage: str, rank: int, how: str, *more: str, shared=SHARED) -> End:
    """A command of two ranks of which one fails at a stage, until its end."""
    arguments, files = command
    for name, text in files.items():
        (folder / name).write_text(text)
    comes = rank if stage in shared else 0
    call = [
        *mpirun(2),
        sys.executable,
        "-m",
        "tests.system.failing_rank",
        stage,
        str(comes),
        how,
        str(rank),
        *arguments,
        *more,
        "--output",
        "here",
    ]
    done = subprocess.run(
        call,
        cwd=folder,
        env={**environment(), "FENICS_GEARS_CACHE": str(folder)},
        capture_output=True,
        text=True,
        timeout=240,
    )
    over = time.time()
    processes = [Path("/proc", file.read_text()) for file in folder.glob("process.*")]
    assert len(processes) == 2 and (folder / "failed").exists(), done.stderr
    while any(each.exists() for each in processes) and time.time() < over + 20.0:
        time.sleep(0.1)
    return End(
        done.returncode,
        done.stderr,
        over - (folder / "failed").stat().st_mtime,
        [int(each.name) for each in processes if each.exists()],
    )


@pytest.mark.nightly
@pytest.mark.parametrize(("command", "stage", "rank", "how"), MATRIX)
def test_an_error_of_a_rank_ends_all(tmp_path, command, stage, rank, how):
    """Hard case 28 and the exit codes: no rank waits for ever, none is left behind, the error is said once."""
    check_end(ended(tmp_path, COMMANDS[command], stage, rank, how), how)


def check_end(end, how):
    assert end.code == CODES[how], end.told
    assert not end.left
    assert {"killed": "", "interrupted": "Interrupted"}.get(how, WORDS) in end.told


def test_a_run_that_does_not_fit_ends_all_ranks(tmp_path):
    """Rank 0 alone says it, once."""
    (tmp_path / "pair.toml").write_text(FACE)
    done = gears(tmp_path, "run", "pair.toml", "--memory", "100 MB", ranks=2)
    assert done.returncode == 3 and done.stderr.count("0.1 GB are allowed. Nothing was computed.") == 1, done.stderr


@pytest.mark.nightly
def test_ranks_share_a_run_whose_settings_are_chosen_by_a_target(tmp_path):
    """Definition: the bodies of the chosen settings, which rank 0 alone knows."""
    (tmp_path / "pair.toml").write_text(FACE.partition("[accuracy]")[0] + '[accuracy]\ntarget = "20 %"\n')
    done = gears(tmp_path, "run", "pair.toml", "--no-pictures", "--output", "here", ranks=2)
    assert done.returncode == 0, done.stderr
    assert load(tmp_path / "here" / "run.nc").attrs["target"] == pytest.approx(0.2)


if __name__ == "__main__":
    for command, *each in MATRIX:
        with tempfile.TemporaryDirectory() as place:
            end = ended(Path(place), COMMANDS[command], *each)
        print(
            command,
            *each,
            end.code,
            f"{end.seconds:.1f} s",
            end.left,
            "says it" if WORDS in end.told else "",
            sep=" | ",
            flush=True,
        )
