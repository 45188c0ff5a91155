"""How finely a scene is computed: the scene's own `[accuracy]` values, and for the rest defaults derived from the
scene.

Flank elements and contact nodes come from the Hertz half-width at the whole load on one tooth pair and the smallest
relative radius on the path of contact. The contact window comes from the deflection that lets teeth touch off the line
of action, the time step from the mesh cycle and the drivetrain's frequencies.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import ceil, floor, log, pi, sqrt

import numpy as np

from fenics_gears.contact.interpolation import AVERAGED
from fenics_gears.contact.window import ContactGrid
from fenics_gears.dynamics.drivetrain import Drivetrain
from fenics_gears.dynamics.frequencies import natural_frequencies
from fenics_gears.elasticity.element_sizes import Discretisation
from fenics_gears.geometry.gear_data import PAIR_STIFFNESS, mean_youngs_modulus
from fenics_gears.geometry.involute import arc_length, roll_angle_at_arc_length
from fenics_gears.geometry.pair import GearPair
from fenics_gears.scene.accuracy import (
    COARSEST_ELEMENT,
    FINEST_ELEMENT,
    FINEST_RESOLVED,
    MOST_CONTACT_NODES,
    MOST_STEPS_PER_MESH_CYCLE,
    NODE_SPACING,
    RESOLVED,
    STEPS_PER_PERIOD,
)
from fenics_gears.scene.data import ISO_6336, Material, Scene

from .drivetrain import line_load, mesh_stiffness
from .modification import steepest_relief

DEFAULT_ELEMENT = "P2"
# Half of the rough stiffness of a pair bounds its deflection from above.
LEAST_PAIR_STIFFNESS = 0.5 * PAIR_STIFFNESS
SPARE_HALF_WIDTHS = 2.0
# Beyond this the window would reach past the tooth; the load that asks for it breaks teeth. In modules.
LONGEST_WINDOW = 3.0
# Where the mate's tip edge presses, along the flank from the start of its active profile, in modules. Of the paper's
# pair a longer part changes the transmission error by 0.01 % at 144 and at 575 N/mm, by 0.04 % at 1700 N/mm.
BELOW_MATE_TIP = 0.03
ABOVE_MATE_TIP = 0.18
# Contact nodes closer than this part of the distance of flank nodes are nearly dependent.
CLOSEST_NODES = 0.7
# Above this Poisson's ratio these first-order elements are more than 0.5 % too stiff on a tooth (2 % at 0.49, 8 % at
# 0.499).
LOCKING_ELEMENTS = ("P1", "Q1")
LOCKING_POISSONS_RATIO = 0.45
# How often gears are meshed and condensed: the fast route, and the paper's.
ONCE = "once"
EVERY_STEP = "every step"
# For rigid flanks: contact window in modules, and the number of nodes in it among which the first contact is searched.
RIGID = "rigid"
RIGID_WINDOW = 0.5
RIGID_NODES = 81
# Sizes that are given are rounded.
ROUNDED = 1.01
# Of the peak pressure with one element in a half-width; with two a quarter of it (`scene.accuracy.RESOLVED`).
ERROR_AT_ONE = 0.2
# Curves of fewer see little of the change from one tooth pair to two.
FEWEST_STEPS = 20


@dataclass(frozen=True)
class Resolution:
    """All of `[accuracy]`, decided: element name, element size (mm), contact grid, steps in a mesh cycle, condensation.

    `half_width`: the Hertz half-width (mm) that the defaults go by; zero without load. `body_element_size` (mm):
    largest in tooth and rim, None for the element's default. `elastic_teeth`: how far apart teeth feel each other (1:
    not at all), None for all. `mate_tips`: roll angles (rad) of pinion and wheel between which the mate's tip edge may
    press. `resolved`: elements in a half-width, of fewer of which the user is told.
    """

    element: str
    flank_element_size: float
    contact_grid: ContactGrid
    steps_per_mesh_cycle: int
    half_width: float
    condensation: str
    body_element_size: float | None = None
    elastic_teeth: int | None = None
    mate_tips: tuple[tuple[float, float] | None, tuple[float, float] | None] = (None, None)
    resolved: float = RESOLVED

    @property
    def order(self) -> int:
        """Of the element's shapes."""
        return 2 if self.element.endswith("2") else 1

    def discretisation(self, gear: int) -> Discretisation:
        """How the body of the pinion (0) or the wheel (1) is divided into finite elements."""
        return Discretisation(
            self.element, self.flank_element_size, self.body_element_size, self.elastic_teeth, self.mate_tips[gear]
        )


def hertz_half_width(line_load: float, relative_radius: float, plane_modulus: float) -> float:
    """Half-width (mm) of a Hertz line contact: sqrt(4 F' R / (pi E*)); Johnson, Contact Mechanics, 1985, eq. 4.43.
    `line_load` N/mm; `relative_radius` mm; `plane_modulus` MPa: E*, see `plane_contact_modulus`."""
    return sqrt(4.0 * line_load * relative_radius / (pi * plane_modulus))


def relative_radius(pair: GearPair, xi: float) -> float:
    """Relative radius of curvature (mm) of the flanks that touch at `xi` (mm from T1)."""
    return xi * (pair.line_of_action_length - xi) / pair.line_of_action_length


def plane_contact_modulus(scene: Scene) -> float:
    """E* (MPa) of the two gears: 1/E* is the sum of (1 - nu^2)/E."""
    first, second = scene.gears.materials
    if first == second:
        return 0.5 * first.youngs_modulus / (1.0 - first.poissons_ratio**2)
    return 1.0 / sum((1.0 - each.poissons_ratio**2) / each.youngs_modulus for each in (first, second))


def resolve(scene: Scene, pair: GearPair, drivetrain: Drivetrain, removal: tuple) -> Resolution:
    """Decide every accuracy setting: the scene's where it has one, else the default. `removal`: from the flanks, as of
    `modification.removals`."""
    if scene.tooth_elasticity is None:
        return _rigid_resolution(scene, drivetrain)
    if scene.accuracy.model == ISO_6336:
        steps = scene.accuracy.steps_per_mesh_cycle or _steps_per_mesh_cycle(scene, pair, drivetrain)
        return replace(_rigid_resolution(scene, drivetrain), element=ISO_6336, steps_per_mesh_cycle=steps)
    asked = scene.accuracy
    load = line_load(scene, pair)
    smallest = min(relative_radius(pair, xi) for xi in (pair.path_start, pair.path_end))
    half_width = hertz_half_width(load, smallest, plane_contact_modulus(scene))
    size = asked.flank_element_size or _flank_element_size(scene, half_width)
    shift = widest(pair) * steepest_relief(pair, removal)
    length = asked.contact_length or _contact_length(scene, pair, load, half_width, size, shift)
    spacing = NODE_SPACING * size if (asked.element or DEFAULT_ELEMENT).endswith("2") else size
    nodes = asked.contact_nodes or max(ceil(length / spacing), 2) + 1
    condensation = asked.condensation or ONCE
    inner = None
    if scene.three_dimensional:
        from .face_resolution import inner_length

        modulus = plane_contact_modulus(scene)
        half_width_of = partial(hertz_half_width, relative_radius=widest(pair), plane_modulus=modulus)
        needed = inner_length(scene, pair, load, half_width_of) + 2.0 * shift + 2.0 * spacing
        inner = in_steps(needed, length)
    return Resolution(
        element=asked.element or DEFAULT_ELEMENT,
        flank_element_size=size,
        contact_grid=ContactGrid(
            length, nodes, asked.interpolation or AVERAGED, closer_at_edges=condensation == ONCE, inner_length=inner
        ),
        steps_per_mesh_cycle=asked.steps_per_mesh_cycle or _steps_per_mesh_cycle(scene, pair, drivetrain),
        half_width=half_width,
        condensation=condensation,
        body_element_size=asked.body_element_size,
        elastic_teeth=asked.elastic_teeth,
        mate_tips=mate_tips(pair) if condensation == ONCE else (None, None),
    )


# Windows differ by this factor, so that loads and designs that are near to each other have the same contact nodes.
WINDOW_STEP = 2.0**0.25


def in_steps(wanted: float, whole: float) -> float:
    """The shortest of a row of lengths (mm) that is as long as `wanted`: the `whole` one, and each shorter by
    WINDOW_STEP.

    >>> in_steps(0.9, 1.0), round(in_steps(0.8, 1.0), 3)
    (1.0, 0.841)
    """
    return whole * WINDOW_STEP ** -max(floor(log(whole / wanted, WINDOW_STEP)), 0)


def _flank_element_size(scene: Scene, half_width: float) -> float:
    module = scene.gears.module
    wanted = half_width / scene.fineness.elements_per_half_width
    usual = float(np.clip(wanted, FINEST_ELEMENT * module, COARSEST_ELEMENT * module))
    if scene.three_dimensional or not half_width:
        return usual
    return min(usual, max(half_width / RESOLVED, FINEST_RESOLVED * module))


def mate_tips(pair: GearPair) -> tuple[tuple[float, float], tuple[float, float]]:
    """Roll angles (rad) of pinion and wheel between which the mate's tip edge may press on the flank: above the start
    of active profile, for a loaded pair touches with the edge alone before it enters and after it has left the path of
    contact."""
    ends = (pair.path_start, pair.line_of_action_length - pair.path_end)
    ranges = []
    for gear, end in zip(pair.gears, ends):
        arc = arc_length(gear.base_radius, end / gear.base_radius)
        around = np.array([arc - BELOW_MATE_TIP * gear.module, arc + ABOVE_MATE_TIP * gear.module])
        around = gear.sign * np.maximum(gear.sign * around, 0.0)
        first, last = roll_angle_at_arc_length(gear.base_radius, around)
        first, last = np.clip((first, last), *gear.roll_ends)
        ranges.append((float(first), float(last)))
    return ranges[0], ranges[1]


def _rigid_resolution(scene: Scene, drivetrain: Drivetrain) -> Resolution:
    """Rigid flanks touch at a point: a window in which it is found, and steps."""
    asked = scene.accuracy
    module = scene.gears.module
    steps = asked.steps_per_mesh_cycle or (
        scene.fineness.steps_per_mesh_cycle if drivetrain.mass is None else MOST_STEPS_PER_MESH_CYCLE
    )
    grid = ContactGrid(asked.contact_length or RIGID_WINDOW * module, asked.contact_nodes or RIGID_NODES)
    return Resolution(RIGID, 0.0, grid, steps, half_width=0.0, condensation=ONCE)


def _contact_length(
    scene: Scene, pair: GearPair, line_load: float, half_width: float, size: float, shift: float
) -> float:
    """Where teeth may touch off the line of action, mm: as far as their deflection lets them, or reliefs `shift` the
    contact (mm)."""
    deflection = line_load / (LEAST_PAIR_STIFFNESS * mean_youngs_modulus(scene.tooth_elasticity))
    reach = max(sqrt(2.0 * widest(pair) * deflection), shift)
    wanted = 2.0 * (reach + SPARE_HALF_WIDTHS * half_width + 2.0 * size)
    return min(wanted, LONGEST_WINDOW * scene.gears.module)


def widest(pair: GearPair) -> float:
    """The largest relative radius (mm) on the path of contact."""
    middle = min(max(0.5 * pair.line_of_action_length, pair.path_start), pair.path_end)
    return max(relative_radius(pair, xi) for xi in (pair.path_start, pair.path_end, middle))


def _steps_per_mesh_cycle(scene: Scene, pair: GearPair, drivetrain: Drivetrain) -> int:
    """Steps that resolve the mesh cycle and, with inertia, the drivetrain's highest frequency."""
    fewest = scene.fineness.steps_per_mesh_cycle
    if drivetrain.mass is None:
        return fewest
    frequencies = natural_frequencies(drivetrain, mesh_stiffness(scene, pair))
    highest = frequencies[frequencies <= drivetrain.right_up_to].max(initial=0.0)
    wanted = ceil(STEPS_PER_PERIOD * highest / scene.mesh_frequencies[0])
    return int(np.clip(wanted, fewest, MOST_STEPS_PER_MESH_CYCLE))


def resolution_warnings(resolution: Resolution) -> list[str]:
    """Sentences on settings too coarse for the contact or the mesh cycle, or contact nodes too close for the
    elements."""
    sentences: list[str] = []
    spacing = resolution.contact_grid.spacing
    if resolution.steps_per_mesh_cycle < FEWEST_STEPS:
        sentences.append(
            f"accuracy.steps_per_mesh_cycle is {resolution.steps_per_mesh_cycle}: the peak-to-peak transmission error"
            f" may miss an extreme; from {FEWEST_STEPS} on it is right within about 1%, without vibrations"
        )
    sentences += _unresolved(resolution)
    node_distance = resolution.flank_element_size / resolution.order
    if spacing < CLOSEST_NODES * node_distance:
        most = max(int(resolution.contact_grid.length / (CLOSEST_NODES * node_distance)) + 1, 2)
        finer = 0.99 * spacing * resolution.order / CLOSEST_NODES
        sentences.append(
            f"contact nodes stand {spacing:.3g} mm apart, the flank's own nodes {node_distance:.3g} mm: the pressure"
            f" oscillates; lower accuracy.contact_nodes to {most}, or accuracy.flank_element_size to"
            f' "{finer:.3g} mm"'
        )
    return sentences


def _unresolved(resolution: Resolution) -> list[str]:
    """Elements and contact nodes that are too large for the pressure in the half-width, or for the contact itself."""
    if not resolution.half_width:
        return []
    half_width = resolution.half_width
    grid = resolution.contact_grid
    sentences = []
    enough = half_width / resolution.resolved
    nodes = ceil(grid.length / enough) + 1
    more = (
        f"contact_nodes = {nodes}" if nodes <= MOST_CONTACT_NODES else "contact_nodes and contact_length of the default"
    )
    for name, size, remedy in (
        ("accuracy.flank_element_size", resolution.flank_element_size, f'flank_element_size = "{enough:.2g} mm"'),
        ("the spacing of accuracy.contact_nodes", grid.spacing, more),
    ):
        if size <= ROUNDED * enough:
            continue
        of = "half " if resolution.resolved == RESOLVED else f"{1.0 / resolution.resolved:.2g} of "
        harm = f"the peak contact pressure may be off by {100.0 * ERROR_AT_ONE * (size / half_width) ** 2:.0f} %"
        if size > half_width:
            of = ""
            harm = (
                "contact is not resolved; pressures are not right, and the transmission error may be off by per cents"
            )
        sentences.append(
            f"{name} is {size:.3g} mm, more than {of}the Hertz half-width of {half_width:.3g} mm at full load: {harm};"
            f" take accuracy.{remedy}"
        )
    return sentences


def locking_warnings(resolution: Resolution, materials: Sequence[Material] | None) -> list[str]:
    largest = max((material.poissons_ratio for material in materials or ()), default=-1.0)
    if resolution.element not in LOCKING_ELEMENTS or largest <= LOCKING_POISSONS_RATIO:
        return []
    return [
        f"accuracy.element {resolution.element} locks in a nearly incompressible material (poissons_ratio"
        f" {largest:g}, above {LOCKING_POISSONS_RATIO}): the teeth are too stiff; choose accuracy.element P2 or Q2"
    ]
