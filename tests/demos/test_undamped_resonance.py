"""The undamped sweep."""

import re

import numpy as np
import pytest
from demos.undamped_resonance import resonance
from demos.undamped_resonance.drawing import draw
from demos.undamped_resonance.sweeps import WITH, WITHOUT, sweeps


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    directory = tmp_path_factory.mktemp("undamped")
    text = resonance.STUDY.read_text()
    text = re.sub(r"motion.mesh_frequency = \[[^]]*\]", 'motion.mesh_frequency = ["100 Hz", "210 Hz"]', text)
    for name, value in (
        ("mesh_cycles", 20),
        ("recorded_cycles", 5),
        ("contact_nodes", 26),
        ("steps_per_mesh_cycle", 160),
    ):
        text, count = re.subn(rf"{name} = \d+", f"{name} = {value}", text)
        assert count == 1
    text = text.replace("[sweep]", 'accuracy.element = "P1"\naccuracy.flank_element_size = "0.12 mm"\n\n[sweep]')
    text = text.replace("../lundvall2004.toml", str(resonance.HERE.parent / "lundvall2004.toml"))
    (directory / "study.toml").write_text(text)
    assert resonance.compute(directory / "study.toml", directory / "out") == 0
    return directory / "out", resonance.picture(directory / "out")


@pytest.mark.nightly
def test_contact_is_kept_far_from_resonance_and_lost_at_it(small):
    """Claim 10 (Section 5); while contact is kept coast flanks change nothing."""
    found = sweeps(small[0])
    for curve in found.values():
        assert list(curve.frequency) == [100.0, 210.0] and list(curve.lost) == [False, True]
        assert np.array_equal(curve.opening > 0.0, curve.lost)
    assert found[WITH].amplitude[0] == pytest.approx(found[WITHOUT].amplitude[0], rel=5e-3)
    assert not found[WITH].meaningless.any()
    assert list(found[WITHOUT].meaningless) == list(found[WITHOUT].opening > 0.099)


@pytest.mark.nightly
def test_picture_shows_both_curves_and_marks_what_was_lost(small):
    """Axes with units; marks exactly where contact was lost."""
    assert small[1].name == "undamped_resonance.png" and small[1].stat().st_size > 10_000
    found = sweeps(small[0])
    above, below = draw(found).get_axes()
    assert "(µm)" in above.get_ylabel() and "(%)" in below.get_ylabel() and "(Hz)" in below.get_xlabel()
    assert {WITH, WITHOUT} <= {text.get_text() for text in above.get_legend().get_texts()}
    crossed = [
        list(line.get_xdata()) for line in above.get_lines() if line.get_marker() == "x" and len(line.get_xdata())
    ]
    assert crossed == [[at] for at in found[WITHOUT].frequency[found[WITHOUT].meaningless]]
    shares = [list(line.get_ydata()) for line in below.get_lines()]
    assert shares == [list(100.0 * curve.share) for curve in found.values()]
