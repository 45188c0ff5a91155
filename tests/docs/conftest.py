"""What the documentation's tests share."""

import os
import shutil
from pathlib import Path

import pytest
from tests.docs.blocks import ROOT
from tests.effects.examples import text_of

from fenics_gears.commands import cli

STUDY = """
scene = "demos/lundvall2004.toml"

[set]
accuracy.steps_per_mesh_cycle = 40
motion.mesh_cycles = 10

[sweep]
motion.mesh_frequency = ["150 Hz", "300 Hz"]
friction = ["absent", "present"]
"""


@pytest.fixture(scope="session")
def readers_folder(tmp_path_factory) -> Path:
    """The demo, its gears in REXS, its result, a small study and its result, a coarse scene with root stress."""
    folder = tmp_path_factory.mktemp("reader")
    (folder / "demos").mkdir()
    for name in ("lundvall2004.toml", "lundvall2004.rexs"):
        shutil.copy(ROOT / "demos" / name, folder / "demos")
    (folder / "frequencies.toml").write_text(STUDY, encoding="utf-8")
    (folder / "scene.toml").write_text(
        text_of("tooth_elasticity") + "\n[output]\nroot_stress = true\n", encoding="utf-8"
    )
    before = Path.cwd()
    os.chdir(folder)
    try:
        assert cli.main(["run", "demos/lundvall2004.toml", "--quiet"]) == 0
        assert cli.main(["study", "frequencies.toml", "--quiet"]) == 0
    finally:
        os.chdir(before)
    return folder
