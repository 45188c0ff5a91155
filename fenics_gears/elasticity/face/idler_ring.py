"""The ring of a gear that one mate loads on the drive flanks and another one, elsewhere, on the coast flanks.

Drive and coast flanks far from each other feel each other by few motions of the body: all that reaches a far tooth are
forces and moments, and how these are spread along the face. With blocks B of both kinds of flanks, one tooth m pitches
ahead of the other,

    B(m) = D H(m) C^T

with the motions D of a drive flank and C of a coast flank, which are the same for all m, and small H.
"""

import numpy as np

from ..compliance import Reach
from ..ring import cut_response, sector_response

# Motions are left out that move flanks by less than this part of the largest: the compliance of a flank itself, ten
# times as large, is not known better from its finite elements.
LEAST_MOTION = 1e-6


def idler_blocks(held: np.ndarray, to_cuts: np.ndarray, link: np.ndarray, teeth: int, reach: Reach) -> dict:
    """Arrays of an idler's body, from what `ring.between_cuts` gives of both flanks (2 f dofs), the coast flank's in
    the mirrored frame.

    "blocks" and "coast" (same + 1, f, f): of the drive flank and, seen in the mirror, of the coast flank of teeth
    ahead. "drive_motions", "coast_motions" (f, r) and "across" (k, r, r'): of drive flanks by coast flanks, from
    `reach.across[0]` pitches ahead on.
    """
    half = len(held) // 2
    joint = cut_response(link, teeth, reach.farthest + 1)
    drive = to_cuts[:half]
    coast = to_cuts[half:]
    offsets = range(reach.same + 1)
    found = {
        "blocks": np.stack([drive @ sector_response(joint, ahead) @ drive.T for ahead in offsets]),
        # In the mirror a tooth ahead is one behind.
        "coast": np.stack([coast @ sector_response(joint, -ahead) @ coast.T for ahead in offsets]),
    }
    found["blocks"][0] += held[:half, :half]
    found["coast"][0] += held[half:, half:]
    for name in ("blocks", "coast"):
        found[name][0] = 0.5 * (found[name][0] + found[name][0].T)
    first, last = reach.across
    across = np.stack([drive @ sector_response(joint, ahead) @ coast.T for ahead in range(first, last + 1)])
    if first <= 0 <= last:
        across[-first] += held[:half, half:]
    return found | _by_few_motions(across)


def _by_few_motions(across: np.ndarray) -> dict:
    """Of blocks (k, f, f)."""
    drive = _motions(sum(block @ block.T for block in across))
    coast = _motions(sum(block.T @ block for block in across))
    return {"drive_motions": drive, "coast_motions": coast, "across": drive.T @ across @ coast}


def _motions(squares: np.ndarray) -> np.ndarray:
    """Orthonormal motions (f, r), of which sums of squares (f, f) are made."""
    sizes, directions = np.linalg.eigh(squares)
    return np.ascontiguousarray(directions[:, sizes > LEAST_MOTION**2 * sizes[-1]])
