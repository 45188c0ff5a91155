"""The width of a gear that counts where its mate is narrower."""

from dataclasses import replace
from math import exp

import pytest
from tests.benchmarks.third_dimension.face_widths import NAME, quotients
from tests.benchmarks.third_dimension.table import read_rows

from fenics_gears import gear_pair
from fenics_gears.geometry.gear_data import Web


def counts(pair, widths, offsets=(0.0, 0.0), common=15.0):
    return replace(pair, own_face_widths=widths, axial_offsets=offsets, face_width=common).effective_face_widths


def test_limits(paper_pair):
    """Exact: a sliver counts whole, a face without end as much as the reach at either end."""
    assert counts(paper_pair, (15.0, 15.0)) == counts(paper_pair, None) == (15.0, 15.0)
    assert counts(paper_pair, (15.0002, 15.0))[0] - 15.0 == pytest.approx(0.0002, rel=1e-4)
    endless = [0.5 * (width - 15.0) / paper_pair.pinion.module for width in counts(paper_pair, (1e5, 1e5))]
    depths = [gear.body_depth / gear.module for gear in (paper_pair.pinion, paper_pair.wheel)]
    assert endless == pytest.approx([1.1 + 1.6 * (1.0 - exp(-depth / 7.0)) for depth in depths], rel=1e-9)


def test_either_end_by_itself(paper_pair):
    """Exact: one end counts half of both, mirrored alike; side by side each gear has one."""
    both = counts(paper_pair, (25.0, 15.0))[0] - 15.0
    assert counts(paper_pair, (20.0, 15.0), (2.5, 0.0))[0] - 15.0 == pytest.approx(0.5 * both, rel=1e-12)
    assert counts(paper_pair, (20.0, 15.0), (-2.5, 0.0)) == pytest.approx(
        counts(paper_pair, (20.0, 15.0), (2.5, 0.0)), rel=1e-12
    )
    assert counts(paper_pair, (20.0, 20.0), (0.0, 5.0))[0] - 15.0 == pytest.approx(0.5 * both, rel=1e-12)


def test_the_tables_pairs_are_within_two_per_cent_of_three_dimensions():
    """Three dimensions, for pairs that the law was not fitted to (`tests.benchmarks.third_dimension.face_widths`)."""
    found = {(row["wheel_teeth"], row["wheel_bore"], row["common"]) for row, _ in quotients(read_rows(NAME))}
    assert len(found) == 5
    for row, equal in quotients(read_rows(NAME)):
        assert row["plane"] / equal["plane"] == pytest.approx(row["space"] / equal["space"], rel=0.02)


def test_a_web_keeps_its_width(paper_scene):
    """Identity: a web of 9 mm stays 9 mm stiff, and its mass is that of the whole face."""
    wheel = replace(paper_scene.gears.wheel, face_width=30.0, web=Web(25.0, 45.0, 9.0 / 30.0))
    pair = gear_pair(replace(paper_scene.gears, pinion=replace(paper_scene.gears.pinion, face_width=15.0), wheel=wheel))
    assert pair.wheel.web.stiff_share * pair.effective_face_widths[1] == pytest.approx(9.0, rel=1e-12)
    assert (pair.wheel.web.share, pair.wheel.of_module_one.web.stiff_share) == (0.3, pair.wheel.web.stiff_share)
    alone = replace(paper_scene.gears, wheel=replace(wheel, face_width=None))
    assert gear_pair(alone).wheel.web.stiff_share is None
