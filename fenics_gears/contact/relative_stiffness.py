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

from .kinematics import CENTRE_COORDINATES

# Centre coordinates of pinion and wheel in CENTRE_COORDINATES, each with how it moves (dx, dy, rb phi) in the gear's
# own frame.
PINION = {"centre_x1": (0, 1.0), "centre_y1": (1, 1.0), "rotation_1": (2, 1.0)}
WHEEL = {"centre_x2": (0, -1.0), "centre_y2": (1, -1.0), "rotation_2": (2, 1.0)}


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

    `gears`: stiffness (2n + 3, 2n + 3) of pinion and wheel over their nodes' normals, tangents and (dx, dy, phi);
    `effective` (k, k): effective stiffness of the drivetrain over `coordinates`, positions in CENTRE_COORDINATES;
    `base_radii`, mm. Maps from drivetrain forces F and displacement u are kept as small matrices, since a run keeps
    many of these objects.
    """

    def __init__(self, gears, effective: np.ndarray, coordinates: list[int], base_radii, tangential: bool):
        shafts = _Shafts(effective, [CENTRE_COORDINATES[index] for index in coordinates])
        first, second = (
            CentreEliminated(stiffness, _motion(names, known, radius), block)
            for stiffness, names, known, radius, block in zip(
                gears, shafts.names, (PINION, WHEEL), base_radii, shafts.stiffness
            )
        )
        unit = np.eye(len(coordinates))
        force_1, force_2 = shafts.forces(unit)
        difference = first.load(force_1) - second.load(force_2)
        factor = cho_factor(first.stiffness + second.stiffness)
        share = cho_solve(factor, first.stiffness)
        relative = first.stiffness - first.stiffness @ share
        relative = 0.5 * (relative + relative.T)
        load = first.load(force_1) - share.T @ difference
        # u_2 of the wheel by u and by F; the pinion has the rest of u.
        wheel_by_force = cho_solve(factor, difference)
        by_force = shafts.coordinates(
            unit, first.centre(force_1, -wheel_by_force), second.centre(force_2, wheel_by_force)
        )
        nothing = np.zeros((len(coordinates), len(relative)))
        zero_1, zero_2 = shafts.forces(nothing)
        by_displacement = shafts.coordinates(
            nothing, first.centre(zero_1, np.eye(len(relative)) - share), second.centre(zero_2, share)
        )
        if not tangential:
            n = len(relative) // 2
            free = cho_factor(relative[n:, n:])
            by_normal, by_load = cho_solve(free, relative[n:, :n]), cho_solve(free, load[n:])
            by_force = by_force - by_displacement[:, n:] @ by_load
            by_displacement = by_displacement[:, :n] - by_displacement[:, n:] @ by_normal
            load = load[:n] - by_normal.T @ load[n:]
            relative = relative[:n, :n] - relative[:n, n:] @ by_normal
        self.stiffness = np.ascontiguousarray(relative)
        self._load, self._by_force, self._by_displacement = load, by_force, by_displacement

    def load(self, force: np.ndarray) -> np.ndarray:
        """f (m,), N, of [C.1] for drivetrain forces F (k,)."""
        return self._load @ force

    def coordinates(self, force: np.ndarray, displacement: np.ndarray) -> np.ndarray:
        """Centre coordinates (k,), mm, that go with drivetrain forces (k,) and a relative displacement (m,)."""
        return self._by_force @ force + self._by_displacement @ displacement


class _Shafts:
    """The drivetrain's effective stiffness split between the gears, phi3 eliminated [20], [21].

    `names`, `stiffness`: of the coordinates of pinion and wheel.
    """

    def __init__(self, effective: np.ndarray, names: list[str]):
        self._places = [[i for i, name in enumerate(names) if name in known] for known in (PINION, WHEEL)]
        self._end = [i for i, name in enumerate(names) if name not in PINION and name not in WHEEL]
        self.names = [[names[i] for i in places] for places in self._places]
        self._end_stiffness = effective[np.ix_(self._end, self._end)]
        self._coupling = effective[np.ix_(self._end, self._places[1])]
        self._from_end = np.linalg.solve(self._end_stiffness, self._coupling)
        pinion, wheel = (effective[np.ix_(places, places)] for places in self._places)
        self.stiffness = [pinion, wheel - self._coupling.T @ self._from_end]

    def forces(self, force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """F^1 and F^2 from the drivetrain's forces (k, any)."""
        return force[self._places[0]], force[self._places[1]] - self._from_end.T @ force[self._end]

    def coordinates(self, force: np.ndarray, pinion: np.ndarray, wheel: np.ndarray) -> np.ndarray:
        """All coordinates (k, any) from those of the gears."""
        result = np.empty((len(force), pinion.shape[1]))
        result[self._places[0]], result[self._places[1]] = pinion, wheel
        result[self._end] = np.linalg.solve(self._end_stiffness, force[self._end] - self._coupling @ wheel)
        return result


def _motion(names: list[str], known: dict[str, tuple[int, float]], base_radius: float) -> np.ndarray:
    """(dx, dy, phi) in the gear's own frame per drivetrain coordinate (3, k); rotations are carried as rb phi."""
    motion = np.zeros((3, len(names)))
    for column, name in enumerate(names):
        row, sign = known[name]
        motion[row, column] = sign / base_radius if row == 2 else sign
    return motion
