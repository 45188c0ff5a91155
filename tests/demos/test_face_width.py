"""The demonstration of transmission error over face width."""

import re

import numpy as np
import pytest
from demos.face_width import widths
from demos.face_width.picture import picture

from fenics_gears import gear_pair, load_scene
from fenics_gears.commands.cli import main


def test_widths_are_overlap_ratios_at_the_same_load_per_width():
    """Definition: epsilon_beta = b sin(beta)/(pi m_n) of the base scene is 1."""
    assert gear_pair(load_scene(widths.STUDY.parent / "pair.toml").gears).overlap_ratio == pytest.approx(1.0, abs=1e-4)
    lines = [re.findall(r'"([\d.]+) ', line) for line in widths.STUDY.read_text().splitlines()]
    swept = [list(map(float, values)) for values in lines if len(values) == 10]
    assert len(swept) == 2
    for values in swept:
        np.testing.assert_allclose(values, values[0] * np.arange(1, 11), rtol=1e-3)


@pytest.mark.nightly
def test_a_whole_overlap_ratio_has_less_ripple(tmp_path):
    """The demonstration's own words, on coarse bodies."""
    text = widths.STUDY.read_text().replace('"pair.toml"', f'"{widths.STUDY.parent / "pair.toml"}"')

    # The third and the fourth of each swept field's values, on half as many slices and layers.
    def kept(found):
        values = found[1].split(", ")[2:4]
        return f"= [{', '.join(values if chr(34) in found[1] else [str(max(4, int(value) // 2)) for value in values])}]"

    coarse = 'accuracy = { body_element_size = "2.5 mm", flank_element_size = "0.2 mm", steps_per_mesh_cycle = 12 }'
    text = re.sub(r"= \[(.*)\]", kept, text).replace("[sweep]", f"[set]\n{coarse}\n\n[sweep]")
    (tmp_path / "study.toml").write_text(text)
    assert main(["study", str(tmp_path / "study.toml"), "--output", str(tmp_path / "out")]) == 0
    found = widths.cases(tmp_path / "out")
    assert [round(case.overlap_ratio, 2) for case in found] == [0.75, 1.0]
    assert found[1].peak_to_peak < 0.5 * found[0].peak_to_peak
    assert widths.table(found).count("\n") == 4
    assert [len(axes.get_lines()) for axes in picture(found).axes] == [4]
