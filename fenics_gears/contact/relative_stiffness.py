"""The paper's equilibrium equations in the relative displacement of the contact nodes alone: [22], then [C.1].

Each gear is taken in its own frame, x outwards along its flank's normal at the line of action, so that both gears answer a
contact force alike: K_i u_i + p + f_i = 0, and the relative displacement u is u_1 + u_2. (The wheel's frame is turned by half a
turn: the paper's u_c^2 and F_e^2 are -u_2 and -f_2.)

[22] eliminates the centre through K_inv = [K_qq + K^i]^-1, which stands also where the drivetrain alone holds nothing (K^i
singular, a wheel without mass): the flank nodes hold the centre. K_i is then singular and only contact holds it.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from fenics_gears.contact.operator import CENTRE_COORDINATES

# Centre coordinates of pinion and wheel in CENTRE_COORDINATES, each with how it moves (dx, dy, rb phi) in the gear's own frame.
PINION = {"centre_x1": (0, 1.0), "centre_y1": (1, 1.0), "rotation_1": (2, 1.0)}
WHEEL = {"centre_x2": (0, -1.0), "centre_y2": (1, -1.0), "rotation_2": (2, 1.0)}


class CentreEliminated:
    """One gear without its centre [22]: `stiffness` (2n, 2n), N/mm, over the contact nodes' normals and tangents.

    `stiffness` given: over the nodes and (dx, dy, phi); `motion` (3, k): of the centre per coordinate of the drivetrain;
    `effective` (k, k): the drivetrain's stiffness K^i [17], [20] on them.
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

    `gears`: stiffness (2n + 3, 2n + 3) of pinion and wheel over their nodes' normals, tangents and (dx, dy, phi); `effective`
    (k, k): effective stiffness of the drivetrain over `coordinates`, positions in CENTRE_COORDINATES; `base_radii`, mm.
    """

    def __init__(self, gears, effective: np.ndarray, coordinates: list[int], base_radii, tangential: bool):
        names = [CENTRE_COORDINATES[index] for index in coordinates]
        self._places = [[i for i, name in enumerate(names) if name in known] for known in (PINION, WHEEL)]
        self._end = [i for i, name in enumerate(names) if name == "shaft_end"]
        wheel = self._places[1]
        self._end_stiffness = effective[np.ix_(self._end, self._end)]
        self._end_coupling = effective[np.ix_(self._end, wheel)]
        # phi3 eliminated, [20].
        self._from_end = np.linalg.solve(self._end_stiffness, self._end_coupling)
        blocks = [effective[np.ix_(places, places)] for places in self._places]
        blocks[1] = blocks[1] - self._end_coupling.T @ self._from_end
        self._gears = [
            CentreEliminated(stiffness, _motion([names[i] for i in places], known, radius), block)
            for stiffness, places, known, radius, block in zip(gears, self._places, (PINION, WHEEL), base_radii, blocks)
        ]
        first, second = (gear.stiffness for gear in self._gears)
        self._sum = cho_factor(first + second)
        self._share = cho_solve(self._sum, first)
        relative = first - first @ self._share
        self._full = 0.5 * (relative + relative.T)
        self._nodes, self._tangential, self.stiffness = len(first) // 2, tangential, self._full
        if not tangential:
            n = self._nodes
            self._free = cho_factor(self._full[n:, n:])
            self._tangents = cho_solve(self._free, self._full[n:, :n])
            self.stiffness = self._full[:n, :n] - self._full[:n, n:] @ self._tangents

    def load(self, force: np.ndarray) -> np.ndarray:
        """f (m,), N, of [C.1] for drivetrain forces F (k,)."""
        relative = self._relative_load(force)
        if self._tangential:
            return relative
        n = self._nodes
        return relative[:n] - self._tangents.T @ relative[n:]

    def coordinates(self, force: np.ndarray, displacement: np.ndarray) -> np.ndarray:
        """Centre coordinates (k,), mm, that go with drivetrain forces (k,) and a relative displacement (m,)."""
        n = self._nodes
        if not self._tangential:
            tangents = -cho_solve(self._free, self._full[n:, :n] @ displacement + self._relative_load(force)[n:])
            displacement = np.concatenate([displacement, tangents])
        pinion_force, wheel_force = self._forces(force)
        difference = self._gears[0].load(pinion_force) - self._gears[1].load(wheel_force)
        second = self._share @ displacement + cho_solve(self._sum, difference)
        result = np.empty(len(force))
        result[self._places[0]] = self._gears[0].centre(pinion_force, displacement - second)
        wheel = self._gears[1].centre(wheel_force, second)
        result[self._places[1]] = wheel
        result[self._end] = np.linalg.solve(self._end_stiffness, force[self._end] - self._end_coupling @ wheel)
        return result

    def _forces(self, force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return force[self._places[0]], force[self._places[1]] - self._from_end.T @ force[self._end]

    def _relative_load(self, force: np.ndarray) -> np.ndarray:
        first, second = (gear.load(part) for gear, part in zip(self._gears, self._forces(force)))
        return first - self._share.T @ (first - second)


def _motion(names: list[str], known: dict[str, tuple[int, float]], base_radius: float) -> np.ndarray:
    """(dx, dy, phi) in the gear's own frame per drivetrain coordinate (3, k); rotations are carried as rb phi."""
    motion = np.zeros((3, len(names)))
    for column, name in enumerate(names):
        row, sign = known[name]
        motion[row, column] = sign / base_radius if row == 2 else sign
    return motion
