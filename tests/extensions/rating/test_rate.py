"""`gears rate`: the standard's numbers beside the run's."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from tests.coarse import COARSE, coarse_scene
from tests.elastic_shaft_scenes import ELASTIC
from tests.hard_cases.invariants import finished_helical_run
from tests.helical import CROWNED, helical_scene
from tests.planets import planetary_text

from fenics_gears import results, simulate
from fenics_gears.commands.cli import main
from fenics_gears.extensions.rating.finish import Finish
from fenics_gears.extensions.rating.load_factors import iterated_face_factor
from fenics_gears.extensions.rating.rating import _operation, of_place


@pytest.fixture(scope="module")
def run(tmp_path_factory, paper_scene):
    directory = tmp_path_factory.mktemp("run")
    results.save(simulate(coarse_scene(paper_scene, cycles=2)), directory / "run.nc")
    return directory


def test_rows_have_both_columns(run, capsys):
    """Formula and run agree within 15 % on teeth as the standard has them; safety is limit over stress."""
    assert COARSE and main(["rate", str(run), "--flank-limit", "1300 MPa"]) == 0
    assert "sigma_H, contact stress of the pinion, MPa" in capsys.readouterr().out
    with open(run / "rating.csv") as file:
        rows = {row["quantity"]: row for row in csv.DictReader(file)}
    stress, safety = rows["sigma_H, contact stress of the pinion"], rows["S_H, safety against pitting of the pinion"]
    assert float(stress["this run"]) == pytest.approx(float(stress["ISO 6336"]), rel=0.15)
    limits = [float(stress[column]) * float(safety[column]) for column in ("ISO 6336", "this run")]
    assert limits[0] == pytest.approx(limits[1], rel=1e-6) and limits[0] == pytest.approx(1300.0, rel=0.15)
    assert rows["K_Hbeta, face load factor"]["this run"] == "" and float(rows["flash temperature"]["this run"]) > 0.0


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--flank-limit", "3 mm"], '--flank-limit "3 mm": allowed is a stress from 100 MPa to 3000 MPa'),
        (["--root-limit", "1 MPa"], "allowed is a stress from 20 MPa"),
        (["--tolerance-class", "5.5"], "allowed is a whole number from 1 to 11"),
        (["--viscosity-grade", "1"], "allowed is from 10 to 1500"),
        (["-o", "table.xlsx"], "a .csv file"),
    ],
)
def test_wrong_calls_are_refused(run, capsys, options, said):
    """Exit code 2, what is allowed."""
    assert main(["rate", str(run), *options]) == 2
    assert said in capsys.readouterr().err


def test_a_run_without_speed_is_refused(tmp_path, capsys, paper_scene):
    """K_v needs a speed."""
    from tests.coarse import teeth_alone

    scene = teeth_alone(coarse_scene(paper_scene, cycles=1))
    text = "\n".join(line for line in scene.text.splitlines() if "mesh_frequency" not in line)
    result = simulate(scene)
    result.attrs["scene"] = text.split("[shafts]")[0]
    results.save(result, tmp_path / "run.nc")
    assert main(["rate", str(tmp_path)]) == 2
    assert "a rating needs a speed" in capsys.readouterr().err


def test_misalignment_over_the_face_is_counted_and_told(tmp_path, capsys):
    """Definition: F_betax is the scene's misalignment less the helix slope that corrects it, or that of the
    tolerance class. A contact stress beside the end of lines of contact is told too."""
    result = finished_helical_run().result
    # By hand, ISO 1328-1: slopes of 8.61 and 8.82 um.
    for more, standard, computed, said in (
        (
            '[misalignment]\nin_plane = "12 um"\n[lead_modifications.pinion]\nhelix_slope = "-5 um"\n',
            7.0,
            7.0,
            "is of the scene's misalignment and helix slopes",
        ),
        (CROWNED, 12.33, 0.0, "is of helix slopes of tolerance class 6 (method C), which this run has not"),
    ):
        results.save(result.assign_attrs(scene=helical_scene(more).text), tmp_path / "run.nc")
        assert main(["rate", str(tmp_path)]) == 0
        assert said in capsys.readouterr().out
        with open(tmp_path / "rating.csv") as file:
            row = next(row for row in csv.DictReader(file) if row["quantity"].startswith("F_betax"))
        assert (float(row["ISO 6336"]), float(row["this run"])) == pytest.approx((standard, computed), abs=0.01)
    beside = {"scene": helical_scene(CROWNED).text, "peak_contact_pressure_beside": "end"}
    results.save(result.assign_attrs(beside), tmp_path / "run.nc")
    assert main(["rate", str(tmp_path)]) == 0
    assert "sigma_H of this run is near the end of the pinion's active profile" in capsys.readouterr().out


def test_the_inclination_of_shafts_that_bend_is_counted(tmp_path, capsys):
    """Definition: F_betax is the run's inclination of the axes. Limit: a straight gap has a foundation's closed
    form, 1 + c b f / 2 F."""
    more = ELASTIC + '[misalignment]\nin_plane = "4 um"\n'
    found = finished_helical_run(more, helix=0.0)
    model, result = found.model, found.result
    results.save(result, tmp_path / "run.nc")
    assert main(["rate", str(tmp_path)]) == 0
    assert "is of the axes' inclination in this run" in capsys.readouterr().out
    with open(tmp_path / "rating.csv") as file:
        rows = {row["quantity"]: row for row in csv.DictReader(file)}
    misaligned = abs(result.attrs["mean_axis_inclination_in_plane"] + 4.0)
    assert float(rows["F_betax, misalignment over the face"]["ISO 6336"]) == pytest.approx(misaligned, rel=1e-6)
    assert float(rows["K_Hbeta, line load iterated over the shafts"]["ISO 6336"]) > 1.0
    # A foundation under rigid shafts, misaligned.
    operation = _operation(model.scene, Finish(), result)
    slices, force = len(operation.opening), operation.base_force
    gap = 5e-3 * (np.arange(slices) + 0.5) / slices
    straight = replace(operation, shafts=np.zeros((slices, slices)), opening=gap)
    stiffness = 1e3 * 0.85 * operation.mesh_stiffness * operation.face_width
    wanted = 1.0 + stiffness * 5e-3 * (1.0 - 1.0 / slices) / 2.0 / force
    assert iterated_face_factor(straight, 1.0) == pytest.approx(wanted, rel=1e-9)


def test_a_planetary_set_is_rated_by_its_sun(tmp_path, capsys):
    """ISO 6336-1: forces are K_gamma times the nominal ones, stresses of flanks its root, of the planet that carries
    most; teeth of planets are bent both ways. With other errors of its pins nothing else of the standard changes."""
    of_runs = []
    for errors in ('["0 um", "0 um", "0 um"]', '["0 um", "40 um", "0 um"]'):
        pins = f'carrier = {{ pin_stiffness = "3e5 N/mm", pin_errors = {errors} }}'
        text = planetary_text((18, 18, 54), "planets = 3", more=pins, sections='[motion]\ninput_speed = "500 rpm"')
        scene = tmp_path / "set.toml"
        scene.write_text(text, encoding="utf-8")
        assert main(["run", str(scene), "--output", str(tmp_path / "run"), "--quiet", "--no-pictures"]) == 0
        assert main(["rate", str(tmp_path / "run")]) == 0
        said = capsys.readouterr().out
        sharing = float(said.split("K_gamma of this run, ")[1].split(",")[0])
        stress = float(said.split("sigma_H, contact stress of the pinion, MPa")[1].split()[0])
        dynamic = [float(said.split(f"{name} factor")[1].split()[0]) for name in ("K_v, dynamic", "K_Hbeta, face load")]
        of_runs.append((sharing, stress / np.prod(dynamic) ** 0.5))
        assert "idlers" in said
    assert "Mesh set: sun, planet 2" in said
    (even, alone), (uneven, raised) = of_runs
    assert even == pytest.approx(1.0, rel=1e-3)
    assert uneven > 1.1
    assert raised / alone == pytest.approx(uneven**0.5, rel=2e-3)


def test_a_scene_is_no_run(tmp_path, capsys):
    """Exit code 2, and what to do."""
    scene = tmp_path / "mine.toml"
    scene.write_text(helical_scene().text)
    assert main(["rate", str(scene)]) == 2
    assert f"is a scene, this command takes a run: `gears run {scene}`" in capsys.readouterr().err


@pytest.mark.parametrize("place", ["pitch_point", "hpstc", "path_start", "path_end"])
def test_a_pressure_where_the_standard_does_not_look_has_a_remark(paper_pair, place):
    """ISO 6336-2 has sigma_H at the pitch point and, by Z_B and Z_D, at the inner points of single tooth contact."""
    roll = paper_pair.pinion_roll_angle(getattr(paper_pair, place))
    said = of_place({"peak_contact_pressure_diameter": 2.0 * float(paper_pair.pinion.radius(roll))}, paper_pair)
    assert bool(said) == place.startswith("path")
    if said:
        words = "0.00 mm after the start" if place == "path_start" else "0.00 mm before the end"
        assert words in said and "ISO 6336-2 has it at the pitch point" in said
