"""What grows over the face: sections, layers, teeth and ranks of a body, slices of contact.

Every point is a standard pair of 20 and 30 teeth, module 3 mm, 15 degrees, 24 mm of face, quasi-static without
friction, but for what its axis changes. Bodies are the wheel's.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from math import cos, radians

from tests.benchmarks.growth.axis import Axis, Theory, logarithmic
from tests.benchmarks.third_dimension.pairs import MODULE, TEETH, scene_of, standard_gear, standard_pair

from fenics_gears.scene.data import Accuracy, Scene
from fenics_gears.scene.defaults import LAYER_THICKNESS, SECTION_SIZE

HELIX_ANGLE, FACE_WIDTH = radians(15.0), 24.0
# mm, of the body: coarse where something else grows.
SECTION, LAYERS = 1.8, 6
WINDOW, NODES, STEPS = 1.2, 13, 8
OF_BODY = {"unknowns": "unknowns", "condensed_unknowns": "condensed onto"}


def helical(teeth: float = TEETH[1], solid: bool = True, **accuracy) -> Scene:
    """The pair with a wheel of so many teeth, solid down to half its root diameter or a rim three modules thick;
    `accuracy`: what is not as on other axes."""
    gears, wheel = standard_pair(FACE_WIDTH, HELIX_ANGLE), standard_gear(int(teeth), HELIX_ANGLE, 0.5)
    if not solid:
        wheel = replace(wheel, bore_diameter=wheel.root_diameter - 6.0 * MODULE)
    gears = replace(gears, wheel=wheel, centre_distance=0.5 * (TEETH[0] + int(teeth)) * MODULE / cos(HELIX_ANGLE))
    given = Accuracy(
        contact_length=WINDOW,
        contact_nodes=NODES,
        steps_per_mesh_cycle=STEPS,
        body_element_size=SECTION,
        layers=LAYERS,
        slices=LAYERS,
    )
    return scene_of(gears, replace(given, **accuracy))


def of_section(size: float) -> Scene:
    """Elements of so many mm in the section, with one number of layers."""
    return helical(body_element_size=size)


def of_unknowns(size: float) -> Scene:
    """Elements of so many mm in the section, layers as thick in proportion as the program's defaults have them."""
    return helical(body_element_size=size, layers=round(FACE_WIDTH * SECTION_SIZE / (LAYER_THICKNESS * size)))


def of_layers(layers: float) -> Scene:
    """So many layers over the face."""
    return helical(layers=int(layers))


def of_slices(slices: float) -> Scene:
    """So many slices over the face; bodies stay."""
    return helical(slices=int(slices))


def of_ranks(ranks: float) -> Scene:
    """The same body on any number of ranks, of the default sections, 15 layers."""
    return helical(body_element_size=0.3 * MODULE, layers=15)


CUTS = "dense matrices of flank and cuts"
SHARED = "shared out between the ranks"
FACE_AXES = (
    Axis(
        "unknowns of a body", "unknowns of the wheel's sector, elements smaller in all directions",
        (2.4, 1.6, 1.1, 0.8, 0.6, 0.47, 0.35, 0.27), of_unknowns, "unknowns",
        {
            "mesh": Theory(2 / 3, "cells of one section"),
            "assemble": Theory(1.0, "proportional to the number of elements"),
            "schur": Theory(2.0, "nested dissection in three dimensions: the largest fronts have N^(2/3) dofs, as the "
            "flank and cuts that are retained, cubed"),
            "ring": Theory(2.0, "dense inverses of a cut with N^(2/3) dofs, one for every other tooth"),
            "factor operations": Theory(2.0, "the same without what the machine makes of it"),
            "factor arrays": Theory(4 / 3, "the largest fronts, squared"),
            "condense arrays": Theory(4 / 3, CUTS),
            "condense peak": Theory(4 / 3, CUTS + ", and the factor"),
        },
        "body", {"layers": "layers", "condensed_unknowns": "condensed onto"},
    ),
    Axis(
        "nodes of a section", "nodes of the section that is swept, 6 layers", (1.8, 0.9, 0.6, 0.4, 0.27, 0.18, 0.13),
        of_section, "section_nodes",
        {
            "mesh": Theory(1.0, "proportional to the number of cells"),
            "assemble": Theory(1.0, "proportional to the number of cells"),
            "schur": Theory(1.5, "nested dissection of the section: separators have the square root of its nodes, a "
            "fixed number of heights each; so have the cuts and the flank that are retained"),
            "factor arrays": Theory(1.0, "n log n"),
            "ring": Theory(1.5, "a dense inverse of a cut for every other tooth; a cut has the square root of the "
            "section's nodes"),
            "condense arrays": Theory(1.0, CUTS),
            "condense peak": Theory(1.0, "factor, n log n, and dense matrices of flank and cuts"),
        },
        "body", OF_BODY,
    ),
    Axis(
        "layers", "layers of elements over the face", (1.0, 2.0, 4.0, 8.0, 14.0, 24.0, 40.0), of_layers, "layers",
        {
            "mesh": Theory(0.0, "one section"),
            "assemble": Theory(1.0, "proportional to the number of layers"),
            "factor arrays": Theory(2.0, "fronts of all layers, squared"),
            "schur": Theory(3.0, "fronts of as many dofs as flank and cuts have, which go through all layers"),
            "ring": Theory(3.0, "dense inverses of a cut, whose nodes are proportional to the layers"),
            "condense arrays": Theory(2.0, CUTS),
            "condense peak": Theory(2.0, "dense matrices of flank and cuts; the factor beside them grows by less"),
        },
        "body", OF_BODY,
    ),
    Axis(
        "teeth of a face body's rim", "teeth of the wheel, a rim three modules thick", logarithmic(20, 2000),
        partial(helical, solid=False), "teeth",
        {
            "mesh": Theory(0.0, "one sector, whatever the number of teeth"),
            "assemble": Theory(0.0, "one sector"),
            "schur": Theory(0.0, "one sector"),
            "ring": Theory(1.0, "a dense inverse for every other tooth: bodies over the face are not joined by "
            "doubling"),
            "condense arrays": Theory(0.0, "does not depend on it"),
        },
        "body", OF_BODY,
    ),
    Axis(
        "teeth of a solid face body", "teeth of the wheel, solid down to half its root diameter",
        logarithmic(20, 300, 6), partial(helical, solid=True), "teeth",
        {
            "mesh": Theory(1.0, "a sector becomes a wedge whose length is proportional to z, with elements as wide as "
            "the wedge"),
            "schur": Theory(2.0, "retained cuts have a number of nodes proportional to z beside a strip"),
            "ring": Theory(4.0, "a dense inverse of a cut, whose nodes are proportional to z, for every other tooth"),
            "condense arrays": Theory(2.0, "dense matrices of the cuts"),
        },
        "body", OF_BODY,
    ),
    Axis(
        "slices", "slices of the common face", (3.0, 6.0, 12.0, 24.0, 48.0, 96.0, 192.0), of_slices, "slices",
        {
            "operators": Theory(2.0, "every pair of contact nodes of all slices"),
            "solving": Theory(2.0, "products with the rows of all nodes, n^2; for large n the dense system of the "
            "closed nodes, n^3"),
            "operators arrays": Theory(2.0, "every pair of contact nodes"),
        },
        "contact", {"most_contact_rows": "contact nodes of all slices", "closed_nodes": "closed ones"},
    ),
    Axis(
        "ranks", "ranks that share a body of 15 layers", (1.0, 2.0), of_ranks, "ranks",
        {
            "assemble": Theory(-1.0, SHARED),
            "schur": Theory(-1.0, SHARED + ", which have a half of the sector each"),
            "ring": Theory(-1.0, "harmonics " + SHARED),
            "clock": Theory(-1.0, SHARED),
            "condense peak": Theory(-1.0, "the factor is " + SHARED + ", each has all dense matrices of flank and "
            "cuts"),
        },
        "body", OF_BODY,
    ),
)  # fmt: skip
