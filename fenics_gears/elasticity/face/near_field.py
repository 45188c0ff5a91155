"""What the layers of a body over the face leave out near a load.

A load on part of a layer moves the flank more than a parabola over the layer can tell. What is missing varies along the
face within a layer, and so decays within that length, down the tooth too: it does not depend on rim, web, bore or
neighbours. It is the difference between two teeth that are held at their root and differ in their layers alone:

    D = T(thin layers) - I T(layers of the body) I^T

with I the interpolation of the second along the face. D is added to the body's compliance of a tooth under its own
load, along the contact normal of each flank node. Of each layer it is found on the layer and its neighbours
(measured: docs/evidence/third_dimension.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil

import numpy as np
from scipy import sparse

# Modules: thickness of the thin layers.
THIN = 0.45
# Layers on either side whose loads a layer feels: so many, and as many as are so many modules together. An even load
# then leaves 0.002 of the plane displacement, which differs from layer to layer; 0.018 with one layer, which made
# K_Hbeta 0.6 % too large, of thick layers and 28 degrees 1.0 %.
FEWEST_FELT = 2
FELT = 2.7
# Of a face whose layers differ: how many times as many layers one held tooth may have.
LARGEST_WHOLE = 2


@dataclass(frozen=True)
class NearField:
    """heights: (H,), mm, of the nodes of the thin layers. normals: (flanks, n, 3), of the flank nodes of a section.
    compliance: of each flank, sparse (H n, H n), mm/N, along these normals."""

    heights: np.ndarray
    normals: np.ndarray
    compliance: tuple[sparse.csr_matrix, ...]

    def scaled(self, module: float, youngs_modulus: float) -> NearField:
        """Of a gear of that module (mm) and Young's modulus (MPa), from that of one of module 1 and 1 MPa."""
        factor = 1.0 / (module * youngs_modulus)
        return replace(self, heights=module * self.heights, compliance=tuple(factor * each for each in self.compliance))

    def of_flanks(self, own: slice) -> NearField:
        """That of some flanks alone."""
        return replace(self, normals=self.normals[own], compliance=self.compliance[own])

    @property
    def arrays(self) -> dict[str, np.ndarray]:
        """For the cache."""
        arrays = {"near_heights": self.heights, "near_normals": self.normals}
        for number, each in enumerate(self.compliance):
            parts = {"data": each.data, "indices": each.indices, "indptr": each.indptr}
            arrays |= {f"near_{name}_{number}": part for name, part in parts.items()}
        return arrays

    @classmethod
    def of_arrays(cls, arrays: dict[str, np.ndarray]) -> NearField:
        """From what `arrays` gave."""
        heights, normals = (arrays[f"near_{name}"] for name in ("heights", "normals"))
        size = len(heights) * normals.shape[1]
        compliance = (
            sparse.csr_matrix(
                tuple(arrays[f"near_{part}_{number}"] for part in ("data", "indices", "indptr")), shape=(size, size)
            )
            for number in range(len(normals))
        )
        return cls(heights, normals, tuple(compliance))


def thin_boundaries(boundaries: np.ndarray) -> np.ndarray:
    """Boundaries of thin layers, among them those given."""
    inner = [np.linspace(*ends, thin_layers(ends[1] - ends[0]) + 1)[:-1] for ends in zip(boundaries, boundaries[1:])]
    return np.append(np.concatenate(inner), boundaries[-1])


def thin_layers(thickness: float) -> int:
    """Thin layers of a layer."""
    return ceil(thickness / THIN - 1e-9)


def neighbours(thick: Sequence[float]) -> list[slice]:
    """For each of layers of some thicknesses (modules) those on which its D is found. They are as many near an end of
    the face as elsewhere: where layers are alike, one held tooth tells all. Where they differ, one of the whole face
    does, unless that is much larger."""
    ends = np.concatenate([[0.0], np.cumsum(thick)])
    layers = len(thick)
    # The fewest layers that are FELT together wherever they begin, but FEWEST_FELT.
    beside = next(
        (many for many in range(FEWEST_FELT, layers) if (ends[many:] - ends[:-many]).min() >= FELT - 1e-9), layers
    )
    most = min(2 * beside + 1, layers)
    first = np.clip(np.arange(layers) - beside, 0, layers - most)
    found = [slice(low, low + most) for low in first.tolist()]
    unlike = len({tuple(thick[near]) for near in found})
    whole = unlike * most >= layers and layers <= LARGEST_WHOLE * most
    return [slice(0, layers)] * layers if whole else found
