"""Reports on runs and studies of trains."""

import base64
import re
from pathlib import Path

import pytest
from tests.extensions.live.conftest import SET
from tests.extensions.report.pages import seen
from tests.planets import in_time, planetary_text
from tests.trains import bent_two_stages, gearbox_file, row, split_text

from fenics_gears import load, results
from fenics_gears.commands.cli import main
from fenics_gears.commands.work import picture
from fenics_gears.extensions.report.train_page import _conditions
from fenics_gears.show import stress_drawn

pytestmark = pytest.mark.usefixtures("without_stills")


def page_of(scene, folder):
    """The folder of a scene's run, and its page."""
    out = folder / "out"
    assert main(["run", str(scene), "-o", str(out), "-q", "--no-pictures"]) == 0
    assert main(["report", str(out), "-q", "--no-stress"]) == 0
    return out, (out / "report.html").read_text(encoding="utf-8")


def test_paths_that_close_tell_their_shares(tmp_path):
    """Those of the result."""
    scene = tmp_path / "split.toml"
    scene.write_text(split_text(of_shaft='clocking = "2 mrad"\ntorsional_stiffness = "1e8 N mm/rad"'))
    out, page = page_of(scene, tmp_path)
    assert f"{100.0 * load(out / 'run.nc')['mean_path_share'].values[1]:#.4g}" in page


def test_each_mesh_has_a_section(tmp_path):
    """And the whole its power flow and orders."""
    scene = gearbox_file(tmp_path)
    scene.write_text(scene.read_text() + '[motion]\ninput_speed = "3000 rpm"\n')
    _, page = page_of(scene, tmp_path)
    for heading in ("Power flow", "Orders of the overall transmission error", "Mesh: first", "Mesh: second"):
        assert heading in page


def test_errors_of_a_ring_are_lengths_and_orders_name_the_set(tmp_path):
    """The base circle of a ring has a radius, though its sign in the equations is negative; its meshes have one mesh
    frequency, whose harmonics beside those of the period of all planets are round-off."""
    scene = tmp_path / "set.toml"
    scene.write_text(SET)
    page_of(scene, tmp_path)
    shown = seen(tmp_path / "out" / "report.html").sections
    lengths = re.findall(r"transmission error, (?:peak to peak|mean)\s*(\S+) µm = (\S+) rad", shown["mesh-2"])
    assert len(lengths) == 2 and all(float(each) > 0.0 for pair in lengths for each in pair)
    assert "set: sun and planets, set: planets and ring" in shown["orders"]
    assert not re.search(r"e-\d\d", shown["orders"])


def test_stages_that_move_together_have_natural_frequencies(tmp_path):
    """What `gears check` tells of them."""
    scene = gearbox_file(tmp_path)
    more = '[motion]\ninput_speed = "900 rpm"\nmesh_cycles = 2\n[inertia]\ndensity = "7.85 g/cm^3"\n'
    scene.write_text(scene.read_text() + more)
    _, page = page_of(scene, tmp_path)
    assert "with inertia" in page
    assert "Natural frequencies" in page


def test_a_set_with_masses_is_not_called_quasi_static():
    """What its scene says."""
    said = _conditions(in_time(1500, 2, sections='[speed_ramp]\nend_speed = "3000 rpm"'))
    assert said == "600 N m on the input, 1500 to 3000 rpm, 6 meshes, with inertia, numbers of the last 2 cycles"
    assert _conditions(in_time(1500, 2, inertia="")).endswith("quasi-static")


def test_bearings_of_shafts_that_bend_are_listed(tmp_path):
    """All of them, with the places of the gears."""
    scene = tmp_path / "bent.toml"
    scene.write_text(bent_two_stages().text)
    _, page = page_of(scene, tmp_path)
    assert "Shaft middle: first.wheel at 35 mm, second.pinion at 100 mm" in page
    assert "middle 1" in page
    assert "middle 2" in page
    assert not re.search(r"e-\d\d", seen(tmp_path / "out" / "report.html").sections["shafts"])


def pictures_of(page) -> list[bytes]:
    """The PNG pictures in the sections of a page on stresses and effects, in their order."""
    shown = (tag["src"] for name, tag in page.tags if name == "img")
    return [base64.b64decode(each.split(",")[1]) for each in shown if each.startswith("data:image/png")]


@pytest.fixture
def numbers_in_pictures(request, monkeypatch):
    """By day pictures of stress hold their numbers alone."""

    def written(mesh, place):
        numbers = b"".join(body.von_mises.tobytes() for body in mesh.gears)
        (place.write_bytes if isinstance(place, Path) else place.write)(numbers)

    if request.config.option.markexpr != "nightly":
        for module in (picture, stress_drawn):
            monkeypatch.setattr(module, "still", lambda mesh, dataset, scale=None: mesh)
            monkeypatch.setattr(module, "save_picture", written)


def test_stresses_of_all_meshes_are_those_of_gears_picture(tmp_path, capsys, numbers_in_pictures):
    """The same pictures at the same time, of a stage by itself and of meshes that an idler couples. A time that no
    mesh has is refused before anything is measured."""
    relief = '[stages.row.tip_relief]\ndepth = "10 um"\nstart = "HPSTC"\n'
    scene = tmp_path / "idler.toml"
    scene.write_text(row((24, 24, 24), (0, 0), 400.0).text.replace('"0.1 mm"', '"0.4 mm"') + relief)
    for train in (scene, gearbox_file(tmp_path)):
        out = tmp_path / train.stem
        assert main(["run", str(train), "-o", str(out), "-q", "--no-pictures"]) == 0
        assert main(["picture", str(out), "--at", "0.3", "-q"]) == 0
        drawn = [each.read_bytes() for each in sorted(out.glob("*/stress.png"))]
        assert main(["report", str(out), "--at", "0.3", "-q"]) == 0
        page = seen(out / "report.html")
        assert len(drawn) == 2 and pictures_of(page) == drawn
        assert all("as asked for" in page.sections[f"stress-{number}"] for number in (1, 2))
    assert drawn[0] != drawn[1]
    assert main(["report", str(out), "--no-stress", "-q"]) == 0
    page = seen(out / "report.html")
    assert not pictures_of(page) and "option --no-stress" in page.sections["stress"]
    capsys.readouterr()
    assert main(["report", str(out), "--at", "7", "--effects"]) == 2
    assert "has stored mesh cycles 0 to 1" in capsys.readouterr().err
    assert not list(out.glob("**/effects.csv"))


def test_effects_of_meshes_that_are_computed_together(tmp_path):
    """Measured when asked for, shown again without, and not beside another run: one of another load."""
    text = row((24, 24, 24), (0, 0), 400.0).text.replace('"0.1 mm"', '"0.4 mm"')
    scene = tmp_path / "idler.toml"
    scene.write_text(text + "[friction]\ncoefficient = 0.1\n")
    out = tmp_path / "out"
    assert main(["run", str(scene), "-o", str(out), "-q", "--no-pictures"]) == 0
    for option in ("--effects", "--quiet"):
        assert main(["report", str(out), "--no-stress", "-q", option]) == 0
        page = seen(out / "report.html")
        assert pictures_of(page) == [(out / "effects.png").read_bytes()]
        assert "row: gears 1 and 2; row: gears 2 and 3" in page.sections["effects"]
        assert "Coulomb friction" in page.sections["effects"]
    results.save(load(out / "run.nc").assign_attrs(mean_overall_transmission_error=1e-3), out / "run.nc")
    assert main(["report", str(out), "--no-stress", "-q"]) == 0
    page = seen(out / "report.html")
    assert not pictures_of(page) and "was measured on another scene" in page.sections["effects"]


@pytest.mark.nightly
def test_effects_of_stages_by_themselves(tmp_path):
    """Each in its folder, as `gears effects` has them; shown where the whole is, and where the stage is."""
    scene = gearbox_file(tmp_path)
    out = tmp_path / "out"
    assert main(["run", str(scene), "-o", str(out), "-q", "--no-pictures"]) == 0
    assert main(["report", str(out), "--no-stress", "-q", "--effects"]) == 0
    measured = [(out / name / "effects.png").read_bytes() for name in ("first", "second")]
    assert pictures_of(seen(out / "report.html")) == measured
    assert main(["report", str(out / "first"), "--no-stress", "-q"]) == 0
    assert pictures_of(seen(out / "first" / "report.html")) == measured[:1]


@pytest.mark.nightly
def test_a_study_has_one_page(tmp_path, monkeypatch):
    """With the cases of a train."""
    monkeypatch.chdir(tmp_path)
    gearbox_file(tmp_path)
    (tmp_path / "study.toml").write_text(
        'scene = "gearbox.toml"\n[sweep]\nload.output_torque = ["300 N m", "400 N m"]\n'
    )
    assert main(["study", "study.toml", "--quiet", "-o", "out"]) == 0
    assert main(["report", "out", "-q"]) == 0
    assert "Gear train: report on a study" in (tmp_path / "out" / "report.html").read_text()


def test_a_study_that_keeps_numbers_alone_has_its_page(tmp_path, monkeypatch):
    """Of its cases the numbers are there, no runs; random fields are one dimension."""
    monkeypatch.chdir(tmp_path)
    coarse = 'steps_per_mesh_cycle = 4\nflank_element_size = "0.5 mm"\ncontact_length = "3 mm"'
    more = 'carrier = { pin_stiffness = "3e5 N/mm" }'
    text = planetary_text(teeth=(20, 16, 52), planets="planets = 4", more=more, accuracy=coarse)
    (tmp_path / "set.toml").write_text(text)
    pins = '{ distribution = "normal", mean = "0 um", deviation = "10 um", count = 3, seed = 1, entries = 4 }'
    swept = f'stages.set.carrier.pin_errors = {pins}\nload.input_torque = ["500 N m", "600 N m"]\n'
    (tmp_path / "few.toml").write_text(f'keep = "numbers"\nscene = "set.toml"\n[sweep]\n{swept}')
    assert main(["study", "few.toml", "-q"]) == 0
    assert main(["report", str(tmp_path / "results" / "few"), "-q"]) == 0
    page = (tmp_path / "results" / "few" / "report.html").read_text(encoding="utf-8")
    assert "K_gamma of the sun" in page
    assert "6 cases over input torque (2 values), 3 samples of 1 random field" in page
