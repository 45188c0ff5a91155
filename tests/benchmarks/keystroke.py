"""From keystroke to result: wall and CPU time of `gears --help`, of a refused scene, and of a run with warm caches, of
two checkouts in turn.

    python -m tests.benchmarks.keystroke [OTHER_CHECKOUT] [--turns 5] [--scene demos/lundvall2004.toml]

Prints medians of the turns. Both checkouts must be set up (`./gears --set-up-only`). CPU time is that of the launcher
and all that it starts.
"""

import argparse
import resource
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parents[2]


def calls(scene: Path, directory: Path) -> dict[str, list[str]]:
    """Arguments of the calls; the refused scene has a negative number of teeth."""
    wrong = directory / "wrong.toml"
    wrong.write_text(scene.read_text(encoding="utf-8").replace("teeth = ", "teeth = -", 1), encoding="utf-8")
    run = ["run", str(scene), "-o", str(directory / "result")]
    return {
        "--help": ["--help"],
        "refused scene": ["run", str(wrong)],
        "run": run,
        "run --no-pictures": [*run, "--no-pictures"],
    }


def measured(checkout: Path, arguments: list[str]) -> tuple[float, float]:
    """Wall and CPU seconds of one call."""
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run([checkout / "gears", *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wall, after = time.perf_counter() - begun, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("other", nargs="?", type=Path)
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--scene", type=Path, default=HERE / "demos" / "lundvall2004.toml")
    options = parser.parse_args()
    checkouts = [options.other.resolve(), HERE] if options.other else [HERE]
    with tempfile.TemporaryDirectory() as directory:
        named = calls(options.scene.resolve(), Path(directory))
        times = {(name, checkout): [] for name in named for checkout in checkouts}
        # The first turn fills caches.
        for turn in range(options.turns + 1):
            for (name, checkout), found in times.items():
                seconds = measured(checkout, named[name])
                found += [seconds] if turn else []
    for (name, checkout), found in times.items():
        wall, processor = (statistics.median(each) for each in zip(*found))
        print(f"{name:18} wall {wall:6.2f} s  CPU {processor:6.2f} s  {checkout}")


if __name__ == "__main__":
    main()
