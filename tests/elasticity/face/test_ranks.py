"""A gear's body shared out between MPI ranks."""

import pytest
from tests.programs import python

pytestmark = pytest.mark.ranks

PROGRAM = """
from dataclasses import replace
import sys
import numpy as np
from tests.coarse_sector import PINION, STEEL
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.face.compliance import face_compliance
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.system.job import led

def compare(job):
    face, both, cache = FaceDiscretisation(2.7, 3, 15.0, 0.007), Reach(1, (-1, 1)), Cache("cache")
    alone = face_compliance(PINION, STEEL, face, both)
    for known in (False, True):
        shared = face_compliance(PINION, STEEL, face, both, cache, job)
        assert shared.timings["from_cache"] == known
        for one, other in ((alone.blocks, shared.blocks), (alone.plane.blocks, shared.plane.blocks)):
            difference = np.linalg.norm(one - other) / np.linalg.norm(one)
            assert difference <= 1e-9, difference
    print(f"{job.size} ranks agree")
    return 0

sys.exit(led(compare))
"""


@pytest.mark.nightly
@pytest.mark.parametrize("ranks", [2, 3])
def test_ranks_give_what_one_gives(tmp_path, ranks):
    """Who eliminates which part changes nothing but round-off; rank 0 alone looks into the cache."""
    (tmp_path / "program.py").write_text(PROGRAM)
    assert f"{ranks} ranks agree" in python("program.py", folder=tmp_path, ranks=ranks).stdout
