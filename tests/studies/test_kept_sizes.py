"""What a study over the gears keeps is said."""

import pytest
from tests.studies.conftest import write_study

from fenics_gears.commands.cli import main
from fenics_gears.scene.data import Derived
from fenics_gears.studies.axis import Axis
from fenics_gears.studies.kept_sizes import kept_sizes


def axis(dotted):
    """A swept field."""
    return Axis(tuple(dotted.split(".")), (1, 2), dotted)


@pytest.mark.parametrize(
    ("swept", "kept"),
    [
        (
            ["gears.pinion.profile_shift"],
            ["gears.pinion.tip_diameter, gears.pinion.root_diameter and gears.centre_distance are kept"],
        ),
        (
            ["gears.wheel.profile_shift", "gears.wheel.tip_diameter", "gears.wheel.root_diameter"],
            ["gears.centre_distance is kept"],
        ),
        (
            ["gears.wheel.teeth", "gears.wheel.tip_diameter", "gears.wheel.root_diameter", "gears.centre_distance"],
            ["gears.pinion.profile_shift, gears.wheel.profile_shift and gears.pinion.tip_diameter are"],
        ),
        (
            ["gears.helix_angle", "gears.centre_distance"],
            [
                "gears.pinion.profile_shift",
                (
                    "gears.pinion.tip_diameter, gears.wheel.tip_diameter, gears.pinion.root_diameter and"
                    " gears.wheel.root_diameter are"
                ),
            ],
        ),
        (["gears.pressure_angle"], ["gears.centre_distance is kept"]),
        (["gears.face_width", "gears.pinion.bore_diameter", "motion.mesh_frequency", "friction.coefficient"], []),
    ],
)
def test_what_is_kept_is_named(swept, kept):
    """ISO 21771: tip and root diameter follow from module, teeth and profile shift, the centre distance without
    backlash from both shifts;
    what is swept along is not kept, and what no other size follows from needs no word."""
    said = kept_sizes([axis(each) for each in swept])
    assert len(said) == len(kept)
    assert all(words in sentence for words, sentence in zip(kept, said))


def test_what_the_scenes_derive_is_not_kept():
    """Authority: as above; a scene without diameters has those that follow from the swept size."""
    left_out = [Derived(name, 1.0, "mm", "") for name in ("pinion tip diameter", "centre distance")]
    (said,) = kept_sizes([axis("gears.pinion.profile_shift")], left_out)
    assert "gears.pinion.root_diameter is kept" in said
    assert (
        kept_sizes([axis("gears.pinion.profile_shift")], [*left_out, Derived("pinion root diameter", 1.0, "mm", "")])
        == []
    )


def test_a_study_says_it_in_summary_and_dataset_and_gives_transmission_errors_as_lengths_first(folder, undrawn, capsys):
    """The interface. Unit conversion: a length at the wheel's base circle is the angle times its radius."""
    import xarray

    sweep = '[sweep]\ngears.pinion.profile_shift = [0.19, 0.196]\nload.wheel_torque = ["100 N m", "400 N m"]'
    study = write_study(folder, 'combine = "zip"\n' + sweep)
    assert main(["study", str(study), "--output", "here"]) == 0
    printed = capsys.readouterr().out
    words = (
        "gears.pinion.profile_shift is swept and gears.pinion.tip_diameter, gears.pinion.root_diameter and"
        " gears.centre_distance are kept"
    )
    assert words in printed
    (line,) = [each for each in printed.splitlines() if "transmission error, peak to peak" in each]
    said = line.partition("peak to peak")[2].split()
    with xarray.open_dataset("here/study.nc", engine="h5netcdf") as opened:
        assert opened.attrs["remarks"].startswith(words)
        angles = opened.peak_to_peak_transmission_error.values
    with xarray.open_dataset(next((folder / "here" / "cases").glob("*.nc")), engine="h5netcdf") as case:
        lengths = angles * case.attrs["base_radius_wheel"] * 1e3
    numbers = [f"{each:.4g}" for each in (lengths.min(), lengths.max(), angles.min(), angles.max())]
    assert said == [numbers[0], "to", numbers[1], "um", "=", numbers[2], "to", numbers[3], "rad"]
