"""``[accuracy]`` and ``[output]``: how a scene is computed, and results that not every run has.

None: the program chooses (``model.resolution``, ``model.face_resolution``) by the numbers at the top of this file.
"""

import re
from dataclasses import dataclass
from math import inf
from typing import Any, NamedTuple

from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.inputs.allowed import Allowed, Refused
from fenics_gears.inputs.fields import choice, declared, quantity, switch, whole_number
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.written import as_written


class Fineness(NamedTuple):
    """Flank elements in a Hertz half-width, and the fewest steps of a mesh cycle."""

    elements_per_half_width: float
    steps_per_mesh_cycle: int


# With three elements the paper's pair is within 0.15 % of its limit in the transmission error, 0.1 % in the peak
# pressure. Two would do except for rounded edges of a sixtieth of the module (2 %). Between steps curves are straight
# lines, 0.4 % off in L2. Over a face a step costs more. Helical pairs with an overlap ratio of 1 or more are smooth:
# with 50 steps five pairs are within 0.01 % of 200 in the mean transmission error, 0.5 % in its span, 0.06 % in
# K_Hbeta, 0.8 % in the peak pressure; friction loses 0.2 % less.
IN_THE_PLANE = Fineness(3.0, 200)
OVER_THE_FACE = Fineness(2.0, 100)
WITH_OVERLAP = Fineness(2.0, 50)
# Flank elements stay between these parts of the module, whatever the load: a vanishing load has no half-width.
FINEST_ELEMENT = 1.0 / 200.0
COARSEST_ELEMENT = 1.0 / 25.0
# Flank elements in a half-width that the peak pressure takes: with two it is 5 % off, with one a fifth. In the plane
# elements become finer than above for their sake, down to this part of the module.
RESOLVED = 2.0
FINEST_RESOLVED = 1.0 / 400.0
# Distance of contact nodes in flank elements, of second order; first-order elements cannot tell so many apart.
NODE_SPACING = 0.7
STEPS_PER_PERIOD = 20
MOST_STEPS_PER_MESH_CYCLE = 1000
# Largest elements of the body's section and largest layers of it over the common face, in normal modules. What they
# leave out near a load is added (contact.face_pairing, elasticity.face.near_field). Elements of 0.3 modules change the
# mean transmission error by 0.04 %, K_Hbeta and line loads away from edges by 0.5 %. Layers half as thick change them
# by 0.05 to 0.1 and 0.3 %.
SECTION_SIZE = 0.5
LAYER_THICKNESS = 2.5
FEWEST_LAYERS = 4
LARGEST_LAYER_TURN = 0.3
# Widest slices, in normal modules and by how far the line of contact of a helical pair moves along the path of contact
# within one, in base pitches. The mean transmission error is then 0.1 to 0.2 % too small (28 and 30 degrees). At a
# whole overlap its peak-to-peak value is too large by 0.15 % of the mean.
SLICE_WIDTH = 0.65
SLICE_RISE = 0.08
FEWEST_SLICES = 8

# Models of the mesh: the full contact of elastic flanks, and cheaper ones.
ELASTIC = "elastic"
RIGID_TEETH = "rigid teeth"
STIFFNESS_TABLE = "stiffness table"
ISO_6336 = "ISO 6336-1"
# For a tooth pair.
MOST_CONTACT_NODES = 1000


@dataclass(frozen=True, kw_only=True)
class Accuracy(Section):
    """``[accuracy]``: element sizes, contact nodes, time steps and the model of the mesh."""

    target: float | None = quantity(
        "0.05 % to 50 %",
        "1 %",
        meaning=(
            "largest numerical error of the transmission error, as a curve and peak to peak, in three dimensions also"
            " of line load and load factors; test runs find the cheapest settings that keep it"
        ),
        otherwise="each setting has its given or default value",
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
            f"1/{IN_THE_PLANE.elements_per_half_width:g} of the smallest Hertz half-width of one pair under the whole"
            f" load, 1/{OVER_THE_FACE.elements_per_half_width:g} of it in three-dimensional scenes, but"
            f" 1/{1.0 / FINEST_ELEMENT:g} to 1/{1.0 / COARSEST_ELEMENT:g} of the module; in the plane"
            f" {RESOLVED:g} in a narrower half-width, down to 1/{1.0 / FINEST_RESOLVED:g} of the module"
        ),
    )
    body_element_size: float | None = quantity(
        "1e-6 mm to 10 m",
        "1.3 mm",
        meaning="size of the largest elements in tooth and rim; those of fillets, coast flank and bore scale with it",
        otherwise=f"a part of the module for each order of element, in three-dimensional scenes {SECTION_SIZE:g}",
    )
    contact_length: float | None = quantity(
        "1e-6 mm to 10 m",
        "1.5 mm",
        meaning="length, across the line of action, over which the contact nodes of a tooth pair are spread",
        otherwise="beyond it the gap is larger than the deflection of the teeth",
    )
    contact_nodes: int | None = whole_number(
        2,
        MOST_CONTACT_NODES,
        20,
        meaning="number of contact nodes of a tooth pair",
        otherwise=f"a spacing of {NODE_SPACING:g} flank elements, or of 1 flank element of first order",
    )
    interpolation: str | None = choice(
        "averaged",
        "collocated",
        meaning="displacement of the flank at a contact node: averaged with the node's function, or that of the node",
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
            f"{IN_THE_PLANE.steps_per_mesh_cycle}, in three-dimensional scenes {OVER_THE_FACE.steps_per_mesh_cycle},"
            f" from an overlap ratio of 1 on {WITH_OVERLAP.steps_per_mesh_cycle};"
            f" with `[inertia]` {STEPS_PER_PERIOD} per period of the highest natural frequency, at most"
            f" {MOST_STEPS_PER_MESH_CYCLE}; with `[inertia]` and rigid flanks {MOST_STEPS_PER_MESH_CYCLE}"
        ),
    )
    slices: int | None = whole_number(
        2,
        1000,
        40,
        meaning=(
            "slices of the common face in which contact is resolved; of 8 or more, helical pairs have the outermost cut"
            " in two"
        ),
        otherwise=(
            f"{SLICE_WIDTH:g} modules wide, in helical pairs at most so that the line of contact moves by"
            f" {SLICE_RISE:g} of the base pitch along the path of contact within a slice; at least {FEWEST_SLICES}"
        ),
        over_face=True,
    )
    layers: int | None = whole_number(
        1,
        1000,
        12,
        meaning="layers of elements of either gear over the common face; a wider gear has more beyond it",
        otherwise=f"{LAYER_THICKNESS:g} modules thick; at least {FEWEST_LAYERS} layers",
        over_face=True,
    )
    condensation: str | None = choice(
        "once",
        "every step",
        meaning=(
            "each gear is meshed and condensed once; or both at every position, as in the paper, which is slow and"
            " serves for comparison"
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


_LAST_CYCLES = re.compile(r"last ([1-9]\d{0,6}) cycles?")


class AllowedContactFields(Allowed):
    """True, false or "last N cycles"."""

    def convert(self, value: Any) -> bool | float:
        """A number of mesh cycles, infinite for true; false as it is."""
        match = _LAST_CYCLES.fullmatch(value) if isinstance(value, str) else None
        if match is None and not isinstance(value, bool):
            raise Refused(f"is {as_written(value)}.")
        return int(match[1]) if match else value and inf


_CONTACT_FIELDS = AllowedContactFields(
    description='true, false, or "last N cycles", such as "last 3 cycles"',
    meaning=(
        "steps at which pressure, traction and place of contact nodes are stored, which stress pictures and pressure"
        " maps need: all, none, or those of the last mesh cycles. Replaces `motion.recorded_cycles`"
    ),
    otherwise="the last `motion.recorded_cycles`",
)


@dataclass(frozen=True)
class Output(Section):
    """``[output]``: results that take additional time or storage."""

    root_stress: bool = switch(
        meaning="stress along the fillets of the loaded teeth, and dynamic factors; see [stress](stress.md)"
    )
    # Of a scene that was read: whether there are any; how many cycles is in its motion.
    contact_fields: bool | float = declared(_CONTACT_FIELDS, True)
