"""Contact of two swept gears at one phase: bilinear pressure over offset and height, gaps weighted by the same
functions, along the normal n = (c, 0, -c tau), c = cos(beta_b). Where points (offset y, height z) lie is found here
from the involute's equation."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from tests.face_reference.swept_gear import SweptGear, line_shapes

from fenics_gears import GearPair

# Gauss points of a cell across the contact line and along the face.
ACROSS, ALONG = 4, 3
NEWTON_STEPS = 40
# Gaps (mm) beyond which a node cannot close: alone, and by which it is wider than the least at its height.
FARTHEST, FARTHER = 0.045, 0.012


@dataclass(frozen=True)
class Position:
    """A pair of gears at `phase` (mesh cycles after a tooth pair reaches the start of contact at z = 0); `slope` tau =
    d(xi)/dz of the contact lines."""

    pair: GearPair
    slope: float
    phase: float

    @property
    def cosine(self) -> float:
        return 1.0 / np.hypot(1.0, self.slope)

    @property
    def twists(self) -> tuple[float, float]:
        """Twist of pinion and wheel, rad/mm."""
        return self.slope / self.pair.pinion.base_radius, -self.slope / self.pair.wheel.base_radius

    def xi(self, index: int, z):
        """Of tooth pair `index` on the path of contact, mm, at heights z (mm)."""
        return self.pair.path_start + (self.phase + index) * self.pair.base_pitch + self.slope * np.asarray(z)

    def contact_rolls(self, index: int, z):
        xi = self.xi(index, z)
        return xi / self.pair.pinion.base_radius, (self.pair.line_of_action_length - xi) / self.pair.wheel.base_radius

    def flank_points(self, index: int, y, z):
        """Roll angles (rad) of pinion and wheel at offsets y and heights z (mm), the transverse gap (mm), and
        whether both flanks are there."""
        gears, rolls, reach, there = (self.pair.pinion, self.pair.wheel), [], 0.0, True
        for gear, contact, sense in zip(gears, self.contact_rolls(index, z), (-1.0, 1.0)):
            roll = _roll_at_height(contact, 1.0 + sense * y / gear.base_radius)
            rolls.append(roll)
            reach = reach + gear.base_radius * (np.sin(contact - roll) + roll * np.cos(contact - roll))
            there = there & (roll >= gear.form_roll_angle) & (roll <= gear.tip_roll_angle)
        return rolls, self.pair.line_of_action_length - reach, there

    def normal(self, gear: int, z) -> np.ndarray:
        """n (k, 3) in the frame of a gear's section at heights z (k,)."""
        turn = self.contact_rolls(0, 0.0)[gear] + np.pi * gear + self.twists[gear] * np.asarray(z)
        return self.cosine * np.stack([np.cos(turn), -np.sin(turn), np.full_like(turn, -self.slope)], axis=-1)


def _roll_at_height(contact, height) -> np.ndarray:
    """Roll angle (rad) of the flank point at a height (base radii above the centre) while `contact` (rad) is on the
    line of action."""
    contact, height = np.broadcast_arrays(np.asarray(contact, dtype=float), height)
    roll = contact.copy()
    for _ in range(NEWTON_STEPS):
        turned = contact - roll
        residual = np.cos(turned) - roll * np.sin(turned) - height
        roll = np.sqrt(np.maximum(roll**2 - 2.0 * residual / np.cos(turned), 1e-12))
    return roll


@dataclass(frozen=True)
class PairPoints:
    """Contact nodes of tooth pair `index`: those (k,) that exist of a grid of offsets `y` (a,) and heights `z` (b,),
    mm. `areas` (k,), mm^2; `gaps` (k,), mm^3, weighted by the node's function; `chosen` (k,) in the grid; `weights`
    of pinion and wheel (k, flank nodes times levels), mm^2."""

    index: int
    y: np.ndarray
    z: np.ndarray
    chosen: np.ndarray
    areas: np.ndarray
    gaps: np.ndarray
    weights: tuple[sparse.csr_matrix, sparse.csr_matrix]

    @cached_property
    def level(self) -> np.ndarray:
        """Index in `z` of the nodes (k,)."""
        return self.chosen // len(self.y)


def pair_points(
    position: Position,
    index: int,
    y: np.ndarray,
    gears: tuple[SweptGear, SweptGear],
    opening,
    heights: np.ndarray | None = None,
) -> PairPoints | None:
    """None where the flanks do not face each other. `opening(z)`: what opens them along n, mm, at heights (k,), mm.
    Pressure varies straight between `heights` (mm), or between the layers' boundaries: with nodes at their middles as
    well it oscillates from node to node. Of given heights, nodes that are too far apart to close are left out."""
    boundaries, given = gears[0].sweep.heights[::2], heights is not None
    heights = heights if given else boundaries
    at_y, weight_y, hat_y = _cells(y, ACROSS, y)
    at_z, weight_z, hat_z = _cells(heights, ALONG, boundaries)
    many_y, many_z = (each.ravel() for each in np.meshgrid(at_y, at_z))
    rolls, gap, there = position.flank_points(index, many_y, many_z)
    weight = np.outer(weight_z, weight_y).ravel() / position.cosine * there
    hats = sparse.kron(hat_z, hat_y, format="csr")
    loaded = sparse.csr_matrix(hats.T.multiply(weight))
    areas = np.asarray(loaded.sum(axis=1)).ravel()
    whole = np.asarray(hats.T @ (np.outer(weight_z, weight_y).ravel() / position.cosine)).ravel()
    chosen = np.flatnonzero(areas > 0.02 * whole)
    gaps = loaded @ (position.cosine * np.nan_to_num(gap) + opening(many_z))
    if given:
        chosen = chosen[_may_close((gaps / np.maximum(areas, 1e-30))[chosen], chosen // len(y))]
    if not len(chosen):
        return None
    keys = (index, -index)
    weights = tuple(
        loaded[chosen] @ _flank_shapes(gear, key, position.pair, number, roll, many_z, there)
        for number, (gear, key, roll) in enumerate(zip(gears, keys, rolls))
    )
    return PairPoints(index, y, heights, chosen, areas[chosen], gaps[chosen], weights)


def _may_close(gaps: np.ndarray, levels: np.ndarray) -> np.ndarray:
    """Of nodes' mean gaps (mm), at their heights' numbers: those near enough, alone and beside their height's least."""
    least = np.full(levels.max(initial=0) + 1, np.inf)
    np.minimum.at(least, levels, gaps)
    return (gaps < FARTHEST) & (gaps < least[levels] + FARTHER)


def _cells(nodes: np.ndarray, count: int, boundaries: np.ndarray):
    """Gauss points (q,) of the cells between boundaries, weights, and hat functions of the nodes (q, k)."""
    gauss, weights = np.polynomial.legendre.leggauss(count)
    length = np.diff(boundaries)
    at = (boundaries[:-1, None] + length[:, None] * 0.5 * (1 + gauss)).ravel()
    cell = np.clip(np.searchsorted(nodes, at) - 1, 0, len(nodes) - 2)
    shares, rows = (at - nodes[cell]) / np.diff(nodes)[cell], np.arange(len(at))
    hats = sparse.csr_matrix(
        (np.concatenate([1 - shares, shares]), (np.tile(rows, 2), np.concatenate([cell, cell + 1]))),
        (len(at), len(nodes)),
    )
    return at, (0.5 * length[:, None] * weights).ravel(), hats


def _flank_shapes(gear: SweptGear, tooth: int, pair: GearPair, number: int, roll, z, there) -> sparse.csr_matrix:
    """Shape functions (q, flank nodes times levels, level by level) of a drive flank at roll angles and heights
    (q,)."""
    node_rolls = gear.section.flanks[tooth][0]
    along, local_along = _located(0.5 * node_rolls**2, np.where(there, 0.5 * roll**2, 0.5 * node_rolls[1] ** 2))
    level, local_level = _located(gear.sweep.heights, z)
    in_plane, in_height = line_shapes(local_along)[0], line_shapes(local_level)[0]
    values = in_height[:, :, None] * in_plane[:, None, :]
    columns = (
        (2 * level[:, None, None] + np.arange(3)[:, None]) * len(node_rolls) + 2 * along[:, None, None] + np.arange(3)
    )
    rows = np.broadcast_to(np.arange(len(z))[:, None, None], columns.shape)
    return sparse.csr_matrix(
        (values.ravel(), (rows.ravel(), columns.ravel())), (len(z), len(node_rolls) * len(gear.sweep.heights))
    )


def _located(nodes: np.ndarray, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Quadratic cell and place in it (-1 to 1) of points in a chain of nodes."""
    ends = nodes[::2]
    cell = np.clip(np.searchsorted(ends, at, side="right") - 1, 0, len(ends) - 2)
    return cell, 2.0 * (at - ends[cell]) / (ends[cell + 1] - ends[cell]) - 1.0


def compliance(
    position: Position,
    points: list[PairPoints],
    gears: tuple[SweptGear, SweptGear],
    columns: int = 48,
    mirrored: bool = False,
) -> np.ndarray:
    """Weighted gap (k, k), mm^3, that 1 MPa at each node opens. `mirrored`: of spur gears columns of one half follow
    from the other."""
    sizes = [len(each.chosen) for each in points]
    total = np.zeros((sum(sizes), sum(sizes)))
    mirror = _mirror(points) if mirrored else None
    wanted = np.arange(sum(sizes)) if mirror is None else np.flatnonzero(np.arange(sum(sizes)) <= mirror)
    for number, gear in enumerate(gears):
        loads = _loads(position, points, gear, number)
        factor = gear.factorised()
        for first in range(0, len(wanted), columns):
            part = wanted[first : first + columns]
            total[:, part] += loads.T @ factor.solve(loads[:, part].toarray())
        factor.close()
    if mirror is not None:
        left = mirror[wanted]
        total[:, left] = total[mirror][:, wanted]
    return 0.5 * (total + total.T)


def _mirror(points: list[PairPoints]) -> np.ndarray:
    """The contact node that is the mirror image about z = 0."""
    found, first = [], 0
    for each in points:
        there = {int(node): first + i for i, node in enumerate(each.chosen)}
        a, b = len(each.y), len(each.z)
        found += [there[(b - 1 - node // a) * a + node % a] for node in map(int, each.chosen)]
        first += len(each.chosen)
    return np.array(found)


def _loads(position: Position, points: list[PairPoints], gear: SweptGear, number: int) -> sparse.csc_matrix:
    blocks = []
    normal = position.normal(number, gear.sweep.heights)
    for each in points:
        nodes = gear.section.flanks[(each.index, -each.index)[number]][1]
        weights = each.weights[number].tocoo()
        level, place = weights.col // len(nodes), weights.col % len(nodes)
        dofs = 3 * (level * gear.nodes + nodes[place])
        rows = dofs[:, None] + np.arange(3)
        values = weights.data[:, None] * normal[level]
        columns = np.broadcast_to(weights.row[:, None], rows.shape)
        shape = (gear.spread.shape[0], len(each.chosen))
        at_nodes = sparse.csc_matrix((values.ravel(), (rows.ravel(), columns.ravel())), shape)
        blocks.append(gear.spread.T @ at_nodes)
    return sparse.hstack(blocks, format="csc")
