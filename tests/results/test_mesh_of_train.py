"""A mesh of a train's result as that of its pair; what all meshes add up to."""

import csv
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from tests.trains import COARSE, row, stage, two_stages

from fenics_gears import (
    HARMONIC_NAMES,
    MICROMETRE,
    SceneError,
    cycles_of_meshes,
    load,
    mesh_run,
    simulate_train,
    train_from_text,
)  # fmt: skip
from fenics_gears.results.curves_table import save_curves
from fenics_gears.results.files import save
from fenics_gears.results.layout import mistake_in
from fenics_gears.results.overall_orders import overall_orders

FRICTION = "[friction]\ncoefficient = 0.08\n"
# Of the whole train, or of the march.
NOT_OF_A_MESH = ("energy", "work_", "time_", "steps_by", "title")


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A train of two stages with friction, its result read from a file, and the results of its stages as pairs."""
    train = two_stages(more=FRICTION)
    pairs = []
    found = simulate_train(train, keep=lambda mesh, dataset: pairs.append(dataset))
    file = tmp_path_factory.mktemp("train") / "run.nc"
    save(found, file)
    return train, load(file), pairs


def test_a_stage_has_all_that_its_pair_has(run):
    """Bit for bit, labels and numbers too: what is drawn, rated and listened to is the pair's."""
    train, found, pairs = run
    for number, pair in enumerate(pairs):
        own = mesh_run(found, train, number)
        assert not mistake_in(own)
        for name, variable in pair.variables.items():
            if not str(name).startswith(NOT_OF_A_MESH):
                assert own[name].variable.identical(variable), name
        for name, value in pair.attrs.items():
            if not name.startswith(NOT_OF_A_MESH):
                assert own.attrs[name] == value, name


def test_orders_are_harmonics_of_the_pairs_through_the_ratios(run):
    """A stage's harmonics, as its pair tells them on the wheel's base circle, turned into the angle of the last shaft;
    order 20 of the first shaft is the first mesh, whose shaft has 20 teeth."""
    train, found, pairs = run
    orders = {(each.meshes, each.harmonic): each for each in overall_orders(found, train)}
    ratio = 1.0
    for mesh, pair in reversed(list(zip(train.meshes, pairs))):
        for harmonic, name in enumerate(HARMONIC_NAMES, 1):
            expected = ratio * pair.attrs[name] * MICROMETRE / mesh.pair.wheel.base_radius
            assert orders[mesh.name, harmonic].amplitude == pytest.approx(expected, rel=1e-9, abs=1e-16)
        ratio *= mesh.pair.rotation_ratio
    assert orders["first", 1].order == pytest.approx(20.0)
    assert orders["second", 2].order == pytest.approx(2 * 20 * 20 / 30)


def test_meshes_of_an_idler_add_up_with_their_phases():
    """The overall error of a row repeats with the one mesh cycle that all its meshes have: its own harmonics."""
    train = row((20, 24, 30), (0, 75), 100.0)
    found = simulate_train(train)
    curve = found["overall_transmission_error"].values[:-1]
    expected = np.abs(np.fft.rfft(curve))[1:6] * 2.0 / len(curve)
    orders = overall_orders(found, train)
    assert [each.amplitude for each in orders[:5]] == pytest.approx(expected, rel=1e-9)
    assert {each.meshes for each in orders} == {"row: gears 1 and 2, row: gears 2 and 3"}
    whole = sum(each.values for each in cycles_of_meshes(found, train))
    assert np.allclose(whole, curve, rtol=1e-12)


def test_the_table_has_a_column_for_each_mesh(run, tmp_path):
    """To the digits that are written; below the last step of a mesh cells are empty."""
    _, found, pairs = run
    save_curves(found, tmp_path / "curves.csv")
    with open(tmp_path / "curves.csv", newline="") as file:
        table = list(csv.DictReader(file))
    overall = [float(line["overall_transmission_error [rad]"]) for line in table if line["time [s]"]]
    assert overall == pytest.approx(found["overall_transmission_error"].values, rel=1e-11)
    for name, pair in zip(("first", "second"), pairs):
        written = [line[f"transmission_error {name} [rad]"] for line in table]
        steps = pair.sizes["time"]
        assert [float(each) for each in written[:steps]] == pytest.approx(pair["transmission_error"].values, rel=1e-11)
        assert not any(written[steps:])
        assert f"rotation {name} wheel [rad]" in table[0]


@pytest.mark.nightly
def test_a_stage_in_the_plane_beside_one_over_the_face():
    """Line loads and the face load factor are of the helical stage alone."""
    helical = stage("one", 3.0, (20, 30), 'helix_angle = "15 deg"\n[stages.one.accuracy]\nslices = 6\nlayers = 4')
    train = train_from_text(
        f"{helical}{stage('two', 3.0, (20, 40))}\n[load]\noutput_torque = '400 N m'\n[accuracy]\n{COARSE}"
    )
    pairs = []
    found = simulate_train(train, keep=lambda mesh, dataset: pairs.append(dataset))
    over_face, plane = (mesh_run(found, train, number) for number in (0, 1))
    assert over_face["line_load"].identical(pairs[0]["line_load"])
    assert "line_load" not in plane and "face_load_factor" not in plane.attrs
    assert plane["contact_pressure"].identical(pairs[1]["contact_pressure"])


def test_orders_of_stages_that_move_together():
    """A lag that is put together of known harmonics of both meshes, over cycles that are whole of the slower mesh
    alone, is taken apart into them; over one cycle, in which their orders are half a cycle apart, it is not, and the
    cycles that are asked for are enough."""
    more = """
        [shafts.one]
        carries = ["first.wheel", "second.pinion"]
        torsional_stiffness = "1e8 N mm/rad"
        """
    one_cycle = two_stages(more=more)
    train = replace(one_cycle, recorded_cycles=3)
    steps = np.array([80, 120])
    times = np.arange(361) / (80 * train.meshes[0].scene.motion.mesh_frequency)
    frequencies = [mesh.scene.motion.mesh_frequency for mesh in train.meshes]
    parts = [(0, 1, 3e-5), (0, 4, 1e-6), (1, 1, 2e-5), (1, 2, 5e-6)]
    lag = 1e-3 + sum(size * np.cos(2.0 * np.pi * n * frequencies[mesh] * times + n) for mesh, n, size in parts)
    result = xr.Dataset(
        {"overall_transmission_error": ("time", lag), "steps_per_mesh_cycle": ("mesh", steps)}, {"time": times}
    )
    found = {(each.place, each.harmonic): each.amplitude for each in overall_orders(result, train)}
    for mesh, n, size in parts:
        assert found.pop((mesh, n)) == pytest.approx(size, rel=1e-9)
    assert max(found.values()) < 1e-9 * 3e-5
    with pytest.raises(SceneError, match=r"too few to tell order .* there are none\. Allowed: 2 or more"):
        overall_orders(result, one_cycle)
    enough = overall_orders(result, replace(one_cycle, recorded_cycles=2))
    assert enough[0].amplitude == pytest.approx(2e-5, rel=1e-9)
