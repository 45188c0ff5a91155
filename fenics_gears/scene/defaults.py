"""Numbers by which defaults of `[accuracy]` are made (`model.resolution`, `model.face_resolution`), and from which the
reference of scenes says what they are."""

from __future__ import annotations

from typing import NamedTuple


class Fineness(NamedTuple):
    """Flank elements in a Hertz half-width, and the fewest steps of a mesh cycle."""

    elements_per_half_width: float
    steps_per_mesh_cycle: int


# With three elements in a half-width the transmission error of the paper's pair is within 0.15 % of its limit, the peak
# pressure within 0.1 %. Two would do for sharp tips, but rounded edges of a sixtieth of the module would err by 2 %.
# Over a face there are many of them.
# Between steps curves are seen as straight lines, 0.4 % off in L2 for the transmission error of the paper's pair; its
# extremes are located between them. Over a face a step costs more, and curves of helical pairs are smoother.
IN_THE_PLANE, OVER_THE_FACE = Fineness(3.0, 200), Fineness(2.0, 100)
# Flank elements stay between these parts of the module, whatever the load: a vanishing load has no half-width.
FINEST_ELEMENT, COARSEST_ELEMENT = 1.0 / 200.0, 1.0 / 25.0
# Distance of contact nodes in flank elements, of second order; first-order elements cannot tell so many apart.
NODE_SPACING = 0.7
STEPS_PER_PERIOD = 20
MOST_STEPS_PER_MESH_CYCLE = 1000
# Largest elements of the body's section and largest layers of it over the common face, in normal modules.
SECTION_SIZE, LAYER_THICKNESS = 0.3, 0.7
FEWEST_LAYERS = 4
# Slices end where layers do: then a line load does not waver from slice to slice by what is of the layers alone.
SLICES_OF_A_LAYER = 2
# How far the line of contact of a helical pair moves along the path of contact within a layer, in base pitches. The
# mean transmission error is then within
# 0.2 % of its limit, and errs as the square of it (30 and 38 degrees, sharp tips); the peak-to-peak value within 2 %,
# also where a whole overlap leaves little of it (30 degrees: 0.9 %). Relieved tips come into contact gently: at 28
# degrees and 0.11 the mean errs by 0.05 %, the peak-to-peak value by 0.2 %.
# Tried: more slices in thicker layers. The mean errs by 0.1 % more, but line loads waver by 1 % again; slices that
# share the body's half layer do not waver, but their mean errs twice as much (30 degrees, 36 slices on 9 layers against
# 18).
LAYER_TURN, LAYER_TURN_RELIEVED = 0.06, 0.12
