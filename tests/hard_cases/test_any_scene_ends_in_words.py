"""Row 26 on whole scenes of all sections, from modules of 0.2 to 60 mm, at loads from nothing to absurd."""

import secrets
import subprocess
import sys
from collections import Counter

import pytest
from tests.docs.blocks import ROOT

SECONDS, PROCESSES = 600, 2


@pytest.mark.nightly
def test_any_scene_ends_with_a_result_or_in_words(tmp_path, measured):
    """A user's expectation: a result of finite numbers, or a typed error with its exit code; nothing is refused that
    `gears check` accepts; one in ten may be stopped, because a fallback takes long. Each process says its seed, with
    which it draws the same scenes again."""
    runs = []
    for _ in range(PROCESSES):
        seed = str(secrets.randbelow(10**6))
        folder = tmp_path / seed
        folder.mkdir()
        words = [sys.executable, "-m", "tests.hard_cases.random_runs", seed, str(SECONDS), str(folder)]
        with open(folder / "said.txt", "w") as said, open(folder / "errors.txt", "w") as errors:
            runs.append((folder, subprocess.Popen(words, cwd=ROOT, stdout=said, stderr=errors)))
    ended, wrong = Counter(), []
    for folder, process in runs:
        code = process.wait(timeout=4 * SECONDS)
        ended.update(line.partition(" (")[0] for line in (folder / "said.txt").read_text().splitlines())
        wrong += [file.read_text() + file.with_suffix(".toml").read_text() for file in folder.glob("[0-9]*.txt")]
        if code:
            left = [file.read_text() for file in folder.glob("*.toml")]
            wrong.append(
                "\n".join([f"seed {folder.name}: exit code {code}", *left, (folder / "errors.txt").read_text()])
            )
    words = ", ".join(f"{count} {how}" for how, count in ended.most_common())
    measured("whole scenes of all sections at random", words, "a result or a typed error", row=26)
    stopped = sum(count for how, count in ended.items() if how.startswith("stopped"))
    assert sum(ended.values()) > max(20, 10 * stopped) and not wrong, "\n\n".join([words, *wrong])
