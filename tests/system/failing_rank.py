"""`gears` under mpirun, of which RANK fails at a STAGE, or kills the VICTIM: python -m tests.system.failing_rank
STAGE RANK HOW VICTIM ARGUMENTS OF THE COMMAND."""

import importlib
import os
import signal
import sys
from pathlib import Path

from fenics_gears import ComputationError, SceneError
from fenics_gears.commands import cli

OWN = int(os.environ.get("OMPI_COMM_WORLD_RANK") or os.environ.get("PMI_RANK", 0))
WORDS = "no more chalk"
STAGES = {
    "reading": "commands.work.run:checked_model_and_directory",
    "model": "simulation.simulate:memory_for_operators",
    "plane sections": "elasticity.gear_compliance:_computed",
    "section mesh": "elasticity.face.condensed:SectionForms",
    "condensing": "elasticity.face.condensed:schur_complement",
    "ring": "elasticity.face.condensed:between_few_motions",
    "remeshing": "elasticity.remeshed_gear:RemeshedGear.stiffness",
    "positions": "contact.mesh_cycle:Cycle.position",
    "march": "dynamics.march:Marcher.run",
    "writing": "results:save",
    "reading a study": "studies.run_study:load_study",
    "condensing for a study": "runs.gear_store:GearStore.body",
    "a case": "runs.one_run:solved",
    "writing a case": "runs.folder:Folder.keep",
    "combining": "studies.run_study:save_study",
}
ERRORS = {
    "refuses": SceneError(WORDS),
    "fails": ComputationError(WORDS),
    "breaks": MemoryError(WORDS),
    "interrupted": KeyboardInterrupt(),
}


def main(stage: str, rank: str, how: str, victim: str, *arguments: str) -> int:
    Path(f"process.{OWN}").write_text(str(os.getpid()))

    def failure(*_, **__):
        Path("failed").touch()
        if how == "killed":
            os.kill(int(Path(f"process.{victim}").read_text()), signal.SIGKILL)
            signal.pause()
        raise ERRORS[how]

    if int(rank) == OWN:
        module, _, name = STAGES.get(stage, stage).partition(":")
        home, found = importlib.import_module(f"fenics_gears.{module}"), name.split(".")
        setattr(getattr(home, found[0]) if found[1:] else home, found[-1], failure)
    return cli.main(arguments)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
