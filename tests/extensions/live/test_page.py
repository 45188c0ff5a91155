"""The page in a browser, and who may open it."""

import random
import re
import resource
import urllib.error
import urllib.request
from pathlib import Path

import pytest
from tests.extensions.live.conftest import PAIR, SET, TRAIN
from tests.extensions.live.driven import family, moved, opened, served, slider
from tests.extensions.report.browser import CHROMIUM, Browser

_needs_browser = pytest.mark.skipif(CHROMIUM is None, reason="no chromium")
DEPTH = "tip_relief.wheel.depth"
OF_PAIR = DEPTH, "tip_relief.pinion.depth", "root_relief.wheel.depth", "load.wheel_torque", "friction.coefficient"
OF_TRAIN = (
    "stages.idler.tip_relief.wheel.depth", "stages.idler.tip_relief.pinion.depth", "load.output_torque",
    "stages.idler.gears.2.profile_shift", "friction.coefficient",
)  # fmt: skip
OF_SET = (
    "stages.set.sun_mesh.tip_relief.depth", "stages.set.ring_mesh.tip_relief.wheel.depth", "load.input_torque",
    "friction.coefficient",
)  # fmt: skip
# Of these each fifth is waited for, the others are given up for the next.
WAITED_FOR = 5
MEBIBYTE = 2**20


@pytest.fixture
def page(tmp_path, request):
    """The address of a page that runs until the test ends, which Ctrl-C ends without a word; and its process."""
    file = tmp_path / "pair.toml"
    file.write_text(getattr(request, "param", PAIR))
    with served(file) as found:
        yield found
    assert [each.name for each in tmp_path.iterdir() if not each.name.startswith("profile")] == ["pair.toml"]


def refused(address, **headers):
    with pytest.raises(urllib.error.HTTPError) as error:
        urllib.request.urlopen(urllib.request.Request(address, headers=headers), timeout=30)
    return error.value.code


@pytest.mark.nightly
def test_nobody_gets_in_without_the_token(page):
    """Neither another user of this machine nor another page of the browser."""
    address, _ = page
    host = re.fullmatch(r"(http://127\.0\.0\.1:\d+)/[\w-]{32}/", address)[1]
    for path in ("/", "/socket", "/scene.toml", "/wrong/result", "/wrong/"):
        assert refused(host + path) == 403
    assert refused(f"{address}socket", Origin="http://elsewhere.example") == 403
    with urllib.request.urlopen(f"{address}scene.toml", timeout=30) as answer:
        assert answer.status == 200 and b"[gears]" in answer.read()


def resident(process):
    """Memory (bytes) of a process and of those that it has started."""
    pages = (int(Path(f"/proc/{each}/statm").read_text().split()[1]) for each in family(process))
    return sum(pages) * resource.getpagesize()


def peak(browser):
    """Of the transmission error that is drawn, as the caption has it."""
    caption = "document.querySelector('#charts figcaption').textContent"
    return float(re.search(r"peak to peak ([\d.]+)", browser.value(caption))[1])


@_needs_browser
@pytest.mark.nightly
def test_sliders_curves_mistakes_and_two_browsers(page, tmp_path):
    """What a designer does: move, see, err, take back; what one browser changes the other shows."""
    address, _ = page
    with Browser(tmp_path / "profile", True) as one, Browser(tmp_path / "profile2", True) as other:
        opened(one, address)
        opened(other, address)
        before = peak(one)
        moved(one, DEPTH, 20)
        one.wait("live.state.changed && live.drawn === live.number")
        curve = "document.querySelector('#charts .js-plotly-plot').data"
        assert peak(one) != before and one.value(f"{curve}.map(each => each.name)")[0] == "start"
        other.wait(f"live.drawn === {one.value('live.number')}")
        assert peak(other) == peak(one)
        text = f"document.getElementById('field {DEPTH}')"
        one.value(f"{text}.value = '-3 um', {text}.dispatchEvent(new Event('change')), true")
        one.wait("live.state.problems.length > 0")
        field = one.value(f"{text}.closest('.field').querySelector('.mistake').textContent")
        assert "is negative" in field
        one.value("document.getElementById('start').click()")
        one.wait("!live.state.changed && live.drawn === live.number")
        assert peak(one) == before
        asked = {each.split("/")[2].split(":")[0] for each in one.requests if each.startswith("http")}
        assert asked == {"127.0.0.1"}


@_needs_browser
@pytest.mark.nightly
@pytest.mark.parametrize("page", [TRAIN], indirect=True)
def test_a_train_in_the_browser(page, tmp_path):
    """Gears are drawn, a slider of a listed gear's mesh moves the curve of the whole, and undo brings it back."""
    address, _ = page
    with Browser(tmp_path / "profile", True) as browser:
        opened(browser, address)
        before = peak(browser)
        assert browser.value("turning.pair.gears.length") == 3 and browser.value("element('flank').hidden")
        moved(browser, "stages.idler.tip_relief.wheel.depth", 20)
        browser.wait("live.state.changed && live.drawn === live.number")
        assert peak(browser) != before
        browser.value("document.getElementById('undo').click()")
        browser.wait("!live.state.changed && live.drawn === live.number")
        assert peak(browser) == before and not browser.console


@_needs_browser
@pytest.mark.nightly
@pytest.mark.parametrize(
    ("page", "names", "moves"),
    [(PAIR, OF_PAIR, 1000), (TRAIN, OF_TRAIN, 200), (SET, OF_SET, 200)],
    indirect=["page"],
    ids=["pair", "train", "set"],
)
def test_random_moves(page, names, moves, tmp_path):
    """No stuck page, no growing memory: the browser's and the program's after the second half are those after the
    first."""
    address, process = page
    drawn = random.Random(7)
    settled = "live.state.number === live.number && (live.drawn === live.number || live.state.problems.length > 0)"
    used = "(performance.memory.usedJSHeapSize)"
    with Browser(tmp_path / "profile", True) as browser:
        opened(browser, address)
        heaps = []
        sizes = []
        for _ in range(2):
            for number in range(moves // 2):
                name = drawn.choice(names)
                low, high = (float(browser.value(f"{slider(name)}.{each}")) for each in ("min", "max"))
                moved(browser, name, drawn.uniform(low, high))
                if number % WAITED_FOR == 0:
                    browser.wait(settled)
            browser.wait(settled)
            heaps.append(browser.value(used))
            sizes.append(resident(process.pid))
        moved(browser, names[0], 11)
        browser.wait("live.drawn === live.number")
        assert sizes[1] < 1.2 * sizes[0] + 100 * MEBIBYTE
        assert not browser.console
        assert heaps[1] < heaps[0] + 60 * MEBIBYTE
        assert browser.value("document.querySelectorAll('#charts figure').length") < 20
        assert browser.value("document.getElementById('trouble').hidden")
