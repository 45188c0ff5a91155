"""The paper's equilibrium equations in the relative displacement of the contact nodes alone: [22], then [C.1].

Each gear is taken in its own frame, x outwards along its flank's normal at the line of action, so that both gears
respond alike to a contact force: K_i u_i + p + f_i = 0, and the relative displacement u is u_1 + u_2. (The wheel's
frame is turned by half a turn: the paper's u_c^2 and F_e^2 are -u_2 and -f_2.)

[22] eliminates the centre through K_inv = [K_qq + K^i]^-1, which exists even where the drivetrain alone holds nothing
(K^i singular, a wheel without mass): the flank nodes hold the centre. K_i is then singular and only contact holds the
gear. These stiffnesses are differences of far larger ones: about 1e-10 of the load is lost in round-off, whatever the
time step.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from fenics_gears.contact.kinematics import COLUMNS
from fenics_gears.geometry.side import Side

# Of the motions of a gear those in the plane: along x and y, and about z.
IN_PLANE = [0, 1, 5]


class CentreEliminated:
    """One gear without its centre [22]: `stiffness` (2n, 2n), N/mm, over the contact nodes' normals and tangents.

    `stiffness` given: over the nodes and (dx, dy, phi); `motion` (3, k): of the centre per coordinate of the
    drivetrain; `effective` (k, k): the drivetrain's stiffness K^i [17], [20] on them.
    """

    def __init__(self, stiffness: np.ndarray, motion: np.ndarray, effective: np.ndarray):
        nodes = len(stiffness) - 3
        self._coupling = stiffness[:nodes, nodes:] @ motion
        self._inverse = np.linalg.inv(motion.T @ stiffness[nodes:, nodes:] @ motion + effective)
        self.stiffness = stiffness[:nodes, :nodes] - self._coupling @ self._inverse @ self._coupling.T

    def load(self, force: np.ndarray) -> np.ndarray:
        """F_e (2n,), N, of drivetrain forces F (k,) [18], [21]."""
        return self._coupling @ (self._inverse @ force)

    def centre(self, force: np.ndarray, displacement: np.ndarray) -> np.ndarray:
        """Centre coordinates (k,), mm, from the nodes' displacement (2n,)."""
        return self._inverse @ (force - self._coupling.T @ displacement)


class RelativeStiffness:
    """`stiffness` (m, m), N/mm, in K u + p + f = 0 [C.1] over the contact nodes: normals, and tangents with friction.

    `gears`: stiffness (2n + 3, 2n + 3) of both over their nodes' normals, tangents and (dx, dy, phi); `effective` (k,
    k): effective stiffness of the drivetrain over `coordinates`, positions in CENTRE_COORDINATES; `sides` of the mesh.
    Maps from drivetrain forces F and displacement u are kept as small matrices, since a run keeps many of these
    objects.
    """

    def __init__(
        self, gears, effective: np.ndarray, coordinates: list[int], sides: tuple[Side, Side], tangential: bool
    ):
        shafts = _Shafts(effective, coordinates)
        known = zip(gears, sides, shafts.places, shafts.stiffness)
        gears = first, second = [
            CentreEliminated(stiffness, _motion(side, [coordinates[place] for place in places]), block)
            for stiffness, side, places, block in known
        ]
        unit = np.eye(len(coordinates))
        loads = [gear.load(force) for gear, force in zip(gears, shafts.forces(unit))]
        difference = loads[0] - loads[1]
        factor = cho_factor(first.stiffness + second.stiffness)
        share = cho_solve(factor, first.stiffness)
        relative = first.stiffness - first.stiffness @ share
        relative = 0.5 * (relative + relative.T)
        load = loads[0] - share.T @ difference

        def coordinates_by(force: np.ndarray, *displacement: np.ndarray) -> np.ndarray:
            each = zip(gears, shafts.forces(force), displacement)
            return shafts.coordinates(force, *(gear.centre(own, moved) for gear, own, moved in each))

        # u_2 of the second gear by u and by F; the first one has the rest of u.
        second_by_force = cho_solve(factor, difference)
        by_force = coordinates_by(unit, -second_by_force, second_by_force)
        nothing = np.zeros((len(coordinates), len(relative)))
        by_displacement = coordinates_by(nothing, np.eye(len(relative)) - share, share)
        if not tangential:
            n = len(relative) // 2
            free = cho_factor(relative[n:, n:])
            by_normal = cho_solve(free, relative[n:, :n])
            by_load = cho_solve(free, load[n:])
            by_force = by_force - by_displacement[:, n:] @ by_load
            by_displacement = by_displacement[:, :n] - by_displacement[:, n:] @ by_normal
            load = load[:n] - by_normal.T @ load[n:]
            relative = relative[:n, :n] - relative[:n, n:] @ by_normal
        self.stiffness = np.ascontiguousarray(relative)
        self._load = load
        self._by_force = by_force
        self._by_displacement = by_displacement

    def load(self, force: np.ndarray) -> np.ndarray:
        """f (m,), N, of [C.1] for drivetrain forces F (k,)."""
        return self._load @ force

    def coordinates(self, force: np.ndarray, displacement: np.ndarray) -> np.ndarray:
        """Centre coordinates (k,), mm, that go with drivetrain forces (k,) and a relative displacement (m,)."""
        return self._by_force @ force + self._by_displacement @ displacement


class _Shafts:
    """The drivetrain's effective stiffness split between the gears, phi3 eliminated [20], [21].

    `places`: of the gears' own coordinates among all; `stiffness` on them.
    """

    def __init__(self, effective: np.ndarray, coordinates: list[int]):
        self.places = [[i for i, each in enumerate(coordinates) if each in columns] for columns in COLUMNS]
        self._end = [i for i in range(len(coordinates)) if i not in sum(self.places, [])]
        self._end_stiffness = effective[np.ix_(self._end, self._end)]
        self._coupling = effective[np.ix_(self._end, self.places[1])]
        self._from_end = np.linalg.solve(self._end_stiffness, self._coupling)
        self.stiffness = [effective[np.ix_(places, places)] for places in self.places]
        self.stiffness[1] -= self._coupling.T @ self._from_end

    def forces(self, force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """F^1 and F^2 from the drivetrain's forces (k, any)."""
        return force[self.places[0]], force[self.places[1]] - self._from_end.T @ force[self._end]

    def coordinates(self, force: np.ndarray, *gears: np.ndarray) -> np.ndarray:
        """All coordinates (k, any) from those of the gears."""
        result = np.empty((len(force), gears[0].shape[1]))
        for places, own in zip(self.places, gears):
            result[places] = own
        result[self._end] = np.linalg.solve(self._end_stiffness, force[self._end] - self._coupling @ gears[1])
        return result


def _motion(side: Side, coordinates: list[int]) -> np.ndarray:
    """(dx, dy, phi) in the gear's own frame per drivetrain coordinate (3, k); rotations are carried as rb phi."""
    own = COLUMNS[side.number][IN_PLANE]
    return np.diag([side.sense, side.sense, 1.0 / side.gear.base_radius]) @ (own[:, None] == np.array(coordinates))
