"""How a gear's body is divided into finite elements in three dimensions."""

from __future__ import annotations

from dataclasses import asdict, astuple, dataclass, replace

import numpy as np

from fenics_gears.errors import SceneError
from fenics_gears.geometry.gear import DECIMALS_IN_MODULES, Gear

from ..element_sizes import ElementSizes
from .layers import Sweep, SweptWeb, layers_of_face, layers_with_web

# Rad, of a layer: its nodes lie on a helix, with parabolas between them.
LARGEST_TURN = 0.5


@dataclass(frozen=True)
class FaceDiscretisation:
    """A section of elements, second order, that is swept along the face in layers.

    section_size: mm, of the elements along the flanks. layers: over the face. face_width: mm. twist: rad/mm, of the
    section along z, counter-clockwise positive. overhang: mm, at either end of the face, beyond the part that the mate
    touches. It has overhang_layers of the layers, all of one thickness; the layers of the rest are of one thickness
    too. web: lengths in mm, its sides are boundaries of layers too.
    """

    section_size: float
    layers: int
    face_width: float
    twist: float = 0.0
    overhang: float = 0.0
    overhang_layers: int = 0
    web: SweptWeb | None = None

    @property
    def sizes(self) -> ElementSizes:
        """Element sizes (mm) of the section, which is symmetric about the tooth's centreline."""
        # What the section misses without variation along the face, a fine section adds: elements half as large in
        # fillet, rim and hub change the sum by less than 0.05 %.
        size = self.section_size
        return ElementSizes(
            flank=size, fillet=size, coast=size, body=4.0 * size, depth=1.0, growth=1.0, both_flanks=True, hub_angle=0.2
        )  # fmt: skip

    @property
    def sweep(self) -> Sweep:
        """Layers and twist of the body."""
        inner = self.layers - 2 * self.overhang_layers, self.face_width - 2.0 * self.overhang
        boundaries = layers_of_face(*inner, self.overhang_layers, self.overhang)
        if self.web is not None:
            boundaries = layers_with_web(boundaries, self.web.low, self.web.high)
        return Sweep(boundaries, self.twist, self.web)

    @property
    def largest_turn(self) -> float:
        """Rad, by which the section turns over the thickest layer."""
        return abs(self.twist) * float(np.diff(self.sweep.boundaries).max())

    def in_modules_of(self, gear: Gear) -> FaceDiscretisation:
        """The same with lengths as multiples of a gear's module."""
        size, width, overhang = gear.in_modules(self.section_size, self.face_width, self.overhang)
        twist = round(self.twist * gear.module, DECIMALS_IN_MODULES)
        web = self.web and SweptWeb(*gear.in_modules(*astuple(self.web)))
        return replace(self, section_size=size, face_width=width, twist=twist, overhang=overhang, web=web)

    def inputs(self, gear: Gear, both_flanks: bool = True) -> dict:
        """The inputs of a gear's mesh other than the gear, with lengths in modules."""
        scaled = self.in_modules_of(gear)
        # The rule that lays the layers may change while their number does not.
        boundaries = scaled.sweep.boundaries.tolist()
        return {"face": asdict(scaled), "boundaries": boundaries, "sizes": asdict(scaled.sizes)}

    def check(self) -> None:
        """Raise SceneError for a value that has no meaning."""
        for name, value in (("section_size", self.section_size), ("face_width", self.face_width)):
            if not (np.isfinite(value) and value > 0.0):
                raise SceneError(f"{name} is {value} mm, must be positive and finite")
        if self.layers < 1:
            raise SceneError(f"layers is {self.layers}, must be 1 or more")
        if not self.largest_turn <= LARGEST_TURN:
            least = int(np.ceil(self.layers * self.largest_turn / LARGEST_TURN - 1e-9))
            raise SceneError(
                f"accuracy.layers = {self.layers}: a layer would turn by {self.largest_turn:.3g} rad, at most"
                f" {LARGEST_TURN} is accurate; take {least} or more"
            )
