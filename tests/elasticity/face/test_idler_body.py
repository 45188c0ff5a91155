"""The body over the face of a gear that several mates load, on the drive flanks and on the coast flanks."""

import numpy as np
from tests.elasticity.face.swept import GEAR, SIZES, TWISTED, condense_swept, mesh
from tests.elasticity.test_coast_flank import difference
from tests.whole_gear import whole_gear_mesh

from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.condensation import by_radius
from fenics_gears.elasticity.face import computed
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.elasticity.face.swept_stiffness import ELEMENT
from fenics_gears.geometry.outline import centreline_angle, rotation

REACH = Reach(1, (-3, 1), (2, 2))


class Coarse(FaceDiscretisation):
    """As few elements and layers as a sector takes."""

    sizes = property(lambda self: SIZES)
    sweep = property(lambda self: TWISTED)


def test_flanks_of_several_mates_feel_each_other_as_in_the_whole_gear(monkeypatch):
    """Brute force: the twisted gear as one mesh, its bore held; no sectors, no harmonics, no mirror, no choice of
    motions. Drive flanks, coast flanks in the mirrored frame, and either under forces on the other, of the same tooth,
    of its neighbours and far round the gear; drive and coast flanks under forces on their like of far teeth."""
    both = mesh(both_flanks=True)
    monkeypatch.setattr(computed, "swept_section", lambda gear, sizes: both)
    found, _ = computed.computed_shared(GEAR, Coarse(1.0, 2, 3.0), 0.3, REACH)
    pitch = GEAR.angular_pitch
    turns = {ahead: rotation(ahead * pitch) for ahead in range(-3, 3)}
    flank, coast = (by_radius(both.edge_nodes(side, ELEMENT.order)) for side in ("flank", "coast"))
    lines = {f"drive {ahead}": flank @ turn.T for ahead, turn in turns.items()}
    lines |= {f"coast {ahead}": coast @ turns[ahead].T for ahead in range(3)}
    whole = whole_gear_mesh(both, GEAR.teeth)
    body = condense_swept(whole, TWISTED, 0.3, lines, held=whole.edge_nodes("hub", ELEMENT.order))
    compliance = np.linalg.inv(body.stiffness)
    axis = np.array([np.cos(centreline_angle(GEAR)), np.sin(centreline_angle(GEAR))])
    mirror = np.eye(3)
    mirror[:2, :2] = 2.0 * np.outer(axis, axis) - np.eye(2)

    def expected(responding: str, loaded: str) -> np.ndarray:
        block = compliance[np.ix_(body.dofs(responding), body.dofs(loaded))]
        frames = []
        for name in (responding, loaded):
            side, ahead = name.split()
            turn = rotation(int(ahead) * pitch, 3)
            frames.append(np.kron(np.eye(len(block) // 3), turn @ mirror if side == "coast" else turn))
        return frames[0].T @ block @ frames[1]

    for ahead in (0, 1):
        assert difference(found["blocks_0"][ahead], expected(f"drive {ahead}", "drive 0")) < 1e-9
        # In the mirror image the tooth ahead is the one behind.
        assert difference(found["blocks_1"][ahead], expected("coast 0", f"coast {ahead}")) < 1e-9
    largest = np.abs(found["blocks_0"][0]).max()
    for number, ahead in enumerate(range(-3, 2)):
        across = found["motions_0"] @ found["between_01"][number] @ found["motions_1"].T
        assert np.abs(across - expected(f"drive {ahead}", "coast 0")).max() < 1e-6 * largest
        assert np.abs(across).max() > 1e-3 * largest
    for kind, name in enumerate(("drive", "coast")):
        motions = found[f"motions_{kind}"]
        for number, ahead in enumerate((2,)):
            far = motions @ found[f"between_{kind}{kind}"][number] @ motions.T
            assert np.abs(far - expected(f"{name} {ahead}", f"{name} 0")).max() < 1e-6 * largest
            assert np.abs(far).max() > 1e-3 * largest
    assert found["between_01"].shape[1] < 0.7 * len(found["blocks_0"][0])
