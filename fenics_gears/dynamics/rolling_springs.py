"""Rolling bearings as nonlinear springs of a drivetrain: what their loads are beyond the secant stiffness that its
matrix has for them, and the step with them.

A step is linear but for contact and these springs. Motions in the bearings are eliminated by the minimum of energy for
given motions of the gears, and the step is solved with the springs' tangents there, until motions stay: Newton's method
around that of contact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fenics_gears.contact.errors import ContactNotConverged

from .rolling_bearing import MOTIONS, reaction

if TYPE_CHECKING:
    from fenics_gears.contact.step_solver import StepSolution

    from .bearings import RollingBearing
    from .drivetrain import Drivetrain

# Change of motions, in parts of the largest, that ends an iteration, whose error is the square of it; and how often.
SAME = 1e-9
MOST_ITERATIONS = 60
MOST_HALVINGS = 30
# Part of the decrease of energy by its slope that a step must bring.
DECREASE = 1e-4
# Part of a bearing's largest stiffness that its free motions are given.
FREE = 1e-9


class Departure(NamedTuple):
    """Energy, N mm, by which springs depart from linear ones, forces (k,), N, and stiffness (k, k), N/mm."""

    energy: float
    forces: np.ndarray
    stiffness: np.ndarray


class RollingSpring(NamedTuple):
    """A bearing: the `rows` (5,) of its motions among the coordinates, its row of rolling elements, the stiffness
    (5, 5) that the drivetrain's matrix has for these, its number among all bearings of elastic shafts, and the `axial`
    stiffness, N/mm, that it has beside them."""

    rows: np.ndarray
    rolling: RollingBearing
    secant: np.ndarray
    bearing: int
    axial: float = 0.0

    def departure(self, coordinates: np.ndarray) -> Departure:
        """Of the loads (5,) at coordinates (k,) of the drivetrain."""
        motion = coordinates[self.rows]
        reacted = reaction(self.rolling, motion)
        linear = self.secant @ motion
        energy = reacted.energy - 0.5 * motion @ linear
        return Departure(energy, reacted.loads - linear, reacted.stiffness - self.secant)


class NoBalance(ContactNotConverged):
    """Motions go on changing, in parts of the largest by `change`."""

    def __init__(self, change: float):
        reason = (
            f"rolling bearings: motions in them still change by {change:.2g} of the largest motion after"
            f" {MOST_ITERATIONS} iterations. Take a smaller clearance, a preload or a larger torque"
        )
        super().__init__([("rolling bearings", "no balance", np.empty((0, 5)), np.empty((0, 0)))], reason)


@dataclass(frozen=True)
class RollingSprings:
    """All of them. `reference` (k,): coordinates under an even load of the teeth; no contact moves the last `modes`
    coordinates, those in bearings among them."""

    springs: tuple[RollingSpring, ...]
    reference: np.ndarray
    modes: int

    def departure(self, coordinates: np.ndarray) -> Departure:
        """What all springs depart by at coordinates (k,)."""
        size = len(coordinates)
        energy = 0.0
        forces = np.zeros(size)
        stiffness = np.zeros((size, size))
        for spring in self.springs:
            own = spring.departure(coordinates)
            energy += own.energy
            forces[spring.rows] += own.forces
            stiffness[np.ix_(spring.rows, spring.rows)] += own.stiffness
        return Departure(energy, forces, stiffness)

    def energies(self, states: np.ndarray) -> np.ndarray:
        """Energies (s,), N mm, by which springs depart from linear ones at states (s, k)."""
        return np.array([self.departure(each).energy for each in states])

    def loads(self, states: np.ndarray, linear: np.ndarray) -> np.ndarray:
        """Loads (s, b, 5) on all bearings of elastic shafts at states (s, k); `linear`: those of linear springs."""
        on_bearings = linear.copy()
        for spring in self.springs:
            on_bearings[:, spring.bearing] += [spring.departure(each).forces for each in states]
        return on_bearings

    def largest_force(self, coordinates: np.ndarray) -> float:
        """Largest force, N, of a rolling element."""
        return max(reaction(each.rolling, coordinates[each.rows]).largest for each in self.springs)

    def largest_under(self, loads: np.ndarray) -> float:
        """The same where the bearings have loads (b, 5), N and N mm. Raises NoBalance."""
        stiffness = np.eye(len(self.reference))
        load = np.zeros(len(self.reference))
        for spring in self.springs:
            # Motions that the bearing does not hold, as a roller bearing's along the axis, stay where they are.
            held = np.diag([0.0, 0.0, spring.axial, 0.0, 0.0]) + FREE * np.abs(spring.secant).max() * np.eye(MOTIONS)
            stiffness[np.ix_(spring.rows, spring.rows)] = spring.secant + held
            load[spring.rows] = loads[spring.bearing]
        return self.largest_force(self.settled(stiffness, load, self.reference))

    def settled(self, stiffness: np.ndarray, load: np.ndarray, coordinates: np.ndarray) -> np.ndarray:
        """Coordinates (k,) of which those that no contact moves are in balance, with a linear stiffness (k, k), under a
        load (k,): where energy is least. Raises NoBalance."""
        own = slice(len(load) - self.modes, len(load))
        balanced = coordinates.copy()
        change = np.inf
        for _ in range(MOST_ITERATIONS):
            beyond = self.departure(balanced)
            slope = (stiffness @ balanced - load + beyond.forces)[own]
            step = -_solved(stiffness[own, own] + beyond.stiffness[own, own], slope)
            change = _change(step, balanced)
            if change <= SAME:
                balanced[own] += step
                return balanced
            balanced = self._lower(stiffness, load, balanced, step, float(slope @ step))
        raise NoBalance(change)

    def _lower(
        self, stiffness: np.ndarray, load: np.ndarray, begun: np.ndarray, step: np.ndarray, slope: float
    ) -> np.ndarray:
        """Coordinates part of a step on, where energy is lower."""

        def energy(coordinates: np.ndarray) -> float:
            return 0.5 * coordinates @ stiffness @ coordinates - load @ coordinates + self.departure(coordinates).energy

        before = energy(begun)
        part = 1.0
        # What energy is too coarse for, near its minimum, is taken whole.
        coarse = 1e-12 * abs(before)
        for _ in range(MOST_HALVINGS):
            lower = begun.copy()
            lower[-self.modes :] += part * step
            if energy(lower) <= before + DECREASE * part * slope + coarse:
                return lower
            part *= 0.5
        return lower

    def solved(
        self,
        stiffness: np.ndarray,
        load: np.ndarray,
        begin: np.ndarray,
        solve: Callable[[np.ndarray, np.ndarray], StepSolution],
    ) -> StepSolution:
        """A step whose matrix is `stiffness` (k, k) and whose right-hand side is `load` (k,), but for what springs
        depart by: `solve` does a linear one. Raises NoBalance."""
        place = begin
        last = change = np.inf
        part = 1.0
        for _ in range(MOST_ITERATIONS):
            place = self.settled(stiffness, load, place)
            beyond = self.departure(place)
            solution = solve(stiffness + beyond.stiffness, load - beyond.forces + beyond.stiffness @ place)
            coordinates = solution.coordinates
            change = _change(coordinates - place, coordinates)
            if change <= SAME:
                return solution
            part = min(1.0, 2.0 * part) if change < last else 0.5 * part
            place = place + part * (coordinates - place)
            last = change
        raise NoBalance(change)


def _solved(tangent: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """Motions (m,) that a tangent stiffness (m, m) answers a slope of the energy (m,) with. Where no element of a
    bearing touches it is singular; a weak spring then leads back to where one does."""
    try:
        return np.linalg.solve(tangent, slope)
    except np.linalg.LinAlgError:
        weak = FREE * np.abs(tangent).max() if tangent.any() else 1.0
        return np.linalg.solve(tangent + weak * np.eye(len(tangent)), slope)


def _change(step: np.ndarray, coordinates: np.ndarray) -> float:
    return float(np.abs(step).max() / max(np.abs(coordinates).max(), np.finfo(float).tiny))


def springs_of(drivetrain: Drivetrain) -> RollingSprings | None:
    """The rolling bearings of a drivetrain whose elastic shafts are at work; None where it has none."""
    if not any(system.in_rolling for system in drivetrain.systems):
        return None
    springs = []
    first = 0
    reference = np.zeros(len(drivetrain.coordinates))
    for system in drivetrain.systems:
        gears = np.linalg.solve(system.gear_stiffness, system.load)
        motions = (system.bearings_at_rest @ gears).reshape(-1, MOTIONS)
        rolling = [number for number, each in enumerate(system.bearings) if each.rolling is not None]
        names = (*system.moved[: len(gears)], *system.in_rolling)
        rows = np.array([drivetrain.coordinates.index(name) for name in names])
        reference[rows] = np.concatenate([gears, motions[rolling].ravel()]) * drivetrain.radii[rows]
        for place, number in enumerate(rolling):
            bearing = system.bearings[number]
            own = rows[len(gears) + MOTIONS * place :][:MOTIONS]
            axial = bearing.axial_stiffness
            secant = np.array(bearing.matrix) - np.diag([0.0, 0.0, axial, 0.0, 0.0])
            springs.append(RollingSpring(own, bearing.rolling, secant, first + number, axial))
        first += len(system.bearings)
    return RollingSprings(tuple(springs), reference, drivetrain.modes)
