"""``[accuracy]``: how a scene is computed. Where a value is None the program chooses it (``model.resolution``)."""

from __future__ import annotations

from dataclasses import dataclass

from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.inputs.fields import choice, quantity, whole_number
from fenics_gears.inputs.section import Section
from fenics_gears.scene import defaults

# Models of the mesh: the full contact of elastic flanks, and cheaper ones.
ELASTIC, RIGID_TEETH, STIFFNESS_TABLE, ISO_6336 = "elastic", "rigid teeth", "stiffness table", "ISO 6336-1"
# For a tooth pair.
MOST_CONTACT_NODES = 1000


@dataclass(frozen=True, kw_only=True)
class Accuracy(Section):
    """``[accuracy]``: element sizes, contact nodes, time steps and the model of the mesh. Fields that are left out are
    derived from the scene."""

    target: float | None = quantity(
        "0.05 % to 50 %",
        "1 %",
        meaning=(
            "largest numerical error allowed in the curve and in the peak-to-peak value of the transmission error, in"
            " three dimensions also in line load and load factors; test runs find the cheapest settings of this section"
            " that keep it"
        ),
        otherwise="no test runs; each setting has its given or default value",
    )
    element: str | None = choice(
        *ELEMENTS,
        meaning=(
            "finite element: triangle (P) or quadrilateral (Q) of first or second order; `Q1 incompatible`, with"
            " Wilson's incompatible modes, is the paper's"
        ),
        otherwise="`P2`",
    )
    flank_element_size: float | None = quantity(
        "1e-6 mm to 1 m",
        "0.08 mm",
        meaning="size of the elements on the flank",
        otherwise=(
            f"1/{defaults.IN_THE_PLANE.elements_per_half_width:g} of the smallest Hertz half-width of one pair under"
            " the whole load,"
            f" 1/{defaults.OVER_THE_FACE.elements_per_half_width:g} of it in three-dimensional scenes, but at least"
            f" 1/{1.0 / defaults.FINEST_ELEMENT:g} and at most 1/{1.0 / defaults.COARSEST_ELEMENT:g} of the module"
        ),
    )
    body_element_size: float | None = quantity(
        "1e-6 mm to 10 m",
        "1.3 mm",
        meaning=(
            "size of the largest elements in tooth and rim; the elements of fillets, coast flank and bore are scaled"
            " with it"
        ),
        otherwise=(
            "a fixed fraction of the module for each order of element, in three-dimensional scenes"
            f" {defaults.SECTION_SIZE:g} modules"
        ),
    )
    contact_length: float | None = quantity(
        "1e-6 mm to 10 m",
        "1.5 mm",
        meaning="length, across the line of action, over which the contact nodes of a tooth pair are spread",
        otherwise="so long that beyond it the gap is larger than the deflection of the teeth",
    )
    contact_nodes: int | None = whole_number(
        2,
        MOST_CONTACT_NODES,
        20,
        meaning="number of contact nodes of a tooth pair",
        otherwise=f"a spacing of {defaults.NODE_SPACING:g} flank elements, or of 1 flank element of first order",
    )
    interpolation: str | None = choice(
        "averaged",
        "collocated",
        meaning=(
            "displacement of the flank at a contact node: averaged with the node's own function, or taken at the node"
            " alone (collocation)"
        ),
        otherwise="`averaged`",
    )
    elastic_teeth: int | None = whole_number(
        1,
        1000,
        2,
        meaning="teeth that the load on a tooth deflects: 1 that tooth alone, 2 its neighbours too, and so on",
        otherwise="all teeth that can be loaded at the same time",
    )
    steps_per_mesh_cycle: int | None = whole_number(
        2,
        1_000_000,
        100,
        meaning="time steps of a mesh cycle",
        otherwise=(
            f"{defaults.IN_THE_PLANE.steps_per_mesh_cycle}, in three-dimensional scenes"
            f" {defaults.OVER_THE_FACE.steps_per_mesh_cycle};"
            f" with `[inertia]` as many as give the highest natural frequency {defaults.STEPS_PER_PERIOD} steps per"
            f" period, at most {defaults.MOST_STEPS_PER_MESH_CYCLE}; with `[inertia]` and rigid flanks"
            f" {defaults.MOST_STEPS_PER_MESH_CYCLE}"
        ),
    )
    slices: int | None = whole_number(
        2,
        1000,
        40,
        meaning=(
            "slices of the common face in which contact is resolved, best a multiple of `layers`; the"
            " outermost of helical pairs are cut in two, if there are 8 or more; of three-dimensional scenes"
        ),
        otherwise=(
            f"{defaults.SLICES_OF_A_LAYER} for each of the default layers; with `layers`, the multiple of it"
            " nearest to that number"
        ),
        over_face=True,
    )
    layers: int | None = whole_number(
        1,
        1000,
        12,
        meaning=(
            "layers of elements of either gear over the common face, of which four or more have the outermost"
            " cut in two; a gear that is wider has more beyond it; of three-dimensional scenes"
        ),
        otherwise=(
            f"a thickness of {defaults.LAYER_THICKNESS:g} modules, in helical pairs at most so thick that the"
            " line of"
            f" contact moves by {defaults.LAYER_TURN:g} of the base pitch along the path of contact within a layer,"
            f" {defaults.LAYER_TURN_RELIEVED:g} where both gears have tip relief; at least {defaults.FEWEST_LAYERS}"
            f" layers. With `slices`, {defaults.SLICES_OF_A_LAYER} slices to a layer or fewer, if possible so that"
            " slices end where layers do"
        ),
        over_face=True,
    )
    condensation: str | None = choice(
        "once",
        "every step",
        meaning=(
            "`once`: each gear is meshed and condensed once; `every step`: both gears are meshed anew at every"
            " position, as in the paper, which is slow and serves for comparison"
        ),
        otherwise="`once`",
    )
    model: str | None = choice(
        ELASTIC,
        RIGID_TEETH,
        STIFFNESS_TABLE,
        ISO_6336,
        meaning=(
            "model of the tooth contact: elastic contact, rigid teeth, a table of the elastic mesh stiffness over phase"
            " and load (quasi-static, frictionless), or c' and c_gamma of ISO 6336-1"
        ),
        otherwise="`elastic`",
    )
