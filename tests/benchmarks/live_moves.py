"""How soon `gears live` shows a change: `python -m tests.benchmarks.live_moves [MOVES]` writes the table of
docs/evidence/performance.md.

Sliders of load, modifications, misalignment and friction are moved at random in a headless browser, each when all of
the move before is drawn; gears and their bodies stay. Measured in the page, from the slider's event: until the answer
is there, and until it is drawn. Beside it stand processor seconds of the program per move, which a busy machine
changes less. The browser draws without a graphics card.
"""

import os
import random
import sys
import time
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from tests.benchmarks.marked_section import markers, write_section
from tests.docs.markdown import table
from tests.extensions.live.driven import family, opened, served, slider
from tests.extensions.report.browser import Browser

DEMOS = Path(__file__).parents[2] / "demos"
PAGE = DEMOS.parent / "docs" / "evidence" / "performance.md"
SCENES = {
    "pair in the plane": "lundvall2004.toml",
    "helical pair over the face": "helical_gearbox/gearbox.toml",
    "idler between two gears": "gear_trains/idler.toml",
    "planetary set, floating sun": "planetary_sets/floating_sun.toml",
}
MOVES = 200
# Of a scene, after which no further move begins.
SECONDS = 200.0
# Moves before the first one that counts, in which reliefs and friction come in for the first time.
BEFORE = 10
# Of the page's fields those that leave the bodies as they are.
KEPT = "each.slides && !each.name.includes('profile_shift') && !each.name.includes('centre_distance')"
HEADINGS = ("scene", "moves", "first look drawn, ms", "answer, ms", "drawn, ms", "processor, ms")
WATCH = """
const plain = { ...told };
let timed = null;
told.result = message => {
  const there = performance.now();
  plain.result(message);
  if (timed && message.number > timed.number) {
    const drawn = performance.now() - timed.begun;
    if (message.first_look) timed.first ??= drawn;
    else { timed.done([timed.first ?? null, there - timed.begun, drawn]); timed = null; }
  }
};
told.failed = message => { plain.failed(message); timed?.done(null); timed = null; };
told.state = message => { plain.state(message); if (message.problems.length) { timed?.done(null); timed = null; } };
window.move = (slider, value) => new Promise(done => {
  timed = { number: live.number, begun: performance.now(), done };
  slider.value = value;
  slider.dispatchEvent(new Event("input"));
});
true
"""


def processor_seconds(process: int) -> float:
    """Of a process and of those that it has started, since they began."""
    ticks = 0
    for each in family(process):
        fields = Path(f"/proc/{each}/stat").read_text().rpartition(")")[2].split()
        ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


class Moves:
    """Random moves of the sliders of a page."""

    def __init__(self, browser: Browser):
        self._browser = browser
        self._drawn = random.Random(7)
        browser.value(WATCH)
        self.names = browser.value(f"live.state.controls.filter(each => {KEPT}).map(each => each.name)")

    def once(self) -> list[float | None] | None:
        """Milliseconds until a first look is drawn, the answer is there and drawn; None where it is a mistake."""
        own = slider(self._drawn.choice(self.names))
        place = self._drawn.random()
        value = f"Number({own}.min) + {place} * ({own}.max - {own}.min)"
        # A slider at its place asks for nothing.
        if self._browser.value(f"Math.abs({own}.value - ({value})) <= Number({own}.step)"):
            return self.once()
        return self._browser.value(f"move({own}, {value})")


def words(times: list[float]) -> str:
    """Median and worst, in whole milliseconds."""
    return f"{median(times):.0f}, {max(times):.0f}" if times else ""


def measured(file: Path, moves: int) -> list[str]:
    """The cells of a scene's row."""
    with TemporaryDirectory() as profile, served(file) as (address, process), Browser(profile, True) as browser:
        opened(browser, address)
        page = Moves(browser)
        for _ in range(BEFORE):
            page.once()
        begun = processor_seconds(process.pid)
        end = time.monotonic() + SECONDS
        found = []
        while len(found) < moves and time.monotonic() < end:
            found.append(page.once())
        spent = processor_seconds(process.pid) - begun
    counted = [each for each in found if each is not None]
    print(f"{file.name}: {len(found) - len(counted)} of {len(found)} moves were mistakes; {', '.join(page.names)}")
    looks, answers, drawings = ([each[n] for each in counted if each[n] is not None] for n in range(3))
    return [str(len(counted)), *map(words, (looks, answers, drawings)), f"{1000.0 * spent / len(found):.0f}"]


def main(moves: int = MOVES) -> None:
    lines = [[name, *measured(DEMOS / file, moves)] for name, file in SCENES.items()]
    found = "\n".join(table(list(HEADINGS), lines))
    print(found)
    write_section(PAGE, *markers("live moves"), found)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
