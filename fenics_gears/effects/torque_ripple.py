"""``[torque_ripple]``: load torque that varies with the rotation of the wheel's shaft (``dynamics.torque_ripple``)."""

from collections.abc import Mapping
from fractions import Fraction
from math import isfinite, lcm, pi

from fenics_gears.dynamics.torque_ripple import TorqueRipple, torque, varying_load
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.tree import Tree, dotted, load_in, quantity_in, table

from .effect import Effect, ResultVariable

# Orders are taken as whole parts of this; finer ones repeat in no run.
FINEST_PART_OF_ORDER = 1000


def torque_keeps_its_sign(tree: Tree) -> Broken:
    """A torque that changes its sign needs the coast flanks."""
    ripple = table(tree, "torque_ripple")
    mean = load_in(tree)
    written = ripple.get("harmonics") if ripple else None
    if mean is None or "coast_flanks" in tree or not isinstance(written, list):
        return
    torque = mean[1]
    of_wheel = "" if mean[0][-1] == "wheel_torque" else " is on the wheel"
    amplitudes = [quantity_in(each.get("amplitude")) for each in written if isinstance(each, Mapping)]
    total = sum(amplitude for amplitude in amplitudes if amplitude is not None)
    if isfinite(total) and total > abs(torque):
        message = (
            f"has amplitudes of {total * 1e-3:.6g} N m together, more than {dotted(mean[0])}{of_wheel}: the torque can"
            f" change its sign. Allowed: up to {abs(torque) * 1e-3:.6g} N m, or any with the section [coast_flanks]."
        )
        yield ("torque_ripple", "harmonics"), message


def load(ripple: TorqueRipple, model):
    return varying_load(ripple, model.drivetrain, shaft_step(model.scene, model.resolution.steps_per_mesh_cycle))


def results(ripple: TorqueRipple, scene, cycle, steps) -> dict:
    """The torque on the wheel's shaft (time,), N mm."""
    angle = shaft_step(scene, cycle.steps)
    return {"wheel_couple": (("time",), scene.load.wheel_torque + torque(ripple, angle * steps))}


def period(ripple: TorqueRipple, scene) -> int:
    """Mesh cycles after which the torque repeats: the least common multiple of z2 / order over all harmonics."""
    teeth = scene.gears.wheel.teeth
    return lcm(
        *((teeth / Fraction(each.order).limit_denominator(FINEST_PART_OF_ORDER)).numerator for each in ripple.harmonics)
    )


def shaft_step(scene, steps_per_mesh_cycle: int) -> float:
    """Angle (rad) that the wheel's shaft turns in a step."""
    return 2.0 * pi / (abs(scene.gears.wheel.teeth) * steps_per_mesh_cycle)


EFFECT = Effect(
    section="torque_ripple",
    description="load torque that varies with the rotation of the wheel's shaft, as a sum of harmonics",
    absent="constant load torque",
    fields=TorqueRipple,
    terms=("varying load torque",),
    variables=(
        ResultVariable(
            "wheel_couple", "N mm", "load torque on the wheel's shaft, positive where it resists the rotation"
        ),
    ),
    rules=torque_keeps_its_sign,
    load=load,
    results=results,
    period=period,
)
