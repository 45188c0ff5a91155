"""Resolved three-dimensional reference: `python -m tests.face_reference` recomputes approach.csv and line_load.csv.
Sections without teeth far from the loaded ones, swept in eighteen-node wedges; contact on a grid of pressures,
frictionless, forces along n. Nothing of the program's compliance but its call of MUMPS. In the plane 0.03 % less
approach than the plane route; two levels of meshes differ by 0.1 % (plain) to 0.5 % (misaligned). A phase takes 25
to 280 s and 2 to 4 GB."""

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
    rows = []
    for case in CASES:
        rows += computed(*case, FINER.get(case, SMALL))
        write(rows)


if __name__ == "__main__":
    main()
