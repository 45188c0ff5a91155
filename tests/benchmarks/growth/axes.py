"""What grows: number of flank nodes, contact nodes, teeth, steps; and what theory expects of every stage.

Every point is the paper's pair, quasi-static with friction, but for what its axis changes.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from pathlib import Path

from tests.benchmarks.growth.axis import Axis, Theory, logarithmic
from tests.benchmarks.growth.face_axes import FACE_AXES

from fenics_gears.model.model import model_of
from fenics_gears.scene.data import Accuracy, GearData, Motion, Scene
from fenics_gears.scene.read import load_scene

SCENE = Path(__file__).parents[3] / "demos" / "lundvall2004.toml"
FLANK_SIZE, LENGTH, NODES, STEPS = 0.08, 3.2, 41, 20
# Contact nodes one flank element's node distance apart and more; finer flanks than this take gigabytes.
FINEST_FLANK = 0.0125


def paper() -> Scene:
    """The paper's scene without inertia, at settings that no axis but its own changes."""
    scene = load_scene(SCENE)
    accuracy = Accuracy(
        element="P2",
        flank_element_size=FLANK_SIZE,
        contact_length=LENGTH,
        contact_nodes=NODES,
        steps_per_mesh_cycle=STEPS,
    )
    return replace(scene, inertia=None, damping=None, motion=Motion(200.0, 2, 1), accuracy=accuracy)


def _accuracy(scene: Scene, **changes) -> Scene:
    return replace(scene, accuracy=replace(scene.accuracy, **changes))


def of_flank_elements(elements: float) -> Scene:
    """So many elements along the pinion's flank."""
    scene = paper()
    pinion = model_of(scene).pair.pinion
    length = 0.5 * pinion.base_radius * (pinion.tip_roll_angle**2 - pinion.form_roll_angle**2)
    return _accuracy(scene, flank_element_size=length / elements)


def of_contact_nodes(nodes: float) -> Scene:
    """So many nodes in a window, the flanks' elements as the program's defaults have them beside them, but not too fine
    to be held."""
    spacing = LENGTH / (nodes - 1)
    return _accuracy(
        paper(), contact_nodes=int(nodes), flank_element_size=max(spacing / 0.7, FINEST_FLANK), steps_per_mesh_cycle=8
    )


def of_steps(steps: float) -> Scene:
    """So many steps in a mesh cycle, of which one is marched."""
    scene = replace(paper(), motion=Motion(200.0, 1, 1))
    return _accuracy(scene, steps_per_mesh_cycle=int(steps))


def of_cycles(cycles: float) -> Scene:
    """The paper's drivetrain at 200 Hz, marched through so many mesh cycles, of which two are kept."""
    scene = replace(load_scene(SCENE), motion=Motion(200.0, int(cycles), min(int(cycles), 2)))
    return replace(scene, accuracy=paper().accuracy)


def of_teeth(teeth: float, solid: bool) -> Scene:
    """A pinion of 20 teeth and a wheel of so many; its rim is three modules thick, or it is solid down to 0.45 of its
    root radius."""
    scene, module = paper(), 4.5
    gears = replace(
        scene.gears, centre_distance=0.5 * module * (20 + teeth) + 0.1,
        pinion=_standard_gear(20, module, solid=True), wheel=_standard_gear(int(teeth), module, solid),
    )  # fmt: skip
    return replace(scene, gears=gears)


def _standard_gear(teeth: int, module: float, solid: bool) -> GearData:
    root = module * (teeth - 2.5)
    bore = 0.45 * root if solid else root - 6.0 * module
    return GearData(teeth, 0.0, module * (teeth + 2.0), root, bore, 0.38)


LINEAR, NONE = "proportional to their number", "does not depend on it"
AXES = (
    Axis(
        "flank nodes", "nodes along the pinion's flank (P2, two an element)", logarithmic(8, 800), of_flank_elements,
        "flank_nodes",
        {
            "mesh": Theory(1.0, "element sizes increase with the distance from the flank, so the number of layers is "
            "fixed and cells are proportional to n"),
            "assemble": Theory(1.0, "proportional to the number of cells"),
            "schur": Theory(2.0, "the n dofs of the flank are retained and the graded strip beside it has short "
            "separators, so fronts have n dofs, squared (N^1.5 holds for a square mesh without retained dofs)"),
            "ring": Theory(3.0, "dense inverse of the flank's stiffness"),
            "operators": Theory(2.0, "rows and columns of the flank's compliance at the contact nodes: the number of "
            "flank nodes in a fixed window, squared"),
            "solving": Theory(0.0, NONE),
            "condense arrays": Theory(2.0, "dense matrices of the flank's dofs"),
            "condense peak": Theory(2.0, "a dozen dense matrices of the flank's dofs at once"),
            "operators arrays": Theory(2.0, "the flank's compliance between every two teeth, stored a second time in "
            "the order of its use"),
        },
    ),
    Axis(
        "contact nodes", "contact nodes of a pair's window, flank elements finer along with them", logarithmic(6, 600),
        of_contact_nodes, "contact_nodes",
        {
            "operators": Theory(2.0, "every pair of contact nodes; for large n the rank by pivoted Cholesky, n^3/3"),
            "solving": Theory(2.0, "products with the rows of all nodes, n^2; for large n the dense system of the "
            "closed nodes, n^3"),
            "operators arrays": Theory(2.0, "every pair of contact nodes"),
        },
    ),
    Axis(
        "teeth of a rim", "teeth of the wheel, a rim three modules thick", logarithmic(20, 2000),
        lambda z: of_teeth(z, False), "teeth",
        {
            "mesh": Theory(0.0, "one sector, whatever the number of teeth"),
            "schur": Theory(0.0, "one sector"),
            "ring": Theory(0.0, "joined by doubling: log z"),
            "fourier": Theory(1.0, "a dense inverse for every other tooth"),
            "operators": Theory(0.0, NONE),
            "solving": Theory(0.0, NONE),
            "condense arrays": Theory(0.0, NONE),
        },
    ),
    Axis(
        "teeth of a solid gear", "teeth of the wheel, solid down to 0.45 of its root radius", logarithmic(20, 2000),
        lambda z: of_teeth(z, True), "teeth",
        {
            "mesh": Theory(1.0, "a sector becomes a wedge whose length is proportional to z, with elements as wide as "
            "the wedge, so cells are proportional to z"),
            "schur": Theory(2.0, "retained cuts have a number of nodes proportional to z beside a strip: fronts of as "
            "many dofs, squared"),
            "ring": Theory(3.0, "log z dense eliminations of a cut, whose nodes are proportional to z"),
            "fourier": Theory(4.0, "a dense inverse of a cut for every other tooth"),
            "operators": Theory(0.0, NONE),
            "solving": Theory(0.0, NONE),
            "condense arrays": Theory(2.0, "dense matrices of the cuts' dofs"),
        },
    ),
    Axis(
        "steps of a mesh cycle", "steps of a mesh cycle, one cycle marched", logarithmic(20, 2000), of_steps, "steps",
        {
            "operators": Theory(1.0, LINEAR),
            "solving": Theory(1.0, LINEAR),
            "operators arrays": Theory(1.0, "all positions of a mesh cycle are kept"),
        },
    ),
    Axis(
        "mesh cycles", "mesh cycles of 20 steps at 200 Hz", logarithmic(2, 400), of_cycles, "cycles",
        {
            "operators": Theory(0.0, "the positions of one mesh cycle are used for all cycles"),
            "solving": Theory(1.0, LINEAR),
            "operators arrays": Theory(0.0, "the positions of one mesh cycle are used for all cycles"),
            "solving arrays": Theory(0.0, "contact forces are kept for the last cycles only; the curves of the result "
            "are not counted here"),
        },
    ),
)  # fmt: skip


def axis_named(name: str) -> Axis:
    """The axis of a name."""
    return next(axis for axis in AXES + FACE_AXES if axis.name == name)


def those_of(names: Collection[str]) -> list[Axis]:
    """The axes of some names, in their order."""
    return [axis for axis in AXES + FACE_AXES if axis.name in names]
