"""What an effect is: the section that switches it on, and the hooks by which it enters the model.

An effect is one module of this package, one entry in the list of ``fenics_gears.effects`` and one field of
``scene.data.Scene``. The module is loaded where a scene names the effect, or where all effects are listed; a hook is
called only in the first case. Physics that takes the effect's data declares their class, which the module imports;
other modules of physics are imported inside the hooks.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import Section, tree_of
from fenics_gears.inputs.section import own_or_shared as own_or_shared

# Over the tooth pairs that can touch at once, and over the contact nodes of each at the steps whose contact fields are
# stored.
OF_PAIRS = ("time", "slot")
OF_NODES = ("contact_time", "slot", "contact_node")
OF_POINTS = ("path_point",)
OF_TIME = ("time",)
OF_GEARS = ("time", "gear")
# The same over the slices of a face.
OF_SLICES = ("contact_time", "slot", "face_position")


@dataclass(frozen=True)
class ResultVariable:
    """One variable of the result. ``needs``: another effect without which it is not there. ``field``: the field of the
    effect's own section without which it is not there, or several, "places or each", of which one is enough.
    ``over_face``: in three-dimensional scenes only."""

    name: str
    units: str
    long_name: str
    needs: str = ""
    dims: tuple[str, ...] = ("time",)
    field: str = ""
    over_face: bool = False

    @property
    def labels(self) -> dict[str, str]:
        return {"units": self.units, "long_name": self.long_name}


def variables(
    dims: tuple[str, ...], needs: str = "", field: str = "", over_face: bool = False, **said: tuple[str, str]
) -> tuple[ResultVariable, ...]:
    """Result variables that are alike but for names, units and long names."""
    return tuple(ResultVariable(name, *each, needs, dims, field, over_face) for name, each in said.items())


@dataclass(frozen=True)
class Effect:
    """One effect: the section that switches it on, what it adds, and the sections it needs or excludes.

    ``needs`` and ``excludes``: section names. ``absent``: what the model is without it; ``unknowns``, ``terms`` and
    ``variables``: what it adds. ``fields``, a class of this module or of the physics that takes it, declares the
    section and is its data. Where the data are another class, ``read`` makes them of the section, and ``write`` makes a
    section (a dictionary) of them. ``rules`` finds what is wrong between fields: each place, and what to do about it.
    ``within``: the section's path where it is not at the top; the scene's attribute is ``section`` all the same.

    Hooks, each with the effect's data first:

    ``removal(data, pair)``: material removed from pinion and wheel, two functions of the roll angle (rad), mm.
    ``gaps(data, model)``: a function of a step and its position: additional gaps of the contact nodes (n,), mm.
    ``load(data, model)``: a function of a step: forces on the centre coordinates (k,), N, in addition to the constant
    load.
    ``clock(data, model)``: when a step is (``dynamics.clock``), where steps are not all as long.
    ``elasticity(data, model, name, reach, cache)``: flank compliance of the "pinion" or the "wheel" over a reach of
    teeth; None for that of equal teeth.
    ``located(data, directory)``: the data with paths of their files, from the scene file's directory on.
    ``files(data)``: the names of these files, each with a hash of what was read.
    ``check(data, scene, pair)``: raises SceneError where those files, or this load and speed, are wrong.
    ``fits(data, model)``: raises SceneError where the run's settings, given or chosen, are too coarse for it.
    ``warnings(data, model)``: sentences to read before the run.
    ``watched(data, cycle, steps)``: values (steps,) of ``dynamics.steps.Steps`` that the findings need, by name;
    of its own variables, results (steps, ...).
    ``findings(data, watched)``: sentences on where a run violates what the effect assumes.
    ``results(data, scene, cycle, steps)``: its own variables at steps (time,), name to (dimensions, values).
    ``period(data, scene)``: mesh cycles after which what it does repeats, infinite where never; 1 unless given.
    """

    section: str
    description: str
    absent: str
    fields: type[Section]
    unknowns: tuple[str, ...] = ()
    terms: tuple[str, ...] = ()
    variables: tuple[ResultVariable, ...] = ()
    needs: tuple[str, ...] = ()
    excludes: tuple[str, ...] = ()
    within: tuple[str, ...] = ()
    read: Callable[[Any], Any] | None = None
    write: Callable[[Any], dict[str, Any]] | None = None
    rules: Callable[[Mapping[str, Any]], Broken] | None = None
    removal: Callable | None = None
    gaps: Callable | None = None
    load: Callable | None = None
    clock: Callable | None = None
    elasticity: Callable | None = None
    located: Callable | None = None
    files: Callable | None = None
    check: Callable | None = None
    fits: Callable | None = None
    warnings: Callable | None = None
    watched: Callable | None = None
    findings: Callable | None = None
    results: Callable | None = None
    period: Callable | None = None

    @property
    def written(self) -> str:
        """The section's name as a scene file has it."""
        return ".".join(self.within) or self.section

    def data_of(self, section: Section | None, directory: Path) -> Any:
        """The data of a section, its files found from a directory on; None for an absent one."""
        if section is None:
            return None
        data = section if self.read is None else self.read(section)
        return data if self.located is None else self.located(data, directory)

    def as_section(self, data: Any) -> dict[str, Any]:
        return tree_of(data) if self.write is None else self.write(data)
