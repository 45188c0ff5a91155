"""Does `[accuracy] target` keep its promise over the face, and at what cost: `python -m
tests.benchmarks.target_over_face [FIRST [LAST]]`, ten helical pairs at random, against settings twice as fine. The
cheapest settings are found from the chosen ones by making mesh or slices coarser as long as the true error allows
it."""

import csv
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from tests.benchmarks.target_reference import counted_seconds
from tests.helical import helical_scene

from fenics_gears.runs.settings.measures import distance, judged_answer
from fenics_gears.runs.settings.setting import Setting, without_settings
from fenics_gears.runs.settings.setting_runs import SettingRuns
from fenics_gears.runs.settings.target import choose
from fenics_gears.scene.data import Scene
from fenics_gears.system.progress import SilentProgress

PAIRS, TARGETS = 10, (0.05, 0.03, 0.02)
FILE = Path(__file__).parents[2] / "docs" / "pictures" / "target_over_face.csv"
COARSER = 2.0**0.5


def pair(number: int) -> tuple[str, Scene, float]:
    """Words, scene and target of a pair."""
    random = np.random.default_rng(1000 + number)
    pinion = int(random.integers(17, 31))
    teeth = pinion, int(pinion * random.uniform(1.0, 3.0))
    helix, width = round(random.uniform(8.0, 30.0), 1), round(random.uniform(8.0, 18.0), 1)
    misaligned, crowned = (round(random.uniform(0.0, most), 1) for most in (12.0, 8.0))
    # Force per width on the reference circle, N/mm.
    load = random.uniform(60.0, 250.0)
    torque = float(round(load * width * teeth[1] * 2.0 / (2.0 * np.cos(np.radians(helix))), -1))
    more = f'[misalignment]\nin_plane = "{misaligned} um"\n'
    more += f'[lead_modifications.pinion]\ncrowning = "{crowned} um"\n'
    scene = helical_scene(
        more, teeth=teeth, helix=helix, width=width, torque=torque, module=2.0, frequency=10.0, accuracy=""
    )
    words = f"{teeth[0]}/{teeth[1]} teeth, {helix} deg, {width} mm, {load:.0f} N/mm, {misaligned} um, {crowned} um"
    return words, scene, TARGETS[number % len(TARGETS)]


def twice_as_fine(setting: Setting) -> Setting:
    return replace(
        setting, flank=0.5 * setting.flank, spacing=0.5 * setting.spacing, body=setting.body / 1.5,
        slices=2 * setting.slices, layers=2 * setting.layers,
    )  # fmt: skip


def coarser(setting: Setting) -> list[Setting]:
    """The setting with a coarser mesh, with fewer slices."""
    mesh = {name: COARSER * getattr(setting, name) for name in ("flank", "spacing", "body")}
    return [replace(setting, **mesh), replace(setting, slices=max(2, round(setting.slices / COARSER)))]


def measured(number: int) -> dict[str, object]:
    words, scene, target = pair(number)
    chosen = choose(scene, target, SilentProgress())
    scene = without_settings(scene)
    runs = SettingRuns(scene, lambda run, model, cycle: judged_answer(run), 6)

    def answer(setting):
        if setting not in runs:
            runs.run(setting)
        return runs.answers[setting]

    truth = answer(twice_as_fine(chosen.setting))

    def errors(setting):
        return {name: distance(answer(setting), truth, name) for name in truth}

    true, cheapest, least, tried = errors(chosen.setting), chosen.setting, counted_seconds(scene, chosen.setting), 0
    while True:
        next_ones = sorted((counted_seconds(scene, each), place, each) for place, each in enumerate(coarser(cheapest)))
        for spent, _, each in next_ones:
            tried += 1
            if spent < least and max(errors(each).values()) <= target:
                cheapest, least = each, spent
                break
        else:
            break
    return {
        "number": number, "pair": words, "target": target, "chosen": chosen.setting.words,
        "estimated": chosen.estimated_error,
        **{f"error_{name.replace(' ', '_')}": error for name, error in true.items()},
        "true_over_target": max(true.values()) / target,
        **{f"estimated_{name.replace(' ', '_')}": part for name, part in chosen.parts.items()},
        "cheapest": cheapest.words, "cheapest_error": max(errors(cheapest).values()), "tried": tried,
        "cost_over_cheapest": counted_seconds(scene, chosen.setting) / least, "trial_runs": chosen.runs,
    }  # fmt: skip


def main(numbers: range) -> None:
    lines = {}
    if FILE.exists():
        with FILE.open(encoding="utf-8", newline="") as file:
            lines = {int(line["number"]): line for line in csv.DictReader(file)}
    for number in numbers:
        found = measured(number)
        lines[number] = {name: f"{value:.4g}" if isinstance(value, float) else value for name, value in found.items()}
        print(lines[number], flush=True)
        with FILE.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, list(lines[number]))
            writer.writeheader()
            writer.writerows(lines[each] for each in sorted(lines))


if __name__ == "__main__":
    given = [int(each) for each in sys.argv[1:]]
    main(range(given[0] if given else 0, given[1] + 1 if len(given) > 1 else PAIRS))
