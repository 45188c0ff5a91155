"""Frames of a session of `gears live`, as somebody sees it: `python -m tests.benchmarks.live_session FOLDER [SCENE]`.

A headless browser opens the page, moves the torque, types a mistake, takes it back, adds a crowning or a relief,
compares, undoes and asks for the scene and the report. After each a PNG is written, to be looked at; `3_shaped.png` is
docs/pictures/live.png.
"""

import sys
import urllib.request
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.extensions.live.driven import moved, opened, served
from tests.extensions.report.browser import Browser

SCENE = Path(__file__).parents[2] / "demos" / "helical_gearbox" / "gearbox.toml"
SETTLED = "live.drawn === live.number && !live.result.first_look"
TORQUE = "each.name.startsWith('load.')"
SHAPE = "each.name === 'lead_modifications.pinion.crowning' || each.name.endsWith('tip_relief.pinion.depth')"


def main(folder: str, scene: Path | str = SCENE) -> None:
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as profile, served(Path(scene)) as (address, _), Browser(profile, True) as browser:

        def frame(name: str, condition: str = SETTLED) -> None:
            browser.wait(condition)
            # Plotly draws in frames of its own.
            browser.value("new Promise(done => setTimeout(done, 1500))")
            browser.photograph(place / f"{name}.png")

        def move(name: str, value: float) -> None:
            before = browser.value("live.number")
            moved(browser, name, value)
            browser.wait(f"live.number > {before}")

        def named(which: str) -> str:
            return browser.value(f"live.state.controls.find(each => {which}).name")

        opened(browser, address)
        frame("1_opened")
        torque = named(TORQUE)
        move(torque, 1.5 * browser.value(f"live.state.controls.find(each => {TORQUE}).number"))
        frame("2_torque", f"live.state.changed && {SETTLED}")
        shape = named(SHAPE)
        move(shape, 6)
        frame("3_shaped", SETTLED)
        text = f"document.getElementById('field {shape}')"
        browser.value(f"{text}.value = '-3 um', {text}.dispatchEvent(new Event('change')), true")
        frame("4_mistake", "live.state.problems.length > 0")
        browser.value("document.getElementById('undo').click()")
        frame("5_undone", f"live.state.problems.length === 0 && {SETTLED}")
        browser.value("document.getElementById('compare').click()")
        move(torque, browser.value(f"live.state.controls.find(each => {TORQUE}).highest"))
        frame("6_compared")
        browser.value("document.getElementById('lines').click()")
        frame("7_python")
        browser.value("document.querySelector('#python button').click()")
        with urllib.request.urlopen(f"{address}scene.toml", timeout=60) as answer:
            (place / "saved.toml").write_bytes(answer.read())
        browser.value("window.scrollTo(0, 900), document.querySelector('main').scrollTo?.(0, 900), true")
        frame("8_below")


if __name__ == "__main__":
    main(*sys.argv[1:])
