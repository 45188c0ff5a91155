"""Stiffness of an elastic mesh, and its largest pressure with where that is.

Deflection delta (mm): overlap of the undeformed flanks along the line of action. Secant stiffness F/delta (N/mm) is the
mesh stiffness of ISO 6336-1. The tangent dF/ddelta is the spring of small vibrations: closed contact nodes stay closed
and friction forces constant.

Place alone decides which contact nodes are near an edge or a kink of the flanks, where linear elasticity has infinite
pressure. These change the pressure about as far as half of the contact is wide (Johnson, Contact Mechanics, 1985, 5.1
to 5.3). So lengths are counted in the Hertz half-width under full load on one pair, from either side along the flank.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numba import njit

from fenics_gears.contact.addresses import form_rows
from fenics_gears.contact.laws import NO_FORCE, OPEN, Tolerance
from fenics_gears.contact.mixed_form import (
    Iterate,
    StepEquations,
    product,
    put_entries,
    solve_factored,
    solved,
    system_of,
)
from fenics_gears.dynamics.steps import Steps, forces_at, in_block, nodes_at, operator_at
from fenics_gears.model.model import Model
from fenics_gears.model.modification import kinks

from .face_ends import in_end_zone
from .side_by_side import Layouts, SideBySide


@njit(cache=True)
def mesh_stiffness(contact, status, forces, coordinates, faces):
    """Secant and tangent stiffness, N/mm, of the drive or coast flanks, whichever carry more, and how many tooth pairs
    carry there. All are zero where nothing touches; the secant is not a number where the flanks do not approach.

    `contact`: the `addresses.Arrays` of elastic flanks; `faces` (2, f, f): stiffness and flexibility of faces that bend
    by coordinates of their own, which are the last that contact moves. Flanks yield by them as others do by their
    seats. The rest as in StepSolution.
    """
    # Taken out of the record once: in a loop that would cost more than the numbers.
    jacobian = contact.jacobian
    gap = contact.gap
    on_drive_flanks = contact.on_drive_flanks
    node_pair = contact.node_pair
    n = len(gap)
    drive = 0.0
    whole = 0.0
    for node in range(n):
        whole += forces[node]
        drive += forces[node] if on_drive_flanks[node] else 0.0
    side = 2.0 * drive >= whole
    closed = np.empty(n, dtype=np.int64)
    count = 0
    force = 0.0
    pairs = 0
    last = -1
    for node in range(n):
        if status[node] != OPEN and on_drive_flanks[node] == side:
            closed[count] = node
            count = count + 1
            force = force + forces[node]
            if forces[node] > 0.0 and node_pair[node] != last:
                pairs = pairs + 1
                last = node_pair[node]
    if force <= NO_FORCE:
        return np.zeros(3)
    overlap = np.full(n, -np.inf)
    rigid = coordinates.copy()
    moved = jacobian.shape[1]
    rigid[moved - faces.shape[1] : moved] = 0.0
    for node in range(n):
        if on_drive_flanks[node] == side:
            overlap[node] = product(jacobian[node], rigid) - gap[node]
    deflection = _highest(overlap, node_pair)
    # Where a gear is so heavy that it does not move, the deflection is below the last digit of its rotation. Wedged
    # teeth may be pressed by friction where they do not approach.
    secant = force / deflection if deflection > 0.0 else np.nan
    return np.array([secant, _tangent(contact, closed[:count], faces), pairs])


@njit(cache=True)
def _highest(overlap, node_pair):
    """Largest overlap (mm) of flanks with overlaps (n,) at evenly spaced nodes. Of all nodes that are no lower than
    their neighbours, it is the highest vertex of the parabolas through the node and these. At nodes alone it would be
    too small by up to spacing^2/(8 rho). Of slices whose highest nodes are alike no one is taken before the others."""
    highest = -np.inf
    last = len(overlap) - 1
    for node in range(last + 1):
        at = overlap[node]
        highest = max(highest, at)
        if 0 < node < last and node_pair[node - 1] == node_pair[node] == node_pair[node + 1]:
            before = overlap[node - 1]
            after = overlap[node + 1]
            bend = 2.0 * at - before - after
            if at >= before and at >= after and bend > 0.0:
                highest = max(highest, at + (after - before) ** 2 / (8.0 * bend))
    return highest


@njit(cache=True)
def _tangent(contact, nodes, faces):
    """Force (N) on some nodes when all of them approach by 1 mm; over a face by what the march factored, where they are
    all that are closed."""
    compliance = contact.compliance
    n = len(contact.gap)
    bent = faces.shape[1]
    first = contact.jacobian.shape[1] - bent
    approach = np.ones(len(nodes))
    # In the plane nothing is factored.
    if contact.rows != 0:
        held = np.eye(1)
        moved = np.zeros((n, 1))
        if bent:
            held = faces[0].copy()
            moved = contact.jacobian[:n, first:].copy()
        nothing = np.empty(0)
        exact = Tolerance(0.0, 0.0)
        load = np.zeros(len(held))
        equations = StepEquations(
            held, load, compliance, moved, contact.gap, nothing, 0.0, nothing, exact, contact.rows
        )
        iterate = Iterate(np.empty(0, dtype=np.int8), np.zeros(n), np.zeros(len(held)), nothing)
        if solve_factored(equations, iterate, nodes, nothing, -approach):
            return iterate.forces.sum()
    # `solve_sets` would be compiled, and loaded by each run, once more.
    form_rows(contact.rows, nodes)
    matrix = system_of(len(nodes))
    for i in range(len(nodes)):
        put_entries(matrix[i], compliance[nodes[i]], nodes, np.int64(0), 1.0)
        for c in range(bent):
            moved_by = 0.0
            for d in range(bent):
                moved_by += faces[1, c, d] * contact.jacobian[nodes[i], first + d]
            for j in range(len(nodes)):
                matrix[i, j] += contact.jacobian[nodes[j], first + c] * moved_by
    return solved(matrix, approach, len(nodes)).sum()


Curves = dict[str, np.ndarray]
# Of a drivetrain in which no face bends by coordinates of its own.
NO_FACES = np.zeros((2, 0, 0))


def stiffness_curves(steps: Steps, faces: np.ndarray = NO_FACES) -> Curves:
    """Secant and tangent stiffness of the mesh, and how many pairs carry, at consecutive steps; `faces`: as in
    `mesh_stiffness`."""
    secant, tangent, pairs = _stiffness(steps.in_memory, faces)
    return {"mesh_stiffness": secant, "mesh_stiffness_tangent": tangent, "loaded_pairs": pairs}


@njit(cache=True)
def _stiffness(block, faces):
    steps = in_block(block)
    stiffnesses = np.zeros((3, len(steps.rows)))
    for s in range(len(steps.rows)):
        forces = steps.forces[forces_at(steps, s)]
        status = steps.status[nodes_at(steps, s)]
        stiffnesses[:, s] = mesh_stiffness(operator_at(steps, s), status, forces, steps.states[s, 0], faces)
    return stiffnesses


def pressure_curves(nodes: SideBySide, fields: Mapping[str, np.ndarray], singular: EdgesAndKinks) -> Curves:
    """The largest pressure of consecutive steps, its tooth pair and its place, from their contact `fields`.

    Nodes near an edge or a kink have a largest pressure of their own. So have pairs that press with the sharp edge of a
    tip, or of an undercut involute, and slices near the ends of the face. There the number grows as contact nodes come
    closer.
    """
    pressed_edge = nodes.of("on_edge").any(axis=0) & (nodes.normal > NO_FORCE)
    beside = singular.beside(nodes)
    largest = {kind: [] for kind in (NOTHING, KINK, EDGE)}
    rolls = []
    steps = len(nodes.steps)
    for side, drive in (("", True), ("coast_", False)):
        if f"{side}contact_pressure" not in fields:
            continue
        place = fields[f"{side}contact_roll_angle"]
        pressure = read_off(fields[f"{side}contact_pressure"], place)
        presses_edge = nodes.by_slice(pressed_edge & (nodes.drive == drive))[..., None] > 0
        kinds = np.where(presses_edge, EDGE, nodes.over_nodes(beside, drive, NOTHING))
        for kind, parts in largest.items():
            parts.append(np.where(kinds == kind, pressure, 0.0).max(axis=-1).reshape(steps, -1))
        node = np.where(kinds == NOTHING, pressure, 0.0).argmax(axis=-1)[..., None]
        rolls.append(np.take_along_axis(place, node, -1).reshape(steps, -1))
    pressures = {kind: np.concatenate(parts, axis=1) for kind, parts in largest.items()}
    repeated = np.repeat(nodes.pair_number, rolls[0].shape[1] // nodes.pair_number.shape[1], axis=1)
    numbers = np.concatenate([repeated] * len(rolls), axis=1)
    off_edge = pressures[NOTHING]
    at = np.arange(len(off_edge)), off_edge.argmax(axis=1)
    touching = off_edge[at] > 0.0
    return {
        "largest_contact_pressure": off_edge[at],
        "largest_contact_pressure_pair": np.where(touching, numbers[at], 0),
        "largest_contact_pressure_roll_angle": np.where(touching, np.concatenate(rolls, axis=1)[at], np.nan),
        "largest_edge_pressure": pressures[EDGE].max(axis=1),
        "largest_kink_pressure": pressures[KINK].max(axis=1),
    }


# What is near a node; of several, the last.
NOTHING, KINK, EDGE = range(3)
# In half-widths: the infinite pressure of a kink is in the contact itself. An edge makes the whole contact softer whose
# border comes within a half-width of it; its peak is another half-width away.
REACH = {KINK: 1.0, EDGE: 2.0}


@dataclass(frozen=True)
class _Place:
    """A place on the flank of the pinion (0) or the wheel (1): `arc` (mm) along the involute from the base circle, and
    whether it is a kink or an edge."""

    gear: int
    arc: float
    kind: int


class EdgesAndKinks:
    """The edges and kinks of a model's flanks; over a face slices near its ends are edges."""

    def __init__(self, model: Model):
        self.half_width = model.resolution.half_width
        self._end_slices = None
        if model.face.slices > 1:
            self._end_slices = in_end_zone(model.pair, model.face.positions)
        self._places: list[_Place] = []
        for number, (gear, removal) in enumerate(zip(model.pair.gears, model.removal)):
            rolls = [(roll, KINK) for roll in kinks(removal)] + [(gear.tip_roll_angle, EDGE)]
            rolls += [(gear.form_roll_angle, EDGE)] if gear.undercut else []
            self._places += [_Place(number, 0.5 * gear.base_radius * roll**2, kind) for roll, kind in rolls]
        self._places.sort(key=lambda place: place.kind)
        # Most blocks of a march have the same positions.
        self._last: tuple[Layouts | None, np.ndarray] = None, np.empty(0)

    def beside(self, nodes: SideBySide) -> np.ndarray:
        """What is near each contact node (N,): NOTHING, KINK or EDGE. Reliefs are of drive flanks alone."""
        if self._last[0] is not nodes.layouts:
            self._last = nodes.layouts, self._beside(nodes)
        return self._last[1]

    def _beside(self, nodes: SideBySide) -> np.ndarray:
        kinds = np.full(len(nodes.step), NOTHING)
        arcs = nodes.of("arcs")
        for place in self._places:
            near = np.abs(arcs[place.gear] - place.arc) <= REACH[place.kind] * self.half_width
            kinds[near & nodes.drive if place.kind == KINK else near] = place.kind
        if self._end_slices is not None:
            kinds[self._end_slices[nodes.of("slice")]] = EDGE
        return kinds


# Exact for cubic pressure, zero for pressure that changes sign from node to node: (1 + d^2/4)(1 - d^2/4), d^2 the
# second difference.
WEIGHTS = np.array([-1.0, 4.0, 10.0, 4.0, -1.0]) / 16.0


def without_oscillation(pressure: np.ndarray) -> np.ndarray:
    """Pressure at evenly spaced contact nodes (..., n), MPa, averaged over five nodes each; the two at either end stay
    as they are.

    Where contact nodes are closer than the flank's elements, the pressure has an error that changes sign from node to
    node. Peaks of this average are within 2.5, 0.8, 0.2 % of Hertz's for half-widths of 2, 4, 8 elements and contact
    nodes 0.5 to 0.7 elements apart. Nodal values err by up to 17, 2, 3 %.
    """
    result = np.array(pressure, dtype=float)
    beyond = result.shape[-1] - len(WEIGHTS) + 1
    if beyond > 0:
        result[..., 2:-2] = sum(weight * pressure[..., i : beyond + i] for i, weight in enumerate(WEIGHTS))
    return result


def read_off(pressure: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    """Pressure (..., n), MPa, averaged as above, from which peaks are read; `offsets` (..., n), mm: NaN where there is
    no contact node."""
    inside = np.zeros(pressure.shape, dtype=bool)
    inside[..., :-2] = ~np.isnan(offsets[..., 2:])
    return np.where(inside, without_oscillation(pressure), pressure)
