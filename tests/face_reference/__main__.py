"""Resolved three-dimensional reference: `python -m tests.face_reference` recomputes reference.csv.

Whole sections without the teeth far from the loaded ones, swept along the helix in eighteen-node wedges, bores held; contact on a grid of
pressures across the line of action and along the face, frictionless, forces along n. No code of the program's compliance is used but its call of MUMPS.
Inputs are in `cases.py`. In the plane (spur, phase 0.35) the small sizes give 0.03 % less approach than the program's plane route.
Two levels of meshes differ by 0.1 % (plain) to 0.5 % (misaligned) in the approach. Peak pressures are not resolved. A phase takes 25 to 120 s and 2 GB, phase 0.35
with layers half as thick 140 to 280 s.
"""

from tests.face_reference.reference import SMALL, THIN_LAYERS, computed, write

CASES = tuple((helix, phase) for phase in (0.35, 0.1, 0.6, 0.85, 0.97) for helix in (0.0, 20.0))
# The phase that is computed with thinner layers, for its line loads.
FINER = 0.35


def main() -> None:
    """Compute the cases one after the other and write the file after each."""
    rows = []
    for case in CASES:
        rows += computed(*case, THIN_LAYERS if case[1] == FINER else SMALL)
        write(rows)


if __name__ == "__main__":
    main()
