"""Resolved three-dimensional reference: `python -m tests.face_reference` recomputes approach.csv and line_load.csv.

Whole sections without the teeth far from the loaded ones, swept along the helix in eighteen-node wedges, bores held;
contact on a grid of pressures across the line of action and along the face, frictionless, forces along n. No code of
the program's compliance is used but its call of MUMPS. Inputs are in `cases.py`. In the plane (spur, phase 0.35) the
small sizes give 0.03 % less approach than the program's plane route. Two levels of meshes differ by 0.1 % (plain) to
0.5 % (misaligned) in the approach. A phase takes 25 to 120 s and 2 GB, with more
layers 140 to 280 s and up to 4 GB.
"""

from tests.face_reference.reference import SMALL, THIN_ASIDE, THIN_LAYERS, THIN_MIDDLE, computed, write

CASES = tuple((helix, phase) for phase in (0.35, 0.1, 0.6, 0.85, 0.97) for helix in (0.0, 20.0))
# Cases that are computed with thinner layers, for their line loads.
FINER = {
    (0.0, 0.35): THIN_LAYERS,
    (20.0, 0.35): THIN_LAYERS,
    (20.0, 0.6): THIN_ASIDE,
    (20.0, 0.85): THIN_ASIDE,
    (20.0, 0.97): THIN_MIDDLE,
}


def main() -> None:
    """Compute the cases one after the other and write the file after each."""
    rows = []
    for case in CASES:
        rows += computed(*case, FINER.get(case, SMALL))
        write(rows)


if __name__ == "__main__":
    main()
