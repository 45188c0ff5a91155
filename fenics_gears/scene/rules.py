"""What must hold between the fields of a scene, beyond what each field allows by itself.

The rules read the parsed TOML file, so that they speak even where some field is wrong; a value that they cannot read is another's problem.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf
from typing import Any

from fenics_gears import effects
from fenics_gears.scene import units
from fenics_gears.scene.names import nearest
from fenics_gears.scene.problems import Problem
from fenics_gears.scene.schema import Gears
from fenics_gears.scene.written import as_written

Tree = Mapping[str, Any]
# In modules: the dense compliance of a flank of such elements has gigabytes.
FINEST_ELEMENT = 1e-3


def broken_rules(tree: Tree) -> list[Problem]:
    """All rules that the parsed file breaks."""
    return [problem for rule in _RULES for problem in rule(tree)]


def _effects_fit_together(tree: Tree) -> Iterator[Problem]:
    known = [effect.section for effect in effects.EFFECTS]
    sections = {nearest(name, known) or name for name in tree}  # a misspelt section is another problem
    for effect, need in effects.missing_needs(sections):
        yield Problem((effect.section,), "", f"needs the section [{need}], which is missing. Add [{need}], or leave [{effect.section}] out.")
    for effect, other in effects.conflicts(sections):
        yield Problem((effect.section,), "", f"cannot stand beside [{other}]. Leave one of the two out.")


def _one_speed(tree: Tree) -> Iterator[Problem]:
    motion = _table(tree, "motion")
    if motion is None:
        return
    given = [name for name in ("mesh_frequency", "pinion_speed") if name in motion]
    if len(given) == 2:
        yield Problem(("motion", "pinion_speed"), as_written(motion["pinion_speed"]), "stands beside mesh_frequency; allowed is one of the two. Leave one out.")
    if not given:
        yield Problem(("motion", "mesh_frequency"), None, 'is missing. Allowed: mesh_frequency, such as "200 Hz", or pinion_speed, such as "750 rpm".')


def _recorded_cycles_are_run(tree: Tree) -> Iterator[Problem]:
    motion = _table(tree, "motion") or {}
    recorded, run = motion.get("recorded_cycles"), motion.get("mesh_cycles")
    if type(recorded) is int and type(run) is int and recorded > run > 0:
        yield Problem(("motion", "recorded_cycles"), as_written(recorded), f"is more than mesh_cycles = {as_written(run)}. Allowed: at most as many cycles as are run.")


def _damping_acts(tree: Tree) -> Iterator[Problem]:
    damping = _table(tree, "damping")
    if damping is None:
        return
    values = {name: _quantity(damping.get(name)) for name in ("stiffness_proportional", "mass_proportional")}
    if values["mass_proportional"] != 0 or values["stiffness_proportional"] is None:
        return
    if values["stiffness_proportional"] == 0:
        yield Problem(("damping",), "", "damps nothing: both values are zero. For an undamped pair, leave the section [damping] out.")
    elif "shafts" not in tree and "bearings" not in tree:
        message = "damps nothing: there is no stiffness without [shafts] or [bearings]. Add one of them, or allow a mass_proportional value above 0."
        yield Problem(("damping", "stiffness_proportional"), as_written(damping["stiffness_proportional"]), message)


def _relief_is_complete(tree: Tree) -> Iterator[Problem]:
    both = _table(tree, "tip_relief")
    if both is None:
        return
    given = {("tip_relief", gear): {*both, *both[gear]} for gear in ("pinion", "wheel") if _table(both, gear) is not None}
    if "depth" in both or not given:
        given["tip_relief",] = set(both)
    for path, names in given.items():
        for name, example in (("depth", '"31 um"'), ("start", '"HPSTC" or "29.61 deg"')):
            if name not in names:
                yield Problem((*path, name), None, f"is missing. Allowed: such as {example}.")


def _resolution_fits_the_teeth(tree: Tree) -> Iterator[Problem]:
    module = _module(tree)
    if module is None:
        return
    accuracy = _table(tree, "accuracy") or {}
    for name, modules in (("flank_element_size", 1.0), ("contact_length", 3.0)):
        size = _quantity(accuracy.get(name))
        if size is not None and size > modules * module:
            yield Problem(("accuracy", name), as_written(accuracy[name]), f"is too large for a module of {module:g} mm. Allowed: up to {modules * module:g} mm.")
    size, finest = _quantity(accuracy.get("flank_element_size")), FINEST_ELEMENT * module
    if size is not None and 0 < size < finest:
        message = f"is too small for a module of {module:g} mm: no memory holds such a mesh. Allowed: from {finest:g} mm."
        yield Problem(("accuracy", "flank_element_size"), as_written(accuracy["flank_element_size"]), message)


def _load_has_flanks(tree: Tree) -> Iterator[Problem]:
    load = _table(tree, "load") or {}
    torque = _quantity(load.get("wheel_torque"))
    if torque is not None and torque < 0.0 and "coast_flanks" not in tree:
        message = "is negative: it drives the pair from the wheel, on its coast flanks. Allowed: with the section [coast_flanks] any sign, without it 0 N m and above."
        yield Problem(("load", "wheel_torque"), as_written(load["wheel_torque"]), message)


def _route_has_flanks(tree: Tree) -> Iterator[Problem]:
    accuracy = _table(tree, "accuracy") or {}
    if accuracy.get("condensation") == "every step" and "coast_flanks" in tree:
        yield Problem(("accuracy", "condensation"), '"every step"', 'has no contact on the coast flanks. Take "once", or leave the section [coast_flanks] out.')


_RULES = (_load_has_flanks, _route_has_flanks, _effects_fit_together, _one_speed, _recorded_cycles_are_run, _damping_acts, _relief_is_complete, _resolution_fits_the_teeth)


def _table(tree: Tree, name: str) -> Tree | None:
    value = tree.get(name)
    return value if isinstance(value, Mapping) else None


def _module(tree: Tree) -> float | None:
    """The module in mm; None where it is missing or wrong by itself."""
    module = _quantity((_table(tree, "gears") or {}).get("module"))
    if module is None:
        return None
    limits = Gears.model_fields["module"].metadata
    return module if all(getattr(each, "ge", 0.0) <= module <= getattr(each, "le", inf) for each in limits) else None


def _quantity(value: Any) -> float | None:
    """The number in N, mm, s, rad; None for what is no quantity."""
    if not isinstance(value, str):
        return None
    try:
        return units.quantity(value)[0]
    except units.QuantityError:
        return None
