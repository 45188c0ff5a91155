"""``[damping]``: Rayleigh damping of each shaft (``dynamics.drivetrain``), or damping ratios of the modes
(``dynamics.damping``)."""

from fenics_gears.dynamics.damping import MODAL, RAYLEIGH, Damping
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.tree import GEARS, Tree, given_for, material_sections, quantity_in, table, with_gears

from .effect import Effect, ResultVariable


def damping_acts(tree: Tree) -> Broken:
    """Damping is given in one way and whole, is not zero, and not proportional to a stiffness that is not there."""
    damping = table(tree, "damping")
    if damping is None:
        return
    modal, rayleigh = ([name for name in names if name in damping] for names in (MODAL, (*RAYLEIGH, *GEARS)))
    if modal:
        for name in rayleigh:
            message = f"is given together with {modal[0]}; allowed is one of the two. Leave one out."
            yield ("damping", name), message
        ratios = damping.get("ratios")
        if isinstance(ratios, list) and ratios and not any(ratios):
            message = "damps nothing: all are zero. For an undamped pair, leave the section [damping] out."
            yield ("damping", "ratios"), message
        if not (material_sections(tree) or {"shafts", "bearings"} & set(tree)):
            message = (
                "damps nothing: between rigid flanks nothing vibrates without [shafts] or [bearings]. Add one of them,"
                " or [gears.material]."
            )
            yield ("damping", modal[0]), message
        return
    yield from _rayleigh_is_complete(damping)
    yield from _rayleigh_acts(tree)


def _rayleigh_is_complete(damping: Tree) -> Broken:
    for name, example in zip(RAYLEIGH, ("0.4e-3 s", "0.5e-3 1/s")):
        gears = [gear for gear in GEARS if name not in given_for(damping, gear)]
        if gears:
            path = ("damping", name) if len(gears) == 2 else ("damping", *gears, name)
            other = "ratio = 0.05 alone, of every mode" if len(gears) == 2 else f"{name} of [damping] for both gears"
            yield path, f'is missing. Allowed: such as "{example}"; or {other}.'


def _rayleigh_acts(tree: Tree) -> Broken:
    sections = with_gears(tree, "damping")
    values = {
        name: {path: quantity_in(section[name]) for path, section in sections.items() if name in section}
        for name in RAYLEIGH
    }
    of_stiffness, of_mass = (values[name] for name in RAYLEIGH)
    # A value that cannot be read is reported with its own field.
    if any(value != 0 for value in of_mass.values()) or not of_stiffness or None in of_stiffness.values():
        return
    if not any(of_stiffness.values()):
        message = "damps nothing: both values are zero. For an undamped pair, leave the section [damping] out."
        yield ("damping",), message
    elif "shafts" not in tree and "bearings" not in tree:
        message = (
            "damps nothing: there is no stiffness without [shafts] or [bearings]. Add one of them, or"
            " mass_proportional damping."
        )
        path = next(path for path, value in of_stiffness.items() if value)
        yield (*path, "stiffness_proportional"), message


EFFECT = Effect(
    section="damping",
    description="Rayleigh damping, or damping ratios of the modes",
    absent="no damping",
    fields=Damping,
    terms=("damping forces: stiffness- and mass-proportional, or by mode",),
    variables=(ResultVariable("work_damping", "N mm", "energy lost to damping"),),
    needs=("inertia",),
    rules=damping_acts,
)
