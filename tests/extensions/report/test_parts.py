"""What curves, spectra and the drawing of a report are made of."""

from math import asin, cos, radians, sin

import numpy as np
from tests.helical import wide_pair
from tests.show.synthetic import made_up_run

from fenics_gears.extensions.report.energy import energy
from fenics_gears.extensions.report.overview import summary
from fenics_gears.extensions.report.spectra import spectra
from fenics_gears.show.run import ShownRun


def ramp_of(paper_scene, cycles):
    text = f'{paper_scene.text}\n[speed_ramp]\nend_frequency = "50 Hz"\n'
    return made_up_run(scene=text, cycles=cycles, steps=int(20 * cycles) + 1)


def test_a_ramp_points_to_orders_cycle_by_cycle_only_where_they_are_drawn(paper_scene, tmp_path):
    """From eight stored mesh cycles on."""
    for cycles in (2.0, 9.0):
        section = spectra(ShownRun(ramp_of(paper_scene, cycles), tmp_path / "run.nc"))
        drawn = [block.caption for block in section.blocks if "cycle by cycle" in getattr(block, "caption", "")]
        assert ("See the orders cycle by cycle." in section.blocks[0].text) == bool(drawn) == (cycles > 8.0)


def tiles_of(dataset, tmp_path):
    (tiles,) = summary(ShownRun(dataset, tmp_path / "run.nc")).blocks
    return {tile.label: tile for tile in tiles.tiles}


def test_the_largest_mesh_force_is_compared_with_the_force_along_the_same_normal(paper_scene, tmp_path):
    """Statics: F_bn = T_2/(r_b2 cos(beta_b)), of a helical pair too."""
    for scene, helix in ((paper_scene.text, 0.0), (wide_pair().text, 15.0)):
        run = made_up_run(scene=scene)
        pair = ShownRun(run).pair
        run["normal_force"] = 0.0 * run["normal_force"] + ShownRun(run).scene.load.wheel_torque / (
            pair.wheel.base_radius * cos(asin(sin(radians(helix)) * cos(radians(20.0))))
        )
        assert tiles_of(run, tmp_path)["Largest mesh force"].note.startswith("1.000 times")


def test_the_account_names_the_side_that_drives_and_keeps_signs(paper_scene, tmp_path):
    """Conservation of energy: a wheel that drives does the larger work."""
    dataset = made_up_run(scene=paper_scene.text)
    work = {
        "work_input": -96.0,
        "work_output": -100.0,
        "work_friction": 3.0,
        "work_contact_changes": -1.0,
        "energy": 0.0,
        "energy_defect": 0.0,
    }
    for name, last in work.items():
        dataset[name] = ("time", np.linspace(0.0, 1e3 * last, dataset.sizes["time"]), {"units": "N mm"})

    def rows():
        facts = energy(ShownRun(dataset, tmp_path / "run.nc")).blocks[0]
        return {label: f"{value} {unit}" for label, value, unit in facts.rows}

    wheel = rows()
    assert wheel["work of the drive, the wheel's shaft"] == "100 N m"
    assert wheel["work done on the load, the pinion's shaft"] == "96 N m (96 % of the drive's work)"
    assert wheel["lost to friction"] == "3 N m (3 % of the drive's work)"
    assert wheel["put in by the time stepping where contact changes"] == "-1 N m (-1 % of the drive's work)"
    for name, last in {"work_input": 100.0, "work_output": 96.0}.items():
        dataset[name] = ("time", np.linspace(0.0, 1e3 * last, dataset.sizes["time"]), {"units": "N mm"})
    assert rows()["work of the drive, the pinion's shaft"] == "100 N m"
