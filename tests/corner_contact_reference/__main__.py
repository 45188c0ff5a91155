"""Regenerates reference.csv: `python -m tests.corner_contact_reference [--only-missing]` (Debian's calculix-ccx; an
hour)."""

import argparse
import tempfile
from pathlib import Path

from tests.corner_contact_reference.reference import CASES, Row, computed, paper_pair, read, write


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only-missing", action="store_true")
    known: list[Row] = read() if parser.parse_args().only_missing else []
    scene, pair = paper_pair()
    rows = list(known)
    for case in [case for case in CASES if case not in {row.case for row in known}]:
        with tempfile.TemporaryDirectory() as folder:
            rows.append(computed(scene, pair, case, Path(folder)))
        print(rows[-1], flush=True)
        write(rows)


if __name__ == "__main__":
    main()
