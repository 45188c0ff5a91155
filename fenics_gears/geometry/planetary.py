"""A planetary set: its speeds and torques (Willis), where planets can be assembled, phases of its meshes, and what
these let through (Parker 2000)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import cos, gcd, lcm, pi, sin

SUN = "sun"
RING = "ring"
SECOND_SUN = "second_sun"
CARRIER = "carrier"
MEMBERS = (SUN, RING, SECOND_SUN, CARRIER)
WITH_RING = (SUN, RING, CARRIER)
# Of what harmonics of the meshes do to sun, ring and carrier.
ROTATION = "r"
TRANSLATION = "t"
BOTH = "b"
NEITHER = "p"
NOTHING_LEFT = 1e-9


@dataclass(frozen=True)
class PlanetarySet:
    """Numbers of `teeth` of sun, planet and ring, all positive, and where the planets stand: at whole numbers of
    `places`, of which `turn` are a turn. Of its `members` one is `fixed`, one the `input`, one the `output`. `step`:
    teeth of the gear of a stepped planet that meshes with the ring; unless given the planet's one gear does. `second`:
    RING, or SECOND_SUN in its place."""

    teeth: tuple[int, int, int]
    places: tuple[int, ...]
    fixed: str
    input: str
    output: str
    step: int | None = None
    second: str = RING

    @property
    def members(self) -> tuple[str, str, str]:
        """Names of its members."""
        return SUN, self.second, CARRIER

    @property
    def stepped(self) -> bool:
        """Whether its planets have two gears each."""
        return self.step is not None

    @property
    def cycles(self) -> tuple[int, int]:
        """Mesh cycles with the sun, and with the ring, after which all meshes are where they were: 1 and 1, but of
        stepped planets z_planet and z_step without common factors."""
        planet, step = self.teeth[1], self.step or self.teeth[1]
        common = gcd(planet, step)
        return planet // common, step // common

    @property
    def planets(self) -> int:
        """Number of planets."""
        return len(self.places)

    @property
    def turn(self) -> int:
        """Places of a whole turn: z_s + z_r; of stepped planets z_s z_step + z_r z_planet, without the factors that
        z_step and z_planet share. All planets are alike, also in how their gears stand to each other."""
        return abs(self.weights[CARRIER])

    @property
    def angles(self) -> list[float]:
        """Directions (rad) of the planets from the centre, counter-clockwise."""
        return [2.0 * pi * place / self.turn for place in self.places]

    @property
    def weights(self) -> dict[str, int]:
        """Torques on the members without losses are as these: they add up to zero, and so do speeds times these."""
        of_planet, of_step = self.cycles
        sun = self.teeth[0] * of_step
        second = self.teeth[2] * of_planet * (1 if self.second == RING else -1)
        return {SUN: sun, self.second: second, CARRIER: -sun - second}

    @property
    def speeds(self) -> dict[str, Fraction]:
        """Speeds of the members where the input has 1, by Willis: z_s w_s + z_r w_r = (z_s + z_r) w_c, in general
        with the weights of the members."""
        own = self.weights
        return {
            self.fixed: Fraction(0),
            self.input: Fraction(1),
            self.output: -Fraction(own[self.input], own[self.output]),
        }

    def torques(self, on_input: float) -> dict[str, float]:
        """Torques on the members from outside, without losses, where the input has that one; positive as it turns."""
        own = self.weights
        return {member: on_input * own[member] / own[self.input] for member in self.members}

    @property
    def sun_by_carrier(self) -> Fraction:
        """Speed of the sun as the carrier sees it, where the input has 1."""
        return self.speeds[SUN] - self.speeds[CARRIER]

    @property
    def ratio(self) -> Fraction:
        """Turns of the input in one of the output, negative where they turn against each other."""
        return 1 / self.speeds[self.output]

    @property
    def sun_drives(self) -> bool:
        """Whether power goes from the sun to the ring, as the carrier sees it."""
        own = self.weights
        return own[SUN] * self.sun_by_carrier / own[self.input] > 0

    @property
    def phases(self) -> list[Fraction]:
        """Mesh cycles (0 to 1) by which the mesh of each planet with the sun is ahead of that of a planet at place
        0."""
        return self._phases(-self.teeth[0])

    @property
    def phases_of_second(self) -> list[Fraction]:
        """The same of the meshes with the ring, which are as far ahead unless planets are stepped."""
        return self._phases(self.teeth[2] if self.second == RING else -self.teeth[2])

    def _phases(self, teeth: int) -> list[Fraction]:
        return [Fraction(teeth * place, self.turn) % 1 for place in self.places]

    @property
    def denominator(self) -> int:
        """Phases are whole multiples of one over this."""
        return lcm(*(each.denominator for each in (*self.phases, *self.phases_of_second)))

    @property
    def equally_spaced(self) -> bool:
        """Whether all planets stand at one angle from the next."""
        steps = {(after - before) % self.turn for before, after in pairwise([*self.places, self.places[0]])}
        return len(steps) == 1

    def phase_law(self, harmonics: int, of_second: bool = False) -> str:
        """What the first so many harmonics of the mesh forces of equal planets with the sun, or `of_second`, do to sun,
        ring and carrier: "r" turn them, "t" push them aside, "b" both, "p" neither. With N planets at one spacing it is
        r where z_s l is a multiple of N, t where it is one more or less."""
        phases = self.phases_of_second if of_second else self.phases
        return "".join(self._of_harmonic(harmonic, phases) for harmonic in range(1, harmonics + 1))

    def _of_harmonic(self, harmonic: int, phases: Sequence[Fraction]) -> str:
        turned = [2.0 * pi * float(harmonic * phase % 1) for phase in phases]
        torque = _size(turned)
        aside = max(_size([one + sign * other for one, other in zip(turned, self.angles)]) for sign in (1.0, -1.0))
        least = NOTHING_LEFT * self.planets
        return {(True, False): ROTATION, (False, True): TRANSLATION, (True, True): BOTH, (False, False): NEITHER}[
            torque > least, aside > least
        ]

    @cached_property
    def neighbours(self) -> list[tuple[int, int, float]]:
        """Planets beside each other, and the angle (rad) between them."""
        order = sorted(range(self.planets), key=lambda each: self.places[each] % self.turn)
        found = []
        for one, other in pairwise([*order, order[0]]):
            between = (self.places[other] - self.places[one]) % self.turn or self.turn
            found.append((one, other, 2.0 * pi * between / self.turn))
        return found

    def clearances(self, centre_distance: float, tip_diameter: float) -> list[tuple[int, int, float]]:
        """Planets beside each other, and the distance (mm) between their tip circles, negative where they overlap."""
        return [
            (one, other, 2.0 * centre_distance * sin(0.5 * min(angle, 2.0 * pi - angle)) - tip_diameter)
            for one, other, angle in self.neighbours
        ]


def _size(angles: Sequence[float]) -> float:
    """Length of a sum of unit vectors."""
    along = sum(map(cos, angles))
    across = sum(map(sin, angles))
    return float((along**2 + across**2) ** 0.5)


def planets_that_assemble(turn: int, centre_distance: float, tip_diameter: float) -> list[int]:
    """Numbers of equally spaced planets, two or more, that can be assembled where a turn has so many places, and keep
    clear of each other."""
    return [
        count
        for count in range(2, turn + 1)
        if turn % count == 0 and 2.0 * centre_distance * sin(pi / count) > tip_diameter
    ]
