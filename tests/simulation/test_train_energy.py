"""Energy accounts of trains: work of drive, load, friction and damping is the change of kinetic and elastic energy."""

from collections.abc import Callable
from functools import reduce

import numpy as np
import pytest
from tests.planets import in_time
from tests.simulation.test_train_motion import BEARINGS, FRICTION, INERTIA, motion, shaft
from tests.simulation.test_train_shafts import all_bent, cut_in
from tests.trains import (
    COARSE,
    COARSE_FACE,
    bent_two_stages,
    gear_text,
    helical_row,
    mate,
    row,
    row_section,
    split_text,
    stage,
    two_stages,
)

from fenics_gears import train_from_text
from fenics_gears.dynamics.energy_account import account, quadratic
from fenics_gears.dynamics.march import Marcher
from fenics_gears.dynamics.steps import Steps
from fenics_gears.model.train import train_model_of
from fenics_gears.results.contact_variables import energy_of_teeth
from fenics_gears.scene.train import TrainScene
from fenics_gears.simulation.train import row_cycle
from fenics_gears.system.progress import SilentProgress

WITHOUT_BEARINGS = f"{INERTIA}[damping]\nratio = 0.04\n{motion(2000, 2)}"
RAMP = '[speed_ramp]\nend_speed = "2600 rpm"\nhold_cycles = 1\n'
MOVING = f"{WITHOUT_BEARINGS}{BEARINGS}"


def helical_idler() -> TrainScene:
    return helical_row([24, 31, 40], [0, 60], 300, more="[stages.row.friction]\ncoefficient = 0.1")


def stages_behind_an_idler() -> TrainScene:
    """A shaft that twists between two stages, and bearings."""
    idlers = row_section((20, 25, 30), (0, 50), module=2, bore=20)
    more = MOVING + FRICTION + shaft("middle", '"row.3", "second.pinion"', 1e8) + shaft("end", '"second.wheel"', 2e8)
    load = f'[load]\noutput_torque = "400 N m"\n[accuracy]\n{COARSE}\n'
    return train_from_text(idlers + stage("second", 3.0, (20, 40)) + load + more)


def helical_with_friction_in_one() -> TrainScene:
    first, idler, last = (gear_text(each, 2.0) for each in (24, 31, 40))
    lean = 'helix_angle = "15 deg"'
    stages = mate("a", first, idler, 0.0, more=f"{lean}\n[stages.a.friction]\ncoefficient = 0.1")
    stages += mate("b", '"a.wheel"', last, 60.0, more=lean)
    return train_from_text(f'{stages}[load]\noutput_torque = "100 N m"\n[accuracy]\n{COARSE_FACE}')


def wedged_idler() -> TrainScene:
    """Its middle gear runs out by more than its teeth have play, so that both of their flanks press in both meshes."""
    run_out = '[stages.row.eccentricity.2]\ndistance = "15 um"\n[stages.row.coast_flanks]\n'
    return row([24, 31, 40], [0, 60], 300, more=run_out + MOVING + FRICTION)


def clocked_paths() -> TrainScene:
    shaft = 'clocking = "1e-4 rad"\ntorsional_stiffness = "1e8 N mm/rad"'
    return train_from_text(split_text(of_shaft=shaft, more=FRICTION + MOVING))


def bent_clocked_paths() -> TrainScene:
    return train_from_text(all_bent(1.0, 'clocking = "1e-4 rad"\n', WITHOUT_BEARINGS + FRICTION))


def several_loads() -> TrainScene:
    """On two outputs, one behind a shaft that twists, and on the shaft between two stages."""
    side = stage("side", 2.0, (18, 25), 'direction = "120 deg"')
    inner = ", ".join(
        f'{{ on = "{gear}", torque = "{torque} N m", moment_of_inertia = "0.01 kg m^2" }}'
        for gear, torque in (("first.wheel", 40), ("side.wheel", 50))
    )
    load = f'[load]\noutput_torque = "400 N m"\ntorques = [{inner}]\n[accuracy]\n{COARSE}\n'
    more = MOVING + FRICTION + shaft("middle", '"first.wheel", "second.pinion", "side.pinion"', 1e8)
    more = more.replace('torsional_stiffness = "100000000.0 N mm/rad"', "") + shaft("end", '"side.wheel"', 2e8)
    return train_from_text(stage("first", 2.0, (20, 30)) + stage("second", 3.0, (20, 40)) + side + load + more)


def set_at_speed() -> TrainScene:
    """A floating sun, and a frame that turns at 200 rad/s."""
    given = {"more": 'floating = ["sun"]', "pins": ', pin_errors = ["10 um", "0 um", "0 um"]'}
    return in_time(6900, 2, sections=FRICTION + "[damping]\nratio = 0.04\n", **given)


CASES = {
    "helical idler": (helical_idler, 1e9),
    "an idler wedged between its mates": (wedged_idler, 1e9),
    "friction in one of two stages": (lambda: two_stages("[stages.first.friction]\ncoefficient = 0.08\n", MOVING), 1e9),
    "helical, friction in one mesh": (helical_with_friction_in_one, 1e9),
    "stages behind an idler": (stages_behind_an_idler, 1e9),
    "a speed ramp": (lambda: train_from_text(two_stages(more=MOVING + FRICTION + RAMP).text), 1e9),
    "several loads": (several_loads, 1e9),
    "no positions kept": (stages_behind_an_idler, 0.0),
    "clocked paths": (clocked_paths, 1e9),
    "a planetary set": (set_at_speed, 1e9),
    "shafts that bend": (lambda: bent_two_stages(1.0, MOVING + FRICTION), 1e9),
    "teeth cut into a shaft that bends": (lambda: cut_in(bent_two_stages(1.0, MOVING + FRICTION)), 1e9),
    "paths on shafts that bend": (bent_clocked_paths, 1e9),
}
LONG = {"paths on shafts that bend"}


@pytest.mark.parametrize(
    ("train", "memory"),
    [pytest.param(*case, id=name, marks=[pytest.mark.nightly] * (name in LONG)) for name, case in CASES.items()],
)
def test_the_account_closes(train: Callable[[], TrainScene], memory: float):
    """Identity, to round-off: also of what one mesh displaces in another a step before, of a shaft that twists or bends
    by its own modes between two gears, and where there is no memory to keep positions."""
    (model,) = train_model_of(train()).rows
    drivetrain = model.drivetrain
    cycle = row_cycle(model, SilentProgress(), None)
    cycle.share(memory)
    blocks: list[Steps] = []
    march = Marcher(cycle, model.equations_of_motion)
    march.run(model.steps, 1, observe=lambda solved, so_far: blocks.append(solved))
    steps = reduce(Steps.followed_by, blocks)
    energy = energy_of_teeth(steps) + 0.5 * quadratic(steps.states[:, 0], drivetrain.stiffness)
    if drivetrain.mass is not None:
        energy = energy + 0.5 * quadratic(steps.states[:, 1], drivetrain.mass)
    equations = model.equations_of_motion
    work = account(drivetrain, equations.clock, steps, energy, equations.loads)
    least = work.friction[-1] if drivetrain.mass is None else min(work.friction[-1], work.damping[-1])
    assert least > 1e-3 * np.ptp(energy)
    assert np.abs(work.defect).max() < 1e-9 * energy.max()
