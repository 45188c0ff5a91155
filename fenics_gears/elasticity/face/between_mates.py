"""The ring of a gear that several mates load, each elsewhere around it, on its drive flanks or on its coast flanks.

Flanks that different mates load feel each other by few motions of the body: all that reaches a far tooth are forces and
moments, and how these are spread along the face. With blocks B of two kinds of flanks, one tooth m pitches ahead of the
other,

    B(m) = D H(m) C^T

with the motions D of the one flank and C of the other, which are the same for all m, and small H.
"""

import numpy as np

from ..compliance import Reach
from ..ring import cut_response, joined_blocks, sector_response

# Motions are left out that move flanks by less than this part of the largest: the compliance of a flank itself, ten
# times as large, is not known better from its finite elements.
LEAST_MOTION = 1e-6


def blocks_between_mates(parts: tuple[np.ndarray, np.ndarray, np.ndarray], teeth: int, reach: Reach) -> dict:
    """Arrays of the body, from the `parts` that `ring.between_cuts` gives of its drive flank (f dofs), or with
    `reach.across` of both flanks, the coast flank's in the mirrored frame.

    "blocks_0" and "blocks_1" (same + 1, f, f): of the drive flank and, seen in the mirror, of the coast flank of teeth
    ahead; with `reach.own` "blocks" (m + 1, 2 f, 2 f) of both flanks in their place. "motions_0", "motions_1" (f, r) of
    drive and coast flanks, and "between_01" and the like (k, r, r') of drive flanks by coast flanks, from the least
    distance of `reach.between_mates` on.
    """
    held, to_cuts, link = parts
    kinds = 1 if reach.across is None else 2
    joint = cut_response(link, teeth, reach.farthest + 1)
    dofs = [slice(len(held) * kind // kinds, len(held) * (kind + 1) // kinds) for kind in range(kinds)]
    on_cuts = [to_cuts[own] for own in dofs]

    def block(kind: int, other: int, ahead: int) -> np.ndarray:
        found = on_cuts[kind] @ sector_response(joint, ahead) @ on_cuts[other].T
        return found if ahead else found + held[dofs[kind], dofs[other]]

    arrays = {}
    if reach.own is not None:
        arrays["blocks"] = joined_blocks(*parts, teeth, reach.of_one_mate)
    for kind in range(kinds if reach.own is None else 0):
        # In the mirror a tooth ahead is one behind.
        own = np.stack([block(kind, kind, -ahead if kind else ahead) for ahead in range(reach.same + 1)])
        own[0] = 0.5 * (own[0] + own[0].T)
        arrays[f"blocks_{kind}"] = own
    wanted = reach.between_mates
    squares = np.zeros((kinds, *(2 * (len(held) // kinds,))))
    for (kind, other), (first, last) in wanted.items():
        for ahead in range(first, last + 1):
            found = block(kind, other, ahead)
            squares[kind] += found @ found.T
            squares[other] += found.T @ found
    motions = list(map(_motions, squares))
    seen = [of_kind.T @ own for of_kind, own in zip(motions, on_cuts)]
    for (kind, other), (first, last) in wanted.items():
        distances = range(first, last + 1)
        between = np.stack([seen[kind] @ sector_response(joint, ahead) @ seen[other].T for ahead in distances])
        if first <= 0 <= last:
            between[-first] += motions[kind].T @ held[dofs[kind], dofs[other]] @ motions[other]
        arrays[f"between_{kind}{other}"] = between
    return arrays | {f"motions_{kind}": own for kind, own in enumerate(motions)}


def _motions(squares: np.ndarray) -> np.ndarray:
    """Orthonormal motions (f, r), of which sums of squares (f, f) are made."""
    sizes, directions = np.linalg.eigh(squares)
    return np.ascontiguousarray(directions[:, sizes > LEAST_MOTION**2 * sizes[-1]])
