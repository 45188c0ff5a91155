"""Measure rows of docs/evidence/index.md and write the page.

`python -m tests.evidence [NAMES] [--python PYTHON of other programs] [--draw from the numbers kept]`: a part whose
program is not there keeps its numbers; the exit code is then 1.
"""

import argparse
import subprocess
import sys
import time

from tests.benchmarks.marked_section import markers, write_section
from tests.evidence.kept import keep
from tests.evidence.page import PAGE, README, page, readme_rows
from tests.evidence.parts import PARTS


def main() -> int:
    by_name = {part.name: part for part in PARTS}
    parser = argparse.ArgumentParser(prog="python -m tests.evidence", description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", choices=[[], *by_name], help=", ".join(by_name))
    parser.add_argument("--python", default=sys.executable, help="one that has other programs")
    parser.add_argument("--draw", action="store_true", help="write the page from the numbers kept")
    given = parser.parse_args()
    failed = 0
    for name in [] if given.draw else given.names or by_name:
        part, begun = by_name[name], time.process_time()
        try:
            numbers = part.measure(given.python)
        except (SystemExit, OSError, subprocess.CalledProcessError) as missing:
            if not part.needs:
                raise
            failed = 1
            print(f"{name}: {part.needs} did not answer, the numbers stay: {str(missing)[:200]}", file=sys.stderr)
            continue
        if part.read is None:
            keep(part, numbers, PARTS)
        # A part may measure more than has a row.
        for row, claim in part.claims.items():
            pair = numbers[row]
            said = "" if claim.holds(*pair) else "   OUTSIDE"
            print(f"{name}, {row}: {pair[0]:.8g} {pair[1]:.8g} {claim.difference(*pair):+.2e}{said}")
        print(f"{name}: {time.process_time() - begun:.0f} s of processor time", flush=True)
    PAGE.write_text(page(PARTS), encoding="utf-8")
    write_section(README, *markers("evidence"), readme_rows(PARTS))
    return failed


if __name__ == "__main__":
    sys.exit(main())
