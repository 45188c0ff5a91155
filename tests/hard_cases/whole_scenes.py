"""Texts of whole scenes with all sections combined at random, from watches to mills: what a user may write. Most are
right; what is refused is told in words. Coarse, so that most runs take seconds."""

from math import pi

from hypothesis import assume
from hypothesis import strategies as st
from tests.hard_cases.random_effects import DENSITY, GEARS, PAIR_STIFFNESS, decades, random_effects

from fenics_gears import SceneError, gear_pair, scene_from_text
from fenics_gears.geometry.gear_data import MATERIALS
from fenics_gears.inputs.written import as_toml

MODULES, WIDTHS = (0.2, 60.0), (0.01, 10.0)
# N/mm of face width and mm of module: at 30 steel teeth are used.
STRESSES = (1e-6, 1e5)
SHAFTS = {"pinion": "input", "wheel": "output"}
ELEMENTS = ("P1", "P2", "Q1", "Q1 incompatible", "Q2")


@st.composite
def whole_scenes(draw) -> str:
    """The text of a scene whose gears alone are right."""
    module = draw(st.one_of(decades(*MODULES), st.sampled_from((0.3, 1.0, 3.0, 4.5, 8.0, 16.0, 50.0))))
    over_face = draw(st.booleans())
    elastic = draw(st.integers(0, 5)) < 5
    tree = {"gears": _gears(draw, module, over_face, elastic), "load": {"wheel_torque": "1 N m"}}
    try:
        pair = gear_pair(scene_from_text(as_toml(tree)).gears)
    except SceneError:
        assume(False)
    width, coast = pair.face_width, draw(st.booleans())
    torque = draw(decades(*STRESSES)) * module * width * pair.wheel.base_radius
    if draw(st.integers(0, 15)) == 15:
        torque = 0.0
    if coast:
        torque *= draw(st.sampled_from((1, -1)))
    frequency, cycles = draw(decades(1e-2, 2e4)), draw(st.integers(1, 3))
    tree["load"] = {"wheel_torque": f"{torque!r} N mm"}
    tree["motion"] = {"mesh_frequency": f"{frequency!r} Hz", "mesh_cycles": cycles}
    tree["accuracy"] = _accuracy(draw, pair, over_face)
    if coast:
        tree["coast_flanks"] = {}
    if draw(st.integers(0, 3)) == 0:
        tree["output"] = {"root_stress": True}
    found = random_effects(draw, pair, width, torque, frequency, cycles, elastic, coast)
    if over_face:
        tree |= _over_the_face(draw, pair)
    if over_face and draw(st.integers(0, 2)) == 0:
        tree |= _elastic_shafts(draw, pair)
    if not (4.0 <= min(pair.face_widths) and 0.5 <= module):
        # Tolerance classes are of larger gears.
        found = [each for each in found if "tolerance_class" not in each]
    tree |= _instead(draw, {*map(_section_of, found)})
    return "\n".join([as_toml(tree), *(each for each in found if _section_of(each) not in tree)]) + "\n"


def _section_of(text: str) -> str:
    return text.partition("]")[0][1:].partition(".")[0]


def _instead(draw, sections: set[str]) -> dict:
    """Sections in another of their forms than that of `random_effects`."""
    found = {}
    if "friction" in sections and draw(st.booleans()):
        formula = draw(st.sampled_from(("Schlenk", "Benedict and Kelley")))
        viscosity, roughness = draw(decades(0.1, 1e4)), draw(decades(0.01, 20.0))
        found["friction"] = {
            "formula": formula, "viscosity": f"{viscosity!r} mPa s", "roughness": f"{roughness!r} um"
        }  # fmt: skip
    if "inertia" in sections and draw(st.booleans()):
        found["inertia"] = {"density": f"{draw(st.sampled_from((7.85, 2.7, 1.2)))} g/cm^3"}
        if "shafts" in sections:
            found["inertia"]["load"] = {"moment_of_inertia": f"{draw(decades(1e-12, 1e3))!r} kg m^2"}
    if "damping" in sections and draw(st.booleans()):
        found["damping"] = {"ratio": draw(st.floats(1e-3, 0.9))}
    return found


def _gears(draw, module: float, over_face: bool, elastic: bool) -> dict:
    own_widths = draw(st.booleans())
    width = module * draw(st.one_of(st.floats(1.0, 10.0), decades(*WIDTHS)))
    helix = draw(st.floats(0.5, 40.0)) if over_face and draw(st.booleans()) else 0.0
    found = {
        "module": f"{module!r} mm",
        "pressure_angle": f"{draw(st.sampled_from((20.0, 20.0, 14.5, 17.5, 25.0)))} deg",
        "backlash": f"{module * draw(st.floats(0.0, 0.2))!r} mm",
    }
    if helix:
        found |= {"helix_angle": f"{helix!r} deg", "pinion_hand": draw(st.sampled_from(("right", "left")))}
    if not own_widths:
        found["face_width"] = f"{width!r} mm"
    if elastic:
        found["material"] = _material(draw)
    for gear in GEARS:
        found[gear] = own = {"teeth": draw(st.integers(10, 60)), "profile_shift": draw(st.floats(-0.4, 0.8))}
        root = module * (own["teeth"] - 3.0)
        own["bore_diameter"] = f"{root * draw(st.floats(0.2, 0.75))!r} mm"
        if own_widths:
            other = width * draw(st.floats(0.5, 2.0))
            own["face_width"] = f"{other!r} mm"
            if over_face and draw(st.booleans()):
                own["axial_offset"] = f"{0.2 * width * draw(st.floats(-1.0, 1.0))!r} mm"
        if draw(st.integers(0, 5)) == 0:
            rim, hub = (root * draw(st.floats(*ends)) for ends in ((0.8, 0.95), (0.6, 0.8)))
            own["bore_diameter"] = f"{0.4 * root!r} mm"
            own["web"] = {
                "rim_inner_diameter": f"{rim!r} mm", "width": f"{width * draw(st.floats(0.1, 0.9))!r} mm"
            }  # fmt: skip
            if draw(st.booleans()):
                own["web"]["hub_diameter"] = f"{hub!r} mm"
        if elastic and draw(st.integers(0, 3)) == 0:
            own["material"] = _material(draw)
        if draw(st.integers(0, 7)) == 0:
            own["tip_chamfer"] = f"{module * draw(st.floats(0.0, 0.2))!r} mm"
    return found


def _material(draw):
    if draw(st.booleans()):
        return draw(st.sampled_from(sorted(MATERIALS)))
    modulus, poisson = draw(decades(1e-3, 1e3)), draw(st.floats(-0.3, 0.499))
    return {"youngs_modulus": f"{modulus!r} GPa", "poissons_ratio": poisson}


def _accuracy(draw, pair, over_face: bool) -> dict:
    module = pair.pinion.module
    found = {
        "flank_element_size": f"{module * draw(st.floats(0.1, 0.4))!r} mm",
        "contact_nodes": draw(st.integers(2, 15)),
        "steps_per_mesh_cycle": draw(st.integers(2, 40)),
    }
    if draw(st.booleans()):
        found["interpolation"] = draw(st.sampled_from(("averaged", "collocated")))
    if draw(st.integers(0, 3)) == 0:
        found["contact_length"] = f"{module * draw(decades(0.05, 2.0))!r} mm"
    if over_face:
        found["slices"], found["layers"] = draw(st.integers(2, 12)), draw(st.integers(1, 4))
        found["layers"] = min(found["layers"], max(1, int(pair.face_width / 0.06)))
        found["body_element_size"] = f"{module * draw(st.floats(0.4, 1.5))!r} mm"
    elif draw(st.integers(0, 1)):
        found["element"] = draw(st.sampled_from(ELEMENTS))
    if draw(st.integers(0, 9)) == 0 and (not over_face or draw(st.booleans())):
        found = {"model": draw(st.sampled_from(("rigid teeth", "stiffness table", "ISO 6336-1"))),
                 "steps_per_mesh_cycle": found["steps_per_mesh_cycle"]}  # fmt: skip
    return found


def _over_the_face(draw, pair) -> dict:
    """Misalignment or lead modifications, at least one of them."""
    kinds = draw(st.sampled_from((("misalignment",), ("lead_modifications",), ("misalignment", "lead_modifications"))))
    found: dict = {}
    if "misalignment" in kinds:
        found["misalignment"] = {"in_plane": _amount(draw, pair), "out_of_plane": _amount(draw, pair)}
    if "lead_modifications" in kinds:
        found["lead_modifications"] = {gear: _lead(draw, pair) for gear in draw(st.sampled_from((GEARS, GEARS[:1])))}
    if draw(st.integers(0, 3)) == 0:
        found["bearings"] = {
            "stiffness": f"{PAIR_STIFFNESS * pair.face_width * draw(decades(1e-3, 1e3))!r} N/mm",
            "axial_stiffness": f"{PAIR_STIFFNESS * pair.face_width * draw(decades(1e-3, 1e3))!r} N/mm",
            "places": {"pinion": [f"{-pair.face_width!r} mm", f"{2.0 * pair.face_width!r} mm"]},
        }
    return found


def _amount(draw, pair) -> str:
    return f"{pair.pinion.module * draw(decades(1e-6, 3e-2)) * draw(st.sampled_from((1, -1)))!r} mm"


def _lead(draw, pair) -> dict:
    found = {"helix_slope": _amount(draw, pair), "crowning": _amount(draw, pair).removeprefix("-")}
    if draw(st.booleans()):
        length = pair.face_width * draw(st.floats(0.05, 0.9))
        found["end_relief"] = {
            "depth": _amount(draw, pair).removeprefix("-"), "length": f"{length!r} mm",
            "sides": draw(st.sampled_from(("both", "left", "right"))),
        }  # fmt: skip
    return found


def _elastic_shafts(draw, pair) -> dict:
    """Shafts with sections on bearings of their own, of one gear or of both."""
    found: dict = {"shafts": {}, "bearings": {}}
    for gear in draw(st.sampled_from((GEARS, GEARS[:1], GEARS[1:]))):
        each, width = getattr(pair, gear), max(pair.face_widths)
        bore, ends = 2.0 * each.bore_radius, width * draw(st.floats(1.0, 4.0))
        seat = draw(st.sampled_from(("rigid over its width", "press fit", "integral")))
        hollow = {"bore": f"{bore * draw(st.floats(0.1, 0.8))!r} mm"} if draw(st.booleans()) else {}
        length = width + 2.0 * ends
        parts = draw(st.integers(1, 3))
        sections = [{"length": f"{length / parts!r} mm", "diameter": f"{bore!r} mm"} | hollow for _ in range(parts)]
        found["shafts"][SHAFTS[gear]] = {
            "sections": sections, "gear_at": f"{0.5 * length!r} mm", "seat": seat,
            "torque_at": f"{length * draw(st.floats(0.0, 1.0))!r} mm",
            "material": {"density": f"{1e9 * DENSITY!r} g/cm^3"},
        }  # fmt: skip
        places = (0.2 * ends, length - 0.2 * ends)
        found["bearings"][gear] = [_bearing(draw, pair, bore, at, first) for at, first in zip(places, (True, False))]
    return found


def _bearing(draw, pair, bore: float, at: float, holds: bool) -> dict:
    stiffness = PAIR_STIFFNESS * pair.face_width
    if draw(st.integers(0, 2)) == 0:
        ball, number = 0.4 * bore, draw(st.integers(3, 20))
        clearance = 1e-3 * ball * draw(st.floats(-1.0, 3.0))
        rolling = {
            "number": number, "diameter": f"{ball!r} mm", "clearance": f"{clearance!r} mm",
            "pitch_diameter": f"{max(1.6 * bore, 1.05 * number * ball / pi)!r} mm",
        }  # fmt: skip
        if draw(st.booleans()):
            rolling |= {"elements": "rollers", "length": f"{ball!r} mm"}
        return {"at": f"{at!r} mm", "rolling": rolling, "axial_stiffness": f"{stiffness!r} N/mm"}
    found = {"at": f"{at!r} mm", "radial_stiffness": f"{stiffness * draw(decades(1e-3, 1e3))!r} N/mm"}
    if holds or draw(st.booleans()):
        found["axial_stiffness"] = f"{stiffness * draw(decades(1e-3, 1e3))!r} N/mm"
    return found
