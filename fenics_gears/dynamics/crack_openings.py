"""Openings of cracks under the contact forces of a run, and a warning where their faces would pass through each
other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fenics_gears.contact.flank_forces import flank_rows
from fenics_gears.contact.tooth_pair import node_slices
from fenics_gears.contact.whole_body_mesh import first_tooth
from fenics_gears.geometry.side import Side
from fenics_gears.inputs.tree import GEARS

from .steps import Record

# Overlaps (mm) below this are round-off.
LEAST_OVERLAP = 1e-6


def openings_of(cycle, side: Side, record: Record) -> np.ndarray:
    """Distances (k,), mm, of facing points of the cracks of a gear; negative where they would overlap.

    From forces on teeth within the reach of the body's compliance; others hardly move a crack.
    """
    body = cycle.bodies[side.number]
    operator = record.position.operator
    forces = record.solution.forces
    by_kind = forces.reshape(-1, operator.nodes)
    total = np.zeros(len(next(iter(body.openings.values()))))
    first = body.first + first_tooth(side, int(record.step // cycle.steps))
    for nodes, pair in zip(node_slices(operator.pairs), operator.pairs):
        rows = body.openings.get((first + pair.place.teeth[side.number]) % body.teeth)
        if rows is not None and forces[nodes].any():
            line = flank_rows(side, pair, len(by_kind) > 1) @ by_kind[:, nodes].ravel() / cycle.pair.face_width
            total += rows @ line
    return total


def crack_openings(cycle, records: Sequence[Record]) -> dict[str, np.ndarray]:
    """Smallest and largest opening at each record, (records,), mm, by the gear's name; only of gears that have
    cracks."""
    by_gear = {}
    for side, body, name in zip(cycle.pair.sides, cycle.bodies, GEARS):
        if not body.alike and body.openings:
            openings = [openings_of(cycle, side, record) for record in records]
            ends = np.array([(each.min(), each.max()) for each in openings])
            by_gear[f"least opening, {name}"], by_gear[f"largest opening, {name}"] = ends.T
    return by_gear


def closed_cracks(watched: Mapping[str, np.ndarray]) -> list[str]:
    """Sentences on cracks that would be closed at times; their faces are not kept from passing through each other."""
    sentences = []
    for name in GEARS:
        least, largest = (watched.get(f"{kind} opening, {name}", np.empty(0)) for kind in ("least", "largest"))
        overlaps = int((least < -LEAST_OVERLAP).sum())
        if overlaps:
            sentences.append(
                f"the faces of a crack in the {name} would pass through each other in {overlaps} of {len(least)} steps,"
                f" by up to {-1e3 * least.min():.3g} um (it opens by up to {1e3 * max(largest.max(), 0.0):.3g} um): a"
                " real crack closes there and carries load, so that the gear is stiffer than computed"
            )
    return sentences
