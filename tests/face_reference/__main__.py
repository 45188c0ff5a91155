"""Resolved three-dimensional reference: `python -m tests.face_reference` recomputes reference.csv.

Whole sections without the teeth far from the loaded ones, swept along the helix in eighteen-node wedges, bores held; contact on a grid of
pressures across the line of action and along the face, frictionless, forces along n. No code of the program's compliance is used but its call of MUMPS.
Inputs are in `cases.py`. In the plane (spur, phase 0.35) the small sizes give 0.03 % less approach than the program's plane route.
Only phase 0.35 is in the file so far, the helical pair on a coarser mesh (0.1 mm, ten layers). Line loads of single levels alternate where the load varies
along the face, since pressures stand at middles of layers too; peak pressures are not resolved. The helical pair is not checked by another model.
"""

from tests.face_reference.reference import computed, write

CASES = tuple((helix, phase) for helix in (0.0, 20.0) for phase in (0.15, 0.35, 0.55, 0.8, 0.9))


def main() -> None:
    """Compute the cases one after the other and write the file after each."""
    rows = []
    for case in CASES:
        rows += computed(*case)
        write(rows)


if __name__ == "__main__":
    main()
