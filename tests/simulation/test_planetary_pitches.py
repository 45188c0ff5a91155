"""Pitch errors of a planetary set: which tooth meets which, and what follows from symmetry."""

from math import atan, pi, tan

import numpy as np
import pytest
from tests.planets import planetary, planetary_text

from fenics_gears import carried_train, simulate_train
from fenics_gears.commands.cli import main
from fenics_gears.contact.flank_gaps import FlankGaps
from fenics_gears.errors import SceneError
from fenics_gears.model.train import train_model_of
from fenics_gears.show.planetary import shares
from fenics_gears.simulation.elastic_route import deviations_of
from fenics_gears.simulation.train import cycle_of_row
from fenics_gears.system.progress import SilentProgress

TEETH = (17, 19, 55)
STEPS = 12


def late(teeth: int, tooth: int, gears: int = 1, gear: int = 0) -> list[str]:
    """Pitches that leave one tooth of one of several gears 8 um late."""
    pitches = np.zeros((gears, teeth))
    pitches[gear, tooth] = 8
    pitches[gear, (tooth + 1) % teeth] = -8
    return [f"{each:g} um" for each in pitches.ravel()]


def run(member: str, pitches: list[str], cycles: int):
    more = f"pitch_errors.{member} = {pitches}"
    motion = f"[motion]\nmesh_cycles = {cycles}"
    return simulate_train(planetary(teeth=TEETH, planets="planets = 3", more=more, sections=motion))


@pytest.mark.parametrize(("member", "number", "sense"), [("sun", 0, 1), ("ring", 2, -1)])
def test_a_late_tooth_comes_to_one_planet_after_the_other(member, number, sense):
    """Symmetry: as the sun has turned by a third against the carrier, what planet 1 carried is on planet 2; the ring
    turns the other way."""
    teeth = TEETH[number]
    found = run(member, late(teeth, 5), teeth // 3 + 16)
    meshes = found["normal_force"].values
    ahead = teeth * STEPS // 3
    for first in range(2):
        kind = meshes[:, first::2]
        np.testing.assert_allclose(kind[ahead:], np.roll(kind[:-ahead], sense, axis=1), rtol=1e-8)
    true = simulate_train(planetary(teeth=TEETH, planets="planets = 3"))["normal_force"].values
    changed = np.abs(meshes[:: STEPS // 2] - true[:: STEPS // 2][np.arange(len(meshes[:: STEPS // 2])) % 2]).max(axis=1)
    # Between two planets the tooth touches nothing.
    assert changed.min() < 1e-6 < 100.0 < changed.max()
    # Cycles differ, and the picture has the one of the largest share.
    (with_sun, *_) = shares(carried_train(found), found)
    assert max(curve.y.max() for curve in with_sun.curves) == pytest.approx(found.attrs["load_sharing_factor"])


def indices(row, mesh: int, side: int) -> np.ndarray:
    """Cumulative pitch errors (z,), mm, of a gear as a mesh of a row counts its teeth."""
    (errors,) = (each for each in deviations_of(row.models[mesh]) if isinstance(each, FlankGaps))
    return errors._amounts[side][:, 0]


def centrelines(row, cycle, mesh: int, side: int) -> dict[int, float]:
    """By the number of a tooth of an external gear, as a mesh has its pitches, the angle (rad) of its centreline as the
    run begins: the point of contact is on the flank, half the tooth's thickness there from the centreline."""
    listed = indices(row, mesh, side)
    position, _ = cycle.position(0).of_meshes[mesh]
    pair = row.meshes[mesh].pair
    gear = pair.gears[side]
    sense = pair.sides[side].sense
    along, off = row.layout.axes(mesh)
    alpha = pi / 9.0
    found = {}
    for each in position.operator.pairs:
        roll = each.place.contact_rolls[side]
        point = sense * (roll * along - off)
        half = (0.5 * pi + 2.0 * gear.profile_shift * tan(alpha)) / gear.teeth + tan(alpha) - alpha - roll + atan(roll)
        turned = row.layout.graph.sense(mesh) * half
        tooth = -each.place.index % gear.teeth
        found[float(listed[tooth])] = np.arctan2(point[1], point[0]) - turned
    return found


def test_a_tooth_is_the_same_in_all_meshes_of_its_gear():
    """Brute force: where an involute tooth stands that touches there; each tooth has an error of its own."""
    pitches = {
        name: [f"{each!r} um" for each in np.tile(each - np.mean(each), gears).tolist()]
        for name, teeth, gears in (("sun", 17, 1), ("planets", 19, 3))
        for each in [np.arange(teeth) ** 2 % 23 + np.arange(teeth) / 7.0]
    }
    more = "\n".join(f"pitch_errors.{name} = {listed}" for name, listed in pitches.items())
    (row,) = train_model_of(planetary(teeth=TEETH, planets="planets = 3", more=more)).rows
    cycle = cycle_of_row(row, SilentProgress())
    compared = 0
    for gear in (gear for gear in row.graph.shared if not row.gear(gear).internal):
        sides = row.graph.sides[gear]
        pitch = row.gear(gear).angular_pitch
        known = [centrelines(row, cycle, *each) for each in sides]
        listed = indices(row, *sides[0])
        for own in known:
            for error, angle in own.items():
                number = int(np.argmin(np.abs(listed - error)))
                first = int(np.argmin(np.abs(listed - next(iter(known[0])))))
                turned = (angle - next(iter(known[0].values()))) / pitch
                onwards = -row.graph.sense(sides[0][0]) * (1 if sides[0][1] == 0 else -1)
                apart = turned * onwards - (number - first)
                assert abs((apart + 0.5 * len(listed)) % len(listed) - 0.5 * len(listed)) < 1e-6
                compared += 1
    assert compared > 20


def test_what_does_not_fit_is_told():
    """Bad input: too few entries, pitches that do not close around a gear, errors of a pair."""
    cumulative = ["1 um"] * 36
    for more, said in (
        ('pitch_errors.sun = ["1 um"]', r"has 1 entries for 1 x 17 teeth"),
        (f"pitch_errors.planets = {cumulative}", r"sums to 18 um over the whole turn"),
        ("flank_errors = { tolerance_class = 6 }", r"Allowed: pitch_errors"),
    ):
        with pytest.raises(SceneError, match=said):
            planetary(more=more)


def test_the_check_tells_them(tmp_path, monkeypatch, capsys):
    """By hand: one tooth is 8 um late."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "set.toml").write_text(planetary_text(more=f"pitch_errors.planets = {late(18, 4, 2, 1)}"))
    assert main(["check", "set.toml"]) == 0
    assert "8 um at most, 8 um in all around the gear" in capsys.readouterr().out
