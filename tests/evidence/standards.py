"""ISO 6336: stiffness, stresses, load factors."""

from dataclasses import replace
from math import cos, radians

from tests.benchmarks.third_dimension import cited
from tests.benchmarks.third_dimension.__main__ import main as third_dimension
from tests.benchmarks.third_dimension.table import read_rows
from tests.corner_contact_reference.reference import paper_pair
from tests.evidence.claim import STANDARDS, Claim, Numbers, Part, within
from tests.extensions.rating.test_iso_6336 import operation
from tests.iso_tooth_root import nominal_root_stress, standard_gear
from tests.simulation.test_iso_6336 import standard_pair, stiffness_of
from tests.simulation.test_run_stresses import highest_single_contact, stresses_of_a_narrow_load

from fenics_gears import gear_pair, load_scene, mesh_factor, single_stiffness
from fenics_gears.elasticity.fillet_points import POINTS
from fenics_gears.extensions.rating.finish import Finish
from fenics_gears.extensions.rating.flank import flank_stress, zone_factor
from fenics_gears.extensions.rating.load_factors import LoadFactors, load_factors
from fenics_gears.scene.data import Motion

TEETH = ((24, 72), (40, 40))


def stiffness(_: str) -> Numbers:
    """N/(mm µm) of two standard pairs; the standard's theoretical values."""
    scene, _pair = paper_pair()
    still, found = replace(scene, inertia=None, damping=None, motion=Motion(200.0, 1, 1)), {}
    for teeth in TEETH:
        gears = standard_pair(*teeth)
        theoretical, factor = single_stiffness(gears)[0], mesh_factor(gear_pair(gears).contact_ratio)
        single, of_mesh = stiffness_of(teeth, still)
        name = "{}/{}".format(*teeth)
        found |= {f"{name} single": (theoretical, single), f"{name} mesh": (theoretical * factor, of_mesh)}
    return found


def roots(_: str) -> Numbers:
    """MPa under 1 N/mm."""
    found = {}
    for teeth in (20, 100):
        gear = standard_gear(teeth)
        roll = highest_single_contact(gear)
        found[str(teeth)] = (
            nominal_root_stress(gear, roll, 1.0),
            float(stresses_of_a_narrow_load(gear, roll)[:POINTS].max()),
        )
    return found


def example(_: str) -> Numbers:
    scene = load_scene(cited.CITED / "iso_tr_6336_30.toml")
    finish = Finish(viscosity_grade=320.0, flank_roughness=6.0, tolerance_class=5)
    found = replace(operation(scene.gears, 9e6, 360.0, 70.0), finish=finish)
    flank = flank_stress(found, LoadFactors(1.003, 1.16, 1.128, 1.0, 1.0))
    theoretical, single = single_stiffness(scene.gears)
    return {
        "zone": (2.39533, zone_factor(found)),
        "nominal": (1206.58207, flank.nominal),
        "dynamic": (1.003, load_factors(found).dynamic),
        "theoretical": (17.85584, theoretical),
        "single": (12.37047, single),
        "mesh": (17.46485, single * mesh_factor(found.pair.contact_ratio)),
    }


def face() -> Numbers:
    at_20 = next(row for row in read_rows("tooth_stiffness") if row["helix_angle"] == 20.0)
    off = next(row for row in read_rows("misaligned") if row["misalignment"] == 10.0)
    root = next(row for row in read_rows("root_stress") if row["helix_angle"] == 20.0)
    nominal = root["nominal"] * root["form"] * root["correction"] * root["helix_factor"] * root["sharing_factor"]
    return {
        "mesh": (at_20["theoretical_mesh"], at_20["mesh"]),
        "face load factor": (off["iso_6336"], off["single_pair"]),
        "root": (nominal / cos(radians(20.0)) ** 3, root["largest"]),
    }


def measured(_: str) -> Numbers:
    third_dimension(["tooth_stiffness", "misaligned", "root_stress"])
    return face()


B, KISSSOFT = "ISO 6336-1, method B, theoretical value", "KISSsoft for ISO/TR 6336-30:2017, example 1"
FITTED, DIGITS = "the standard's 0.8 is fitted to measurements", "printed digits"
PARTS = [
    Part(
        "stiffness", STANDARDS, "other_programs.md#iso-6336-1-mesh-stiffness",
        {
            f"{z1}/{z2} {kind}": Claim(f"{words}, {z1} and {z2} teeth", B, "N/(mm µm)", (-0.2, 0.0), FITTED)
            for z1, z2 in TEETH
            for kind, words in (("single", "stiffness of one tooth pair"), ("mesh", "mean mesh stiffness"))
        },
        stiffness,
    ),
    Part(
        "roots", STANDARDS, "other_programs.md#iso-6336-3-root-stress",
        {z: Claim(f"root stress under 1 N/mm, {z} teeth", "ISO 6336-3, method B", "MPa", within(0.2),
                  "the method scatters by 20 to 25 %") for z in ("20", "100")},
        roots,
    ),
    Part(
        "example", STANDARDS, "other_programs.md#iso-6336-load-capacity",
        {
            "zone": Claim("zone factor Z_H", KISSSOFT, "", within(3e-6), DIGITS),
            "nominal": Claim("nominal contact stress", KISSSOFT, "MPa", within(5e-7), DIGITS),
            "dynamic": Claim("dynamic factor K_v", KISSSOFT, "", within(2e-3), "three digits printed; reduced mass"),
            "theoretical": Claim("theoretical stiffness c'th", KISSSOFT, "N/(mm µm)", within(3e-7), DIGITS),
            "single": Claim("single stiffness c'", KISSSOFT, "N/(mm µm)", within(5e-7), DIGITS),
            "mesh": Claim("mesh stiffness", KISSSOFT, "N/(mm µm)", within(2e-4), "contact ratio of five digits"),
        },
        example,
    ),
    Part(
        "face", STANDARDS, "third_dimension.md#misaligned-axes",
        {
            "mesh": Claim("mean mesh stiffness, helical, 20 deg", B, "N/(mm µm)", (-0.2, 0.0), FITTED),
            "face load factor": Claim("face load factor, misaligned by 10 µm", "ISO 6336-1, method C", "",
                                      within(0.1), "a foundation of one stiffness there"),
            "root": Claim("root stress, helical, 20 deg", "ISO 6336-3:2019, method B", "MPa", within(0.2),
                          "the method scatters by 20 to 25 %"),
        },
        measured, face, minutes=5.0,
    ),
]  # fmt: skip
