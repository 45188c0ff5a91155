"""Row 20: friction of 0.3 to 2 on the paper's pair: it converges, or says what friction does."""

from dataclasses import replace
from itertools import product

import pytest
from tests.coarse import quasi_static
from tests.hard_cases.invariants import run_of, worst_of
from tests.hard_cases.test_any_scene import LAWS

from fenics_gears import model_of, simulate
from fenics_gears.elasticity.cache import user_cache
from fenics_gears.results.summary import summary_rows
from fenics_gears.simulation.bodies import gear_bodies
from fenics_gears.system.progress import SilentProgress

WORDS = ("self-locking", "more than one solution")
ABSENT = [(), ("bearings",), ("shafts", "bearings")]
DYNAMIC = {"dynamic": lambda scene: scene, "quasi-static": quasi_static}
# Rows 1 and 2.
LIMITS = ("penetration", "tension", "complementarity", "cone", "wrong_way", "dissipation")


def with_friction(scene, coefficient, absent=()):
    return replace(scene, friction=replace(scene.friction, coefficient=coefficient), **dict.fromkeys(absent))


def marched(scene):
    model = model_of(scene)
    return run_of(model, gear_bodies(model, SilentProgress(), user_cache()))


def outcome(run):
    """How a run ends: what its warnings or its error say of friction, and whether it converged."""
    if run.failure is not None:
        return run.failure.reason, False, {}
    said = [line for line in run.result.attrs["warnings"].splitlines() if any(words in line for words in WORDS)]
    return "; ".join(said), True, rungs_of(run.result)


def rungs_of(result):
    return {key.split(": ")[1]: int(count) for key, count in result.attrs.items() if key.startswith("steps_by_rung")}


def locks_from(pair):
    """Friction at the first point of contact outweighs the normal force on the wheel from this coefficient on."""
    return pair.wheel.base_radius / (pair.line_of_action_length - pair.path_start)


# By day both ends of friction, each in time on one drivetrain and at rest on another.
BY_DAY = [
    (0.3, "dynamic", ()),
    (0.3, "quasi-static", ABSENT[2]),
    (2.0, "dynamic", ABSENT[2]),
    (2.0, "quasi-static", ()),
]


@pytest.mark.parametrize(
    ("friction", "dynamic", "absent"),
    [
        pytest.param(*each, marks=[] if each in BY_DAY else pytest.mark.nightly)
        for each in product((0.3, 0.6, 1.0, 2.0), DYNAMIC, ABSENT)
    ],
)
def test_strong_friction_converges_or_says_why(friction, dynamic, absent, coarse, paper_pair, measured):
    """Coulomb's law from the equations; by the wheel's moments friction can lock from mu = rb2/(L - x) on (1.65 at
    the start of contact), and not below."""
    run = marched(with_friction(DYNAMIC[dynamic](coarse), friction, absent))
    springs = "all springs" if not absent else "without " + " and ".join(absent)
    converges_or_says_why(run, f"{dynamic}, {springs}", locks_from(paper_pair), measured)


def converges_or_says_why(run, words, locks, measured):
    """A run with friction, which may lock the gears from a coefficient `locks` on."""
    (said, converged, rungs), worst, friction = outcome(run), worst_of(run), run.friction
    case = f"mu = {friction:g}, {words}"
    fallbacks = ", ".join(f"{count} by {method}" for method, count in rungs.items() if method != "newton")
    causes = "; ".join(each.partition(":")[0] for each in said.split("; ") if ":" in each)
    measured(
        case,
        ("converges" if converged else "error")
        + (f" ({fallbacks})" if fallbacks else "")
        + (f"; {causes}" if causes else ""),
        "converges, or names the cause",
        row=20,
    )
    for name in LIMITS:
        _, law, limit, unit = LAWS[name]
        measured(f"mu = {friction:g}: {law}", worst[name], limit, unit, row=20)
    if friction < locks:
        assert converged and not said
    else:
        assert "self-locking" in said


@pytest.mark.parametrize("dynamic", DYNAMIC)
def test_locking_begins_where_the_lever_arms_say(dynamic, coarse, paper_pair, measured):
    """Exact: rb2/(L - x) at the first point where the teeth touch."""
    limit = locks_from(paper_pair)
    below, above = (
        outcome(marched(with_friction(DYNAMIC[dynamic](coarse), factor * limit, ("shafts", "bearings"))))[0]
        for factor in (0.98, 1.15)
    )
    measured(f"{dynamic}: friction coefficient above which the paper's pair can lock", limit, "rb2/(L - x)")
    for words, said, right in (("2 % below", below, "no self-locking"), ("15 % above", above, "self-locking")):
        found = "self-locking" if "self-locking" in said else "no self-locking"
        measured(f"{dynamic}: {words} this coefficient", found, right)
        assert found == right


def test_the_summary_counts_the_fallbacks(coarse, measured):
    """Message: a line on fallbacks with the result's own counts; none where Newton alone was used."""
    scene = with_friction(quasi_static(coarse), 2.0, ("shafts", "bearings"))
    result = simulate(scene)
    counts = rungs_of(result)
    (line,) = [value for label, value, _ in summary_rows(result) if label == "steps solved by fallbacks"]
    measured("fallbacks in the summary at mu = 2", line, "as counted in the result")
    assert sum(counts.values()) == result.attrs["steps"] and len(counts) > 1
    assert line == ", ".join(f"{count} by {rung}" for rung, count in counts.items() if rung != "newton")
    plain = summary_rows(simulate(with_friction(quasi_static(coarse), 0.3)))
    assert not [label for label, _, _ in plain if "fallback" in label]
