"""`gears live` as a user has it: its process, its page in a browser, and sliders that are moved there."""

import signal
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.extensions.report.browser import Browser
from tests.programs import command, environment


@contextmanager
def served(scene: Path) -> Iterator[tuple[str, subprocess.Popen]]:
    """The address of a page, and its process, which Ctrl-C ends without a word."""
    call = command("live", scene, "--no-browser")
    with subprocess.Popen(
        call, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment()
    ) as process:
        try:
            yield process.stdout.readline().strip(), process
        finally:
            process.send_signal(signal.SIGINT)
            try:
                _, said = process.communicate(timeout=60)
            except subprocess.TimeoutExpired:
                process.kill()
                raise
    assert process.returncode == 0 and said == "", said


def opened(browser: Browser, address: str) -> None:
    """Show the page, and wait for its first result."""
    browser.visit(address, 1500, 1100)
    browser.wait("window.live && live.result !== null && !live.result.first_look")


def family(process: int) -> list[int]:
    """A process and those that it has started."""
    children = Path(f"/proc/{process}/task/{process}/children").read_text().split()
    return [process, *(each for child in children for each in family(int(child)))]


def slider(name: str) -> str:
    """The JavaScript expression of a slider."""
    return f"document.querySelector('input[type=range][data-name=\"{name}\"]')"


def moved(browser: Browser, name: str, value: float) -> None:
    """A slider, as by hand."""
    own = slider(name)
    browser.value(f"{own}.value = {value}, {own}.dispatchEvent(new Event('input')), true")
