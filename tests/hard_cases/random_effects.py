"""Any set of effects with any valid values, as sections of a scene's text; an effect that is added is drawn here.
Lengths go with the module, stiffnesses with the teeth's own."""

from collections.abc import Callable
from math import degrees, log10, pi

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from fenics_gears import GeometryError
from fenics_gears.geometry.tip_edge import tip_edge

# Of steel teeth: stiffness of a pair (N/mm^2), density.
PAIR_STIFFNESS, DENSITY = 14e3, 7.8e-9
GEARS = ("pinion", "wheel")
# No edge is rounder than the tip is thick, nor leaves a contact ratio below this; no error of manufacture is larger
# than this part of the module; no more waves a tooth than half the steps of a mesh cycle can show.
WIDEST_EDGE, LEAST_CONTACT_RATIO, LARGEST_ERROR, MOST_WAVES = 0.45, 1.02, 1e-2, 9
Draw = Callable


def decades(lowest: float, highest: float) -> st.SearchStrategy[float]:
    """Positive numbers, every decade as likely as the next."""
    return st.floats(log10(lowest), log10(highest)).map(lambda exponent: 10.0**exponent)


def random_effects(
    draw: Draw, pair, width: float, torque: float, mesh_frequency: float, cycles: int, elastic: bool, coast: bool
) -> list[str]:
    """Sections of any effects but material and coast flanks. `torque`: N mm on the wheel; `elastic`: whether flanks
    give way."""
    found = _drivetrain(draw, pair, width, mesh_frequency, cycles) + _flanks(draw, pair)
    if torque and draw(st.booleans()):
        found.append(torque_ripple(draw, torque, coast))
    if elastic and draw(st.booleans()):
        found.append(f"[friction]\ncoefficient = {draw(st.one_of(decades(1e-6, 0.1), st.floats(0.01, 1.0)))!r}")
    if elastic and draw(st.booleans()):
        found.append(corner_contact(draw, pair))
    return found


def _drivetrain(draw: Draw, pair, width: float, mesh_frequency: float, cycles: int) -> list[str]:
    """Springs from 1e-4 to 1e5 of the teeth's own stiffness, masses within ten times those of steel discs."""
    radius = pair.wheel.base_radius
    teeth, disc = PAIR_STIFFNESS * width, DENSITY * pi * radius**2 * width
    shafts, supported = draw(st.booleans()), draw(st.booleans())
    found = []
    if shafts:
        found.append(f'[shafts]\ntorsional_stiffness = "{draw(decades(1e-4, 1e5)) * teeth * radius**2!r} N mm/rad"')
    if supported:
        found.append(bearings(draw, teeth))
    if not draw(st.booleans()):
        return found
    mass, inertia = disc * draw(decades(0.1, 10.0)), 0.5 * disc * radius**2 * draw(decades(0.1, 10.0))
    found.append(f'[inertia]\nmass = "{mass!r} t"\nmoment_of_inertia = "{inertia!r} t mm^2"')
    if draw(st.booleans()):
        of_stiffness = draw(decades(1e-7, 1e-2)) if shafts or supported else 0.0
        found.append(
            f'[damping]\nstiffness_proportional = "{of_stiffness!r} s"\nmass_proportional ='
            f' "{draw(decades(1e-3, 1e4))!r} 1/s"'
        )
    if draw(st.booleans()):
        found.append(speed_ramp(draw, mesh_frequency, cycles))
    return found


def _flanks(draw: Draw, pair) -> list[str]:
    """What changes the flanks."""
    drawings = (
        lambda: relief(draw, pair, "tip_relief", "HPSTC"),
        lambda: relief(draw, pair, "root_relief", "LPSTC"),
        lambda: flank_errors(draw, pair),
        lambda: eccentricity(draw, pair),
    )
    return [drawing() for drawing in drawings if draw(st.booleans())]


def bearings(draw: Draw, teeth: float) -> str:
    """Supports alike or not along and off the line of action; `teeth`: their stiffness, N/mm."""

    def stiffness(*names):
        return "".join(f'{name} = "{draw(decades(1e-4, 1e5)) * teeth!r} N/mm"\n' for name in names)

    text = "[bearings]\n" + stiffness(
        *draw(st.sampled_from((("stiffness",), ("stiffness_x", "stiffness_y"), ("stiffness", "stiffness_y"))))
    )
    for gear in draw(st.sampled_from(((), (), ("pinion",), ("wheel",), GEARS))):
        text += f"\n[bearings.{gear}]\n" + stiffness(draw(st.sampled_from(("stiffness", "stiffness_x", "stiffness_y"))))
    return text


def speed_ramp(draw: Draw, mesh_frequency: float, cycles: int) -> str:
    """Up or down, by a millionth up to a factor of ten, at once or after all cycles but one."""
    factor = (1.0 + draw(decades(1e-6, 9.0))) ** draw(st.sampled_from((1, -1)))
    return (
        f'[speed_ramp]\nend_frequency = "{factor * mesh_frequency!r} Hz"\nhold_cycles ='
        f" {draw(st.integers(0, cycles - 1))}"
    )


def torque_ripple(draw: Draw, torque: float, coast: bool) -> str:
    """One to three harmonics that turn the couple's sign only where the coast flanks can hold it."""
    count = draw(st.integers(1, 3))
    largest = (2.0 if coast else 0.999) * abs(torque) / count
    entries = [
        f'{{ order = {draw(decades(0.1, 500.0))!r}, amplitude = "{draw(st.floats(1e-3, 1.0)) * largest!r} N mm", '
        f'phase = "{draw(st.floats(-360.0, 360.0))!r} deg" }}'
        for _ in range(count)
    ]
    return f"[torque_ripple]\nharmonics = [{', '.join(entries)}]"


def relief(draw: Draw, pair, section: str, usual: str) -> str:
    """Alike for both gears from where it usually starts, or each gear's own from anywhere on its flank."""
    shape = draw(st.sampled_from(("linear", "parabolic")))
    text = f'[{section}]\nshape = "{shape}"\n'
    if draw(st.booleans()):
        return text + f'depth = "{_depth(draw, pair)!r} mm"\nstart = "{usual}"'
    for name in draw(st.sampled_from((("pinion",), ("wheel",), GEARS))):
        gear = getattr(pair, name)
        roll = gear.form_roll_angle + draw(st.floats(0.05, 0.95)) * (gear.tip_roll_angle - gear.form_roll_angle)
        diameter = 2.0 * gear.base_radius * float(np.hypot(1.0, roll))
        start = draw(st.sampled_from((usual, f"{degrees(roll)!r} deg", f"{diameter!r} mm")))
        text += f'\n[{section}.{name}]\ndepth = "{_depth(draw, pair)!r} mm"\nstart = "{start}"\n'
    return text


def _depth(draw: Draw, pair) -> float:
    return pair.pinion.module * draw(decades(1e-4, 3e-2))


def eccentricity(draw: Draw, pair) -> str:
    return "\n\n".join(
        f'[eccentricity.{gear}]\ndistance = "{_error(draw, pair)!r} mm"\nphase = "{draw(st.floats(-360.0, 360.0))!r}'
        ' deg"'
        for gear in draw(st.sampled_from((("pinion",), ("wheel",), GEARS)))
    )


def _error(draw: Draw, pair) -> float:
    return pair.pinion.module * draw(decades(1e-5, LARGEST_ERROR))


def flank_errors(draw: Draw, pair) -> str:
    """Drawn within a class, given tooth by tooth, or some of both."""
    by_class = draw(st.booleans())
    text = "[flank_errors]\n"
    if by_class:
        text += f"tolerance_class = {draw(st.integers(1, 11))}\nseed = {draw(st.integers(0, 2**31 - 1))}\n"
    gears = draw(st.sampled_from((("pinion",), ("wheel",), GEARS) + (((),) if by_class else ())))
    return text + "".join(_errors_of(draw, pair, gear) for gear in gears)


def _errors_of(draw: Draw, pair, gear: str) -> str:
    """A list for each tooth of what is given, to 0.001 um, and perhaps waves; pitches close over a turn."""
    text, numbers = f"\n[flank_errors.{gear}]\n", np.random.default_rng(draw(st.integers(0, 2**31 - 1)))
    teeth = getattr(pair, gear).teeth
    given = draw(st.lists(st.sampled_from(("pitch", "profile_slope", "profile_form")), min_size=1, unique=True))
    for name in given:
        values = _error(draw, pair) * numbers.uniform(-1.0, 1.0, teeth)
        if name == "pitch":
            values -= values.mean()
        text += f"{name} = [{', '.join(f'{chr(34)}{1e3 * value:.3f} um{chr(34)}' for value in values)}]\n"
    if draw(st.booleans()):
        waves = (
            f'amplitude = "{0.1 * _error(draw, pair)!r} mm"\nwaves = {draw(st.integers(1, MOST_WAVES * teeth))}\nphase'
            f' = "{draw(st.floats(-360.0, 360.0))!r} deg"'
        )
        text += f"\n[flank_errors.{gear}.waviness]\n{waves}\n"
    return text


def corner_contact(draw: Draw, pair) -> str:
    """Sharp edges, rounded ones alike, or each gear's own; as round as leaves enough of the flanks."""
    kind = draw(st.sampled_from(("sharp", "alike", "own")))
    if kind == "sharp":
        return "[corner_contact]"
    thickness = min(pair.pinion.tip_thickness, pair.wheel.tip_thickness)
    pinion = draw(decades(1e-3, WIDEST_EDGE)) * thickness
    wheel = draw(decades(1e-3, WIDEST_EDGE)) * thickness if kind == "own" else pinion
    assume(_contact_ratio(pair, (pinion, wheel)) >= LEAST_CONTACT_RATIO)
    if kind == "alike":
        return f'[corner_contact]\nedge_radius = "{pinion!r} mm"'
    return "\n\n".join(
        f'[corner_contact.{gear}]\nedge_radius = "{radius!r} mm"' for gear, radius in zip(GEARS, (pinion, wheel))
    )


def _contact_ratio(pair, radii: tuple[float, float]) -> float:
    """That of the flanks which rounded tip edges leave; 0 where they leave none."""
    gears = (pair.pinion, pair.wheel)
    try:
        ends = [gear.base_radius * tip_edge(gear, radius).flank_roll for gear, radius in zip(gears, radii)]
    except GeometryError:
        return 0.0
    return (sum(ends) - pair.line_of_action_length) * pair.pinion.teeth / (2.0 * pi * pair.pinion.base_radius)
