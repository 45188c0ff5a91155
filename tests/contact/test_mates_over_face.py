"""Several mates of one gear over the face: those on the same flanks of its teeth, and on either."""

import numpy as np
import pytest
from tests.simulation.test_train_loads import torques
from tests.trains import COARSE, gear_text, mate, split_text

from fenics_gears import SceneError, simulate_train, train_from_text
from fenics_gears.dynamics.stepping import Stepper
from fenics_gears.elasticity.cache import Cache
from fenics_gears.model.train import train_model_of
from fenics_gears.simulation.train import row_cycle
from fenics_gears.system.progress import SilentProgress

COARSER = 'steps_per_mesh_cycle = 6\nflank_element_size = "0.25 mm"'
COARSE_FACE = f'slices = 3\nlayers = 2\nbody_element_size = "4 mm"\n{COARSER}'
FRICTION = "[friction]\ncoefficient = 0.1\n"
OUTPUTS = torques(("b.wheel", 60.0), ("c.wheel", 80.0))


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    return Cache(tmp_path_factory.mktemp("gears"))


def over_face(text: str, helix: str = 'helix_angle = "15 deg"', accuracy: str = COARSE_FACE) -> str:
    """A train of such stages with narrow faces and coarse elements."""
    text = text.replace("face_width", f"{helix}\nface_width").replace('face_width = "20 mm"', 'face_width = "8 mm"')
    return text.replace(COARSE, accuracy)


def two_outputs(more: str = "") -> str:
    """A gear that drives two others."""
    stages = mate("b", gear_text(20, 2.0), gear_text(30, 2.0), 0.0) + mate("c", '"b.pinion"', gear_text(30, 2.0), 150.0)
    return over_face(f"{stages}[load]\n{OUTPUTS}\n[accuracy]\n{COARSE}\n{more}")


def three_mates(middle_first: bool, hand: str, more: str = "") -> str:
    """A gear of three meshes: one drives it, two are driven by it, on the opposite flanks of its teeth. It is declared
    as the wheel of the first one, or as the pinion of the others."""
    first, middle, last = (gear_text(each, 2.0) for each in (20, 31, 24))
    names = ('"b.pinion"', middle, '"b.pinion"') if middle_first else (middle, '"a.wheel"', '"a.wheel"')
    driving = mate("a", first, names[0], 180.0)
    driven = mate("b", names[1], last, 100.0) + mate("c", names[2], last, -70.0)
    stages = driven + driving + '[shafts.first]\ncarries = ["a.pinion"]\n' if middle_first else driving + driven
    text = over_face(f"{stages}[load]\n{OUTPUTS}\n[accuracy]\n{COARSE}\n{more}")
    return text.replace("helix_angle", f'pinion_hand = "{hand}"\nhelix_angle')


def operator_of(text: str, cache: Cache, step: int = 2):
    (model,) = train_model_of(train_from_text(text)).rows
    cycle = row_cycle(model, SilentProgress(), cache)
    return cycle, cycle.position(step).operator


def test_compliance_between_all_meshes_is_symmetric_and_positive(cache):
    """Betti's theorem and the energy of any load, with friction: of each two meshes of a gear of three, on the same
    flanks and on either."""
    cycle, operator = operator_of(three_mates(False, "right", FRICTION), cache)
    compliance = operator.compliance
    largest = np.abs(compliance).max()
    assert np.abs(compliance - compliance.T).max() < 1e-12 * largest
    assert np.linalg.eigvalsh(compliance).min() > 0.0
    ends = np.cumsum([0, *(mesh.cycle.position(2).operator.nodes for mesh in cycle.meshes)])
    for one, other in ((0, 1), (0, 2), (1, 2)):
        assert np.abs(compliance[ends[one] : ends[one + 1], ends[other] : ends[other + 1]]).max() > 1e-3 * largest


def errors_at(text: str, phases: tuple[float, ...], cache: Cache) -> dict[str, list[float]]:
    """Transmission error (rad) of each mesh at rest, where the first one is at such phases."""
    (model,) = train_model_of(train_from_text(text)).rows
    cycle = row_cycle(model, SilentProgress(), cache)
    stepper = Stepper(cycle, model.equations_of_motion)
    names = [mesh.name for mesh in model.meshes]
    found: dict[str, list[float]] = {name: [] for name in names}
    for phase in phases:
        step = (phase - model.layout.phases[names.index("a")]) % 1.0 * cycle.steps
        position = stepper.in_balance(step, cycle.between(step, step - 1.0)).state.position
        for name, own, mesh in zip(names, model.models, cycle.meshes):
            found[name].append(float(own.transmission_error(mesh.coordinates @ position)))
    return found


def test_in_whatever_order_and_of_whatever_hand_meshes_are(cache):
    """Exchange: from which of its meshes teeth and flanks of a gear are counted changes nothing; and mirrored along its
    axis a train without lead modifications is itself. Both leave out other motions, of 1e-6 of the largest."""
    trains = [three_mates(*each) for each in ((False, "right"), (True, "right"), (False, "left"))]
    right, exchanged, left = (errors_at(each, (0.1, 0.7), cache) for each in trains)
    for mesh in "abc":
        assert exchanged[mesh] == pytest.approx(right[mesh], rel=1e-7)
        assert left[mesh] == pytest.approx(right[mesh], rel=1e-7)


def test_mates_at_mirrored_places_share_evenly():
    """Turned by half a turn the train of two helical paths is itself: each path carries half, at every step, through
    bodies that both meshes of a gear load on one flank."""
    found = simulate_train(train_from_text(over_face(split_text())))
    assert found["path_share"].values == pytest.approx(np.full((len(found["step"]), 4), 0.5), abs=1e-10)


def test_a_gear_has_one_lead_in_all_meshes():
    """The same flanks cannot be crowned in one mesh and level in another."""
    crowned = '[stages.b.lead_modifications.pinion]\ncrowning = "5 um"\n'
    with pytest.raises(SceneError, match="other lead modifications"):
        train_model_of(train_from_text(two_outputs(crowned)))
    train_model_of(train_from_text(two_outputs(crowned + crowned.replace("stages.b", "stages.c"))))


def test_a_gear_has_one_hand_in_all_meshes():
    """A right-hand gear has left-hand mates alone."""
    text = two_outputs().replace("helix_angle", 'pinion_hand = "left"\nhelix_angle', 1)
    with pytest.raises(SceneError, match="one pinion_hand"):
        train_model_of(train_from_text(text))
