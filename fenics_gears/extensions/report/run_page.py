"""The report on a run: its sections in order."""

from collections.abc import Callable

from fenics_gears.charts import conditions
from fenics_gears.many_runs import NO_MEANING, Progress, SilentProgress
from fenics_gears.pages import Page, PageSection, made_by, scene_section, version_section
from fenics_gears.shown import ShownRun, changed_files

from .curves import forces, motion, pressure
from .effects import effects
from .energy import energy
from .face import face
from .geometry import geometry
from .numbers import numbers
from .overview import summary, warnings
from .root_stress import root_stress
from .solver import solver
from .spectra import spectra
from .stress import stress

# What was computed comes first, as in any report; of the results pictures come before tables.
SECTIONS: tuple[Callable[[ShownRun], PageSection | None], ...] = (
    summary, warnings, geometry, motion, forces, pressure, face, stress, root_stress, spectra, numbers, effects, energy,
    solver,
)  # fmt: skip


def run_page(run: ShownRun, progress: Progress | None = None) -> Page:
    """The page of a run. Raises SceneError where a time is asked for that the run has not stored."""
    progress = progress or SilentProgress()
    progress.stage("sections")
    sections: list[PageSection] = []
    for make in progress.counted(SECTIONS, lambda make: make.__name__.replace("_", " ")):
        if (section := make(run)) is not None:
            sections.append(section)
    attributes = run.dataset.attrs
    remarks = [] if run.scene is None else changed_files(run.dataset, run.scene)
    scene = scene_section(str(attributes.get("scene", "")), remarks=remarks)
    sections += [version_section(attributes, run.file), scene]
    subtitle = conditions(run.scene) if run.scene is not None else ""
    return Page("Gear pair: report on a run", run.title or run.file.stem, subtitle, sections, made_by(), _alarm(run))


def _alarm(run: ShownRun) -> str:
    said = str(run.dataset.attrs.get("warnings", "")).splitlines()
    without_meaning = [f"NO MEANING: {each}." for each in said if NO_MEANING in each]
    return " ".join([*_incomplete(run), *without_meaning])


def _incomplete(run: ShownRun) -> list[str]:
    if run.complete:
        return []
    why = {
        "interrupted": " It was interrupted.",
        "failed": " It failed.",
        "not ended": " Its process was killed, or still runs.",
    }.get(run.dataset.attrs.get("stopped"), "")
    if not run.steps:
        return [f"INCOMPLETE RUN.{why} No step is stored."]
    stopped = f"It stopped at mesh cycle {run.dataset['mesh_phase'].values[-1]:.2f}"
    return [f"INCOMPLETE RUN.{why} {stopped}; numbers are of the {run.steps} steps that are stored."]
