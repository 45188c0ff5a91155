"""The ring of sectors. Against brute force and its kernel: hard cases 5 and 6."""

import pytest
from tests.coarse_sector import relative
from tests.whole_gear import whole_gear_compliance, whole_gear_mesh

from fenics_gears import ComputationError
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.elasticity.ring import condensed_sector, ring_compliance


def test_every_tooth_is_the_same_and_teeth_behind_are_the_transpose(pinion, steel, coarse_sector):
    """Exact identities: isotropy under whole pitches; Betti's theorem for the tooth behind."""
    whole = whole_gear_mesh(coarse_sector("P2"), pinion.teeth)
    first = whole_gear_compliance(whole, pinion, steel, tooth_offsets=pinion.teeth - 1)
    fifth = whole_gear_compliance(whole, pinion, steel, loaded_tooth=5, tooth_offsets=2)
    assert relative(first.blocks[:3] - fifth.blocks, fifth.blocks) < 1e-9
    for offset in (1, 2):
        behind = first.blocks[pinion.teeth - offset]
        assert relative(behind - fifth.block(-offset), behind) < 1e-9


def test_cuts_that_do_not_match_are_refused(pinion, coarse_sector):
    """A ring of one tooth more has another pitch."""
    sector = condensed_sector(coarse_sector("P1"), ELEMENTS["P1"], 0.3)
    with pytest.raises(ComputationError, match="do not match"):
        ring_compliance(sector, pinion.teeth + 1, 1)
