"""Forces on the nodes of either gear's flanks from forces at contact nodes, `N^T p`, as the flank compliance has
them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np
from scipy import sparse

from fenics_gears.geometry.outline import centreline_mirror
from fenics_gears.geometry.side import Side

from .compliance_product import directions
from .face import Face
from .interpolation import FlankInterpolation
from .tooth_pair import COAST, ToothPair


def flank_rows(side: Side, pair: ToothPair, tangential: bool) -> sparse.coo_array:
    """Forces (2 f, n or 2 n) on flank nodes, in the tooth's frame, per unit force at the pair's contact nodes, normals
    first.

    A positive contact force pushes on the flank of the gear of that `side`; that of friction acts against e_y of the
    tooth's frame. The coast flank's are in the frame mirrored at the tooth's centreline, as its compliance is.
    """
    return _pushed(pair.interpolation[side.number], directions(pair.place.contact_rolls[side.number], tangential))


def _pushed(nodes: FlankInterpolation, axes: np.ndarray) -> sparse.coo_array:
    """The same of contact nodes with that interpolation `nodes` and with axes (1 or 2, components)."""
    count, width = nodes.near.shape
    kinds, components = axes.shape
    on_flank = (nodes.first[:, None] + np.arange(width)) * components
    loaded = np.broadcast_to(on_flank[..., None] + np.arange(components), (kinds, count, width, components))
    own = np.broadcast_to(np.arange(kinds * count).reshape(kinds, count, 1, 1), loaded.shape)
    values = -nodes.near[..., None] * axes[:, None, None]
    shape = components * nodes.flank_nodes, kinds * count
    return sparse.coo_array((values.ravel(), (loaded.ravel(), own.ravel())), shape)


def rows_in_slice(side: Side, face: Face, pair: ToothPair, tangential: bool) -> sparse.coo_array:
    """Forces (f components, n or 2 n) on the nodes of a flank in the pair's slice, in the tooth's own frame, per unit
    force at the pair's contact nodes: N over a face of many slices, of one N/mm."""
    if face.slices == 1:
        nodes = pair.interpolation[side.number]
        axes = directions(pair.place.contact_rolls[side.number], tangential) / face.widths[0]
    else:
        # Imported here: plane scenes have none.
        from .face_pairing import FacePair, contact_axes

        nodes = cast(FacePair, pair).coarse[side.number]
        axes = contact_axes(face, side, [pair], tangential)[0, :, :3]
    if pair.place.flank == COAST:
        axes[:, :2] = axes[:, :2] @ centreline_mirror(side.gear).T
    return _pushed(nodes, axes)


def flank_forces(
    side: Side, face: Face, averages: np.ndarray, pairs: Sequence[ToothPair], forces: Sequence[np.ndarray]
) -> dict[int, np.ndarray]:
    """Forces (flanks, h, f components) on the flank nodes of a gear's loaded teeth, in each tooth's own frame at that
    height, as of `rows_in_slice`.

    `averages` (slices, h): over each slice, of values at the heights of the gear's nodes. A slice moves as the average
    over its width; its force spreads over the nodes accordingly. `forces`: of each pair's contact nodes in its slice,
    (n,) or (2 n,) with friction's, N. Teeth are those of a Place.
    """
    both = any(pair.place.flank == COAST for pair in pairs)
    result: dict[int, np.ndarray] = {}
    for pair, force in zip(pairs, forces):
        if not force.any():
            continue
        section = rows_in_slice(side, face, pair, len(force) > len(pair.offsets)) @ force
        tooth = pair.place.teeth[side.number]
        total = result.setdefault(tooth, np.zeros((2 if both else 1, averages.shape[1], len(section))))
        total[pair.place.flank if both else 0] += averages[pair.place.slice][:, None] * section
    return result
