"""The reference that settings are judged by: one fine run and what each setting, refined alone, still adds by Richardson's limit."""

from dataclasses import dataclass, replace

import numpy as np

from fenics_gears.model.model import model_of
from fenics_gears.model.resolution import NODE_SPACING
from fenics_gears.scene.data import Scene
from fenics_gears.studies.accuracy.convergence import richardson, together
from fenics_gears.studies.accuracy.measures import JUDGED, Answer, answer
from fenics_gears.studies.accuracy.runs import run_sharing, shared_gears
from fenics_gears.studies.accuracy.setting import Setting, half_width

# Elements in a half-width, contact nodes 0.7 of them apart; body elements in parts of their default; steps in a cycle. What one still
# adds to the base is measured with few steps where it is not the steps'. The base's flank is fine: on a coarse one small steps find
# extremes that belong to single nodes as they come into contact (0.3 % of T_EPP at 2.8 elements).
LEVELS = {"flank": (2.8, 5.6, 11.2), "body": (1.0, 0.5, 0.25), "steps": (640, 1280, 2560)}
BASE = {"flank": 5.6, "body": 0.5, "steps": 640}
FEW_STEPS = 320
EXPECTED = {"flank": 1.5, "body": 2.0, "steps": 1.5}


def highest(curve: np.ndarray) -> float:
    """The highest value of a periodic curve, samples of one period, between samples too: where the straight lines from both sides meet.

    A corner, where a pair comes or goes, stands on no sample: the highest sample misses it by an amount that hardly falls from one number of
    steps to the next (14/30: 0.28, then 0.14 % of T_EPP at 1280 and 2560 steps).
    """
    at = int(np.argmax(curve))
    first, second, third, fourth, fifth = (curve[(at + offset) % len(curve)] for offset in range(-2, 3))
    met = [third]
    for before, left, right, after in ((first, second, third, fourth), (second, third, fourth, fifth)):
        rise, fall = left - before, after - right
        place = (right - fall - left) / (rise - fall) if rise > fall else -1.0
        if 0.0 <= place <= 1.0:
            met.append(left + rise * place)
    return float(max(met))


@dataclass(frozen=True)
class Reference:
    """Answers at all limits, relative uncertainty of each measure, of it each setting's part, and orders observed."""

    answer: Answer
    uncertainty: dict[str, float]
    parts: dict[str, dict[str, float]]
    orders: dict[str, dict[str, float | None]]


def reference(scene: Scene, window: float, told=print) -> Reference:
    """The reference of a scene whose `[accuracy]` is empty; `window` (mm): that of pressures."""
    unit, gears = half_width(scene), shared_gears(4)
    length = model_of(scene).resolution.contact_grid.length

    def setting(values) -> Setting:
        return Setting("P2", unit / values["flank"], NODE_SPACING * unit / values["flank"], length, values["body"], values["steps"])

    def run(values) -> Answer:
        words = setting(values)
        told(words.words)
        found, _ = run_sharing(words.of(scene), gears)
        curve = found.transmission_error.values[:-1]
        found.attrs["peak_to_peak_transmission_error"] = highest(curve) + highest(-curve)
        return answer(found, window)

    base, limits, orders = run(BASE), {name: [] for name in JUDGED}, {}
    for size, levels in LEVELS.items():
        others = BASE if size == "steps" else {**BASE, "steps": FEW_STEPS}
        answers = [base if {**others, size: level} == BASE else run({**others, size: level}) for level in levels]
        own_base = answers[levels.index(BASE[size])]
        halved = [level if size == "body" else 1.0 / level for level in levels]
        found = {name: richardson([each[name] for each in answers], halved, EXPECTED[size]) for name in JUDGED}
        orders[size] = {name: limit.order for name, limit in found.items()}
        for name, limit in found.items():
            limits[name].append(replace(limit, value=base[name] + limit.value - own_base[name]))
    whole = {name: together(base[name], limits[name]) for name in JUDGED}
    return Reference(
        {name: limit.value for name, limit in whole.items()},
        {name: limit.uncertainty / float(np.linalg.norm(limit.value)) for name, limit in whole.items()},
        {
            size: {name: limits[name][place].uncertainty / float(np.linalg.norm(whole[name].value)) for name in JUDGED}
            for place, size in enumerate(LEVELS)
        },
        orders,
    )
