"""The bodies of a model's gears in three dimensions, both at once where that pays."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial

from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.face.compliance import face_compliance
from fenics_gears.elasticity.face_compliance_data import FaceCompliance
from fenics_gears.inputs.tree import GEARS
from fenics_gears.model.face_cost import both_at_once
from fenics_gears.model.face_resolution import face_discretisation
from fenics_gears.model.model import Model
from fenics_gears.system.environment import threads
from fenics_gears.system.progress import Progress
from fenics_gears.system.second_process import SecondProcess, second_process

Solids = tuple[FaceCompliance, FaceCompliance]


@contextmanager
def begun(model: Model, progress: Progress, cache: Cache | None) -> Iterator[Callable[[], Solids]]:
    """What gives both bodies. Where there are cores and memory for both at once, a second process begins the wheel's
    here: to start it takes as long as both gears' sections."""

    def begin(number: int) -> None:
        progress.stage(f"condense {GEARS[number]}'s body")

    def by(wheel: Callable[[], FaceCompliance]) -> Solids:
        begin(0)
        pinion = solid_of(model, GEARS[0], cache)
        begin(1)
        return pinion, wheel()

    if threads() > 1 and both_at_once(model):
        with ThreadPoolExecutor(1) as waiting, second_process() as second:
            yield partial(by, waiting.submit(solid_of, model, GEARS[1], cache, second).result)
    else:
        yield partial(by, lambda: solid_of(model, GEARS[1], cache))


def solid_of(model: Model, name: str, cache: Cache | None, process: SecondProcess | None = None) -> FaceCompliance:
    """The body of the "pinion" or the "wheel" in three dimensions, from the cache or condensed."""
    gear = getattr(model.pair, name)
    material = model.scene.gears.material_of(name)
    division = face_discretisation(model, GEARS.index(name))
    return face_compliance(gear, material, division, model.touching.reach, cache, process)
